//! A finished run read back from its directory, to be compared again without being run again.

use std::io;
use std::path::Path;

use super::status::{RunState, Status};
use crate::simulation::{RunSummary, Series, Stage, Timing};

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
    let series = read_series(&std::fs::read_to_string(directory.join("series.csv"))?)
        .map_err(|line| io::Error::other(format!("line {line} of series.csv is damaged")))?;
    Ok(RunSummary { series, timing, n_dofs: status.dofs, steps: status.step })
}

/// The series in a text; the number of the first bad line otherwise.
pub(super) fn read_series(text: &str) -> Result<Series, usize> {
    let mut lines = text.lines();
    let header = lines.next().ok_or(1_usize)?;
    let names: Vec<String> = header.split(',').skip(1).map(str::to_owned).collect();
    let mut series = Series { names, ..Series::default() };
    for (index, line) in lines.enumerate() {
        let numbers: Result<Vec<f64>, _> = line.split(',').map(str::parse).collect();
        match numbers.as_deref() {
            Ok([time, values @ ..]) if values.len() == series.names.len() => {
                series.times.push(*time);
                series.rows.push(values.to_vec());
            }
            _ => return Err(index + 2),
        }
    }
    Ok(series)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_series_is_read_as_it_was_written() {
        let series = read_series("time,a.x,b.y\n0.0,1.5,NaN\n0.1,-2e-5,inf\n").unwrap();
        assert_eq!(series.names, ["a.x", "b.y"]);
        assert_eq!(series.times, [0.0, 0.1]);
        assert_eq!(series.column("a.x"), Some(vec![1.5, -2e-5]));
        assert!(series.rows[0][1].is_nan() && series.rows[1][1] == f64::INFINITY);
        assert_eq!(read_series("time,a.x\n0.0,1.0\n0.1\n"), Err(3));
        assert_eq!(read_series("time,a.x\n0.0,one\n"), Err(2));
    }
}
