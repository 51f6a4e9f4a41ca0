//! `sweep status`: how many points of a sweep are done, and what is known of the others.

use std::path::PathBuf;

use clap::{Args, ValueHint};
use serde_json::{Map, Value, json};

use super::many::failure_line;
use crate::cli::exit::{Exit, Failure};
use crate::cli::style::say;
use crate::sweep::{PointState, Stand, SweepDirectory, stand};

/// What `sweep status` is asked for.
#[derive(Debug, Args)]
pub struct Options {
    /// Directory of the sweep
    #[arg(value_name = "DIR", value_hint = ValueHint::DirPath)]
    directory: PathBuf,
    /// As JSON, all points
    #[arg(long)]
    json: bool,
}

/// Reports where the points of a sweep stand.
pub fn status(options: &Options) -> Result<Exit, Failure> {
    let directory = SweepDirectory::open(&options.directory)?;
    let stands: Vec<Stand> = (0..directory.n_points()).map(|i| stand(&directory, i)).collect();
    if options.json {
        say(&format!("{:#}", to_json(&directory, &stands)));
        return Ok(Exit::Done);
    }
    let counts = PointState::ALL.iter().filter_map(|state| {
        let n = stands.iter().filter(|stand| stand.state == *state).count();
        (n > 0).then(|| format!("{n} {}", state.name()))
    });
    let n = directory.n_points();
    say(&format!(
        "{}: {n} points of {}: {}",
        options.directory.display(),
        directory.plan().case,
        counts.collect::<Vec<_>>().join(", ")
    ));
    for (index, stand) in stands.iter().enumerate() {
        if let Some(line) = line(&directory, index, stand) {
            say(&format!("  {line}"));
        }
    }
    Ok(Exit::Done)
}

/// What there is to report of a point that is neither missing nor finished.
fn line(directory: &SweepDirectory, index: usize, stand: &Stand) -> Option<String> {
    match stand.state {
        PointState::Missing | PointState::Finished => None,
        PointState::Failed => Some(failure_line(directory, index, stand.failure.as_ref()?)),
        PointState::Running | PointState::Stopped => {
            let status = stand.status.as_ref()?;
            let end = status.end.map_or_else(String::new, |end| format!(" of {end}"));
            Some(format!(
                "point {} ({}) {}, step {}, t {}{end}",
                index + 1,
                directory.plan().label(index),
                stand.state.name(),
                status.step,
                status.time
            ))
        }
    }
}

fn to_json(directory: &SweepDirectory, stands: &[Stand]) -> Value {
    let plan = directory.plan();
    let points = stands.iter().enumerate().map(|(index, stand)| {
        let values = plan.points[index].iter().cloned();
        let settings: Map<String, Value> = plan.swept.iter().cloned().zip(values).collect();
        let status = stand.status.as_ref();
        json!({
            "point": index + 1,
            "directory": directory.point(index),
            "settings": settings,
            "state": stand.state.name(),
            "step": status.map(|status| status.step),
            "time": status.map(|status| status.time),
            "end": status.and_then(|status| status.end),
            "cpu_seconds": status.and_then(|status| status.cpu_seconds.get("total")),
            "exit": stand.failure.as_ref().and_then(|failure| failure.exit),
            "reason": stand.failure.as_ref().map(|failure| &failure.reason),
        })
    });
    json!({ "case": plan.case, "directory": directory.path(), "points": points.collect::<Vec<_>>() })
}
