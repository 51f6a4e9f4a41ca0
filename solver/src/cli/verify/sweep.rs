//! The points of a sweep, each as a run, whether each is the one of its place, and the table.

use std::path::Path;

use super::found::Found;
use super::one;
use crate::case::SweepQuantity;
use crate::observer::{RunDirectory, RunLock};
use crate::sweep::{PointState, SweepDirectory, TABLE_FILE, collect, stand};

/// Looks at the sweep in a directory.
pub fn verify(directory: &Path) -> Found {
    let mut found = Found::new(directory, "sweep");
    let Some(sweep) = found.read("sweep.json", SweepDirectory::open(directory)) else {
        return found;
    };
    let n = sweep.n_points();
    let mut counts = [0; PointState::ALL.len()];
    for index in 0..n {
        let stand = stand(&sweep, index);
        let path = sweep.point(index);
        if let Some(at) = PointState::ALL.iter().position(|state| *state == stand.state) {
            counts[at] += 1;
        }
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let below = format!("points/{name}");
        if let Some(failure) = stand.failure.filter(|failure| failure.is_of_another_case) {
            found.wrong(&below, failure.reason);
        }
        if RunDirectory::is_one(&path) && !RunLock::is_held(&path, &[]) {
            found.take_in(&below, one::verify(&path));
        }
    }
    found.count("points", n);
    let reported = PointState::ALL.iter().zip(counts).filter(|(_, n)| *n > 0);
    let reported: Vec<String> =
        reported.map(|(state, n)| format!("{n} {}", state.name())).collect();
    found.state = reported.join(", ");
    check_table(&sweep, &mut found);
    found
}

/// The table is that of the points, unless it was asked for other quantities, or points came to their end since.
fn check_table(sweep: &SweepDirectory, found: &mut Found) {
    let Ok(written) = std::fs::read(sweep.path().join(TABLE_FILE)) else { return };
    let wanted = sweep.plan().quantities.iter().map(|text| SweepQuantity::parse(text));
    let Ok(wanted) = wanted.collect::<Result<Vec<_>, _>>() else { return };
    let Some(now) = found.read(TABLE_FILE, collect(sweep, &wanted)) else { return };
    let header = |table: &[u8]| table.split(|byte| *byte == b'\n').next().map(<[u8]>::to_vec);
    if header(&written) == header(&now) && written != now {
        let what = "its rows are not those of the points: alewife sweep collect writes it again";
        found.wrong(TABLE_FILE, what);
    }
}
