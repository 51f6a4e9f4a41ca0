//! Problems of `[[scalar]]`: how much it diffuses, where it is given, and what determines its level.

use crate::rules::Findings;
use crate::rules::body::bodies::check_word;
use crate::rules::expressions::check_one;
use crate::text::type_error::suggestion;
use crate::{BoundaryCondition, Motion, ScalarCondition, ScalarSpec, TimeSettings};

/// Names of the other fields of a file.
const FIELDS: [&str; 4] = ["velocity", "pressure", "vorticity", "speed"];

pub fn check(findings: &mut Findings<'_>) {
    let case = findings.case();
    for (index, scalar) in case.scalar.iter().enumerate() {
        let key = format!("scalar.{index}");
        check_word(findings, &format!("{key}.name"), &scalar.name);
        let mut others = case.scalar[..index].iter();
        if others.any(|other| other.name == scalar.name) || FIELDS.contains(&scalar.name.as_str()) {
            findings.error(
                &format!("{key}.name"),
                format!("the name \"{}\" is that of another field", scalar.name),
                "give every scalar a name of its own; velocity, pressure, vorticity and speed are taken",
            );
        }
        check_diffusivity(findings, &key, scalar);
        check_places(findings, &key, scalar);
        for one in case.scalar_expressions(index) {
            check_one(findings, &one);
        }
        check_steady(findings, &key, scalar);
    }
}

/// One number says how much it diffuses.
fn check_diffusivity(findings: &mut Findings<'_>, key: &str, scalar: &ScalarSpec) {
    match (scalar.diffusivity, scalar.peclet) {
        (None, None) => findings.error(
            key,
            format!("nothing says how much \"{}\" diffuses", scalar.name),
            "write diffusivity = (m2/s), or peclet = beside [scales]",
        ),
        (Some(_), Some(_)) => findings.error(
            &format!("{key}.peclet"),
            format!("\"{}\" has both `diffusivity` and `peclet`", scalar.name),
            "give one of them",
        ),
        _ => {}
    }
    if findings.case().scales.is_some() {
        return;
    }
    for (name, is_given) in
        [("peclet", scalar.peclet.is_some()), ("difference", scalar.difference.is_some())]
    {
        if is_given {
            findings.error(
                &format!("{key}.{name}"),
                format!("`{name}` needs a length and a velocity, and there are no [scales]"),
                "write [scales] with length and velocity, or give `diffusivity` and leave this out",
            );
        }
    }
}

/// Sides and bodies exist, and sides are not joined to others.
fn check_places(findings: &mut Findings<'_>, key: &str, scalar: &ScalarSpec) {
    let case = findings.case();
    let sides = case.sides();
    for side in scalar.boundary.keys() {
        let place = format!("{key}.boundary.{side}");
        if !sides.contains(&side.as_str()) {
            findings.error(
                &place,
                format!("the domain has no side \"{side}\""),
                &format!("{}; its sides are {}", suggestion(side, &sides), sides.join(", ")),
            );
        } else if is_joined(findings, side) {
            findings.error(
                &place,
                format!("\"{side}\" is periodic, or the axis: nothing holds on it"),
                "leave it out",
            );
        }
    }
    let model = findings.model();
    let bodies: Vec<&str> = model.bodies.iter().map(|body| body.name.as_str()).collect();
    for body in scalar.body.keys() {
        if !bodies.contains(&body.as_str()) {
            findings.error(
                &format!("{key}.body.{body}"),
                format!("no body is called \"{body}\""),
                &format!("{}; bodies are: {}", suggestion(body, &bodies), bodies.join(", ")),
            );
        }
    }
}

fn is_joined(findings: &Findings<'_>, side: &str) -> bool {
    let own = findings.case().boundary.get(side);
    let is_other_end = findings.case().boundary.values().any(
        |other| matches!(other, BoundaryCondition::Periodic(partner) if partner.as_str() == side),
    );
    let is_joined = matches!(own, Some(BoundaryCondition::Periodic(_) | BoundaryCondition::Axis));
    is_joined || is_other_end || side == "axis"
}

