//! Problems of `body.gait`, and of the shapes that swim by it.

use std::f64::consts::TAU;

use super::joints::stroke;
use super::midline;
use super::skin::has_rate;
use super::slip;
use crate::read::schema::{alternatives, fitting, whole};
use crate::rules::flow::boundary::check_factor;
use crate::rules::{Findings, OneOf};
use crate::{
    AnguilliformGait, Body, CarangiformGait, FlagellumGait, GaitSpec, Geometry, PulsatingGait,
    ShapeSpec, SquirmerGait, Stroke, TimeSettings,
};

/// Lengths of a fish or a flagellate.
pub fn check_shape(findings: &mut Findings<'_>, key: &str, shape: &ShapeSpec) {
    // Lengths that are not positive are refused already
    if !findings.is_right(key) || shape.profile().is_some() {
        return;
    }
    match shape {
        ShapeSpec::Fish(fish) if fish.head_end > fish.head_width => findings.error(
            &format!("{key}.fish.head_end"),
            format!(
                "the head ends at {} of the length, behind its widest section at {}",
                fish.head_end, fish.head_width
            ),
            "head_end must not be larger than head_width, the radius of the head",
        ),
        ShapeSpec::Fish(_) => findings.error(
            &format!("{key}.fish"),
            "these lengths make no fish".to_owned(),
            "head_end < tail_start < 1, tail_width less than the width of the head, and tip_radius \
             and corner_radius much smaller than both",
        ),
        ShapeSpec::Flagellate(body) if body.thickness >= 2.0 * body.head[1] => findings.error(
            &format!("{key}.flagellate.thickness"),
            format!(
                "the tail is {} thick, and the head {} only",
                body.thickness,
                2.0 * body.head[1]
            ),
            "make the tail thinner than the head",
        ),
        ShapeSpec::Flagellate(_) => findings.error(
            &format!("{key}.flagellate"),
            "these lengths make no flagellate".to_owned(),
            "make the tail longer than its thickness and its fillet, or the fillet smaller",
        ),
        _ => {}
    }
}

/// Names of the shapes that can move by a gait in a geometry; of all others where there are none.
fn possible_shapes(gait: &GaitSpec, geometry: Geometry) -> Vec<&'static str> {
    let known = alternatives(&whole()["$defs"]["ShapeSpec"]);
    let fitting = fitting(known, geometry);
    let all = gait.shapes();
    let possible: Vec<&str> = all.iter().copied().filter(|name| fitting.contains(name)).collect();
    if possible.is_empty() { all.to_vec() } else { possible }
}

/// Whether a gait fits its body, and its numbers make a motion.
pub fn check(findings: &mut Findings<'_>, key: &str, body: &Body) {
    let Some(gait) = &body.gait else { return };
    if body.deforms() && matches!(findings.case().time, TimeSettings::Steady(_)) {
        findings.error(
            &format!("{key}.gait"),
            format!("body \"{}\" deforms, and a steady flow has no time for it", body.name),
            "write time.unsteady = { step = ..., end = ... }",
        );
    }
    if !gait.shapes().contains(&body.shape.name()) {
        let wanted = possible_shapes(gait, findings.case().geometry).join(" or ");
        findings.error(
            &format!("{key}.gait"),
            format!(
                "this gait is that of a {wanted}, but \"{}\" is of shape `{}`",
                body.name,
                body.shape.name()
            ),
            &format!("give the body the shape of a {wanted}, or another gait"),
        );
    }
    let key = format!("{key}.gait");
    match gait {
        GaitSpec::Squirmer(gait) => squirmer(findings, &format!("{key}.squirmer"), body, gait),
        GaitSpec::Slip(gait) => slip::check(findings, &format!("{key}.slip"), body, gait),
        GaitSpec::Carangiform(gait) => carangiform(findings, &format!("{key}.carangiform"), gait),
        GaitSpec::Anguilliform(gait) => {
            anguilliform(findings, &format!("{key}.anguilliform"), gait);
        }
        GaitSpec::Flagellum(gait) => flagellum(findings, &format!("{key}.flagellum"), body, gait),
        GaitSpec::Midline(gait) => midline::check(findings, &format!("{key}.midline"), gait),
        GaitSpec::Pulsating(gait) => pulsating(findings, &format!("{key}.pulsating"), gait),
        // The joints it is made from are checked
        GaitSpec::Joints(_) => {}
    }
}

