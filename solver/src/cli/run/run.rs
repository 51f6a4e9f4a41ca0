//! `run`: one case, its files, and how it compares with its references.

use std::cell::OnceCell;
use std::path::{Path, PathBuf};

use clap::{Args, ValueHint};

use super::fidelity::Fidelity;
use super::reduced;
use super::results::{
    print_cell_numbers, print_comparisons, print_last_values, print_run_warnings, print_step_errors,
};
use crate::case::soft::SoftFile;
use crate::case::{CaseFile, TimeSettings, WallTime};
use crate::cli::exit::{Exit, Failure};
use crate::cli::read::{CheckedCase, Settings, print_warnings, read_for_flow};
use crate::cli::style::say;
use crate::cli::{complete, soft};
use crate::runner::{self, Finished, Outcome, RunPlan, Stopped};
use crate::timing::cpu_seconds;

/// What is left of a run that was stopped before its first state.
const NO_STATE: &str = "it left no state to resume from, and begins again when it is run again";
/// The same of one that is steady.
const STEADY: &str = "it left no state to resume from: a steady run keeps nothing on its way, and begins again when \
                      it is run again";

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
    /// Which model of the swimmer is run; by default the full solver, or the only model of a case without a flow
    #[arg(long, value_name = "MODEL", value_enum)]
    fidelity: Option<Fidelity>,
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
    /// Ask for what was asked for in a session: its commands.csv. Needed for a case with a `command`
    #[arg(long, value_name = "CSV", value_hint = ValueHint::FilePath)]
    replay: Option<PathBuf>,
    /// Continue a finished run, too, where the case ends later now; it is done where it does not. Given by
    /// itself to a job that its batch system has started again
    #[arg(long = "continue")]
    continues: bool,
    /// Stop in time for a checkpoint within this time on the clock, such as "2 h"; by default the end
    /// of the batch job
    #[arg(long, value_name = "TIME")]
    max_walltime: Option<WallTime>,
    /// Show the run to viewers that speak the WebSocket protocol of Foxglove, such as its app: they connect
    /// to ws://ADDRESS:PORT
    #[arg(
        long,
        value_name = "ADDRESS:PORT",
        num_args = 0..=1,
        default_missing_value = runner::DEFAULT_ADDRESS
    )]
    live: Option<String>,
    /// Let web pages of this origin look on, too, such as https://app.foxglove.dev; pages of this machine and programs
    /// other than browsers always may. A name alone is one by which viewers call this machine. May be repeated
    #[arg(long, value_name = "ORIGIN", requires = "live")]
    live_origin: Vec<String>,
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
    /// The model, once it has been looked for.
    #[arg(skip)]
    found: OnceCell<Fidelity>,
}

impl Options {
    /// Whether the full solver runs, which sees to signals itself.
    pub fn is_of_flow(&self) -> bool {
        self.model() == Fidelity::Ale
    }

    /// The model that is run.
    fn model(&self) -> Fidelity {
        let of = || Fidelity::of(&self.case, &self.settings.set);
        *self.found.get_or_init(|| self.fidelity.unwrap_or_else(of))
    }

    /// The run that is asked for.
    fn plan(&self, file: CaseFile) -> RunPlan {
        let default = || Path::new("runs").join(file.directory_name());
        let out = self.out.clone().unwrap_or_else(default);
        RunPlan {
            threads: self.threads,
            resume: self.resume.clone(),
            replay: self.replay.clone(),
            continues: self.continues,
            overwrite: self.overwrite,
            max_walltime: self.max_walltime,
            live: self.live.clone(),
            live_origins: self.live_origin.clone(),
            compares: !self.no_references,
            quiet: self.quiet,
            verbose: self.verbose,
            ..RunPlan::new(file, out)
        }
    }

    /// The same by the reduced model.
    fn reduced(&self) -> reduced::Request<'_> {
        let given = [
            ("resume", self.resume.is_some()),
            ("continue", self.continues),
            ("max-walltime", self.max_walltime.is_some()),
            ("live", self.live.is_some()),
        ];
        reduced::Request {
            case: &self.case,
            settings: &self.settings.set,
            out: self.out.as_deref(),
            overwrite: self.overwrite,
            replay: self.replay.as_deref(),
            foreign: given
                .iter()
                .filter(|(_, is_given)| *is_given)
                .map(|(name, _)| *name)
                .collect(),
        }
    }

    /// What to type to continue it.
    fn command(&self) -> String {
        let mut words = vec!["run".to_owned(), self.case.clone()];
        let mut option = |name: &str, value: Option<String>| {
            words.extend(value.into_iter().flat_map(|value| [format!("--{name}"), value]));
        };
        self.settings.set.iter().for_each(|setting| option("set", Some(setting.clone())));
        option("fidelity", self.fidelity.map(|model| model.name().to_owned()));
        option("out", self.out.as_ref().map(|out| out.display().to_string()));
        option("replay", self.replay.as_ref().map(|file| file.display().to_string()));
        option("threads", self.threads.map(|threads| threads.to_string()));
        option("max-walltime", self.max_walltime.map(String::from));
        option("live", self.live.clone());
        self.live_origin.iter().for_each(|origin| option("live-origin", Some(origin.clone())));
        let flags = [
            ("--continue", self.continues),
            ("--no-references", self.no_references),
            ("--quiet", self.quiet),
        ];
        words
            .extend(flags.iter().filter(|(_, is_set)| *is_set).map(|(flag, _)| (*flag).to_owned()));
        words.extend(std::iter::repeat_n("--verbose".to_owned(), self.verbose.into()));
        command(&words)
    }
}

