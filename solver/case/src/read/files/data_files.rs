//! `[data]`: the files that do not come with a case are there, or it is told where they are from.

use std::path::Path;

use crate::read::library::{self, Beside};
use crate::text::diagnostic::{CaseError, Diagnostic, Severity};
use crate::text::source::Origin;
use crate::text::tree::{TomlNode, TomlValue};

/// Looks for the files, and takes their names out: a case that is written with what was in them needs none.
///
/// # Errors
/// [`CaseError::Elsewhere`] at the first that is not there, with all of them.
pub(crate) fn resolve(root: &mut TomlNode) -> Result<(), CaseError> {
    let Some(data) = root.table_mut().and_then(|entries| entries.get_mut("data")) else {
        return Ok(());
    };
    let source = data.get("source").and_then(TomlNode::text).unwrap_or_default().to_owned();
    let files = data.table_mut().and_then(|entries| entries.get_mut("files"));
    let Some(TomlNode { value: TomlValue::Array(files), .. }) = files else { return Ok(()) };
    // What is no text is refused when the case is typed
    let named = files.iter().filter_map(|file| Some((file.text()?, &file.origin)));
    let missing: Vec<_> = named.filter(|(name, origin)| !is_there(name, origin)).collect();
    if let [(name, origin), others @ ..] = &missing[..] {
        let directory = origin.source.directory.as_deref().unwrap_or(Path::new(""));
        let place = match directory.as_os_str().is_empty() {
            true => "this folder".to_owned(),
            false => directory.display().to_string(),
        };
        let others: Vec<String> = others.iter().map(|(name, _)| format!("`{name}`")).collect();
        let others = match others.is_empty() {
            true => String::new(),
            false => format!("; nor are {}", others.join(", ")),
        };
        let what = match is_folder(name, origin) {
            true => "is a folder there and no file:",
            false => "is not in",
        };
        return Err(CaseError::Elsewhere(Diagnostic {
            severity: Severity::Error,
            key: "data.files".to_owned(),
            message: format!("`{name}` does not come with the case, and {what} {place}{others}"),
            help: format!("put it there: it is from {source}"),
            location: Some(origin.location()),
        }));
    }
    files.retain(|file| file.text().is_none());
    Ok(())
}

fn is_there(name: &str, origin: &Origin) -> bool {
    match library::beside(&origin.source, name) {
        Some(Beside::Shipped(_)) => true,
        Some(Beside::OnDisk(path)) => path.is_file(),
        None => false,
    }
}

/// Whether there is a folder in place of the file.
fn is_folder(name: &str, origin: &Origin) -> bool {
    matches!(library::beside(&origin.source, name), Some(Beside::OnDisk(path)) if path.is_dir())
}
