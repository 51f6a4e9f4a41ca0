//! `TomlNode`: a case before it is typed: TOML values that know where they were written.
//!
//! A case is put together from several texts (a parent, the file, a variant, `--set`); each value
//! keeps where it came from, so that every later message can point at it.

use std::collections::BTreeMap;
use std::sync::Arc;

use toml::de::{DeTable, DeValue};

use super::choices::CHOICES;
use super::names::{Step, with_dots};
use super::source::{Origin, Source};
use super::toml_help::{TomlHelp, toml_help};

/// A value and where it is written.
#[derive(Debug, Clone, PartialEq)]
pub struct TomlNode {
    /// Where its key is written; the value itself within an array.
    pub key: Origin,
    /// Where it is written; the header of a table.
    pub origin: Origin,
    /// The value.
    pub value: TomlValue,
}

/// A TOML value.
#[derive(Debug, Clone, PartialEq)]
pub enum TomlValue {
    /// Text.
    String(String),
    /// Whole number.
    Integer(i64),
    /// Number.
    Float(f64),
    /// True or false.
    Boolean(bool),
    /// A date, which no key of a case takes.
    Date(String),
    /// Values in order.
    Array(Vec<TomlNode>),
    /// Values by key.
    Table(BTreeMap<String, TomlNode>),
}

/// What a path leads to.
#[derive(Debug, Clone, Copy)]
pub struct Found<'a> {
    /// The value, or the nearest table around it.
    pub node: &'a TomlNode,
    /// Whether it is the value itself.
    pub is_exact: bool,
}

/// Why a text or a path could not be followed.
#[derive(Debug, Clone, PartialEq)]
pub struct TreeError {
    /// Where.
    pub origin: Origin,
    /// What is wrong.
    pub message: String,
    /// What to do.
    pub help: String,
}

/// Reads a TOML text.
pub fn parse(source: &Arc<Source>) -> Result<TomlNode, TreeError> {
    let table = DeTable::parse(&source.text).map_err(|error| {
        let span = error.span().unwrap_or(0..0);
        let TomlHelp { reason, help } = toml_help(&source.text, span.clone(), error.message());
        TreeError {
            origin: Origin { source: Arc::clone(source), span },
            message: format!("this is not TOML: {reason}"),
            help,
        }
    })?;
    let start = Origin { source: Arc::clone(source), span: 0..0 };
    Ok(TomlNode { key: start.clone(), origin: start, value: table_value(source, table.get_ref())? })
}

/// Reads one TOML value, such as the right-hand side of `--set`.
pub fn parse_value(source: &Arc<Source>, start: usize) -> Result<TomlNode, String> {
    let text = &source.text[start..];
    let value = DeValue::parse(text).map_err(|error| error.message().to_owned())?;
    // Spans within the value are not needed: the whole setting is one line.
    let whole = Origin { source: Arc::clone(source), span: start..source.text.len() };
    let mut node = node(source, &whole, value.get_ref()).map_err(|error| error.message)?;
    node.relocate(&whole);
    Ok(node)
}

fn table_value(source: &Arc<Source>, table: &DeTable<'_>) -> Result<TomlValue, TreeError> {
    let mut entries = BTreeMap::new();
    for (key, value) in table {
        let written_at = |span| Origin { source: Arc::clone(source), span };
        let mut entry = node(source, &written_at(value.span()), value.get_ref())?;
        entry.key = written_at(key.span());
        entries.insert(key.get_ref().to_string(), entry);
    }
    Ok(TomlValue::Table(entries))
}

