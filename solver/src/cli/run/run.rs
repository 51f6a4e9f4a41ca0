//! `run`: one case, its files, and how it compares with its references.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::Instant;

use clap::{Args, ValueHint};

use super::continuation::{Beginning, beginning, n_requeued};
use super::live;
use super::results::{print_comparisons, tell_cell_numbers, tell_last_values, tell_step_errors};
use crate::case::{Case, CaseFile, TimeSettings, rounded};
use crate::cli::complete;
use crate::cli::engine::{self, Resumed, RunInto, SignalWatch, WallLimit, threads, too_large};
use crate::cli::exit::{Exit, Failure};
use crate::cli::read::{Settings, read_case};
use crate::cli::style::{complain, say};
use crate::observer::{
    COMPARISON_FILE, Earlier, FAILURE_STATE, History, Point, RunDirectory, Shown, Start,
    checkpoints, read_state, run_of_state, write_atomic,
};
use crate::run::{Dimension, RunError, RunSummary, SavedState, Solve};
use crate::step::FlowError;
use crate::timing::cpu_seconds;
use crate::validation::{Comparison, compare, comparisons_to_json};

/// What `run` is asked for.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  alewife run squirmer-alone
  alewife run sphere-in-tube/free-0.5 --threads 4 --out free
  alewife run my.toml --set fluid.viscosity=0.5 --set 'body.0.center=[1.0, 2.0]'

A run that was stopped or killed continues when it is run again: from its latest checkpoint, with the
same bits as without the interruption.

The run directory holds the case as it was run (case.toml), series.csv, run.mcap, fields/ and
fields.pvd, checkpoints/, status.json, log.jsonl, provenance.json, bodies.json and comparison.json. A
file STOP made in it stops the run after its step, a file CHECKPOINT has it write its state.")]
pub struct Options {
    /// Which case
    #[arg(add = complete::case())]
    case: String,
    #[command(flatten)]
    settings: Settings,
    /// Directory of the run; `runs/<case>` if absent
    #[arg(long, short, value_name = "DIR", value_hint = ValueHint::DirPath)]
    out: Option<PathBuf>,
    /// Threads; by default those the batch system or the machine grants
    #[arg(long, short, value_name = "N")]
    threads: Option<usize>,
    /// Continue from the state of another run, or of this one with other settings: the directory of a run,
    /// or one of its checkpoints/*.state or failure/last.state
    #[arg(long, value_name = "STATE")]
    resume: Option<PathBuf>,
    /// Continue a finished run, too, where the case ends later now; it is done where it does not. Given by
    /// itself to a job that its batch system has started again
    #[arg(long = "continue")]
    continues: bool,
    /// Stop in time for a checkpoint within this time on the clock, such as "2 h"; by default the end
    /// of the batch job
    #[arg(long, value_name = "TIME")]
    max_walltime: Option<String>,
    /// Show the run to viewers that speak the WebSocket protocol of Foxglove, such as its app: they connect
    /// to ws://ADDRESS:PORT
    #[arg(
        long,
        value_name = "ADDRESS:PORT",
        num_args = 0..=1,
        default_missing_value = live::DEFAULT_ADDRESS
    )]
    live: Option<String>,
    /// Do not compare with references
    #[arg(long)]
    no_references: bool,
    /// Replace a finished run
    #[arg(long)]
    overwrite: bool,
    /// No progress on the terminal
    #[arg(long, short)]
    quiet: bool,
    /// Print more on the terminal; repeat for details
    #[arg(long, short, action = clap::ArgAction::Count)]
    verbose: u8,
}

/// How a point of a sweep is run.
pub struct PointRun {
    /// Its directory.
    pub out: PathBuf,
    /// Threads.
    pub threads: Option<usize>,
    /// Its time on the clock.
    pub max_walltime: Option<String>,
    /// Whether an earlier run is replaced, and not continued.
    pub overwrite: bool,
    /// Whether there is no progress on the terminal.
    pub quiet: bool,
}

