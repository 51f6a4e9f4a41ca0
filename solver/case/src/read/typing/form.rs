//! How a value is written, by the schema: what a mistake at a key is answered with.

use serde_json::{Map, Value};

use crate::read::schema::{alternatives, referred, whole};

/// Names of coordinates, for what has one number for each.
const COORDINATES: [&str; 3] = ["x", "y", "z"];

/// Most keys that an example of a table has.
const MOST_KEYS: usize = 4;

/// How the value at a path of a case is written, such as `disc = { radius = ... }`, with what was found in its place
/// where a table has one key only; nothing of a path that is not known.
pub fn written(path: &str, found: Option<&str>) -> Option<String> {
    let last = path.rsplit('.').find(|step| step.parse::<usize>().is_err())?;
    let declared = resolved(at(path)?);
    let forms = forms(declared, found);
    match forms.as_slice() {
        [] => None,
        [form] => Some(format!("write {last} = {form}")),
        several => Some(format!("write {last} = one of: {}", several.join(", "))),
    }
}

/// How the alternative of a name is written as the value at a path, and what it is.
pub fn alternative(path: &str, name: &str) -> Option<String> {
    let named = |one: &&'static Value| one["properties"].get(name).is_some();
    let one = options(resolved(at(path)?)).find(named)?;
    let declared = resolved(&one["properties"][name]);
    let form = match forms(declared, None).into_iter().next() {
        Some(form) => form,
        None if declared["type"] == "string" => "\"...\"".to_owned(),
        None => "...".to_owned(),
    };
    let what = one["description"].as_str().and_then(|text| text.split("\n\n").next());
    let what = what.map(|text| format!(" ({})", text.replace('\n', " ").trim_end_matches('.')));
    let what = what.unwrap_or_default();
    Some(format!("write {{ {name} = {form} }} instead of \"{name}\"{what}"))
}

/// The table below the one at a path, or the alternative of it, that has all of some keys.
pub fn holder(path: &str, keys: &[&str]) -> Option<&'static str> {
    let declared = if path.is_empty() { whole() } else { resolved(at(path)?) };
    let holds = |below: &'static Value| keys.iter().all(|key| step(below, key).is_some());
    let options = std::iter::once(declared).chain(options(declared));
    let mut entries = options.filter_map(|one| one["properties"].as_object()).flatten();
    entries.find(|(_, below)| has_keys(below) && holds(below)).map(|(name, _)| name.as_str())
}

/// Whether a value is a table with names of its own: not one of sides, whose keys are free.
fn has_keys(declared: &'static Value) -> bool {
    let declared = resolved(declared);
    declared["properties"].is_object() || options(declared).any(|one| one["properties"].is_object())
}

/// What the schema says of the value at a path.
fn at(path: &str) -> Option<&'static Value> {
    path.split('.').try_fold(whole(), |declared, key| step(declared, key))
}

