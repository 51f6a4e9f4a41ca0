//! Where the checkpoints of a run are, and what asks for one.

use std::io;
use std::path::{Path, PathBuf};

use super::removal::names_in;

/// The folder they are in.
pub(super) const FOLDER: &str = "checkpoints";
/// How the names of states end.
pub(super) const ENDING: &str = ".state";
/// A file of this name in the directory of a run asks for a checkpoint; it is removed then.
pub(super) const REQUEST: &str = "CHECKPOINT";

/// The checkpoints of the run in a directory, the latest first.
pub fn checkpoints(directory: &Path) -> io::Result<Vec<PathBuf>> {
    let folder = directory.join(FOLDER);
    let step = |name: &String| name.strip_suffix(ENDING)?.parse::<u64>().ok();
    let mut found: Vec<(u64, String)> =
        names_in(&folder)?.into_iter().filter_map(|name| Some((step(&name)?, name))).collect();
    found.sort_unstable_by(|one, other| other.cmp(one));
    Ok(found.into_iter().map(|(_, name)| folder.join(name)).collect())
}
