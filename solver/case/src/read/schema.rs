//! JSON Schema of case files, for editors (`#:schema alewife.schema.json` in the first line) and for checks.

use std::sync::LazyLock;

use serde_json::Value;

use crate::Geometry;

static SCHEMA: LazyLock<Value> =
    LazyLock::new(|| serde_json::from_str(schema()).unwrap_or_default());

/// The schema as JSON text.
///
/// It is derived from the types of a case once, by a test, and not in each build of the program.
#[must_use]
pub fn schema() -> &'static str {
    include_str!("../../alewife.schema.json")
}

/// The schema of a whole case.
pub(crate) fn whole() -> &'static Value {
    &SCHEMA
}

/// The schema that a `$ref` leads to, if it is one.
pub(crate) fn referred(declared: &Value) -> Option<&'static Value> {
    SCHEMA.pointer(declared["$ref"].as_str()?.trim_start_matches('#'))
}

/// The schemas of which a value has one.
pub(crate) fn alternatives(declared: &Value) -> &[Value] {
    let all = declared["oneOf"].as_array().or_else(|| declared["anyOf"].as_array());
    all.map_or(&[], Vec::as_slice)
}

/// Whether what a schema describes can stand in a case of a geometry.
pub(crate) fn fits(declared: &Value, geometry: Geometry) -> bool {
    let geometries = declared["geometries"].as_array();
    geometries.is_none_or(|all| all.iter().any(|one| one == geometry.name()))
}