/// What it says of one key or index of a value.
fn step(declared: &'static Value, key: &str) -> Option<&'static Value> {
    let declared = resolved(declared);
    if key.parse::<usize>().is_ok() && declared["items"].is_object() {
        return Some(&declared["items"]);
    }
    let own = declared["properties"].get(key);
    let of_all = Some(&declared["additionalProperties"]).filter(|one| one.is_object());
    own.or(of_all).or_else(|| options(declared).find_map(|one| step(one, key)))
}

fn resolved(declared: &'static Value) -> &'static Value {
    referred(declared).map_or(declared, resolved)
}

/// The schemas of which a value has one, but for that of nothing.
fn options(declared: &'static Value) -> impl Iterator<Item = &'static Value> {
    alternatives(declared).iter().map(resolved).filter(|one| one["type"] != "null")
}

/// All ways in which a value is written.
fn forms(declared: &'static Value, found: Option<&str>) -> Vec<String> {
    let mut all: Vec<String> = options(declared).flat_map(|one| forms(one, found)).collect();
    if all.is_empty() {
        all.extend(form(declared, found));
    }
    all.dedup();
    all
}

/// How a value of one kind is written.
fn form(declared: &'static Value, found: Option<&str>) -> Option<String> {
    if let Some(word) = declared["const"].as_str() {
        return Some(format!("\"{word}\""));
    }
    if let Some(words) = declared["enum"].as_array() {
        let words = words.iter().filter_map(Value::as_str).map(|word| format!("\"{word}\""));
        return Some(words.collect::<Vec<_>>().join(", "));
    }
    let types = &declared["type"];
    let is = |name: &str| {
        types == name || types.as_array().is_some_and(|all| all.iter().any(|one| one == name))
    };
    if is("object") {
        return Some(table(declared["properties"].as_object()?, declared, found));
    }
    if is("array") {
        return Some(array(declared));
    }
    if is("boolean") {
        return Some("true or false".to_owned());
    }
    (is("number") || is("integer")).then(|| "a number".to_owned())
}

/// A table with the keys that it needs, else with the first of those that it may have.
fn table(properties: &'static Map<String, Value>, declared: &Value, found: Option<&str>) -> String {
    let needed: Vec<&str> =
        declared["required"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
    let keys =
        if needed.is_empty() { properties.keys().map(String::as_str).collect() } else { needed };
    let value = |key: &str| match (found, &keys[..]) {
        (Some(found), [_]) if is_number(&properties[key]) => found.to_owned(),
        _ => content(&properties[key]),
    };
    let mut shown: Vec<String> =
        keys.iter().take(MOST_KEYS).map(|key| format!("{key} = {}", value(key))).collect();
    if keys.len() > MOST_KEYS {
        shown.push("...".to_owned());
    }
    if shown.is_empty() { "{}".to_owned() } else { format!("{{ {} }}", shown.join(", ")) }
}

/// What stands behind a key in an example.
fn content(declared: &'static Value) -> String {
    let declared = resolved(declared);
    match declared["type"].as_str() {
        Some("array") => array(declared),
        Some("object") if declared["properties"].is_object() => "{ ... }".to_owned(),
        _ => "...".to_owned(),
    }
}

fn is_number(declared: &'static Value) -> bool {
    resolved(declared)["type"] == "number"
}

/// Brackets, with a coordinate for each of a few numbers.
fn array(declared: &Value) -> String {
    let n = declared["minItems"].as_u64().filter(|n| declared["maxItems"] == *n);
    match n.and_then(|n| COORDINATES.get(..usize::try_from(n).ok()?)) {
        Some(coordinates) => format!("[{}]", coordinates.join(", ")),
        None => "[...]".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_written_as_the_schema_has_them() {
        let of = |path: &str, found: Option<&str>| written(path, found).unwrap_or_default();
        assert_eq!(of("body.0.shape.disc", Some("0.5")), "write disc = { radius = 0.5 }");
        assert_eq!(of("body.0.shape.disc", None), "write disc = { radius = ... }");
        assert!(of("body.0.shape.ellipse", None).contains("{ semi_axes = [x, y] }"));
        assert!(of("boundary.left.velocity", None).contains("velocity = { value = [...] }"));
        let fields = of("output.fields", None);
        assert!(fields.contains("\"never\"") && fields.contains("{ steps = ... }"), "{fields}");
        assert!(of("contact.barrier", None).contains("range = ..."));
        assert_eq!(written("body.0.nothing.here", None), None);
    }

    #[test]
    fn an_alternative_is_shown_with_what_it_holds() {
        let found = alternative("boundary.left", "periodic").unwrap();
        assert!(
            found.starts_with("write { periodic = \"...\" } instead of \"periodic\""),
            "{found}"
        );
        assert!(found.ends_with("(One of a periodic pair: the side opposite, by name)"), "{found}");
        let found = alternative("body.0.shape", "disc").unwrap();
        assert!(found.starts_with("write { disc = { radius = "), "{found}");
        assert_eq!(alternative("body.0.shape", "banana"), None);
    }

    #[test]
    fn keys_are_found_in_the_tables_below() {
        assert_eq!(holder("", &["viscosity"]), Some("fluid"));
        assert_eq!(holder("", &["fields"]), Some("output"));
        assert_eq!(holder("time", &["end", "step"]), Some("unsteady"));
        assert_eq!(holder("body.0.motion", &["velocity"]), Some("imposed"));
        assert_eq!(holder("", &["nowhere"]), None);
    }
}