fn node(source: &Arc<Source>, origin: &Origin, value: &DeValue<'_>) -> Result<TomlNode, TreeError> {
    let refused = |what: &str| TreeError {
        origin: origin.clone(),
        message: format!("this number cannot be read: {what}"),
        help: "write it as 12, -0.5 or 1e-3".to_owned(),
    };
    let value = match value {
        DeValue::String(text) => TomlValue::String(text.to_string()),
        DeValue::Integer(number) => TomlValue::Integer(
            i64::from_str_radix(number.as_str(), number.radix())
                .map_err(|error| refused(&error.to_string()))?,
        ),
        DeValue::Float(number) => TomlValue::Float(
            number
                .as_str()
                .parse()
                .map_err(|error: std::num::ParseFloatError| refused(&error.to_string()))?,
        ),
        DeValue::Boolean(value) => TomlValue::Boolean(*value),
        DeValue::Datetime(date) => TomlValue::Date(date.to_string()),
        DeValue::Array(items) => TomlValue::Array(
            items
                .iter()
                .map(|item| {
                    let origin = Origin { source: Arc::clone(source), span: item.span() };
                    node(source, &origin, item.get_ref())
                })
                .collect::<Result<_, _>>()?,
        ),
        DeValue::Table(table) => table_value(source, table)?,
    };
    Ok(TomlNode { key: origin.clone(), origin: origin.clone(), value })
}

impl TomlNode {
    /// Says of this value and all within that they are written at `origin`.
    pub fn relocate(&mut self, origin: &Origin) {
        self.key = origin.clone();
        self.origin = origin.clone();
        match &mut self.value {
            TomlValue::Array(items) => items.iter_mut().for_each(|item| item.relocate(origin)),
            TomlValue::Table(entries) => {
                entries.values_mut().for_each(|entry| entry.relocate(origin))
            }
            _ => {}
        }
    }

    /// The entries of a table.
    pub fn table(&self) -> Option<&BTreeMap<String, TomlNode>> {
        if let TomlValue::Table(entries) = &self.value { Some(entries) } else { None }
    }

    /// The entries of a table, to be changed.
    pub fn table_mut(&mut self) -> Option<&mut BTreeMap<String, TomlNode>> {
        if let TomlValue::Table(entries) = &mut self.value { Some(entries) } else { None }
    }

    /// The items of an array.
    pub fn array(&self) -> Option<&[TomlNode]> {
        if let TomlValue::Array(items) = &self.value { Some(items) } else { None }
    }

    /// The text of a string.
    pub fn text(&self) -> Option<&str> {
        if let TomlValue::String(text) = &self.value { Some(text) } else { None }
    }

    /// The value at a dotted path, if it is written.
    pub fn get(&self, path: &str) -> Option<&Self> {
        let found = self.find(path);
        found.is_exact.then_some(found.node)
    }

