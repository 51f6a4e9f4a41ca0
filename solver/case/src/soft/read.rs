//! `SoftFile`: a soft case that is read, with the files it names, and where everything in it is written.

use serde::Deserialize;

use super::spec::SoftCase;
use crate::read::case_text::{Located, locate, source_beside};
use crate::read::directory_name::directory_name;
use crate::read::files::data_files;
use crate::read::files::read_mesh::bytes_of;
use crate::read::files::surface_file;
use crate::read::{UntypedCase, collect_numbers, location, wrong};
use crate::text::diagnostic::{CaseError, Diagnostic, Severity};
use crate::text::source::{Location, Origin};
use crate::text::tree::{TomlNode, TomlValue, TreeError};
use crate::text::type_error::Mismatch;

/// A soft case and where everything in it is written.
#[derive(Debug, Clone)]
pub struct SoftFile {
    /// The case, with `extends` and settings applied.
    pub case: SoftCase,
    /// Name: that of the file, or of its directory if the file is `case.toml`, with the variant behind it:
    /// `starfish/soft`.
    pub name: String,
    /// Name of the file that was read.
    pub file: String,
    /// The recorded motion, if the case names one.
    pub record: Option<BesideFile>,
    /// The mesh of the body, if the case names one.
    pub mesh: Option<BesideFile>,
    root: TomlNode,
}

/// A file that a case names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BesideFile {
    /// Its name in messages.
    pub name: String,
    /// What it holds.
    pub bytes: Vec<u8>,
}

/// The JSON Schema of soft cases; derived from the types once, by a test.
#[must_use]
pub fn schema() -> &'static str {
    include_str!("../../alewife.soft.schema.json")
}

/// Whether a case has the table `[soft]`.
pub(crate) fn is_soft(root: &TomlNode) -> bool {
    root.get("soft").is_some_and(|table| table.table().is_some())
}

/// The only model of a case that has no flow.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OnlyModel {
    /// An elastic body.
    Soft,
    /// A tree of rigid links.
    Reduced,
}

impl OnlyModel {
    /// That of a case, by the tables it has: no file that it names is read. None where there is a flow, where one of the
    /// two tables that only a flow has may have been forgotten, or where the case cannot be read.
    #[must_use]
    pub fn of(argument: &str, settings: &[String]) -> Option<Self> {
        let Located { text, variant } = locate(argument).ok()?;
        let root = UntypedCase::assemble(&text, variant, settings).ok()?.root;
        let is_left_out = |table: &str| root.get(table).is_none();
        match () {
            () if is_soft(&root) => Some(Self::Soft),
            () if is_left_out("domain") && is_left_out("mesh") && !is_left_out("reduced") => {
                Some(Self::Reduced)
            }
            () => None,
        }
    }
}

impl SoftFile {
    /// Reads a soft case: a path to a TOML file, the name of a shipped case, or either followed by `/VARIANT`; then
    /// sets `KEY=VALUE` for each of `settings`. None where it is a case of the full solver.
    ///
    /// # Errors
    /// [`CaseError`]: no such case, a file that cannot be read, or all that is wrong in it.
    pub fn read_if_soft(argument: &str, settings: &[String]) -> Result<Option<Self>, CaseError> {
        let Located { text, variant } = locate(argument)?;
        let untyped = UntypedCase::assemble(&text, variant, settings)?;
        if is_soft(&untyped.root) { Self::typed(untyped).map(Some) } else { Ok(None) }
    }

    /// Reads a soft case, as [`Self::read_if_soft`] does.
    ///
    /// # Errors
    /// The same, and where it is no soft case.
    pub fn read(argument: &str, settings: &[String]) -> Result<Self, CaseError> {
        Self::read_if_soft(argument, settings)?.ok_or_else(|| {
            CaseError::at(
                "",
                format!("{argument} has no table [soft]: it is no case of an elastic body without a flow"),
                "see the page on soft cases for what such a case has",
            )
        })
    }

    /// The name as that of a directory: `starfish-soft`.
    #[must_use]
    pub fn directory_name(&self) -> String {
        directory_name(&self.name)
    }

    /// A soft case as it is written, without what is in the files that it names, which need not be there. None where it
    /// is a case of the full solver.
    ///
    /// # Errors
    /// [`CaseError`]: no such case, a file that cannot be read, or what is wrong in it.
    pub fn declared(argument: &str) -> Result<Option<Self>, CaseError> {
        let Located { text, variant } = locate(argument)?;
        let untyped = UntypedCase::assemble(&text, variant, &[])?;
        if is_soft(&untyped.root) { Self::of_tree(untyped).map(Some) } else { Ok(None) }
    }

    /// Types it; a sweep is read to find what is wrong in it, and left out.
    pub(crate) fn typed(mut untyped: UntypedCase) -> Result<Self, CaseError> {
        data_files::resolve(&mut untyped.root)?;
        surfaces(&mut untyped.root).map_err(wrong)?;
        let mut read = Self::of_tree(untyped)?;
        read.read_files().map_err(wrong)?;
        Ok(read)
    }

