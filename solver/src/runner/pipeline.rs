//! A run from where it begins to its outcome.

use std::path::Path;
use std::sync::atomic::Ordering;
use std::time::Instant;

use super::blamed_key::with_key;
use super::continuation::{Beginning, beginning, n_requeued};
use super::failure::{Exit, Failure};
use super::plan::{Finished, Outcome, RunPlan, Stopped};
use super::replay::recording;
use super::resume::{is_inside, read_resumed};
use super::signal::SignalWatch;
use super::simulate::{Resumed, RunInto, simulate_into};
use super::wall_limit::WallLimit;
use super::{live, threads};
use crate::case::{CaseFile, rounded};
use crate::observer::{
    COMPARISON_FILE, Earlier, Point, Provenance, RunDirectory, Shown, Start, Status, Warning,
    begin_warnings, checkpoints, continue_warnings, print_line, start_log, write_atomic,
};
use crate::run::{Dimension, RunError, Solve};
use crate::step::FlowError;
use crate::validation::{Comparison, compare, comparisons_to_json};

/// Runs a case as it is planned.
///
/// # Errors
/// Whatever keeps the run from its beginning or its end, unless it was asked to stop.
pub fn run(plan: &RunPlan) -> Result<Outcome, Failure> {
    match plan.file.case().geometry.dimensions() {
        2 => run_in::<2>(plan),
        _ => run_in::<3>(plan),
    }
}

fn run_in<const D: usize>(plan: &RunPlan) -> Result<Outcome, Failure>
where
    Dimension<D>: Solve<D>,
{
    let RunPlan { file, out, .. } = plan;
    let (name, started) = (file.full_name(), Instant::now());
    // Before anything of a directory is touched
    let recording = recording(&plan.file, plan.replay.as_deref())?;
    // From here on, so that no signal ends the process without a word, and no other process writes to what is read
    let watch = SignalWatch::start()?;
    let limit = WallLimit::new(plan.max_walltime);
    let has_limit_asked = limit.as_ref().map(WallLimit::has_asked);
    let live = plan.live.as_deref();
    let live = live.map(|address| live::start(address, &name, &plan.live_origins)).transpose()?;
    let lock = plan.lock.clone().map_or_else(|| RunDirectory::hold(out), Ok)?;
    let verbosity = i8::try_from(plan.verbose).unwrap_or(i8::MAX) - i8::from(plan.quiet);
    // What is wrong with files of an earlier part is reported, too
    start_log(None, verbosity)?;
    begin_warnings(plan.warnings.iter().map(Warning::of_case).collect());
    let resumed: Option<Resumed<D>> = match beginning_of(plan)? {
        Beginning::AtStart => None,
        Beginning::From(resumed) => Some(*resumed),
        Beginning::IsDone => return Ok(Outcome::WasFinished),
    };
    let earlier = match &resumed {
        Some(resumed) if resumed.is_in_place => Earlier::Continue,
        _ if plan.overwrite => Earlier::Replace,
        _ => Earlier::Keep,
    };
    if earlier != Earlier::Continue {
        check_lies_elsewhere(file, out)?;
    }
    let n_threads = threads::start(plan.threads)?;
    let from = resumed.as_ref().map_or(Point::default(), |resumed| Point {
        step: resumed.state.step(),
        time: resumed.state.time(),
    });
    let start = Start { threads: n_threads, from, lock: Some(lock) };
    let directory = RunDirectory::create(out, file.case(), start, earlier)?;
    start_log(Some(out), verbosity)?;
    if let Some(resumed) = &resumed {
        report_resuming(resumed, plan);
    }

    let shown = Shown { quiet: plan.quiet, live };
    let run = RunInto { directory: &directory, shown, watch, limit };
    let summary = match simulate_into(&file.model, resumed.as_ref(), recording.as_ref(), run) {
        Err(error @ RunError::Flow(FlowError::Stopped { step, .. })) => {
            let is_over = has_limit_asked.is_some_and(|asked| asked.load(Ordering::Relaxed));
            return Ok(Outcome::Stopped(Stopped {
                reason: format!("{error}{}", why_stopped(is_over, step > from.step)),
                has_state: checkpoints(out).is_ok_and(|found| !found.is_empty()),
            }));
        }
        summary => summary.map_err(|error| with_key(file, error))?,
    };
    let comparisons =
        if plan.compares { compare(&name, file.case(), &summary) } else { Vec::new() };
    if !comparisons.is_empty() {
        write_comparisons(out, &comparisons)?;
    }
    let wall = started.elapsed().as_secs_f64();
    let finished = Finished { summary, comparisons, steps_before: from.step, wall };
    Ok(Outcome::Finished(Box::new(finished)))
}

/// What a run begins with: a state that is asked for, or one in its directory.
fn beginning_of<const D: usize>(plan: &RunPlan) -> Result<Beginning<D>, Failure> {
    let RunPlan { file, out, .. } = plan;
    match &plan.resume {
        Some(path) => Ok(Beginning::From(Box::new(read_resumed(path, file.case(), out)?))),
        None if plan.overwrite => Ok(Beginning::AtStart),
        None => beginning(out, file, plan.continues || n_requeued() > 0),
    }
}

/// Reports from where a run continues.
fn report_resuming<const D: usize>(resumed: &Resumed<D>, plan: &RunPlan) {
    let of_run = Status::read(&plan.out).ok().filter(|_| resumed.is_in_place);
    let earlier = of_run.map_or_else(Vec::new, |status| status.warnings);
    continue_warnings(resumed.state.time(), earlier);
    let (step, time, from) = (resumed.state.step(), resumed.state.time(), resumed.from.display());
    tracing::info!(step, time, from = %from, "resumed");
    if !plan.quiet {
        let time = rounded(time);
        print_line(&format!("continues at step {step}, t {time}, from {from}"));
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

/// Writes the comparison of a run with the references of its case, and what was run.
///
/// # Errors
/// When the provenance cannot be read, or the file system refuses.
pub fn write_comparisons(directory: &Path, all: &[Comparison]) -> std::io::Result<()> {
    let mut json = comparisons_to_json(all);
    json["provenance"] = serde_json::to_value(Provenance::read(directory)?.origin)?;
    write_atomic(&directory.join(COMPARISON_FILE), format!("{json:#}\n").as_bytes())
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