/// A steady solution has a level, and bodies that stay in its mesh.
fn check_steady(findings: &mut Findings<'_>, key: &str, scalar: &ScalarSpec) {
    if !matches!(findings.case().time, TimeSettings::Steady(_)) {
        return;
    }
    let mut conditions = scalar.boundary.values().chain(scalar.body.values());
    if !conditions.any(ScalarCondition::fixes_level) {
        findings.error(
            key,
            format!("nothing determines the level of \"{}\" in a steady solution", scalar.name),
            "give a `value` or an `uptake` on a side or a body, or write [time.unsteady]",
        );
    }
    let model = findings.model();
    let frame = findings.case().frame.as_deref();
    let moving = model
        .bodies
        .iter()
        .find(|body| body.motion != Motion::Held && frame != Some(body.name.as_str()));
    if let Some(body) = moving {
        let message = format!(
            "the body \"{}\" moves, so that \"{}\" is not steady around it",
            body.name, scalar.name
        );
        let remedy = format!(
            "write frame = \"{}\", hold it in a stream, or write [time.unsteady]",
            body.name
        );
        findings.error(key, message, &remedy);
    }
}

#[cfg(test)]
mod tests {
    use crate::{Case, check};

    const CASE: &str = r#"
title = "t"
geometry = "planar"
fluid = { model = "stokes", viscosity = 1.0 }
domain.channel = { length = 2.0, height = 1.0 }
mesh.size = 0.05
time.steady = {}
boundary = { left.parabolic.peak = 1.0, right = "do-nothing", bottom = "no-slip", top = "no-slip" }
body = [{ name = "b", shape.disc.radius = 0.1, center = [1.0, 0.5], motion = "held" }]
"#;

    fn first(scalar: &str, more: &[&str]) -> Option<String> {
        let mut settings = vec![format!("scalar=[{{ name = 'c', {scalar} }}]")];
        settings.extend(more.iter().map(|&text| text.to_owned()));
        let file = Case::parse("t.toml", CASE, &settings).unwrap_or_else(|e| panic!("{e}"));
        check(&file).first().map(|found| format!("{} {} {}", found.key, found.message, found.help))
    }

    #[test]
    fn what_is_wrong_with_scalars_is_told() {
        let scales = "scales={ length = 1.0, velocity = 1.0 }";
        let unsteady = "time={ unsteady = { step = 0.1, end = 1.0 } }";
        for (right, more) in [
            ("diffusivity = 0.1, boundary.left.value = 1.0", &[][..]),
            ("diffusivity = 0.1, body.b.value = '1 + y'", &[]),
            ("diffusivity = 0.1, body.b.uptake = { rate = 1.0 }, source = 'x'", &[]),
            ("peclet = 10, boundary.left.value = 0, difference = -1", &[scales]),
            ("diffusivity = 0.1, initial = 'x*y'", &[unsteady]),
        ] {
            assert_eq!(first(right, more), None, "{right}");
        }
        let moving =
            "body=[{ name = 'b', shape.disc.radius = 0.1, center = [1.0, 0.5], motion = 'free' }]";
        for (wrong, more, words) in [
            ("boundary.left.value = 1", &[][..], "scalar.0 nothing says how much"),
            ("diffusivity = -1, boundary.left.value = 1", &[], "scalar.0.diffusivity"),
            ("diffusivity = 0.0, boundary.left.value = 1", &[], "scalar.0.diffusivity"),
            ("peclet = 1, boundary.left.value = 1", &[], "scalar.0.peclet `peclet` needs"),
            ("peclet = 1, diffusivity = 1, boundary.left.value = 1", &[scales], "both"),
            ("diffusivity = 1, boundary.lefft.value = 1", &[], "no side \"lefft\""),
            ("diffusivity = 1, body.c.value = 1", &[], "no body is called \"c\""),
            ("diffusivity = 1", &[], "nothing determines the level"),
            ("diffusivity = 1, boundary.left.flux = 1", &[], "nothing determines the level"),
            ("diffusivity = 1, boundary.left.value = 'q'", &[], "left.value \"q\" at character 1"),
            ("diffusivity = 1, boundary.left.value = 1, source = '1/'", &[], "scalar.0.source"),
            ("diffusivity = 1, body.b.uptake.rate = -1", &[], "uptake.rate"),
            ("diffusivity = 1, boundary.left.value = 1", &[moving], "the body \"b\" moves"),
            ("diffusivity = 1, boundary.left.value = 1, difference = 0", &[scales], "difference"),
        ] {
            let found = first(wrong, more).unwrap_or_else(|| panic!("{wrong} is accepted"));
            assert!(found.contains(words), "{wrong}: {found}");
        }
        let twice = "scalar=[{ name = 'c', diffusivity = 1, body.b.value = 1 }, { name = 'c', diffusivity = 1, body.b.value = 1 }]";
        let file = Case::parse("t.toml", CASE, &[twice.to_owned()]).unwrap();
        assert!(check(&file)[0].message.contains("another field"), "{:?}", check(&file)[0]);
    }
}
