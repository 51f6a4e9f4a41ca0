//! The terminal, which log and progress share so that neither writes into the other's line.

use std::io::{self, IsTerminal, Write};
use std::sync::{LazyLock, Mutex, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{MultiProgress, ProgressBar};

/// Time between two plain lines where stderr is not a terminal.
pub const LINE_INTERVAL: Duration = Duration::from_secs(10);

/// The one terminal of the process, as there is one stderr.
pub static TERMINAL: LazyLock<Terminal> = LazyLock::new(|| Terminal {
    bars: MultiProgress::new(),
    notes: Mutex::new(Notes::Dropped),
    is_terminal: io::stderr().is_terminal(),
});

/// Where notes on what the program does just now are shown.
enum Notes {
    Dropped,
    Bar(ProgressBar),
    Lines { last: Instant },
}

/// Writes one line to stderr, above any bar.
pub fn print_line(text: &str) {
    TERMINAL.line(text);
}

/// See [`TERMINAL`].
pub struct Terminal {
    bars: MultiProgress,
    notes: Mutex<Notes>,
    is_terminal: bool,
}

/// Columns of the terminal that a stream is; 80 if it is none, or does not say.
pub fn columns_of(stream: impl std::os::fd::AsFd) -> usize {
    let size = rustix::termios::tcgetwinsize(stream);
    size.map(|size| usize::from(size.ws_col)).ok().filter(|columns| *columns > 0).unwrap_or(80)
}

impl Terminal {
    /// Whether stderr is a terminal.
    pub fn is_terminal(&self) -> bool {
        self.is_terminal
    }

    /// Its columns; 80 if it does not say.
    pub fn width(&self) -> usize {
        columns_of(io::stderr())
    }

    /// Shows a bar, and the notes beside it.
    pub fn show(&self, bar: ProgressBar) -> ProgressBar {
        let bar = self.bars.add(bar);
        self.set_notes(Notes::Bar(bar.clone()));
        bar
    }

    /// Shows notes as plain lines, not too many of them.
    pub fn show_lines(&self) {
        self.set_notes(Notes::Lines { last: Instant::now() });
    }

    /// Shows no more notes.
    pub fn drop_notes(&self) {
        self.set_notes(Notes::Dropped);
    }

    /// Says what the program does just now.
    pub fn note(&self, text: &str) {
        match &mut *self.notes.lock().unwrap_or_else(PoisonError::into_inner) {
            Notes::Dropped => {}
            Notes::Bar(bar) => bar.set_message(text.to_owned()),
            Notes::Lines { last } => {
                if last.elapsed() >= LINE_INTERVAL {
                    *last = Instant::now();
                    self.line(text);
                }
            }
        }
    }

    /// Writes one line above any bar. A terminal that is gone is no reason to stop a run.
    pub fn line(&self, text: &str) {
        let _ = self.bars.suspend(|| writeln!(io::stderr(), "{text}"));
    }

    fn set_notes(&self, notes: Notes) {
        *self.notes.lock().unwrap_or_else(PoisonError::into_inner) = notes;
    }
}

/// Writes log lines above any bar.
pub struct AboveBars;

impl Write for AboveBars {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        TERMINAL.bars.suspend(|| io::stderr().write(bytes))
    }

    fn flush(&mut self) -> io::Result<()> {
        io::stderr().flush()
    }
}
