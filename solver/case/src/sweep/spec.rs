//! What a `[sweep]` says: which keys take which values, read with the place of every mistake.

use std::collections::BTreeMap;

use super::entries::{Entry, entries, in_order, is_range};
use super::latin_hypercube::sample;
use super::quantity;
use super::quantity::SweepQuantity;
use super::range;
use super::range::{CountedRange, EXAMPLE};
use crate::text::source::Origin;
use crate::text::tree::{TomlNode, TomlValue, TreeError};
use crate::text::type_error::suggestion;

/// Keys of a sweep.
const KEYS: [&str; 5] = ["grid", "zip", "list", "latin-hypercube", "quantities"];

/// A key that is swept.
#[derive(Debug, Clone)]
pub struct SweptKey {
    /// Its path, as on the command line.
    pub path: String,
    /// Where that is written.
    pub origin: Origin,
}

/// Keys that vary together: each row gives a value to every one of them.
#[derive(Debug, Clone)]
pub struct Block {
    /// The keys.
    pub keys: Vec<SweptKey>,
    /// Their values.
    pub rows: Vec<Vec<TomlNode>>,
}

/// What a sweep varies, and what it collects besides references.
#[derive(Debug, Clone, Default)]
pub struct SweepSpec {
    /// All combinations of their rows are points.
    pub blocks: Vec<Block>,
    /// Quantities to collect.
    pub quantities: Vec<SweepQuantity>,
}

/// Reads a `[sweep]`.
///
/// # Errors
/// What is wrong in it.
pub fn read(sweep: &TomlNode) -> Result<SweepSpec, TreeError> {
    let mut spec = SweepSpec::default();
    for Entry { path: key, node } in in_order(table_of("sweep", sweep)?) {
        match key.as_str() {
            "grid" => {
                for entry in entries(table_of("sweep.grid", node)?, "")? {
                    let rows = values(&entry)?.into_iter().map(|value| vec![value]).collect();
                    spec.blocks.push(Block { keys: vec![swept(&entry)], rows });
                }
            }
            "zip" => {
                for group in tables_of("sweep.zip", node)? {
                    spec.blocks.push(zipped(group)?);
                }
            }
            "list" => spec.blocks.push(listed(node)?),
            "latin-hypercube" => spec.blocks.push(latin_hypercube(node)?),
            "quantities" => spec.quantities = quantity::read(node)?,
            other => {
                return Err(TreeError {
                    origin: node.key.clone(),
                    message: format!("unknown key `{other}` in `sweep`"),
                    help: suggestion(other, &KEYS),
                });
            }
        }
    }
    check_overlaps(&spec.blocks)?;
    Ok(spec)
}

fn swept(entry: &Entry<'_>) -> SweptKey {
    SweptKey { path: entry.path.clone(), origin: entry.node.key.clone() }
}

fn refused(node: &TomlNode, message: String, help: &str) -> TreeError {
    TreeError { origin: node.origin.clone(), message, help: help.to_owned() }
}

fn table_of<'a>(
    path: &str,
    node: &'a TomlNode,
) -> Result<&'a BTreeMap<String, TomlNode>, TreeError> {
    node.table().ok_or_else(|| {
        let help =
            "write keys of the case with their values, such as \"fluid.viscosity\" = [1.0, 2.0]";
        refused(node, format!("`{path}` is not a table"), help)
    })
}

/// A table, or the tables of an array.
fn tables_of<'a>(path: &str, node: &'a TomlNode) -> Result<Vec<&'a TomlNode>, TreeError> {
    let tables = node.array().map_or_else(|| vec![node], |items| items.iter().collect());
    tables.iter().try_for_each(|table| table_of(path, table).map(drop))?;
    Ok(tables)
}

/// The values of a key: those of a list, or those of a range.
fn values(entry: &Entry<'_>) -> Result<Vec<TomlNode>, TreeError> {
    let Entry { path, node } = entry;
    if let Some(items) = node.array() {
        if items.is_empty() || items.len() > range::MOST_POINTS {
            let message = format!("`{path}` has {} values", items.len());
            let help = format!("a list has 1 to {} of them", range::MOST_POINTS);
            return Err(refused(node, message, &help));
        }
        return Ok(items.to_vec());
    }
    if !node.table().is_some_and(is_range) {
        let help = format!("write a list such as [1.0, 2.0], or a range; {EXAMPLE}");
        return Err(refused(node, format!("`{path}` has no values to sweep"), &help));
    }
    let CountedRange { range, n } = range::read(path, node)?;
    let n = n.ok_or_else(|| {
        refused(
            node,
            format!("the range of `{path}` has no `n`"),
            "add n = ..., how many values it has",
        )
    })?;
    Ok(range.values(n).into_iter().map(|value| written_like(node, value)).collect())
}

/// A value that follows from what is written in a place.
pub fn written_like(node: &TomlNode, value: TomlValue) -> TomlNode {
    TomlNode { key: node.key.clone(), origin: node.origin.clone(), value }
}