    /// The value at a dotted path, or the nearest table around it that is written.
    pub fn find(&self, path: &str) -> Found<'_> {
        let mut here = self;
        let mut left = path.trim_start_matches('.');
        while !left.is_empty() {
            let (step, after) = left.split_once('.').unwrap_or((left, ""));
            let next = match &here.value {
                TomlValue::Table(entries) => match entries.get(step) {
                    Some(node) => Some(Step { node, after }),
                    None => with_dots(entries, left),
                },
                TomlValue::Array(items) => {
                    let item = step.parse().ok().and_then(|index: usize| items.get(index));
                    item.map(|node| Step { node, after })
                }
                _ => None,
            };
            match next {
                Some(Step { node, after }) => (here, left) = (node, after.trim_start_matches('.')),
                None => return Found { node: here, is_exact: false },
            }
        }
        Found { node: here, is_exact: true }
    }

    /// The value at a dotted path, to be changed.
    pub fn find_mut(&mut self, path: &str) -> Option<&mut Self> {
        let mut here = self;
        for step in path.split('.').filter(|step| !step.is_empty()) {
            here = match &mut here.value {
                TomlValue::Table(entries) => entries.get_mut(step)?,
                TomlValue::Array(items) => items.get_mut(step.parse::<usize>().ok()?)?,
                _ => return None,
            };
        }
        Some(here)
    }

    /// A value that is written nowhere.
    pub fn at_no_place(value: TomlValue) -> Self {
        let (name, text) = (String::new(), String::new());
        let source = Arc::new(Source { name, directory: None, text });
        let origin = Origin { source, span: 0..0 };
        Self { key: origin.clone(), origin, value }
    }

    /// Whether it is a table written within a line, in braces.
    pub fn is_inline(&self) -> bool {
        self.table().is_some() && self.begins_with('{')
    }

    /// Whether it is a table below a header in brackets.
    pub fn is_under_header(&self) -> bool {
        self.table().is_some() && self.begins_with('[')
    }

    fn begins_with(&self, c: char) -> bool {
        let Origin { source, span } = &self.origin;
        source.text[span.start.min(source.text.len())..].starts_with(c)
    }

    /// Puts a value at a dotted path; tables on the way that are not there yet are made.
    ///
    /// Whether the path leads to a key that is known is found out when the case is typed.
    pub fn set(&mut self, path: &str, value: Self) -> Result<(), TreeError> {
        let refused =
            |message: String, help: String| TreeError { origin: value.key.clone(), message, help };
        let steps: Vec<&str> = path.split('.').collect();
        if steps.iter().any(|step| step.trim().is_empty()) {
            return Err(refused(
                format!("`{path}` is not a path"),
                "write keys joined by dots, such as body.0.center.1".to_owned(),
            ));
        }
        let mut here = self;
        let mut above = "";
        for (depth, step) in steps.iter().enumerate() {
            let so_far = steps[..depth].join(".");
            let fresh =
                Self { key: value.key.clone(), origin: value.origin.clone(), value: empty() };
            // One alternative gives way to another, bare or with a table; a list of that name is none.
            let is_list = matches!(here.value, TomlValue::Array(_));
            let has_it = here.table().is_some_and(|entries| entries.contains_key(*step));
            if is_choice(above, &so_far) && !has_it && !is_list {
                here.value = empty();
            }
            here = match &mut here.value {
                TomlValue::Table(entries) => entries.entry((*step).to_owned()).or_insert(fresh),
                TomlValue::Array(items) => {
                    let n = items.len();
                    let item = step.parse().ok().and_then(|index: usize| items.get_mut(index));
                    item.ok_or_else(|| {
                        refused(
                            format!("`{path}`: there is no `{so_far}.{step}`"),
                            format!("entries are counted from 0; `{so_far}` has {n} of them"),
                        )
                    })?
                }
                _ => {
                    return Err(refused(
                        format!("`{path}`: `{so_far}` is not a table, so it has no `{step}`"),
                        format!("set `{so_far}` itself"),
                    ));
                }
            };
            above = step;
        }
        *here = value;
        Ok(())
    }

    /// Lays `child` over this: tables are merged, everything else is replaced.
    pub fn merge(&mut self, child: Self) {
        self.merge_at("", "", child);
    }

    fn merge_at(&mut self, name: &str, path: &str, child: Self) {
        match (&mut self.value, child.value) {
            (TomlValue::Table(ours), TomlValue::Table(theirs)) => {
                if is_choice(name, path) && theirs.keys().any(|key| !ours.contains_key(key)) {
                    ours.clear();
                }
                for (key, entry) in theirs {
                    match ours.get_mut(&key) {
                        Some(old) => old.merge_at(&key, &format!("{path}.{key}"), entry),
                        None => {
                            ours.insert(key, entry);
                        }
                    }
                }
                self.key = child.key;
                self.origin = child.origin;
            }
            (_, value) => *self = Self { key: child.key, origin: child.origin, value },
        }
    }
}

fn empty() -> TomlValue {
    TomlValue::Table(BTreeMap::new())
}

