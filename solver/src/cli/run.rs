//! `run`: one case, its files, and how it compares with what was published.

use std::path::{Path, PathBuf};

use clap::Args;

use super::exit::{Exit, Failure};
use super::read::{Settings, read_case};
use super::style::{Ink, on_stdout, say};
use super::{engine, threads};
use crate::case::{Case, Model, TimeSettings, significant};
use crate::observer::{RunDirectory, write_atomic};
use crate::simulation::{RunSummary, SavedState};
use crate::validation::{Comparison, Verdict, compare, comparison_table, comparisons_to_json};

/// File of a run that holds its comparison with published values.
const COMPARISON_FILE: &str = "comparison.json";

/// What `run` is asked for.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  alewife run squirmer-alone
  alewife run sphere-in-tube/free-0.5 --threads 4 --out free
  alewife run my.toml --set fluid.viscosity=0.5 --set 'body.0.center=[1.0, 2.0]'

The run directory holds the case as it was run (case.toml), series.csv, run.mcap, fields/ and
fields.pvd, status.json, log.jsonl, provenance.json and comparison.json.")]
pub struct Options {
    /// Which case
    case: String,
    #[command(flatten)]
    settings: Settings,
    /// Directory of the run; `runs/<case>` if absent
    #[arg(long, short, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Threads; by default those the batch system or the machine grants
    #[arg(long, short, value_name = "N")]
    threads: Option<usize>,
    /// Resume from the state of a run that stopped or failed: its state.json or failure/state.json
    #[arg(long, value_name = "FILE")]
    resume: Option<PathBuf>,
    /// Replace a finished run
    #[arg(long)]
    overwrite: bool,
    /// No progress on the terminal
    #[arg(long, short)]
    quiet: bool,
    /// Tell more on the terminal; repeat for details
    #[arg(long, short, action = clap::ArgAction::Count)]
    verbose: u8,
}

/// Runs a case.
pub fn run(options: &Options) -> Result<Exit, Failure> {
    let file = read_case(&options.case, &options.settings.set)?;
    let saved = options.resume.as_deref().map(|path| read_state(path, file.case())).transpose()?;
    let n_threads = threads::start(options.threads)?;
    let name = file.full_name();
    let out = options.out.clone().unwrap_or_else(|| Path::new("runs").join(name.replace('/', "-")));
    let directory = RunDirectory::create(&out, file.case(), n_threads, options.overwrite)?;
    let verbosity = i8::try_from(options.verbose).unwrap_or(i8::MAX) - i8::from(options.quiet);
    engine::start_log(Some(&out), verbosity)?;

    let outcome = engine::simulate_into(&file.model, saved.as_ref(), &directory, options.quiet)?;
    let comparisons = compare(&name, file.case(), &outcome);
    if !comparisons.is_empty() {
        let text = format!("{:#}\n", comparisons_to_json(&comparisons));
        write_atomic(&out.join(COMPARISON_FILE), text.as_bytes())?;
    }
    print_comparisons(&comparisons);
    if comparisons.is_empty() {
        tell_last_values(&file.model, &outcome);
    }
    let seconds: f64 = outcome.timing.cpu.iter().sum();
    let remeshes = outcome.series.column("flow.remeshes").and_then(|all| all.last().copied());
    let moving = remeshes.map_or_else(String::new, |remeshes| {
        format!(", {:.3} s a step, {remeshes} remeshings", seconds / outcome.steps.max(1) as f64)
    });
    say(&format!(
        "{} unknowns, {} steps, {seconds:.2} s of CPU time{moving}; written to {}",
        outcome.n_dofs,
        outcome.steps,
        out.display()
    ));
    Ok(Exit::Done)
}

/// Reads the state a run left.
fn read_state(path: &Path, case: &Case) -> Result<SavedState<2>, Failure> {
    let refuse = |exit, reason: String| {
        let path = path.display();
        Failure::new(
            exit,
            format!(
                "--resume {path}: {reason}; a run that stopped leaves state.json, \
                                    one that failed failure/state.json"
            ),
        )
    };
    let TimeSettings::Unsteady(settings) = &case.time else {
        return Err(refuse(Exit::Usage, "a steady solution cannot be resumed".to_owned()));
    };
    let text = std::fs::read(path).map_err(|error| refuse(Exit::NoInput, error.to_string()))?;
    let saved: SavedState<2> = serde_json::from_slice(&text)
        .map_err(|error| refuse(Exit::BadCase, format!("this is no state of a run: {error}")))?;
    if saved.time >= settings.end {
        let reason = format!("it is at time {}, and the case ends at {}", saved.time, settings.end);
        return Err(refuse(Exit::BadCase, reason));
    }
    Ok(saved)
}

/// Prints how the bodies ended, for a case without published values.
fn tell_last_values(model: &Model, outcome: &RunSummary) {
    let Some(last) = outcome.series.rows.last() else { return };
    // Of the many bodies of a swimmer only what they do together.
    let is_alone = |body: usize| {
        !model.swimmers.iter().any(|one| one.bodies.len() > 1 && one.bodies.contains(&body))
    };
    let bodies = model.bodies.iter().enumerate().filter(|(index, _)| is_alone(*index));
    let shown: Vec<&str> = bodies
        .map(|(_, body)| body.name.as_str())
        .chain(model.swimmers.iter().map(|swimmer| swimmer.name.as_str()))
        .collect();
    let body_of = |name: &str| shown.iter().any(|shown| name.starts_with(&format!("{shown}.")));
    for (name, value) in outcome.series.names.iter().zip(last) {
        // Of cycles nothing is known before the first has ended
        if body_of(name) && !name.contains("surface_") && !value.is_nan() {
            say(&format!("{name:32}  {}", significant(*value)));
        }
    }
}

/// Prints the table of comparisons, verdicts in colour, with reasons and notes.
pub fn print_comparisons(comparisons: &[Comparison]) {
    if comparisons.is_empty() {
        return;
    }
    let table = comparison_table(comparisons);
    let mut lines = table.iter();
    if let Some(header) = lines.next() {
        say(&on_stdout(Ink::Bold, header));
    }
    for (line, comparison) in lines.zip(comparisons) {
        let ink = match comparison.verdict {
            Verdict::Within => Ink::Green,
            Verdict::Outside | Verdict::NotComputed => Ink::Red,
        };
        let word = comparison.verdict.name();
        let start = line.len() - word.len();
        say(&format!("{}{}", &line[..start], on_stdout(ink, word)));
        if let Err(reason) = &comparison.computed {
            say(&format!("    {reason}"));
        }
    }
}
