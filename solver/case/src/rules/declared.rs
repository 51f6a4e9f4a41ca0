//! What the schema declares of single keys: ranges of numbers, lengths of lists, and geometries.
//!
//! It is derived from the types in `spec`: a range is written at its field, and nowhere else.

use serde_json::{Map, Value};

use super::Findings;
use crate::read::schema::{alternatives, fits, fitting, referred, whole};

/// What to write in other geometries, by the ends of keys that have no meaning there.
const INSTEAD: [(&str, &str); 15] = [
    (".orientation", "write angle = ... (rad)"),
    (".angle", "write orientation = { turned = { axis = [x, y, z], angle = ... } }"),
    (".rest_orientation", "write rest_angle = ... (rad)"),
    (".rest_angle", "write rest_orientation = { turned = { axis = [x, y, z], angle = ... } }"),
    (".squirmer.axis", "write heading = ... (rad)"),
    (".heading", "write gait.squirmer.axis = [x, y, z], or turn the body"),
    (".turn", "write gait.squirmer.axis = [x, y, z], or turn the body"),
    (".star.along", "write directions = [...] (rad)"),
    (".along", "write direction = ... (rad)"),
    (".direction", "write along = [x, y, z], in the frame of the parent"),
    (".hinge.axis", "leave it out: the axis is z"),
    (".bent.axis", "leave it out: the axis is z"),
    (
        ".rotating.axis",
        "leave it out: the axis is z; write clockwise = true for the other way round",
    ),
    (".clockwise", "turn the axis round for the other way"),
    (".skin", "leave it out for separate links"),
];

/// Every value of the case, but for those of variants, against what is declared of its key.
pub fn check(findings: &mut Findings<'_>) {
    let mut case = serde_json::to_value(findings.case()).unwrap_or_default();
    if let Value::Object(keys) = &mut case {
        keys.remove("variant");
    }
    visit(findings, "", &case, whole());
}

/// A value, at its key, and all within it.
fn visit(findings: &mut Findings<'_>, key: &str, value: &Value, declared: &Value) {
    match value {
        Value::Number(number) => range(findings, key, number.as_f64().unwrap_or(0.0), declared),
        Value::Array(items) => list(findings, key, items, declared),
        Value::Object(entries) => table(findings, key, entries, declared),
        _ => {}
    }
    if let Some(declared) = referred(declared) {
        visit(findings, key, value, declared);
    }
    for one in alternatives(declared) {
        visit(findings, key, value, one);
    }
    if let Some(name) = value.as_object().and_then(|entries| entries.keys().next()) {
        alternative(findings, key, name, alternatives(declared));
    }
}

/// A number is in its range.
fn range(findings: &mut Findings<'_>, key: &str, value: f64, declared: &Value) {
    let bound = |name: &str| declared[name].as_f64();
    let (above, from) = (bound("exclusiveMinimum"), bound("minimum"));
    let (below, to) = (bound("exclusiveMaximum"), bound("maximum"));
    let wanted = match (above, from, below, to) {
        (Some(0.0), ..) if value <= 0.0 => "be positive".to_owned(),
        (Some(above), ..) if value <= above => format!("be larger than {above}"),
        (_, Some(0.0), ..) if value < 0.0 => "not be negative".to_owned(),
        (_, Some(from), ..) if value < from => format!("be {from} or more"),
        (_, _, Some(below), _) if value >= below => format!("be less than {below}"),
        (_, _, _, Some(to)) if value > to => format!("not be more than {to}"),
        _ if declared["not"]["const"].as_f64() == Some(value) => "not be 0".to_owned(),
        _ => return,
    };
    let mut help = match (above, from, below, to) {
        (Some(above), _, Some(below), _) => format!("write a number between {above} and {below}"),
        (_, Some(from), _, Some(to)) => format!("write a number from {from} to {to}"),
        (Some(above), ..) => format!("write a number larger than {above}"),
        (_, Some(0.0), ..) => "write 0 or a larger number".to_owned(),
        (_, Some(from), ..) => format!("write {from} or more"),
        _ => format!("write another number: {}", meaning(declared)),
    };
    if let Some(usual) = declared["default"].as_f64() {
        help += &format!("; {usual} is usual");
    }
    findings.error(key, format!("`{key}` is {value}, but must {wanted}"), &help);
}