fn carangiform(findings: &mut Findings<'_>, key: &str, gait: &CarangiformGait) {
    stroke_of_midline(findings, key, "beat", gait.beat.as_ref());
    stroke_of_midline(findings, key, "bend", gait.bend.as_ref());
    let positions: Vec<f64> = gait.curvature.iter().map(|row| row[0]).collect();
    let does_rise = positions.windows(2).all(|pair| pair[1] > pair[0]);
    if positions.len() < 2
        || !does_rise
        || positions[0] != 0.0
        || positions[positions.len() - 1] != 1.0
    {
        findings.error(
            &format!("{key}.curvature"),
            format!("the curvature is given at s/L = {positions:?}, not from head to tail"),
            "write [[0.0, K L], ..., [1.0, K L]] with rising positions, or leave it out",
        );
    }
}

/// A stroke of a midline has numbers that make one, and a rate that does not jump.
fn stroke_of_midline(findings: &mut Findings<'_>, key: &str, name: &str, given: Option<&Stroke>) {
    let Some(given) = given else { return };
    let key = format!("{key}.{name}");
    stroke(findings, &key, given);
    has_rate(findings, &key, given);
}

fn anguilliform(findings: &mut Findings<'_>, key: &str, gait: &AnguilliformGait) {
    // Slope at the tail: the displacement may not grow faster than the midline is long
    let slope = gait.amplitude * (TAU * (1.0 + gait.offset)).hypot(1.0);
    if slope >= 1.0 {
        findings.error(
            &format!("{key}.amplitude"),
            format!(
                "the tail would be displaced by {slope:.3} per length of midline, which it cannot \
                 be without being stretched"
            ),
            &format!("write an amplitude below {:.4}", gait.amplitude / slope),
        );
    }
}

fn flagellum(findings: &mut Findings<'_>, key: &str, body: &Body, gait: &FlagellumGait) {
    let Some(joint) = gait.joint else { return };
    if let ShapeSpec::Flagellate(flagellate) = &body.shape
        && joint > flagellate.tail_length
    {
        findings.error(
            &format!("{key}.joint"),
            format!("the joint is {joint} long, and the tail {}", flagellate.tail_length),
            "make it a small part of the tail, or leave it out",
        );
    }
}

fn pulsating(findings: &mut Findings<'_>, key: &str, gait: &PulsatingGait) {
    let of = OneOf {
        what: "a pulsating body",
        names: ["amplitude", "table"],
        given: [gait.amplitude.is_some(), !gait.table.is_empty()],
        help: "amplitude = ... goes with period = ..., table is [[0.0, 1.0], [time, ratio], ...]",
    };
    if !findings.one_of(key, &of) {
        return;
    }
    if gait.amplitude.is_some() {
        if gait.period.is_none() {
            findings.error(
                &format!("{key}.amplitude"),
                "the amplitude has no `period`".to_owned(),
                "write period = ...",
            );
        }
        return;
    }
    let does_rise = gait.table.windows(2).all(|rows| rows[1][0] > rows[0][0]);
    let does_start = gait.table.first().is_some_and(|row| row[0] == 0.0);
    if !does_rise || !does_start || gait.table.iter().any(|row| row[1] <= 0.0) {
        findings.error(
            &format!("{key}.table"),
            "the table is not one of positive ratios at times that rise from 0".to_owned(),
            "write [[0.0, ratio], [time, ratio], ...] with rising times and ratios above 0",
        );
    }
    let last = gait.table.last().copied().unwrap_or_default();
    if let Some(period) = gait.period
        && (period < last[0] || last[1] != gait.table[0][1])
    {
        findings.error(
            &format!("{key}.period"),
            format!(
                "the table ends at t = {} with the ratio {}, and begins again at t = {period} with \
                 {}",
                last[0], last[1], gait.table[0][1]
            ),
            "let it end with the ratio it begins with, at the period or before",
        );
    }
}

fn squirmer(findings: &mut Findings<'_>, key: &str, body: &Body, squirmer: &SquirmerGait) {
    resolved_modes(findings, key, body, squirmer);
    let n_modes = squirmer.modes.len();
    for (mode, factor) in &squirmer.factors {
        let factor_key = format!("{key}.factors.{mode}");
        // "02" would be another key for the same mode.
        if !(1..=n_modes).any(|number| number.to_string() == *mode) {
            findings.error(
                &factor_key,
                format!(
                    "the squirmer \"{}\" has {n_modes} mode{}, and none is `{mode}`",
                    body.name,
                    if n_modes == 1 { "" } else { "s" }
                ),
                "name factors by the number of their mode: factors = { 1 = ..., 2 = ... }",
            );
        }
        check_factor(findings, &factor_key, factor);
    }
    if let Some(turn) = &squirmer.turn {
        check_factor(findings, &format!("{key}.turn"), turn);
    }
}

