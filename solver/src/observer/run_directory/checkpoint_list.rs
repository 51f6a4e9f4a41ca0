//! Where the checkpoints of a run are, and what asks for one.

use std::io;
use std::path::{Path, PathBuf};

use crate::observer::system::names_in;

/// The folder they are in.
pub(in crate::observer) const FOLDER: &str = "checkpoints";
/// How the names of states end.
pub(in crate::observer) const ENDING: &str = ".state";
/// A file of this name in the directory of a run asks for a checkpoint; it is removed then.
pub(in crate::observer) const REQUEST: &str = "CHECKPOINT";

/// The checkpoints of the run in a directory, the latest first.
pub fn checkpoints(directory: &Path) -> io::Result<Vec<PathBuf>> {
    let folder = directory.join(FOLDER);
    Ok(numbered(&folder)?.into_iter().map(|one| folder.join(one.name)).collect())
}

/// Those of later steps than one.
pub(in crate::observer) fn checkpoints_after(
    directory: &Path,
    step: usize,
) -> io::Result<Vec<PathBuf>> {
    let folder = directory.join(FOLDER);
    let later = numbered(&folder)?.into_iter().filter(|one| one.step > step as u64);
    Ok(later.map(|one| folder.join(one.name)).collect())
}

/// A checkpoint by its step, then its name.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Numbered {
    step: u64,
    name: String,
}

fn numbered(folder: &Path) -> io::Result<Vec<Numbered>> {
    let step = |name: &String| name.strip_suffix(ENDING)?.parse::<u64>().ok();
    let names = names_in(folder)?.into_iter();
    let mut found: Vec<Numbered> =
        names.filter_map(|name| Some(Numbered { step: step(&name)?, name })).collect();
    found.sort_unstable_by(|one, other| other.cmp(one));
    Ok(found)
}