/// Keys whose first values go together, and their second ones, and so on.
fn zipped(group: &TomlNode) -> Result<Block, TreeError> {
    let entries = entries(table_of("sweep.zip", group)?, "")?;
    let columns: Vec<Vec<TomlNode>> = entries.iter().map(values).collect::<Result<_, _>>()?;
    let Some(n) = columns.first().map(Vec::len) else {
        return Err(refused(group, "nothing is zipped here".to_owned(), "name two keys at least"));
    };
    if let Some(other) = columns.iter().position(|column| column.len() != n) {
        let (first, entry) = (&entries[0].path, &entries[other]);
        let message = format!(
            "`{}` has {} values, but `{first}`, with which it goes, has {n}",
            entry.path,
            columns[other].len()
        );
        return Err(refused(entry.node, message, "give all keys of a zip equally many values"));
    }
    let row = |index: usize| columns.iter().map(|column| column[index].clone()).collect();
    Ok(Block { keys: entries.iter().map(swept).collect(), rows: (0..n).map(row).collect() })
}

/// Points that are given one by one.
fn listed(list: &TomlNode) -> Result<Block, TreeError> {
    let (mut keys, mut rows): (Vec<SweptKey>, _) = (Vec::new(), Vec::new());
    for point in tables_of("sweep.list", list)? {
        let mut entries = entries(table_of("sweep.list", point)?, "")?;
        if keys.is_empty() {
            keys = entries.iter().map(swept).collect();
        }
        let place = |path: &str| keys.iter().position(|key| key.path == path);
        if entries.len() != keys.len() || entries.iter().any(|one| place(&one.path).is_none()) {
            let names: Vec<&str> = keys.iter().map(|key| key.path.as_str()).collect();
            let help = format!("give every point of the list these keys: {}", names.join(", "));
            return Err(refused(point, "this point sets other keys than the first".into(), &help));
        }
        entries.sort_by_key(|entry| place(&entry.path));
        rows.push(entries.into_iter().map(|entry| entry.node.clone()).collect());
    }
    if keys.is_empty() {
        let help = "write { \"fluid.viscosity\" = 1.0 } for each point";
        return Err(refused(list, "`sweep.list` has no points".to_owned(), help));
    }
    Ok(Block { keys, rows })
}

/// Points at random in ranges.
fn latin_hypercube(node: &TomlNode) -> Result<Block, TreeError> {
    let mut table = table_of("sweep.latin-hypercube", node)?.clone();
    let n = table.remove("points").ok_or_else(|| {
        let message = "`sweep.latin-hypercube` does not say how many points it has".to_owned();
        refused(node, message, "add points = ... there")
    })?;
    let n = range::read_count(&n, 1)?;
    let seed = match table.remove("seed") {
        None => 0,
        Some(TomlNode { value: TomlValue::Integer(seed), .. }) if seed >= 0 => seed.unsigned_abs(),
        Some(other) => {
            let message = "this is no seed of numbers at random".to_owned();
            return Err(refused(&other, message, "write a whole number that is not negative"));
        }
    };
    let (mut keys, mut ranges, mut nodes) = (Vec::new(), Vec::new(), Vec::new());
    for entry in entries(&table, "")? {
        if !entry.node.table().is_some_and(is_range) {
            let message = format!("`{}` is no range, beside `points` and `seed`", entry.path);
            let help = "points at random lie in ranges { from = 1.0, to = 10.0 }, with scale = \"log\" if \
                        wanted";
            return Err(refused(entry.node, message, help));
        }
        let CountedRange { range, n } = range::read(&entry.path, entry.node)?;
        if n.is_some() {
            let message = format!("the range of `{}` has an `n`", entry.path);
            return Err(refused(
                entry.node,
                message,
                "leave it out: `points` says how many there are",
            ));
        }
        keys.push(swept(&entry));
        ranges.push(range);
        nodes.push(entry.node);
    }
    if keys.is_empty() {
        let help = "add a range such as \"fluid.viscosity\" = { from = 1.0, to = 10.0 }";
        return Err(refused(node, "`sweep.latin-hypercube` has no ranges".to_owned(), help));
    }
    let row = |values: Vec<f64>| {
        let values = nodes.iter().zip(values);
        values.map(|(node, value)| written_like(node, TomlValue::Float(value))).collect()
    };
    let rows = sample(&ranges, n, seed).into_iter().map(row).collect();
    Ok(Block { keys, rows })
}

/// Whether one of two paths is the other, or leads to what the other is in.
pub fn overlap(one: &str, other: &str) -> bool {
    let is_within = |inner: &str, outer: &str| {
        inner.strip_prefix(outer).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    };
    is_within(one, other) || is_within(other, one)
}

fn check_overlaps(blocks: &[Block]) -> Result<(), TreeError> {
    let mut before: Vec<&SweptKey> = Vec::new();
    for key in blocks.iter().flat_map(|block| &block.keys) {
        if let Some(other) = before.iter().find(|other| overlap(&other.path, &key.path)) {
            return Err(TreeError {
                origin: key.origin.clone(),
                message: format!("`{}` is swept twice, here and as `{}`", key.path, other.path),
                help: "let one of the two go; keys that change together go into one `zip`"
                    .to_owned(),
            });
        }
        before.push(key);
    }
    Ok(())
}