impl Options {
    /// What a point of a sweep is asked for, whose case has been read.
    pub fn of_point(point: PointRun) -> Self {
        let PointRun { out, threads, max_walltime, overwrite, quiet } = point;
        Self {
            case: String::new(),
            settings: Settings { set: Vec::new() },
            out: Some(out),
            threads,
            resume: None,
            continues: true,
            max_walltime,
            live: None,
            no_references: false,
            overwrite,
            quiet,
            verbose: 0,
        }
    }
}

/// Runs a case.
pub fn run(options: &Options) -> Result<Exit, Failure> {
    run_file(options, &read_case(&options.case, &options.settings.set)?)
}

/// Runs a case that has been read.
pub fn run_file(options: &Options, file: &CaseFile) -> Result<Exit, Failure> {
    match file.case().geometry.dimensions() {
        2 => run_in::<2>(options, file),
        _ => run_in::<3>(options, file),
    }
}

fn run_in<const D: usize>(options: &Options, file: &CaseFile) -> Result<Exit, Failure>
where
    Dimension<D>: Solve<D>,
{
    let (name, started) = (file.full_name(), Instant::now());
    let out = options.out.clone().unwrap_or_else(|| Path::new("runs").join(name.replace('/', "-")));
    // From here on, so that no signal ends the process without a word, and no other process writes to what is read
    let watch = SignalWatch::start()?;
    let limit = WallLimit::new(options.max_walltime.as_deref())?;
    let has_limit_asked = limit.as_ref().map(WallLimit::has_asked);
    let live = options.live.as_deref().map(|address| live::start(address, &name)).transpose()?;
    let lock = RunDirectory::hold(&out)?;
    let resumed: Option<Resumed<D>> = match beginning_of(options, file, &out)? {
        Beginning::AtStart => None,
        Beginning::From(resumed) => Some(*resumed),
        Beginning::IsDone => {
            say(&format!("{} has come to its end before", out.display()));
            return Ok(Exit::Done);
        }
    };
    let earlier = match &resumed {
        Some(resumed) if resumed.is_in_place => Earlier::Continue,
        _ if options.overwrite => Earlier::Replace,
        _ => Earlier::Keep,
    };
    if earlier != Earlier::Continue {
        check_lies_elsewhere(file, &out)?;
    }
    let n_threads = threads::start(options.threads)?;
    let from = resumed.as_ref().map_or(Point::default(), |resumed| Point {
        step: resumed.state.step(),
        time: resumed.state.time(),
    });
    let start = Start { threads: n_threads, from, lock };
    let directory = RunDirectory::create(&out, file.case(), start, earlier)?;
    let verbosity = i8::try_from(options.verbose).unwrap_or(i8::MAX) - i8::from(options.quiet);
    engine::start_log(Some(&out), verbosity)?;

    if let Some(resumed) = &resumed {
        tell_of_resuming(resumed, options.quiet);
    }
    let shown = Shown { quiet: options.quiet, live };
    let run = RunInto { directory: &directory, shown, watch, limit };
    let outcome =
        engine::simulate_into(&file.model, resumed.as_ref(), run).map_err(|error| match error {
            RunError::Flow(FlowError::Stopped { step, .. }) => {
                let is_over = has_limit_asked.is_some_and(|asked| asked.load(Ordering::Relaxed));
                stopped(&error, why_stopped(is_over, step > from.step), &out)
            }
            other => too_large::failure(file, other),
        })?;
    let comparisons =
        if options.no_references { Vec::new() } else { compare(&name, file.case(), &outcome) };
    if !comparisons.is_empty() {
        write_comparisons(&directory, &comparisons)?;
    }
    print_comparisons(&comparisons);
    if comparisons.is_empty() {
        tell_last_values(&file.model, &outcome);
    }
    let before = resumed.as_ref().map_or(0, |resumed| resumed.state.step());
    tell_cost(file, &outcome, Spent { steps_before: before, started }, &out);
    tell_cell_numbers(&outcome);
    tell_step_errors(&outcome);
    Ok(Exit::Done)
}

