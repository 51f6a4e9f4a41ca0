//! `reduced.calibrated`: coefficients of a file of `alewife calibrate` take the place of its name.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::read::case_text::source_beside;
use crate::text::source::Origin;
use crate::text::tree::{self, TomlNode, TomlValue, TreeError};

/// What is taken over from the table `calibrated` of the file.
const TAKEN: [&str; 4] = ["bodies", "periods", "amplitudes", "viscosities"];

/// Takes over what a calibrated file has, so that a case stands for itself.
///
/// # Errors
/// When it cannot be read, is none, or is of another law of loads.
pub fn resolve(root: &mut TomlNode) -> Result<(), TreeError> {
    let Some(asked) = root.get("reduced.calibrated.file") else { return Ok(()) };
    // It was read before the case was written down as it was run
    if root.get("reduced.calibrated.bodies").is_some() {
        return Ok(());
    }
    let origin = asked.origin.clone();
    let refused = |message: String, help: &str| TreeError {
        origin: origin.clone(),
        message,
        help: help.to_owned(),
    };
    let Some(path) = asked.text().map(str::to_owned) else { return Ok(()) };
    let source = source_beside(&path, &origin)
        .map_err(|what| refused(what, "give the file that `alewife calibrate` has written"))?;
    let file = tree::parse(&Arc::new(source))?;
    let law = |node: &TomlNode, key: &str| {
        node.get(key).and_then(TomlNode::text).unwrap_or_default().to_owned()
    };
    let (ours, theirs) = (law(root, "reduced.loads"), law(&file, "reduced.loads"));
    let (Some(found), Some(facts)) = (file.get("reduced.coefficients"), file.get("calibrated"))
    else {
        return Err(refused(
            format!("{path} was not written by `alewife calibrate`"),
            "give the file calibrated.toml of a calibration",
        ));
    };
    if ours != theirs {
        return Err(refused(
            format!("{path} has coefficients of the law \"{theirs}\", and the case has \"{ours}\""),
            "give the file of a calibration with this law, or write the other law",
        ));
    }
    let of_bodies = file.get("reduced.body").cloned();
    let (found, facts) = (found.clone(), facts.clone());
    let Some(reduced) = root.find_mut("reduced").and_then(TomlNode::table_mut) else {
        return Ok(());
    };
    let TomlValue::Table(found) = found.value else { return Ok(()) };
    let empty = || TomlNode {
        key: origin.clone(),
        origin: origin.clone(),
        value: TomlValue::Table(Default::default()),
    };
    fill(reduced.entry("coefficients".to_owned()).or_insert_with(empty), found, &origin);
    if let Some(TomlValue::Table(bodies)) = of_bodies.map(|node| node.value) {
        let all = reduced.entry("body".to_owned()).or_insert_with(empty);
        for (body, own) in bodies {
            if let (Some(all), TomlValue::Table(own)) = (all.table_mut(), own.value) {
                fill(all.entry(body).or_insert_with(empty), own, &origin);
            }
        }
    }
    if let Some(entries) = reduced.get_mut("calibrated").and_then(TomlNode::table_mut) {
        for name in TAKEN {
            if let Some(fact) = facts.get(name) {
                entries.insert(name.to_owned(), fact.clone());
            }
        }
        let none = TomlNode { value: TomlValue::Array(Vec::new()), ..empty() };
        entries.entry("bodies".to_owned()).or_insert(none);
    }
    Ok(())
}

/// Puts values into a table that has none of their names.
fn fill(table: &mut TomlNode, found: BTreeMap<String, TomlNode>, origin: &Origin) {
    if let Some(own) = table.table_mut() {
        for (name, mut value) in found {
            (value.key, value.origin) = (origin.clone(), origin.clone());
            own.entry(name).or_insert(value);
        }
    }
}
