//! One `KEY=VALUE` of the command line.

use std::path::PathBuf;
use std::sync::Arc;

use super::source::{Origin, Source};
use super::tree;
use super::tree::{TomlNode, TomlValue, TreeError};

/// Name of the source of a setting.
pub const NAME: &str = "--set";

/// A key that is set, and its value.
pub struct Setting {
    /// The key, with its tables.
    pub path: String,
    /// The value.
    pub value: TomlNode,
}

/// The text of a setting as a source that messages can point at.
pub fn source(setting: &str) -> Arc<Source> {
    Arc::new(Source {
        name: NAME.to_owned(),
        directory: Some(PathBuf::new()),
        text: setting.to_owned(),
    })
}

/// Reads one setting; what is in the tree already shows whether a text is wanted.
///
/// # Errors
/// When it is no setting, or its value is neither TOML nor a word.
pub fn read(root: &TomlNode, setting: &str) -> Result<Setting, TreeError> {
    let source = source(setting);
    let written_at = |span| Origin { source: Arc::clone(&source), span };
    let whole = written_at(0..setting.len());
    let Some((path, raw)) = setting.split_once('=') else {
        return Err(TreeError {
            origin: whole,
            message: format!("`{setting}` sets nothing"),
            help: "write --set KEY=VALUE, such as --set mesh.scale=0.5".to_owned(),
        });
    };
    let start = path.len() + 1;
    let path = path.trim();
    let wants_text = root.get(path).and_then(TomlNode::text).is_some();
    let as_text = || TomlNode {
        key: whole.clone(),
        origin: written_at(start..setting.len()),
        value: TomlValue::String(raw.trim().to_owned()),
    };
    let mut value = match tree::parse_value(&source, start) {
        Ok(node)
            if wants_text && matches!(node.value, TomlValue::Integer(_) | TomlValue::Float(_)) =>
        {
            as_text()
        }
        Ok(node) => node,
        // A word without quotes is a string; what starts like something else is a mistake.
        Err(reason) if raw.trim().is_empty() || raw.trim().starts_with(['[', '{', '"', '\'']) => {
            return Err(TreeError {
                origin: written_at(start..setting.len()),
                message: format!("`{}` is not a TOML value: {reason}", raw.trim()),
                help: "close every quote and bracket; quote the setting for your shell".to_owned(),
            });
        }
        Err(_) => as_text(),
    };
    value.key = written_at(0..start - 1);
    Ok(Setting { path: path.to_owned(), value })
}