/// From where on a run has taken time.
#[derive(Clone, Copy)]
struct Spent {
    steps_before: usize,
    started: Instant,
}

/// Tells what a run has cost, and where it is.
fn tell_cost(file: &CaseFile, outcome: &RunSummary, spent: Spent, out: &Path) {
    let (seconds, wall) = (cpu_seconds(), spent.started.elapsed().as_secs_f64());
    let remeshes = outcome.series.column("flow.remeshes").and_then(|all| all.last().copied());
    let moving = remeshes.map_or_else(String::new, |remeshes| {
        let steps = outcome.steps - spent.steps_before;
        format!(", {:.3} s of it a step, {remeshes} remeshings", seconds / steps.max(1) as f64)
    });
    let steps = n_steps(file, outcome.steps);
    say(&format!(
        "{} unknowns,{steps} {seconds:.2} s of CPU time, {wall:.2} s on the clock{moving}; \
         written to {}",
        outcome.n_dofs,
        out.display()
    ));
}

/// How many steps a run has made; nothing of a steady solution, which has none.
fn n_steps(file: &CaseFile, steps: usize) -> String {
    match file.case().time {
        TimeSettings::Steady(_) => String::new(),
        TimeSettings::Unsteady(_) => format!(" {steps} steps,"),
    }
}

/// What a run begins with: a state that is asked for, or one in its directory.
fn beginning_of<const D: usize>(
    options: &Options,
    file: &CaseFile,
    out: &Path,
) -> Result<Beginning<D>, Failure> {
    match &options.resume {
        Some(path) => Ok(Beginning::From(Box::new(read_resumed(path, file.case(), out)?))),
        None if options.overwrite => Ok(Beginning::AtStart),
        None => beginning(out, file, options.continues || n_requeued() > 0),
    }
}

/// Tells from where a run goes on.
fn tell_of_resuming<const D: usize>(resumed: &Resumed<D>, quiet: bool) {
    let (step, time, from) = (resumed.state.step(), resumed.state.time(), resumed.from.display());
    tracing::info!(step, time, from = %from, "resumed");
    if !quiet {
        let time = rounded(time);
        complain(&format!("continues at step {step}, t {time}, from {from}"));
    }
}

/// Refuses to clear the directory that the case file lies in.
fn check_lies_elsewhere(file: &CaseFile, out: &Path) -> Result<(), Failure> {
    if !is_inside(Path::new(&file.file), out) {
        return Ok(());
    }
    let (file, out) = (&file.file, out.display());
    let reason = format!("{file} lies in {out}, which a new run would clear; give another --out");
    Err(Failure::new(Exit::Usage, reason))
}

/// Writes the comparison with the references, and what was run.
fn write_comparisons(directory: &RunDirectory, all: &[Comparison]) -> std::io::Result<()> {
    let mut json = comparisons_to_json(all);
    json["provenance"] = serde_json::to_value(&directory.provenance().origin)?;
    write_atomic(&directory.path().join(COMPARISON_FILE), format!("{json:#}\n").as_bytes())
}

/// Whether a file lies in a directory.
fn is_inside(file: &Path, directory: &Path) -> bool {
    match (file.canonicalize(), directory.canonicalize()) {
        (Ok(file), Ok(directory)) => file.starts_with(directory),
        _ => false,
    }
}

/// Why a run was stopped, as far as that is known: whether its time was over, and whether it made a step.
fn why_stopped(is_over: bool, has_gone_on: bool) -> &'static str {
    match (is_over, has_gone_on) {
        (false, _) => "",
        (true, true) => ", in time for the limit of its time on the clock",
        (true, false) => {
            ": the limit of its time on the clock (--max-walltime) has left none for a step and a checkpoint"
        }
    }
}

