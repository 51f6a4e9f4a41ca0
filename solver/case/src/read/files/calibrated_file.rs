//! `reduced.calibrated`: coefficients of a file of `alewife calibrate` take the place of its name.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::read::case_text::source_beside;
use crate::text::source::Origin;
use crate::text::tree::{self, TomlNode, TomlValue, TreeError};

/// What is taken over from the table `calibrated` of the file.
const TAKEN: [&str; 4] = ["bodies", "periods", "amplitudes", "viscosities"];

/// A table by its keys.
type Entries = BTreeMap<String, TomlNode>;

/// What a calibrated file has.
struct Calibrated {
    /// Of all bodies without their own.
    coefficients: Entries,
    /// Of single bodies.
    bodies: BTreeMap<String, Entries>,
    facts: TomlNode,
}

fn refused(origin: &Origin, message: String, help: &str) -> TreeError {
    TreeError { origin: origin.clone(), message, help: help.to_owned() }
}

fn law(node: &TomlNode) -> String {
    node.get("reduced.loads").and_then(TomlNode::text).unwrap_or_default().to_owned()
}

impl Calibrated {
    /// Of the file that a case names, if it does and has not been read yet.
    fn read(root: &TomlNode) -> Result<Option<Self>, TreeError> {
        let Some(asked) = root.get("reduced.calibrated.file") else { return Ok(None) };
        // It was read before the case was written down as it was run
        if root.get("reduced.calibrated.bodies").is_some() {
            return Ok(None);
        }
        let Some(path) = asked.text() else { return Ok(None) };
        let origin = &asked.origin;
        let source = source_beside(path, origin).map_err(|what| {
            refused(origin, what, "give the file that `alewife calibrate` has written")
        })?;
        let file = tree::parse(&Arc::new(source))?;
        let (ours, theirs) = (law(root), law(&file));
        let coefficients = file.get("reduced.coefficients").and_then(TomlNode::table);
        if let Some(run) = file.get("calibrated.run").and_then(TomlNode::text) {
            let message = format!("{path} has other numbers than coefficients, too");
            let help = format!("run the case that was written beside it, {run}, or extend it");
            return Err(refused(origin, message, &help));
        }
        let (Some(coefficients), Some(facts)) = (coefficients, file.get("calibrated")) else {
            return Err(refused(
                origin,
                format!("{path} was not written by `alewife calibrate`"),
                "give the file calibrated.toml of a calibration",
            ));
        };
        if ours != theirs {
            let message = format!(
                "{path} has coefficients of the law \"{theirs}\", and the case has \"{ours}\""
            );
            let help = "give the file of a calibration with this law, or write the other law";
            return Err(refused(origin, message, help));
        }
        let bodies = file.get("reduced.body").and_then(TomlNode::table).into_iter().flatten();
        let bodies = bodies.filter_map(|(name, own)| Some((name.clone(), own.table()?.clone())));
        Ok(Some(Self {
            coefficients: coefficients.clone(),
            bodies: bodies.collect(),
            facts: facts.clone(),
        }))
    }

    /// What it has of a coefficient, of a body if one is named.
    fn value(&self, body: Option<&str>, name: &str) -> Option<&TomlNode> {
        let own = body.and_then(|body| self.bodies.get(body)?.get(name));
        own.or_else(|| self.coefficients.get(name))
    }
}

/// Whose coefficients a case writes: those of all bodies, and of single ones.
fn written(root: &TomlNode) -> Vec<Option<String>> {
    let bodies = root.get("reduced.body").and_then(TomlNode::table).into_iter().flatten();
    std::iter::once(None).chain(bodies.map(|(name, _)| Some(name.clone()))).collect()
}

fn number(node: &TomlNode) -> Option<f64> {
    match node.value {
        TomlValue::Float(value) => Some(value),
        TomlValue::Integer(value) => Some(value as f64),
        _ => None,
    }
}

/// What has been laid over a table `reduced`, the later over the earlier: where it names a file, what that has replaces
/// coefficients from before, and those that are written beside its name are refused.
///
/// # Errors
/// A coefficient that is written beside the name of a file that has it, too.
pub fn laid_over(before: Option<&TomlNode>, root: &mut TomlNode) -> Result<(), TreeError> {
    let Some(asked) = root.get("reduced.calibrated.file").cloned() else { return Ok(()) };
    let earlier = |path: &str| before.and_then(|before| before.get(path));
    if earlier("calibrated.file") == Some(&asked) {
        return Ok(());
    }
    // Facts of a file that was named before
    let calibrated = root.find_mut("reduced.calibrated").and_then(TomlNode::table_mut);
    if let (Some(entries), Some(old)) = (calibrated, earlier("calibrated")) {
        entries
            .retain(|name, node| !TAKEN.contains(&name.as_str()) || old.get(name) != Some(&*node));
    }
    // What is wrong with the file is told when the case is whole
    let Ok(Some(file)) = Calibrated::read(root) else { return Ok(()) };
    for body in written(root) {
        let path = body.as_ref().map_or("coefficients".to_owned(), |name| format!("body.{name}"));
        let Some(table) = root.find_mut(&format!("reduced.{path}")).and_then(TomlNode::table_mut)
        else {
            continue;
        };
        for name in table.keys().cloned().collect::<Vec<String>>() {
            let (Some(own), Some(found)) = (table.get(&name), file.value(body.as_deref(), &name))
            else {
                continue;
            };
            if earlier(&format!("{path}.{name}")) == Some(own) {
                table.remove(&name);
            } else if number(own) != number(found) {
                let (own, value) = (own.clone(), number(found).unwrap_or(f64::NAN));
                let file = asked.text().unwrap_or_default();
                return Err(refused(
                    &own.key,
                    format!("reduced.{path}.{name} is written here, and {file} has {value} for it"),
                    "leave one of them out; a variant, --set or a case that extends this one may write it",
                ));
            }
        }
    }
    Ok(())
}

/// Takes over what a calibrated file has, so that a case stands for itself.
///
/// # Errors
/// When it cannot be read, is none, or is of another law of loads.
pub fn resolve(root: &mut TomlNode) -> Result<(), TreeError> {
    let Some(Calibrated { coefficients, bodies, facts }) = Calibrated::read(root)? else {
        return Ok(());
    };
    let Some(origin) = root.get("reduced.calibrated.file").map(|asked| asked.origin.clone()) else {
        return Ok(());
    };
    let Some(reduced) = root.find_mut("reduced").and_then(TomlNode::table_mut) else {
        return Ok(());
    };
    let empty = || TomlNode {
        key: origin.clone(),
        origin: origin.clone(),
        value: TomlValue::Table(BTreeMap::default()),
    };
    fill(reduced.entry("coefficients".to_owned()).or_insert_with(empty), coefficients);
    if !bodies.is_empty() {
        let all = reduced.entry("body".to_owned()).or_insert_with(empty);
        for (body, own) in bodies {
            if let Some(all) = all.table_mut() {
                fill(all.entry(body).or_insert_with(empty), own);
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

/// Puts values into a table that has none of their names; what is wrong with one is told where the file has it.
fn fill(table: &mut TomlNode, found: Entries) {
    if let Some(own) = table.table_mut() {
        for (name, value) in found {
            own.entry(name).or_insert(value);
        }
    }
}
