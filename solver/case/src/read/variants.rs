//! `[[variant]]` in a tree that is not typed yet: names, and what a variant sets.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::text::diagnostic::{CaseError, Diagnostic};
use crate::text::names::unusable_as_directory;
use crate::text::source::{Origin, Source};
use crate::text::tree::{TomlNode, TomlValue, TreeError};
use crate::text::type_error::suggestion;

/// Refuses names by which a variant could not be asked for, or not be given a directory.
///
/// # Errors
/// [`CaseError::Wrong`] with all of them.
pub fn check_names(root: &TomlNode) -> Result<(), CaseError> {
    let mut wrong = Vec::new();
    let mut taken: Vec<&str> = Vec::new();
    for (index, table) in variant_tables(root).enumerate() {
        // Without a name, or with one of another type, it is refused when it is typed
        let Some(node) = table.get("name") else { continue };
        let Some(name) = node.text() else { continue };
        let mut refuse = |message: String, help: &str| {
            let location = Some(node.origin.location());
            let key = format!("variant.{index}.name");
            wrong.push(Diagnostic { location, ..Diagnostic::error(&key, message, help) });
        };
        if let Some(reason) = unusable_as_directory(name) {
            refuse(
                format!("\"{name}\" cannot be the name of a variant: {reason}"),
                "its run gets a directory of that name: write a word such as \"free-0.5\"",
            );
        } else if taken.contains(&name) {
            refuse(
                format!("the name \"{name}\" is taken by a variant above"),
                "give every variant a name of its own",
            );
        }
        taken.push(name);
    }
    if wrong.is_empty() { Ok(()) } else { Err(CaseError::Wrong(wrong)) }
}

fn variant_tables(root: &TomlNode) -> impl Iterator<Item = &BTreeMap<String, TomlNode>> {
    let items = root.get("variant").and_then(TomlNode::array).unwrap_or_default();
    items.iter().filter_map(TomlNode::table)
}

/// Names of all variants, in their order.
pub fn variant_names(root: &TomlNode) -> Vec<String> {
    variant_tables(root)
        .filter_map(|table| table.get("name")?.text().map(ToOwned::to_owned))
        .collect()
}

/// Sets what a variant sets, adds its references, and forgets all variants.
///
/// # Errors
/// When there is no such variant, or a path it sets leads nowhere.
pub fn apply_variant(
    root: &mut TomlNode,
    source: &Arc<Source>,
    name: &str,
) -> Result<(), TreeError> {
    let table = variant_tables(root)
        .find(|table| table.get("name").and_then(TomlNode::text) == Some(name))
        .cloned();
    let Some(table) = table else {
        let known = variant_names(root);
        let first = root.get("variant").and_then(TomlNode::array).and_then(<[TomlNode]>::first);
        let start = Origin { source: Arc::clone(source), span: 0..0 };
        return Err(TreeError {
            origin: first.map_or(start, |node| node.origin.clone()),
            message: format!("there is no variant `{name}`"),
            help: if known.is_empty() {
                "this case has no [[variant]]; leave out what follows the /".to_owned()
            } else {
                suggestion(name, &known)
            },
        });
    };
    if let Some(entries) = root.table_mut() {
        entries.remove("variant");
        match table.get("quick") {
            Some(quick) => entries.insert("quick".to_owned(), quick.clone()),
            None => entries.remove("quick"),
        };
        if let Some(TomlValue::Array(more)) = table.get("reference").map(|node| &node.value) {
            match entries.get_mut("reference").map(|node| &mut node.value) {
                Some(TomlValue::Array(references)) => references.extend(more.iter().cloned()),
                _ => {
                    entries.insert("reference".to_owned(), table["reference"].clone());
                }
            }
        }
    }
    for (path, value) in table.get("set").and_then(TomlNode::table).into_iter().flatten() {
        root.set(path, value.clone())?;
    }
    Ok(())
}