/// Runs a case by the model that is asked for.
pub fn run(options: &Options) -> Result<Exit, Failure> {
    let model = options.model();
    if options.fidelity.is_none() && model != Fidelity::Ale && !options.quiet {
        say(&format!("a case without a flow: --fidelity {}", model.name()));
    }
    match model {
        Fidelity::Ale => run_flow(options),
        Fidelity::Soft => run_soft(options),
        Fidelity::Reduced => reduced::run(&options.reduced()),
    }
}

/// Runs a case of an elastic body without a flow.
fn run_soft(options: &Options) -> Result<Exit, Failure> {
    let asked = [
        ("--resume", options.resume.is_some()),
        ("--replay", options.replay.is_some()),
        ("--continue", options.continues),
        ("--max-walltime", options.max_walltime.is_some()),
        ("--live", options.live.is_some()),
    ];
    if let Some((name, _)) = asked.iter().find(|(_, is_set)| *is_set) {
        let message = format!("{name} is of runs of the full solver: a soft case runs in one go");
        return Err(Failure::new(Exit::Usage, message));
    }
    let file = SoftFile::read(&options.case, &options.settings.set)?;
    let place = soft::Place {
        out: options.out.clone(),
        overwrite: options.overwrite,
        compares: !options.no_references,
        lock: None,
    };
    soft::run(&file, place)
}

/// Runs a case by the full solver.
fn run_flow(options: &Options) -> Result<Exit, Failure> {
    let CheckedCase { file, warnings } = read_for_flow(&options.case, &options.settings.set)?;
    print_warnings(&warnings);
    let plan = RunPlan { warnings, ..options.plan(file) };
    run_plan(&plan, &format!("it continues with\n  {}", options.command()))
}

/// Runs a plan and prints what became of it, with the remedy if it was stopped and left a state.
pub fn run_plan(plan: &RunPlan, remedy: &str) -> Result<Exit, Failure> {
    let exit = runner::run(plan).and_then(|outcome| report(plan, outcome, remedy));
    // However a run ends, and last
    print_run_warnings();
    exit
}

fn report(plan: &RunPlan, outcome: Outcome, remedy: &str) -> Result<Exit, Failure> {
    match outcome {
        Outcome::WasFinished => {
            say(&format!("{} has come to its end before", plan.out.display()));
        }
        Outcome::Stopped(Stopped { reason, has_state }) => {
            let remedy = match plan.file.case().time {
                _ if has_state => remedy,
                TimeSettings::Steady(_) => STEADY,
                TimeSettings::Unsteady(_) => NO_STATE,
            };
            // Who stops a run makes no error
            return Err(Failure { exit: Exit::Stopped, message: format!("{reason}; {remedy}") });
        }
        Outcome::Finished(finished) => {
            print_comparisons(&finished.comparisons);
            if finished.comparisons.is_empty() {
                print_last_values(&plan.file.model, &finished.summary);
            }
            tell_cost(plan, &finished);
            print_cell_numbers(&finished.summary);
            print_step_errors(&finished.summary);
        }
    }
    Ok(Exit::Done)
}

/// Reports what a run has cost, and where it is.
fn tell_cost(plan: &RunPlan, finished: &Finished) {
    let Finished { summary, steps_before, wall, .. } = finished;
    let seconds = cpu_seconds();
    let remeshes = summary.series.column("flow.remeshes").and_then(|all| all.last().copied());
    let moving = remeshes.map_or_else(String::new, |remeshes| {
        let steps = summary.steps - steps_before;
        format!(", {:.3} s of it a step, {remeshes} remeshings", seconds / steps.max(1) as f64)
    });
    // A steady solution has none
    let steps = match plan.file.case().time {
        TimeSettings::Steady(_) => String::new(),
        TimeSettings::Unsteady(_) => format!(" {} steps,", summary.steps),
    };
    say(&format!(
        "{} unknowns,{steps} {seconds:.2} s of CPU time, {wall:.2} s on the clock{moving}; \
         written to {}",
        summary.n_dofs,
        plan.out.display()
    ));
}

/// A command of this program as a shell reads it, by the name with which the program was called.
pub fn command(words: &[String]) -> String {
    let program = std::env::args().next().filter(|typed| !typed.is_empty());
    let program = program.unwrap_or_else(|| "alewife".to_owned());
    let words: Vec<String> = [program].iter().chain(words).map(|word| quoted(word)).collect();
    words.join(" ")
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_quoted_where_a_shell_would_not_read_them_as_they_are() {
        assert_eq!(quoted("target/release/alewife"), "target/release/alewife");
        assert_eq!(quoted("./my tools/alewife"), "'./my tools/alewife'");
        assert_eq!(quoted("it's"), r"'it'\''s'");
    }
}
