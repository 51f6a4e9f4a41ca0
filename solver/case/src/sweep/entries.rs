//! The keys of a table of a sweep by their paths, whether these are in quotes or not.

use std::collections::BTreeMap;

use crate::text::source::Origin;
use crate::text::tree::{TomlNode, TreeError};

/// A key of the case, and what stands behind it in the sweep.
#[derive(Debug, Clone)]
pub struct Entry<'a> {
    /// The path of the key, as on the command line.
    pub path: String,
    /// Its values, or its range.
    pub node: &'a TomlNode,
}

/// First steps of paths that are no part of what is run.
const NOT_SWEPT: [&str; 3] = ["extends", "sweep", "variant"];

/// Whether a table is a range of values, and not one of keys.
pub fn is_range(table: &BTreeMap<String, TomlNode>) -> bool {
    table.contains_key("from") || table.contains_key("to")
}

/// The entries of a table in the order in which they are written, those of the command line last.
pub fn in_order(table: &BTreeMap<String, TomlNode>) -> Vec<Entry<'_>> {
    let entry = |(key, node): (&String, _)| Entry { path: key.clone(), node };
    let mut entries: Vec<Entry<'_>> = table.iter().map(entry).collect();
    entries
        .sort_by_key(|Entry { node, .. }| (node.key.source.name == "--set", node.key.span.start));
    entries
}

/// All keys of the case in a table; `above` is the path of the table itself.
///
/// # Errors
/// When one of them cannot be swept.
pub fn entries<'a>(
    table: &'a BTreeMap<String, TomlNode>,
    above: &str,
) -> Result<Vec<Entry<'a>>, TreeError> {
    let mut found = Vec::new();
    for Entry { path: key, node } in in_order(table) {
        let path = if above.is_empty() { key } else { format!("{above}.{key}") };
        match node.table() {
            Some(inner) if !is_range(inner) && !inner.is_empty() => {
                found.extend(entries(inner, &path)?);
            }
            _ => {
                check_path(&path, &node.key)?;
                found.push(Entry { path, node });
            }
        }
    }
    Ok(found)
}

fn check_path(path: &str, key: &Origin) -> Result<(), TreeError> {
    let first = path.split('.').next().unwrap_or_default();
    if NOT_SWEPT.contains(&first) {
        return Err(TreeError {
            origin: key.clone(),
            message: format!("`{path}` cannot be swept"),
            help: "sweep keys of the case itself, such as \"fluid.viscosity\"".to_owned(),
        });
    }
    Ok(())
}