/// Whether the table with this key holds one of several alternatives.
fn is_choice(name: &str, path: &str) -> bool {
    let mut back = path.rsplit('.');
    let parent = back.nth(1).unwrap_or_default();
    CHOICES.contains(&name) || parent == "boundary" || parent == "factors"
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tree(text: &str) -> TomlNode {
        let source =
            Arc::new(Source { name: "t.toml".to_owned(), directory: None, text: text.to_owned() });
        parse(&source).unwrap()
    }

    fn set(root: &mut TomlNode, path: &str, value: &str) -> Result<(), TreeError> {
        let source =
            Arc::new(Source { name: "--set".to_owned(), directory: None, text: value.to_owned() });
        root.set(path, parse_value(&source, 0).unwrap())
    }

    #[test]
    fn every_value_knows_its_line_and_column() {
        let root = tree("[fluid]\nviscosity = 1.0\n[[body]]\nname = \"a\"\n[[body]]\nx = [1, 2]\n");
        let written_at = |path: &str| {
            let location = root.get(path).unwrap().origin.location();
            (location.line, location.column)
        };
        assert_eq!(written_at("fluid"), (1, 1));
        assert_eq!(written_at("fluid.viscosity"), (2, 13));
        assert_eq!(written_at("body.0"), (3, 1));
        assert_eq!(written_at("body.1"), (5, 1));
        assert_eq!(written_at("body.1.x.1"), (6, 9));
        let root = tree("[set]\n\"body.0.x\" = 1.0\nbody = { 0 = 3 }\n\"a.b\" = { c = 2 }\n");
        let line = |path: &str| root.get(path).map(|node| node.origin.location().line);
        assert_eq!(line("set.body.0.x"), None);
        assert_eq!(line("set.body.0"), Some(3));
        assert_eq!(line("set.a.b"), Some(4));
        assert_eq!(line("set.a.b.c"), Some(4));
        assert_eq!(line("set.a"), None);
    }

    #[test]
    fn another_alternative_replaces_the_first_one() {
        let mut root = tree("time = { steady = {} }\nboundary = { left = \"no-slip\" }");
        set(&mut root, "time.unsteady.step", "0.1").unwrap();
        assert!(root.get("time.steady").is_none() && root.get("time.unsteady.step").is_some());
        set(&mut root, "boundary.left.parabolic.peak", "2").unwrap();
        assert_eq!(root.get("boundary.left.parabolic.peak").unwrap().value, TomlValue::Integer(2));
        let mut parent = tree("[time.steady]\n[mesh]\nsize = 1\ngrowth = 0.1");
        parent.merge(tree("[time.unsteady]\nstep = 1\n[mesh]\nsize = 2"));
        assert!(parent.get("time.steady").is_none() && parent.get("mesh.growth").is_some());
        let mut bent = tree("kind.bent.angle = { constant = 0.5 }");
        bent.merge(tree("kind.bent.angle = { sine = { amplitude = 0.5, period = 1.0 } }"));
        assert!(bent.get("kind.bent.angle.constant").is_none(), "{bent:?}");
        assert_eq!(parent.get("mesh.size").unwrap().value, TomlValue::Integer(2));
    }

    #[test]
    fn an_index_past_the_end_is_refused() {
        let mut root = tree("modes = [1, 2]");
        set(&mut root, "modes.1", "3").unwrap();
        assert_eq!(root.get("modes.1").unwrap().value, TomlValue::Integer(3));
        let error = set(&mut root, "modes.2", "3").unwrap_err();
        assert!(error.help.contains("has 2 of them"), "{error:?}");
        assert!(set(&mut root, "modes.1.x", "3").is_err());
    }

    #[test]
    fn a_list_with_the_name_of_a_choice_keeps_its_entries() {
        let mut root = tree("[[solid]]\nhold = [{ axes = ['y'] }, { axes = ['x'] }]");
        let value = TomlNode::at_no_place(TomlValue::String("z".to_owned()));
        root.set("solid.0.hold.1.axes.0", value).expect("there is such an entry");
        let axis = |path: &str| root.get(path).and_then(TomlNode::text);
        assert_eq!(axis("solid.0.hold.0.axes.0"), Some("y"));
        assert_eq!(axis("solid.0.hold.1.axes.0"), Some("z"));
    }
}