/// A list is as long as it has to be, and a direction points somewhere.
fn list(findings: &mut Findings<'_>, key: &str, items: &[Value], declared: &Value) {
    let least = declared["minItems"].as_u64().unwrap_or(0);
    if declared["perDimension"] == true {
        per_dimension(findings, key, items.len());
    } else if (items.len() as u64) < least {
        findings.error(
            key,
            format!("`{key}` has {} of the {least} entries it needs at least", items.len()),
            &format!("give {least} or more: {}", meaning(declared)),
        );
    }
    if declared["not"]["const"].is_array() && items.iter().all(|part| part.as_f64() == Some(0.0)) {
        findings.error(
            key,
            format!("`{key}` is zero and points nowhere"),
            "write a direction such as [1.0, 0.0, 0.0]",
        );
    }
    for (index, item) in items.iter().enumerate() {
        visit(findings, &format!("{key}.{index}"), item, &declared["items"]);
    }
}

/// A vector has a number for each dimension.
fn per_dimension(findings: &mut Findings<'_>, key: &str, n: usize) {
    let dimensions = findings.case().geometry.dimensions();
    if n != dimensions {
        let plural = if n == 1 { "" } else { "s" };
        findings.error(
            key,
            format!("`{key}` has {n} number{plural}, but this case has {dimensions} dimensions"),
            if dimensions == 3 {
                "write [x, y, z]"
            } else {
                "write [x, y]; in axisymmetric cases x is along the axis and y the distance from it"
            },
        );
    }
}

/// The keys of a table stand in a case of this geometry, or have no effect.
fn table(findings: &mut Findings<'_>, key: &str, entries: &Map<String, Value>, declared: &Value) {
    let geometry = findings.case().geometry;
    for (name, value) in entries {
        let key = if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
        let property = &declared["properties"][name];
        if property.is_null() {
            visit(findings, &key, value, &declared["additionalProperties"]);
            continue;
        }
        if !fits(property, geometry) && *value != property["default"] {
            let instead = INSTEAD.iter().find(|(end, _)| key.ends_with(end));
            let instead = instead.map_or("leave it out", |(_, instead)| instead);
            let other = property["geometries"][0].as_str().unwrap_or_default();
            findings.error(
                &key,
                format!("`{key}` has no meaning in {} case", with_article(geometry.name())),
                &format!("{instead}, or take geometry = \"{other}\""),
            );
        }
        visit(findings, &key, value, property);
    }
}

/// An alternative stands in a case of this geometry.
fn alternative(findings: &mut Findings<'_>, key: &str, name: &str, all: &[Value]) {
    let geometry = findings.case().geometry;
    let given = all.iter().find(|one| !one["properties"][name].is_null());
    if given.is_none_or(|given| fits(given, geometry)) {
        return;
    }
    let what = key.rsplit('.').find(|step| step.parse::<usize>().is_err()).unwrap_or(key);
    findings.error(
        key,
        format!("{} cannot stand in {} case", with_article(name), with_article(geometry.name())),
        &format!("{} {what}s: {}", geometry.name(), fitting(all, geometry).join(", ")),
    );
}

/// A word with the article before it.
fn with_article(word: &str) -> String {
    let article = if word.starts_with(['a', 'e', 'i', 'o']) { "an" } else { "a" };
    format!("{article} {word}")
}

