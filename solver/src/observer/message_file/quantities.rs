//! `QuantityGroups`: the quantities of a run as messages, one topic and schema for each body, swimmer or
//! probe and the flow.
//!
//! The parts of a name become keys of objects, as paths of viewers have them: `swimmer.velocity.x` is
//! `velocity.x` on `/quantities/swimmer`. The text around the numbers is made once.

use std::collections::BTreeMap;
use std::io;

use serde_json::{Map, Value, json};

/// The quantities of one body, swimmer or probe, or of the flow.
#[derive(Debug)]
pub struct Group {
    /// Where they are reported.
    pub topic: String,
    /// Name of the schema.
    pub schema_name: String,
    /// The schema, by the rules of JSON Schema.
    pub schema: Value,
    /// Text before each number, and the place of the number among all quantities.
    pieces: Vec<Piece>,
    /// Text after the last one.
    end: String,
}

#[derive(Debug)]
struct Piece {
    before: String,
    index: usize,
}

/// Quantities as a tree of the parts of their names.
#[derive(Debug, Default)]
struct Tree {
    index: Option<usize>,
    children: BTreeMap<String, Tree>,
}

impl Group {
    /// The groups of all quantities, in the order of their first ones.
    pub fn all(names: &[String]) -> Vec<Self> {
        let mut order: Vec<&str> = Vec::new();
        let mut trees: BTreeMap<&str, Tree> = BTreeMap::new();
        for (index, name) in names.iter().enumerate() {
            let (group, rest) = name.split_once('.').unwrap_or((name, "value"));
            let mut tree = trees.entry(group).or_insert_with(|| {
                order.push(group);
                Tree::default()
            });
            for part in rest.split('.') {
                tree = tree.children.entry(part.to_owned()).or_default();
            }
            tree.index = Some(index);
        }
        order.into_iter().filter_map(|name| Some(Self::new(name, trees.get(name)?))).collect()
    }

    fn new(name: &str, tree: &Tree) -> Self {
        let (mut pieces, mut text) = (Vec::new(), String::new());
        tree.write(&mut pieces, &mut text);
        let schema_name = format!("alewife.Quantities.{name}");
        let mut schema = tree.schema();
        schema["title"] = json!(schema_name);
        Self { topic: format!("/quantities/{name}"), schema_name, schema, pieces, end: text }
    }

    /// The message with the values of all quantities.
    ///
    /// # Errors
    /// Never: numbers can be written to memory.
    pub fn message(&self, values: &[f64]) -> io::Result<Vec<u8>> {
        let mut text = Vec::with_capacity(40 * self.pieces.len());
        for Piece { before, index } in &self.pieces {
            text.extend_from_slice(before.as_bytes());
            // A number that is not finite is null
            serde_json::to_writer(&mut text, &values[*index])?;
        }
        text.extend_from_slice(self.end.as_bytes());
        Ok(text)
    }
}

impl Tree {
    /// Keys and what is below them; a quantity whose name is the beginning of others is `value` among them.
    fn entries(&self) -> impl Iterator<Item = (&str, Option<&Self>)> {
        let own = self.index.filter(|_| !self.children.is_empty()).map(|_| ("value", None));
        own.into_iter().chain(self.children.iter().map(|(key, tree)| (key.as_str(), Some(tree))))
    }

    fn write(&self, pieces: &mut Vec<Piece>, text: &mut String) {
        text.push('{');
        for (nth, (key, tree)) in self.entries().enumerate() {
            if nth > 0 {
                text.push(',');
            }
            *text += &format!("{}:", json!(key));
            match (tree, tree.map_or(self.index, |tree| tree.index)) {
                (Some(tree), _) if !tree.children.is_empty() => tree.write(pieces, text),
                (_, Some(index)) => {
                    pieces.push(Piece { before: std::mem::take(text), index });
                }
                (_, None) => *text += "null",
            }
        }
        text.push('}');
    }

    fn schema(&self) -> Value {
        let properties: Map<String, Value> = self
            .entries()
            .map(|(key, tree)| {
                let schema = match tree {
                    Some(tree) if !tree.children.is_empty() => tree.schema(),
                    _ => json!({"type": ["number", "null"]}),
                };
                (key.to_owned(), schema)
            })
            .collect();
        json!({"type": "object", "properties": properties})
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_names_become_keys() {
        let names = ["a.speed", "flow.energy", "a.force.x", "a.force.y", "a.speed.mean"];
        let groups = Group::all(&names.map(str::to_owned));
        let topics: Vec<&str> = groups.iter().map(|group| group.topic.as_str()).collect();
        assert_eq!(topics, ["/quantities/a", "/quantities/flow"]);
        let values = [1.5, f64::NAN, -2e-300, 3.0, 4.0];
        let read = |group: &Group| -> Value {
            serde_json::from_slice(&group.message(&values).unwrap()).unwrap()
        };
        let speed = json!({"value": 1.5, "mean": 4.0});
        assert_eq!(read(&groups[0]), json!({"force": {"x": -2e-300, "y": 3.0}, "speed": speed}));
        assert_eq!(read(&groups[1]), json!({"energy": null}));
        let force = &groups[0].schema["properties"]["force"]["properties"];
        assert_eq!(force["x"], json!({"type": ["number", "null"]}));
    }
}