/// Names of those alternatives with values of their own that can stand in a case of a geometry.
pub(crate) fn fitting(alternatives: &[Value], geometry: Geometry) -> Vec<&str> {
    let fitting = alternatives.iter().filter(|one| fits(one, geometry));
    fitting
        .filter_map(|one| one["properties"].as_object()?.keys().next())
        .map(String::as_str)
        .collect()
}

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::{env, fs};

    use serde_json::{Value, json};

    use super::schema;
    use crate::Case;
    use crate::read::files::stroke_file::FileStroke;
    use crate::read::reference_rows::REFERENCES;
    use crate::read::reference_table::ReferenceTable;
    use crate::text::choices::CHOICES;

    /// The schema of `Case`, and `extends`, which only reading knows.
    fn derived() -> Value {
        let mut schema = schemars::schema_for!(Case).to_value();
        schema["title"] = json!("alewife case");
        schema["properties"]["extends"] = json!({
            "type": "string",
            "description": "The case this one starts from: the relative path of a case file, or the \
                            name of a shipped case. Tables are merged, everything else is replaced; \
                            reference, references, variant, quick and sweep are not inherited.",
        });
        // Rows are put beside the references before the case is typed
        let mut table = schemars::schema_for!(ReferenceTable).to_value();
        if let Some(keys) = table.as_object_mut() {
            keys.retain(|key, _| key != "$schema" && key != "title");
        }
        schema["$defs"]["ReferenceTable"] = table;
        schema["properties"][REFERENCES] = json!({
            "$ref": "#/$defs/ReferenceTable",
            "description": "What the case and its variants are compared with, as a table.",
        });
        schema["properties"]["sweep"] = sweep();
        schema["$defs"]["SweepRange"] = sweep_range();
        // A plain number is a stroke, too
        if let Some(strokes) = schema["$defs"]["Stroke"]["oneOf"].as_array_mut() {
            strokes.push(json!({ "type": "number", "description": "The same as `constant`." }));
        }
        // Values of what is an angle in time may have a unit
        for name in ["Stroke", "TimeFunction"] {
            allow_units(&mut schema["$defs"][name]);
        }
        // Values of a file are put in its place before the case is typed
        let mut file = schemars::schema_for!(FileStroke).to_value();
        if let Some(keys) = file.as_object_mut() {
            keys.retain(|key, _| key != "$schema" && key != "title");
        }
        for name in ["Stroke", "TimeFunction"] {
            let Some(strokes) = schema["$defs"][name]["oneOf"].as_array_mut() else { continue };
            strokes.push(json!({
                "type": "object",
                "properties": { "file": &file },
                "required": ["file"],
                "additionalProperties": false,
            }));
        }
        // What is needed may stand in the extended file.
        let required = schema["required"].take();
        if let Some(object) = schema.as_object_mut() {
            object.remove("required");
            object.insert(
                "anyOf".to_owned(),
                json!([{ "required": ["extends"] }, { "required": required }]),
            );
        }
        schema
    }

    /// The schema of `[sweep]`, whose keys are those of the case by their paths.
    fn sweep() -> Value {
        let values = json!({
            "description": "Values by the paths of keys, such as \"fluid.viscosity\" = [1.0, 2.0] or \
                            { from = 1.0, to = 10.0, n = 5 }.",
            "type": "object",
            "additionalProperties": { "anyOf": [
                { "type": "array", "minItems": 1 },
                { "$ref": "#/$defs/SweepRange" },
                { "type": "object" },
            ] },
        });
        let points = json!({ "description": "Values of a point.", "type": "object" });
        json!({
            "description": "What `alewife sweep` varies: all combinations of what stands here.",
            "type": "object",
            "additionalProperties": false,
            "properties": {
                "grid": values,
                "zip": {
                    "description": "Keys that vary together: their first values, their second ones, ...",
                    "anyOf": [values, { "type": "array", "items": values }],
                },
                "list": { "description": "Points one by one.", "type": "array", "items": points },
                "latin-hypercube": {
                    "description": "Points at random in ranges, one in each of the equal parts of every \
                                    range.",
                    "type": "object",
                    "required": ["points"],
                    "properties": {
                        "points": { "description": "How many.", "type": "integer", "minimum": 1 },
                        "seed": {
                            "description": "Equal seeds give equal points.",
                            "type": "integer",
                            "minimum": 0,
                        },
                    },
                },
                "quantities": {
                    "description": "Quantities to collect, with a statistic in front if wanted: \
                                    \"mean squirmer.power\".",
                    "type": "array",
                    "items": { "type": "string" },
                },
            },
        })
    }

    /// The schema of a range of a sweep.
    fn sweep_range() -> Value {
        json!({
            "type": "object",
            "additionalProperties": false,
            "required": ["from", "to"],
            "properties": {
                "from": { "description": "First value.", "type": "number" },
                "to": { "description": "Last value.", "type": "number" },
                "n": { "description": "Number of values.", "type": "integer", "minimum": 2 },
                "scale": {
                    "description": "Equal steps or equal factors.",
                    "enum": ["linear", "log"],
                },
            },
        })
    }

    /// Lets the values of a function of time be angles with a unit, which its own schema does not know.
    fn allow_units(schema: &mut Value) {
        match schema {
            Value::Object(keys) if keys.get("format").is_some_and(|format| format == "double") => {
                keys.remove("type");
                keys.remove("format");
                keys.insert("$ref".to_owned(), json!("#/$defs/Angle"));
            }
            Value::Object(keys) => {
                let is_value = |key: &str| !["period", "phase", "ramp", "duration"].contains(&key);
                keys.iter_mut()
                    .filter(|(key, _)| is_value(key))
                    .for_each(|(_, own)| allow_units(own));
            }
            Value::Array(items) => items.iter_mut().for_each(allow_units),
            _ => {}
        }
    }

    /// To write the file again: `ALEWIFE_UPDATE=1 cargo test --release --workspace schema`.
    #[test]
    fn the_schema_is_that_of_the_types() {
        let text = format!("{:#}\n", derived());
        if env::var_os("ALEWIFE_UPDATE").is_some() {
            let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("alewife.schema.json");
            fs::write(file, &text).unwrap();
            return;
        }
        assert!(text == schema(), "alewife.schema.json is not up to date");
    }

    /// The schema a `$ref` leads to.
    fn resolved<'a>(root: &'a Value, schema: &'a Value) -> &'a Value {
        match schema["$ref"].as_str() {
            Some(path) => root.pointer(path.trim_start_matches('#')).unwrap(),
            None => schema,
        }
    }

    fn has_alternatives_with_values(root: &Value, property: &Value) -> bool {
        let options = ["oneOf", "anyOf"];
        let alternatives =
            |schema: &Value| options.iter().find_map(|key| schema[*key].as_array().cloned());
        let property = resolved(root, property);
        alternatives(property).is_some_and(|list| {
            list.iter().any(|option| {
                let option = resolved(root, option);
                let is_tagged = option["type"] == "object" && option["required"].is_array();
                let is_one_of_one =
                    option["properties"].as_object().is_some_and(|keys| keys.len() == 1);
                (is_tagged && is_one_of_one) || has_alternatives_with_values(root, option)
            })
        })
    }

    #[test]
    fn a_stroke_may_be_a_number() {
        let strokes = derived()["$defs"]["Stroke"]["oneOf"].as_array().cloned().unwrap();
        assert!(strokes.iter().any(|stroke| stroke["type"] == "number"));
    }

    #[test]
    fn every_table_of_alternatives_is_known_to_merging() {
        let root = derived();
        let mut found = Vec::new();
        let structs = root["$defs"].as_object().unwrap().values().chain([&root]);
        for definition in structs {
            let variants = definition["oneOf"].as_array().cloned().unwrap_or_default();
            // A definition of one alternative is no table, what an alternative holds is one
            let has_one = |table: &serde_json::Value| {
                table["required"].as_array().is_some_and(|keys| keys.len() == 1)
                    && table["properties"].as_object().is_some_and(|keys| keys.len() == 1)
            };
            let own = Some(definition.clone()).filter(|table| !has_one(table));
            let tables = own.into_iter().chain(
                variants.iter().filter_map(|v| v["properties"].as_object()).flat_map(
                    |properties| properties.values().map(|inner| resolved(&root, inner).clone()),
                ),
            );
            for table in tables.collect::<Vec<_>>() {
                for (key, property) in table["properties"].as_object().into_iter().flatten() {
                    if has_alternatives_with_values(&root, property) {
                        found.push(key.clone());
                    }
                }
            }
        }
        found.sort();
        found.dedup();
        let mut known: Vec<String> = CHOICES.iter().map(ToString::to_string).collect();
        known.sort();
        assert_eq!(found, known);
    }

    #[test]
    fn unknown_keys_are_refused_and_extends_is_known() {
        let root = derived();
        assert_eq!(root["additionalProperties"], false);
        assert!(root["properties"]["extends"].is_object());
        assert!(root.get("required").is_none());
    }
}
