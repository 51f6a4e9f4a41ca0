//! The field files of a run: whether those of the list are there, whole, and of this run.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

use super::found::Found;
use super::known::Known;
use crate::observer::{FAILURE_FOLDER, Frame, frames};

/// The list of all.
const LIST: &str = "fields.pvd";
/// Bytes at the start of a file with what it is of, and at its end.
const ENDS: u64 = 4096;
/// How a whole file ends.
const END: &str = "</VTKFile>";
/// What precedes the checksum of the case that a file is of.
const CASE: &str = "case crc32:";

/// Looks at all field files of a run.
pub fn check(directory: &Path, known: &Known, found: &mut Found) {
    let Some(listed) = found.read(LIST, frames(directory)) else { return };
    found.count("fields", listed.len());
    for pair in listed.windows(2) {
        if pair[1].time <= pair[0].time {
            found.wrong(LIST, format!("{} does not come after {}", pair[1].file, pair[0].file));
        }
    }
    for Frame { file, .. } in &listed {
        check_file(directory, file, known, found);
    }
    let names: BTreeSet<&str> = listed.iter().map(|frame| frame.file.as_str()).collect();
    if !known.is_under_way {
        for name in files_in(&directory.join("fields")) {
            let file = format!("fields/{name}");
            // One of a run that was stopped goes from the list when it continues
            if name != "stopped.vtu" && known.is_finished() && !names.contains(file.as_str()) {
                found.wrong(&file, format!("it is not in {LIST}"));
            }
        }
    }
    let failure = format!("{FAILURE_FOLDER}/flow.vtu");
    if directory.join(&failure).exists() {
        check_file(directory, &failure, known, found);
    }
}

fn check_file(directory: &Path, file: &str, known: &Known, found: &mut Found) {
    let ends = ends_of(&directory.join(file)).map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => "it is missing".to_owned(),
        _ => error.to_string(),
    });
    let Some([head, tail]) = found.read(file, ends) else { return };
    if !head.contains("<VTKFile") || !tail.trim_end().ends_with(END) {
        found.wrong(file, "it is not whole");
        return;
    }
    let hash = head.split_once(CASE).map(|(_, rest)| rest.chars().take(8).collect::<String>());
    if let Some(hash) = hash
        && !known.is_of_a_leg(&format!("crc32:{hash}"))
    {
        found.wrong(
            file,
            format!("it is of a case of checksum crc32:{hash}, which was not run here"),
        );
    }
}

/// The first and the last bytes of a file as text.
fn ends_of(path: &Path) -> io::Result<[String; 2]> {
    let mut file = File::open(path)?;
    let length = file.metadata()?.len();
    let mut head = Vec::new();
    Read::by_ref(&mut file).take(ENDS).read_to_end(&mut head)?;
    file.seek(SeekFrom::Start(length.saturating_sub(ENDS)))?;
    let mut tail = Vec::new();
    file.read_to_end(&mut tail)?;
    Ok([head, tail].map(|bytes| String::from_utf8_lossy(&bytes).into_owned()))
}

/// Names of the field files of a folder.
fn files_in(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
    let mut names: Vec<String> = names
        .filter(|name| {
            let stem = name.strip_suffix(".vtu").unwrap_or_default();
            !stem.is_empty() && stem.bytes().all(|byte| byte.is_ascii_digit())
        })
        .collect();
    names.sort();
    names
}
