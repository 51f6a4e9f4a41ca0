//! Probes on a line: a `probe` with a `line` becomes a probe for each of its places.

use crate::text::tree::{TomlNode, TomlValue, TreeError};

/// How a line is written.
const WANTED: &str =
    "write line = { from = [x, y], to = [x, y], count = 9 }, with a number for each dimension";

/// Most probes of a line.
const MOST: i64 = 10_000;

/// Puts probes `NAME-1`, `NAME-2`, ... in the place of those on lines, both ends included.
///
/// # Errors
/// When a line is not understood, or there is a `point` beside it.
pub fn resolve(root: &mut TomlNode) -> Result<(), TreeError> {
    let Some(probes) = root.table_mut().and_then(|entries| entries.get_mut("probe")) else {
        return Ok(());
    };
    let TomlValue::Array(probes) = &mut probes.value else { return Ok(()) };
    let mut all = Vec::with_capacity(probes.len());
    for probe in std::mem::take(probes) {
        match probe.get("line").cloned() {
            None => all.push(probe),
            Some(line) => all.extend(on_line(&probe, &line)?),
        }
    }
    *probes = all;
    Ok(())
}

/// The probes of a line.
fn on_line(probe: &TomlNode, line: &TomlNode) -> Result<Vec<TomlNode>, TreeError> {
    let refused = |node: &TomlNode, message: String| TreeError {
        origin: node.origin.clone(),
        message,
        help: WANTED.to_owned(),
    };
    if let Some(point) = probe.get("point") {
        return Err(refused(point, "the probe has both `point` and `line`".to_owned()));
    }
    let unknown = line
        .table()
        .into_iter()
        .flatten()
        .find(|(key, _)| !["from", "to", "count"].contains(&key.as_str()));
    if let Some((key, node)) = unknown {
        return Err(refused(node, format!("unknown key `{key}` in the `line` of a probe")));
    }
    let end = |key: &str| {
        let missing = || refused(line, format!("the `line` of a probe has no point `{key}`"));
        let node = line.get(key).ok_or_else(missing)?;
        numbers(node).ok_or_else(|| refused(node, format!("`{key}` is no point")))
    };
    let (from, to) = (end("from")?, end("to")?);
    if from.len() != to.len() {
        return Err(refused(line, "`from` and `to` have different dimensions".to_owned()));
    }
    let count = match line.get("count").map(|node| &node.value) {
        Some(TomlValue::Integer(count)) if (2..=MOST).contains(count) => *count,
        _ => {
            let message = format!("`count` of the line is no number of points from 2 to {MOST}");
            return Err(refused(line.get("count").unwrap_or(line), message));
        }
    };
    let name = probe.get("name").and_then(TomlNode::text).unwrap_or_default().to_owned();
    let node = |value| TomlNode { key: line.key.clone(), origin: line.origin.clone(), value };
    let made = (0..count).map(|nth| {
        let part = nth as f64 / (count - 1) as f64;
        let along = from.iter().zip(&to).map(|(from, to)| from + (to - from) * part);
        let point = along.map(|x| node(TomlValue::Float(x))).collect();
        let mut one = probe.clone();
        if let Some(entries) = one.table_mut() {
            entries.remove("line");
            entries.insert("point".to_owned(), node(TomlValue::Array(point)));
            if let Some(own) = entries.get_mut("name").filter(|own| own.text().is_some()) {
                own.value = TomlValue::String(format!("{name}-{}", nth + 1));
            }
        }
        one
    });
    Ok(made.collect())
}

/// The numbers of a list; `None` of another value.
fn numbers(node: &TomlNode) -> Option<Vec<f64>> {
    let TomlValue::Array(items) = &node.value else { return None };
    let number = |item: &TomlNode| match item.value {
        TomlValue::Float(value) => Some(value),
        TomlValue::Integer(value) => Some(value as f64),
        _ => None,
    };
    items.iter().map(number).collect()
}

#[cfg(test)]
mod tests {
    use crate::{Case, check};

    const CASE: &str = r#"
title = "t"
geometry = "planar"
fluid = { model = "stokes", viscosity = 1.0 }
domain.channel = { length = 2.0, height = 1.0 }
mesh.size = 0.5
time.steady = {}
boundary = { left.parabolic.peak = 1.0, right = "do-nothing", bottom = "no-slip", top = "no-slip" }
"#;

    fn read(probe: &str) -> Result<Case, String> {
        let setting =
            format!("probe=[{{ name = 'a', point = [0.1, 0.1] }}, {{ name = 'p', {probe} }}]");
        let file = Case::parse("t.toml", CASE, &[setting]).map_err(|error| error.to_string())?;
        match check(&file).first() {
            None => Ok(file.model.case),
            Some(found) => Err(format!("{} {}", found.key, found.message)),
        }
    }

    #[test]
    fn a_line_is_a_probe_for_each_place() {
        let case = read("line = { from = [1, 0.0], to = [1.5, 1.0], count = 3 }").unwrap();
        let all: Vec<_> = case.probe.iter().map(|p| (p.name.as_str(), p.point.clone())).collect();
        let wanted = [
            ("a", vec![0.1, 0.1]),
            ("p-1", vec![1.0, 0.0]),
            ("p-2", vec![1.25, 0.5]),
            ("p-3", vec![1.5, 1.0]),
        ];
        assert_eq!(all, wanted);
        for (wrong, words) in [
            ("line = { from = [1, 0], to = [1, 1] }", "`count` of the line"),
            ("line = { from = [1, 0], to = [1, 1], count = 1 }", "`count` of the line"),
            ("line = { from = [1, 0], count = 3 }", "no point `to`"),
            ("line = { from = [1, 0], to = ['a', 1], count = 3 }", "`to` is no point"),
            ("line = { from = [1, 0], to = [1, 1, 1], count = 3 }", "different dimensions"),
            ("line = { from = [1, 0], to = [1, 1], n = 3 }", "unknown key `n`"),
            ("line = { from = [1, 0], to = [1, 1], count = 3 }, point = [1, 0]", "both"),
            ("line = { from = [1, 0], to = [1, 2], count = 3 }", "outside the domain"),
            ("minus = [1.0, 0.5]", "point"),
        ] {
            let found = read(wrong).expect_err(wrong);
            assert!(found.contains(words), "{wrong}: {found}");
        }
    }
}