/// What a key means, on one line.
fn meaning(declared: &Value) -> String {
    let text = declared["description"].as_str().unwrap_or_default();
    text.trim_end().trim_end_matches('.').split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use crate::read::schema::{alternatives, whole};
    use crate::{Case, check};

    /// Key, message and remedy of the only problem of a disc in a box with these settings.
    fn only(settings: &[&str]) -> [String; 3] {
        let text = "title = 't'
geometry = 'planar'
fluid = { model = 'stokes', viscosity = 1.0 }
domain.box = { min = [-4.0, -4.0], max = [4.0, 4.0] }
boundary = { left = 'no-slip', right = 'no-slip', bottom = 'no-slip', top = 'no-slip' }
mesh = { size = 0.3 }
time.unsteady = { step = 0.1, end = 1.0 }
body = [{ name = 'b', shape.disc.radius = 1.0, center = [0.0, 0.0], motion = 'free' }]
";
        let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
        let mut found = check(&Case::parse("t.toml", text, &settings).unwrap());
        assert_eq!(found.len(), 1, "{settings:?}: {found:?}");
        let one = found.remove(0);
        [one.key, one.message, one.help]
    }

    #[test]
    fn a_value_out_of_its_range_is_refused_with_the_range_and_what_is_usual() {
        let steps = "time.unsteady.adaptive.gap=";
        let sphere = "body.0.shape={ spline = { points = [[1, 0], [0, 1]] } }";
        for (setting, key, message, help) in [
            (
                "mesh.scale=0",
                "mesh.scale",
                "is 0, but must be positive",
                "larger than 0; 1 is usual",
            ),
            ("mesh.sides={ top = -1 }", "mesh.sides.top", "must be positive", "larger than 0"),
            (
                "fluid.density=-2",
                "fluid.density",
                "is -2, but must not be negative",
                "write 0 or a larger",
            ),
            (
                "mesh.growth=1.5",
                "mesh.growth",
                "is 1.5, but must not be more than 1",
                "write a number from 0 to 1; 0.2 is usual",
            ),
            (
                &format!("{steps}0"),
                "time.unsteady.adaptive.gap",
                "must be positive",
                "write a number between 0 and 1; 0.3 is usual",
            ),
            (
                &format!("{steps}1"),
                "time.unsteady.adaptive.gap",
                "must be less than 1",
                "between 0 and 1",
            ),
            (
                "output.series.steps=0",
                "output.series.steps",
                "is 0, but must be 1 or more",
                "write 1 or more",
            ),
            (
                sphere,
                "body.0.shape.spline.points",
                "has 2 of the 3 entries",
                "give 3 or more: Points",
            ),
            (
                "body.0.shape={ sphere = { radius = 1 } }",
                "body.0.shape",
                "a sphere cannot",
                "planar shapes: disc",
            ),
            (
                "body.0.orientation={ along = [1, 0, 0] }",
                "body.0.orientation",
                "`body.0.orientation` has no meaning in a planar case",
                "write angle = ... (rad), or take geometry = \"spatial\"",
            ),
        ] {
            let [found_key, found_message, found_help] = only(&[setting]);
            assert_eq!(found_key, key);
            assert!(found_message.contains(message), "{setting}: {found_message}");
            assert!(found_help.contains(help), "{setting}: {found_help}");
        }
    }

    /// All schemas within a schema, itself included.
    fn all_within<'a>(schema: &'a Value, found: &mut Vec<&'a Value>) {
        found.push(schema);
        for table in ["properties", "$defs"] {
            for one in schema[table].as_object().into_iter().flatten() {
                all_within(one.1, found);
            }
        }
        alternatives(schema).iter().for_each(|one| all_within(one, found));
    }

    #[test]
    fn what_is_declared_can_be_met() {
        let mut all = Vec::new();
        all_within(whole(), &mut all);
        let (mut n_ranges, mut n_geometries) = (0, 0);
        for schema in all {
            if let (Some(default), Some(least)) =
                (schema["default"].as_f64(), schema["exclusiveMinimum"].as_f64())
            {
                n_ranges += 1;
                assert!(default > least, "{schema}");
            }
            for geometry in schema["geometries"].as_array().into_iter().flatten() {
                n_geometries += 1;
                assert!(
                    ["planar", "axisymmetric", "spatial"].contains(&geometry.as_str().unwrap())
                );
            }
        }
        // Otherwise they are not where they are looked for
        assert!(n_ranges > 10 && n_geometries > 50, "{n_ranges}, {n_geometries}");
    }
}
