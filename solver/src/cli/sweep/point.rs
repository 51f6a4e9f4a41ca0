//! One point of a sweep, run by this very process.

use std::path::Path;
use std::time::Duration;

use super::many;
use super::points::check_points;
use super::run_options::Options;
use super::swept::directory_of;
use crate::cli::exit::{Exit, Failure};
use crate::cli::parent;
use crate::cli::read::print_warnings;
use crate::cli::run::run_plan;
use crate::cli::soft;
use crate::cli::style::{complain, say};
use crate::observer::{LockError, RunDirectory, RunDirectoryError, RunLock};
use crate::runner::RunPlan;
use crate::sweep::{Plan, PointFailure, PointState, SweepDirectory, stand_of_own};

/// How often it is looked whether another process has given a point free.
const LOOK_EVERY: Duration = Duration::from_millis(200);

/// Runs the point of an index from 0.
pub fn run(options: &Options, index: usize) -> Result<Exit, Failure> {
    parent::stop_with(options.parent)?;
    let sweep = options.sweep()?;
    let all = 0..sweep.n_points();
    if let Some(named) = options.index {
        named.range(all.len())?;
    }
    let warnings = check_points(&sweep, index..index + 1)?;
    if options.parent.is_none() {
        print_warnings(&warnings);
    }
    let plan = Plan::new(&sweep)?;
    let directory =
        SweepDirectory::create(&directory_of(options.out.as_ref(), &sweep), plan, &sweep)?;
    // Nobody else decides on the point from here on, until its failure is written, too
    let (out, lock) = (directory.point(index), hold(&directory.point(index), options)?);
    let before = stand_of_own(&directory, index);
    if before.state == PointState::Finished {
        say(&format!("{} has come to its end before", out.display()));
        return Ok(Exit::Done);
    }
    if let Some(failure) = before.failure.as_ref().filter(|failure| is_kept(failure, options)) {
        return Err(Failure::new(many::exit_of(failure), failure.line()));
    }
    PointFailure::forget(&directory, index)?;
    let made = if sweep.is_soft() {
        let lock = Some(lock);
        let place = soft::Place { out: Some(out), overwrite: true, compares: true, lock };
        sweep.soft_case(index).map_err(Failure::from).and_then(|file| soft::run(&file, place))
    } else {
        let plan = RunPlan {
            warnings,
            lock: Some(lock),
            threads: options.threads,
            continues: true,
            overwrite: before.has_failed_run(),
            max_walltime: options.max_walltime,
            quiet: options.quiet || options.parent.is_some(),
            ..RunPlan::new(sweep.case(index)?, out)
        };
        run_plan(&plan, "the same call again continues")
    };
    made.inspect_err(|failure| {
        if failure.exit != Exit::Stopped {
            let reason = failure.message.clone();
            let failure = PointFailure::new(Some(failure.exit as u8), reason);
            // Where it cannot be written the point is run again
            if let Err(error) = failure.write(&directory, index) {
                complain(&format!("error: {error}"));
            }
        }
    })
}

/// Holds the directory of a point. A process of a sweep has other points to run; one of a single point waits.
fn hold(out: &Path, options: &Options) -> Result<RunLock, Failure> {
    let mut has_told = false;
    loop {
        match RunDirectory::hold(out) {
            Err(RunDirectoryError::Lock(error @ LockError::InUse { .. })) => {
                if options.parent.is_some() {
                    return Err(Failure::new(Exit::InUse, error.to_string()));
                }
                if !has_told && !options.quiet {
                    complain(&format!("{error}: waits for it"));
                }
                has_told = true;
                std::thread::sleep(LOOK_EVERY);
            }
            held => return Ok(held?),
        }
    }
}

/// Whether a failure that is known stands: that of a directory that holds another point, and of a run that would
/// fail again, unless this call is to run it.
fn is_kept(failure: &PointFailure, options: &Options) -> bool {
    let is_asked = options.retry || options.parent.is_none();
    failure.is_for_good() && (!is_asked || failure.is_of_another_case)
}