/// Modes whose waves are shorter than the edges on the body.
fn resolved_modes(findings: &mut Findings<'_>, key: &str, body: &Body, squirmer: &SquirmerGait) {
    let mesh = &findings.case().mesh;
    let size = body.size.or(mesh.surface).unwrap_or(mesh.size) * mesh.scale;
    // Mode n has n half waves from pole to pole of a sphere, n waves around a disc
    let half_waves = match body.shape {
        ShapeSpec::Sphere { .. } => 1.0,
        _ => 2.0,
    };
    let most = body.shape.perimeter() / size / half_waves;
    let highest = squirmer.modes.iter().rposition(|mode| *mode != 0.0).map_or(0, |last| last + 1);
    if highest as f64 > most.max(2.0) {
        findings.warning(
            &format!("{key}.modes"),
            format!(
                "mode {highest} of \"{}\" is not resolved: half a wave of it is shorter than an edge",
                body.name
            ),
            &format!("leave out modes above {most:.0}, or lower the edge length on the body"),
        );
    }
}

#[cfg(test)]
mod tests {
    use crate::{Case, Severity, check};

    /// Keys of the errors of a case with this body.
    fn errors(body: &str) -> Vec<String> {
        let text = format!(
            "title = 't'
geometry = 'planar'
fluid = {{ model = 'stokes', viscosity = 1.0 }}
domain.box = {{ min = [-4.0, -4.0], max = [4.0, 4.0] }}
boundary = {{ left = 'no-slip', right = 'do-nothing', bottom = 'no-slip', top = 'no-slip' }}
mesh = {{ size = 0.5, surface = 0.01 }}
time.unsteady = {{ step = 0.1, end = 1.0 }}
[[body]]
name = 'b'
center = [0, 0]
motion = 'free'
{body}
"
        );
        let file = Case::parse("t.toml", &text, &[]).unwrap();
        let problems = check(&file).into_iter();
        problems.filter(|p| p.severity == Severity::Error).map(|p| p.key).collect()
    }

    #[test]
    fn swimmers_as_published_have_no_errors() {
        for body in [
            "shape.fish.length = 1.0\ngait.carangiform.period = 1.0",
            "shape.fish.length = 1.0\ngait.anguilliform.period = 1.0",
            "shape.flagellate = { head = [0.2, 0.1], tail_length = 5.0, thickness = 0.02 }\n\
             gait.flagellum = { period = 0.3, wavelength = 2.0, amplitude = 0.4 }",
            "shape.disc.radius = 1.0\ngait.pulsating = { amplitude = 0.5, period = 1.0 }",
            "shape.disc.radius = 1.0\ngait.pulsating.table = [[0.0, 1.0], [1.0, 2.0]]",
        ] {
            assert_eq!(errors(body), Vec::<String>::new(), "{body}");
        }
    }

    #[test]
    fn what_cannot_swim_is_refused_at_its_key() {
        let fish = |gait: &str| format!("shape.fish.length = 1.0\n{gait}");
        let disc = |gait: &str| format!("shape.disc.radius = 1.0\n{gait}");
        let tail = |numbers: &str| {
            format!("shape.flagellate = {{ head = [0.2, 0.1], tail_length = 5.0, {numbers} }}")
        };
        let cases = [
            (fish("shape.fish.head_end = 0.05"), "body.0.shape.fish.head_end"),
            (fish("shape.fish.tail_width = 0.1"), "body.0.shape.fish"),
            (fish("shape.fish.height = 0.1"), "body.0.shape.fish.height"),
            (tail("thickness = 0.3"), "body.0.shape.flagellate.thickness"),
            (tail("thickness = 0.02, fillet = 900.0"), "body.0.shape.flagellate"),
            (disc("gait.carangiform.period = 1.0"), "body.0.gait"),
            (fish("gait.pulsating = { amplitude = 0.5, period = 1.0 }"), "body.0.gait"),
            (fish("gait.carangiform.period = 0.0"), "body.0.gait.carangiform.period"),
            (
                fish("gait.carangiform = { period = 1.0, curvature = [[0.0, 1.0], [0.5, 1.0]] }"),
                "body.0.gait.carangiform.curvature",
            ),
            (
                fish("gait.anguilliform = { period = 1.0, amplitude = 0.3 }"),
                "body.0.gait.anguilliform.amplitude",
            ),
            (disc("gait.pulsating.period = 1.0"), "body.0.gait.pulsating"),
            (disc("gait.pulsating.amplitude = 0.5"), "body.0.gait.pulsating.amplitude"),
            (disc("gait.pulsating.table = [[1.0, 1.0]]"), "body.0.gait.pulsating.table"),
        ];
        for (body, key) in cases {
            assert_eq!(errors(&body), [key], "{body}");
        }
    }
}
