//! The keys of a case that say what is solved: those a run that resumes shares with its state.

use std::collections::BTreeMap;

use serde_json::Value;

use crate::Case;

/// What may differ besides these is how the problem is solved, and what is reported of it.
const TABLES: [&str; 12] = [
    "geometry", "frame", "fluid", "flow", "field", "domain", "boundary", "body", "joint",
    "swimmer", "tracer", "scalar",
];

impl Case {
    /// Geometry, fluid, boundary conditions, bodies and what moves them: the value of each key, by its
    /// path as on the command line, such as `body.0.shape.disc.radius`.
    ///
    /// # Errors
    /// When the case cannot be written.
    pub fn problem_keys(&self) -> Result<BTreeMap<String, String>, serde_json::Error> {
        let mut keys = BTreeMap::new();
        let case = serde_json::to_value(self)?;
        for table in TABLES {
            if let Some(value) = case.get(table) {
                collect_keys(table.to_owned(), value, &mut keys);
            }
        }
        // A file is known by its checksum, wherever it is
        keys.remove("domain.mesh.file");
        Ok(keys)
    }
}

/// Adds the values of all keys of a value at a path, by their paths.
pub fn collect_keys(path: String, value: &Value, keys: &mut BTreeMap<String, String>) {
    match value {
        Value::Object(entries) => {
            for (key, value) in entries {
                collect_keys(format!("{path}.{key}"), value, keys);
            }
        }
        Value::Array(items) if items.iter().any(|item| item.is_object()) => {
            for (index, item) in items.iter().enumerate() {
                collect_keys(format!("{path}.{index}"), item, keys);
            }
        }
        value => drop(keys.insert(path, value.to_string())),
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn keys_say_what_is_solved_and_not_how() {
        let keys = |settings: &[&str]| {
            let settings: Vec<String> = settings.iter().map(|one| (*one).to_owned()).collect();
            crate::Case::read("three-disc-2d", &settings)
                .unwrap()
                .model
                .case
                .problem_keys()
                .unwrap()
        };
        let known = keys(&[]);
        assert_eq!(known["geometry"], "\"planar\"");
        assert_eq!(keys(&["mesh.scale=2", "title=\"another\""]), known);
        let other = keys(&["fluid.viscosity=7.5"]);
        assert_eq!(other["fluid.viscosity"], "7.5");
        assert_eq!(known.iter().filter(|(key, value)| other[*key] != **value).count(), 1);
        let turned = keys(&["field.magnetic.rotating={ strength = 1.0, frequency = 2.0 }"]);
        assert_eq!(turned["field.magnetic.rotating.frequency"], "2.0");
    }
}