    fn of_tree(untyped: UntypedCase) -> Result<Self, CaseError> {
        untyped.check_sweep()?;
        let (file, name) = (untyped.file().to_owned(), untyped.full_name());
        let root = untyped.root;
        let case = SoftCase::deserialize(&root).map_err(|error| {
            let path = error.path();
            let key = match error.mismatch() {
                Mismatch::UnknownKey { key, .. } | Mismatch::MissingKey(key) if path.is_empty() => {
                    key.clone()
                }
                Mismatch::UnknownKey { key, .. } | Mismatch::MissingKey(key) => {
                    format!("{path}.{key}")
                }
                _ => path,
            };
            CaseError::Wrong(vec![Diagnostic {
                severity: Severity::Error,
                key,
                message: error.message(),
                help: error.help(),
                location: error.origin().map(Origin::location),
            }])
        })?;
        Ok(Self { case, name, file, record: None, mesh: None, root })
    }

    /// Where the value at a dotted path is written, or the table it would stand in.
    #[must_use]
    pub fn location(&self, path: &str) -> Option<Location> {
        location(&self.root, path)
    }

    /// An error at a key, with where it is written.
    #[must_use]
    pub fn error(&self, key: &str, message: String, help: &str) -> Diagnostic {
        Diagnostic { location: self.location(key), ..Diagnostic::error(key, message, help) }
    }

    /// The first number that is not one, by its key.
    pub(super) fn not_a_number(&self) -> Option<String> {
        let mut numbers = Vec::new();
        for (key, node) in self.root.table().into_iter().flatten() {
            collect_numbers(node, key.clone(), &mut numbers);
        }
        let wrong = numbers.into_iter().find(|number| {
            let is_open = number.path.contains(".region.") && !number.value.is_nan();
            !number.value.is_finite() && !is_open
        });
        wrong.map(|number| number.path)
    }

    fn read_files(&mut self) -> Result<(), TreeError> {
        let origin = |path: &str| self.root.find(path).node.origin.clone();
        if let Some(record) = &self.case.record {
            let origin = origin("record.file");
            let source = source_beside(&record.file, &origin)
                .map_err(|message| missing(&origin, message))?;
            let bytes = source.text.into_bytes();
            self.record = Some(BesideFile { name: source.name, bytes });
        }
        let mesh = self.case.solid.first().and_then(|solid| solid.mesh.as_ref());
        if let Some(mesh) = mesh {
            let origin = origin("solid.0.mesh.file");
            let bytes =
                bytes_of(&mesh.file, &origin).map_err(|error| missing(&origin, error.message))?;
            self.mesh = Some(BesideFile { name: mesh.file.clone(), bytes });
        }
        Ok(())
    }
}

/// Puts the triangles of files in the place of their names, so that a case stands for itself.
fn surfaces(root: &mut TomlNode) -> Result<(), TreeError> {
    let solids = root.table_mut().and_then(|entries| entries.get_mut("solid"));
    let Some(TomlNode { value: TomlValue::Array(solids), .. }) = solids else { return Ok(()) };
    for solid in solids {
        let shape = solid.table_mut().and_then(|entries| entries.get_mut("shape"));
        let surface = shape.and_then(TomlNode::table_mut).and_then(|all| all.get_mut("surface"));
        surface.map_or(Ok(()), surface_file::resolve)?;
    }
    Ok(())
}

/// A file that is not there.
fn missing(origin: &Origin, message: String) -> TreeError {
    let help = "give the path of the file, relative to the file in which it is written".to_owned();
    TreeError { origin: origin.clone(), message, help }
}

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::{env, fs};

    use super::*;

    /// To write the file again: `ALEWIFE_UPDATE=1 cargo test --release --workspace schema`.
    #[test]
    fn the_schema_is_that_of_soft_cases() {
        let mut derived = schemars::schema_for!(SoftCase).to_value();
        derived["title"] = "alewife soft case".into();
        // What reading alone knows
        derived["properties"]["extends"] = serde_json::json!({
            "type": "string",
            "description": "The case this one starts from: the relative path of a case file, or the name of a \
                            shipped case. Tables are merged, everything else is replaced; reference, variant and \
                            sweep are not inherited.",
        });
        derived["properties"]["sweep"] = serde_json::json!({
            "type": "object",
            "description": "What `alewife sweep` varies, as in other cases: `grid`, `zip`, `list`, \
                            `latin-hypercube`, and `quantities`, columns of `series.csv`.",
        });
        let text = format!("{derived:#}\n");
        if env::var_os("ALEWIFE_UPDATE").is_some() {
            let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("alewife.soft.schema.json");
            fs::write(file, &text).unwrap();
            return;
        }
        assert!(text == schema(), "alewife.soft.schema.json is not up to date");
    }
}
