//! A finished run read back from its directory, to be compared again without being run again.

use std::io;
use std::path::Path;

use super::series_rows::{SERIES_FILE, series_of};
use crate::observer::run_directory::status::{RunState, Status};
use crate::observer::system::AtPath;
use crate::run::RunSummary;
use crate::timing::{Stage, Timing};

/// What the run in `directory` left: its series, its time and its size.
///
/// # Errors
/// When it has not finished, or its files cannot be read.
pub fn read_outcome(directory: &Path) -> io::Result<RunSummary> {
    let status = Status::read(directory)?;
    if status.state != RunState::Finished {
        return Err(io::Error::other(format!("it is {:?} and not finished", status.state)));
    }
    let mut timing = Timing::default();
    for stage in Stage::ALL {
        let of = |seconds: &std::collections::BTreeMap<String, f64>| {
            seconds.get(stage.name()).copied().unwrap_or(0.0)
        };
        timing.cpu[stage as usize] = of(&status.cpu_seconds);
        timing.wall[stage as usize] = of(&status.wall_seconds);
    }
    let path = directory.join(SERIES_FILE);
    let series = series_of(&path, &std::fs::read_to_string(&path).at(&path)?)?;
    let (n_dofs, steps, cycles) = (status.dofs, status.step, Vec::new());
    Ok(RunSummary { series, timing, n_dofs, steps, cycles, step_errors: None })
}
