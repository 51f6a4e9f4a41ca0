//! The log: text on stderr, JSON lines in `log.jsonl`, the latest message beside the progress bar.

use std::fmt::{Debug, Write as _};
use std::fs::File;
use std::io;
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};

use tracing::field::{Field, Visit};
use tracing::{Event, Level, Subscriber};
use tracing_subscriber::filter::{LevelFilter, Targets};
use tracing_subscriber::fmt;
use tracing_subscriber::layer::{Context, Layer, SubscriberExt};
use tracing_subscriber::util::SubscriberInitExt;

use super::terminal::{AboveBars, TERMINAL};
use crate::case::significant;
use crate::observer::system::AtPath;
use crate::observer::warnings;

/// The file JSON lines go to just now. One process has one log, but may make several runs.
static FILE: Mutex<Option<File>> = Mutex::new(None);

/// Starts the log of this process; later calls only turn to the `log.jsonl` of another run.
///
/// `verbosity` is the number of `-v` on the command line: warnings, then 1 for what the program
/// does, 2 for details, 3 for everything; negative for errors only. The variable `ALEWIFE_LOG`
/// overrides it: a level, or pairs `target=level` separated by commas. `log.jsonl` in `directory`
/// always holds what the program does, and more if `verbosity` asks for more.
///
/// # Errors
/// When `log.jsonl` cannot be made, or `ALEWIFE_LOG` cannot be understood.
pub fn start_log(directory: Option<&Path>, verbosity: i8) -> io::Result<()> {
    let filter = |least: i8| match std::env::var("ALEWIFE_LOG") {
        Ok(directives) => directives.parse::<Targets>().map_err(|error| {
            let accepted = "a level such as `debug`, or pairs such as `alewife_core=debug`";
            let message = format!("ALEWIFE_LOG = `{directives}`: {error}; accepted: {accepted}");
            io::Error::new(io::ErrorKind::InvalidInput, message)
        }),
        Err(_) => Ok(Targets::new().with_default(level(verbosity.max(least)))),
    };
    let colour = TERMINAL.is_terminal() && std::env::var_os("NO_COLOR").is_none();
    let text = fmt::layer()
        .with_writer(|| AboveBars)
        .with_ansi(colour)
        .with_target(false)
        .without_time()
        .with_filter(filter(i8::MIN)?);
    // A full disk is reported once, by the file that stops the run
    let json = fmt::layer()
        .json()
        .log_internal_errors(false)
        .with_writer(|| ToFile)
        .with_filter(filter(1)?);
    *the_file() = match directory {
        None => None,
        Some(directory) => {
            let path = directory.join("log.jsonl");
            // A run that resumes in its own directory continues its log
            Some(File::options().append(true).create(true).open(&path).at(&path)?)
        }
    };
    let _ = tracing_subscriber::registry()
        .with(text)
        .with(json)
        .with(Latest)
        .with(Collected)
        .try_init();
    Ok(())
}

/// Writes to [`FILE`]; what is said while there is none is not kept.
struct ToFile;

impl io::Write for ToFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        the_file().as_mut().map_or(Ok(bytes.len()), |file| file.write(bytes))
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

fn the_file() -> MutexGuard<'static, Option<File>> {
    FILE.lock().unwrap_or_else(PoisonError::into_inner)
}

fn level(verbosity: i8) -> LevelFilter {
    match verbosity {
        ..=-1 => LevelFilter::ERROR,
        0 => LevelFilter::WARN,
        1 => LevelFilter::INFO,
        2 => LevelFilter::DEBUG,
        3.. => LevelFilter::TRACE,
    }
}

/// Shows the latest message beside the progress bar.
struct Latest;

impl<S: Subscriber> Layer<S> for Latest {
    fn on_event(&self, event: &Event<'_>, _context: Context<'_, S>) {
        if *event.metadata().level() <= Level::INFO {
            let mut words = Words::default();
            event.record(&mut words);
            TERMINAL.note(&(words.message + &words.fields));
        }
    }
}

/// Adds warnings to the list of the run, whatever the log shows.
struct Collected;

impl<S: Subscriber> Layer<S> for Collected {
    fn on_event(&self, event: &Event<'_>, _context: Context<'_, S>) {
        let is_ours = event.metadata().target().starts_with("alewife");
        if is_ours && *event.metadata().level() == Level::WARN {
            let mut words = Words::default();
            event.record(&mut words);
            warnings::add(words.message + &words.fields);
        }
    }
}

/// An event as one line of text: its message, then its fields.
#[derive(Default)]
struct Words {
    message: String,
    fields: String,
}

impl Visit for Words {
    fn record_debug(&mut self, field: &Field, value: &dyn Debug) {
        // Writing to a string cannot fail.
        let _ = match field.name() {
            "message" => write!(self.message, "{value:?}"),
            name => write!(self.fields, "  {name} {value:?}"),
        };
    }

    fn record_f64(&mut self, field: &Field, value: f64) {
        let _ = write!(self.fields, "  {} {}", field.name(), significant(value));
    }

    fn record_str(&mut self, field: &Field, value: &str) {
        let _ = write!(self.fields, "  {} {value}", field.name());
    }
}