/// A run that was stopped: why, and what to type to go on.
fn stopped(error: &RunError, why: &str, out: &Path) -> Failure {
    let mut arguments = std::env::args();
    let mut command = vec![program(&arguments.next().unwrap_or_default())];
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--resume" => drop(arguments.next()),
            "--overwrite" => {}
            other if other.starts_with("--resume=") => {}
            other => command.push(quoted(other)),
        }
    }
    let remedy = if checkpoints(out).is_ok_and(|found| !found.is_empty()) {
        format!("it continues with\n  {}", command.join(" "))
    } else {
        "it left no state to resume from".to_owned()
    };
    // Who stops a run makes no error
    Failure { exit: Exit::Stopped, message: format!("{error}{why}; {remedy}") }
}

/// How the program was called: from here that works again.
fn program(typed: &str) -> String {
    if typed.is_empty() { "alewife".to_owned() } else { quoted(typed) }
}

/// The state a path names: the latest checkpoint, where it is the directory of a run, or its last state.
fn state_in(path: &Path) -> PathBuf {
    if !path.is_dir() {
        return path.to_owned();
    }
    let last = path.join(FAILURE_STATE);
    let latest = checkpoints(path).ok().and_then(|found| found.into_iter().next());
    latest.or_else(|| last.is_file().then_some(last)).unwrap_or_else(|| path.to_owned())
}

/// A word as a shell reads it.
pub fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,:+@%".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

/// Reads a state, and what the run it lies in has written up to there.
fn read_resumed<const D: usize>(
    path: &Path,
    case: &Case,
    out: &Path,
) -> Result<Resumed<D>, Failure> {
    let path = &state_in(path);
    let state = read_unfinished(path, case)?;
    let run = run_of_state(path);
    let is_in_place = run.is_some_and(|run| is_inside(run, out) && is_inside(out, run));
    let mut history = run.map(|run| History::read(run, state.step(), state.time())).transpose()?;
    if let Some(history) = history.as_mut().filter(|_| !is_in_place) {
        // The field files stay where they are
        history.frames.clear();
    }
    Ok(Resumed { state, history, is_in_place, from: path.clone() })
}

/// Reads the state a run left before the end of a case.
fn read_unfinished<const D: usize>(path: &Path, case: &Case) -> Result<SavedState<D>, Failure> {
    let refuse = |exit, reason: String| {
        let leaves = "runs in time leave checkpoints/*.state, one that failed failure/last.state";
        Failure::new(exit, format!("--resume: {reason}; {leaves}"))
    };
    let TimeSettings::Unsteady(settings) = &case.time else {
        return Err(refuse(Exit::Usage, "a steady solution cannot be resumed".to_owned()));
    };
    let saved = read_state(path).map_err(|error| match error.kind() {
        ErrorKind::InvalidData => refuse(Exit::BadCase, error.to_string()),
        _ => refuse(Exit::NoInput, error.to_string()),
    })?;
    // Before anything of a run directory is touched
    saved.check_case(case).map_err(|error| {
        let path = path.display();
        Failure::new(Exit::BadCase, format!("cannot resume from {path}: {error}"))
    })?;
    if saved.time() >= settings.end {
        let (path, time, end) = (path.display(), saved.time(), settings.end);
        let reason = format!(
            "cannot resume from {path}: it is at time {time}, and the case ends at {end}; raise \
             time.unsteady.end"
        );
        return Err(Failure::new(Exit::BadCase, reason));
    }
    Ok(saved)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_is_what_was_typed() {
        assert_eq!(program("alewife"), "alewife");
        assert_eq!(program("./my tools/alewife"), "'./my tools/alewife'");
        assert_eq!(program("target/release/alewife"), "target/release/alewife");
        assert_eq!(program("/home/me/targets/alewife"), "/home/me/targets/alewife");
    }
}
