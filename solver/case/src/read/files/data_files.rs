//! `[data]`: the files that do not come with a case are there, or it is told where they are from.

use std::path::Path;

use crate::read::library::{self, Beside};
use crate::text::diagnostic::{CaseError, Diagnostic, Severity};
use crate::text::source::Origin;
use crate::text::tree::{TomlNode, TomlValue};

/// Looks for the files, and takes their names out: a case that is written with what was in them needs none.
///
/// # Errors
/// [`CaseError::Elsewhere`] for the first that is not there.
pub(crate) fn resolve(root: &mut TomlNode) -> Result<(), CaseError> {
    let Some(data) = root.table_mut().and_then(|entries| entries.get_mut("data")) else {
        return Ok(());
    };
    let source = data.get("source").and_then(TomlNode::text).unwrap_or_default().to_owned();
    let files = data.table_mut().and_then(|entries| entries.get_mut("files"));
    let Some(TomlNode { value: TomlValue::Array(files), .. }) = files else { return Ok(()) };
    // What is no text is refused when the case is typed
    for file in files.iter() {
        let Some(name) = file.text().filter(|name| !is_there(name, &file.origin)) else { continue };
        let directory = file.origin.source.directory.as_deref().unwrap_or(Path::new(""));
        let place = match directory.as_os_str().is_empty() {
            true => "this folder".to_owned(),
            false => directory.display().to_string(),
        };
        return Err(CaseError::Elsewhere(Diagnostic {
            severity: Severity::Error,
            key: "data.files".to_owned(),
            message: format!("`{name}` does not come with the case, and is not in {place}"),
            help: format!("put it there: it is from {source}"),
            location: Some(file.origin.location()),
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
