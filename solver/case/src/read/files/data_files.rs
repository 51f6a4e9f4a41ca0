//! `[data]`: the files that do not come with a case are there, or it is told where they are from.

use std::path::Path;

use crate::read::library;
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
        let place = match &file.origin.source.directory {
            Some(directory) if directory.as_os_str().is_empty() => "this folder".to_owned(),
            Some(directory) => directory.display().to_string(),
            None => "this folder".to_owned(),
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
    match &origin.source.directory {
        Some(directory) => directory.join(Path::new(name)).is_file(),
        None => {
            let case = &origin.source.name;
            library::file_beside(case, name).is_some() || library::brought(case, name).is_some()
        }
    }
}
