//! Problems of `body.rod`, `attached` and `activation`: rods of no body, that fold, or that are held nowhere.

use super::{attached, beside_rod};
use crate::rules::Findings;
use crate::{Activation, AlongBody, Body, Hold, RestShape, RodSpec, Stroke};

/// A table may end behind the tail by this part of the length: that of a fish is that up to where its sides would meet.
const BEHIND: f64 = 0.1;

/// Half width over the radius of curvature at rest above which a rod is no slender one.
const BENT: f64 = 0.5;

pub fn check(findings: &mut Findings<'_>, key: &str, body: &Body) {
    let Some(rod) = &body.rod else {
        without_rod(findings, key, body);
        return;
    };
    let name = &body.name;
    let Some(profile) = body.shape.profile() else {
        // Lengths that make no body are refused already
        if !["fish", "flagellate", "tube"].contains(&body.shape.name()) {
            findings.error(
                &format!("{key}.rod"),
                format!("\"{name}\" is of shape `{}`, which has no midline", body.shape.name()),
                "give it the shape of a fish or a flagellate, or leave `rod` out",
            );
        }
        return;
    };
    let body_of = Slender {
        length: profile.length(),
        half_width: profile.stations().iter().map(|at| at.half_width).fold(0.0, f64::max),
    };
    beside_rod::check(findings, key, body);
    stiffness(findings, &format!("{key}.rod"), rod, body_of);
    rest(findings, &format!("{key}.rod.rest"), rod, body_of);
    if let Some(attached) = &body.attached {
        attached::check(findings, &format!("{key}.attached"), body, attached, body_of.length);
        if let Hold::Angle(angle) = &attached.hold {
            has_rate(findings, &format!("{key}.attached.hold.angle"), angle);
        }
    }
    if let Some(active) = &body.activation {
        activation(findings, &format!("{key}.activation"), active, body_of);
    }
}

/// Lengths of a slender body (m).
#[derive(Clone, Copy)]
struct Slender {
    length: f64,
    half_width: f64,
}

fn without_rod(findings: &mut Findings<'_>, key: &str, body: &Body) {
    for (name, is_given) in
        [("attached", body.attached.is_some()), ("activation", body.activation.is_some())]
    {
        if is_given {
            findings.error(
                &format!("{key}.{name}"),
                format!("`{name}` is of a rod, and \"{}\" is none", body.name),
                &format!("write rod = {{ bending = ... }}, or leave `{name}` out"),
            );
        }
    }
}

fn stiffness(findings: &mut Findings<'_>, key: &str, rod: &RodSpec, body: Slender) {
    if rod.bending.is_some() == rod.young.is_some() {
        findings.error(
            key,
            "a rod needs either `bending` or `young`".to_owned(),
            "write bending = ... (N m2; N m planar), or young = ... (Pa)",
        );
    }
    let Some(AlongBody::Table(rows)) = &rod.bending else { return };
    let key = format!("{key}.bending");
    rises_along(findings, &key, rows, body);
    if let Some(nth) = rows.iter().position(|row| row[1] <= 0.0) {
        findings.error(
            &format!("{key}.{nth}.1"),
            format!("the stiffness at {} is {}, but must be positive", rows[nth][0], rows[nth][1]),
            "write [[distance from the head, stiffness], ...] with stiffnesses above 0",
        );
    }
}

/// Distances of a table rise from row to row, and lie on the body.
fn rises_along(findings: &mut Findings<'_>, key: &str, rows: &[[f64; 2]], body: Slender) {
    let does_rise = rows.windows(2).all(|pair| pair[1][0] > pair[0][0]);
    let is_inside = rows.iter().all(|row| (0.0..=body.length * (1.0 + BEHIND)).contains(&row[0]));
    if rows.is_empty() || !does_rise || !is_inside {
        findings.error(
            key,
            format!(
                "the table has no distances that rise from the head to the tail at {}",
                body.length
            ),
            "write [[distance from the head, value], ...] with distances from 0 to the length",
        );
    }
}

fn rest(findings: &mut Findings<'_>, key: &str, rod: &RodSpec, body: Slender) {
    let Some(rest) = &rod.rest else { return };
    let key = match rest {
        RestShape::Curvature(_) => format!("{key}.curvature"),
        RestShape::Table(rows) => {
            let key = format!("{key}.table");
            rises_along(findings, &key, rows, body);
            key
        }
    };
    too_sharp(findings, &key, rest.sharpest(), body, "at rest");
}

/// A rod must not be thicker than it is bent.
fn too_sharp(findings: &mut Findings<'_>, key: &str, curvature: f64, body: Slender, when: &str) {
    let part = curvature * body.half_width;
    if part >= 1.0 {
        findings.error(
            key,
            format!(
                "{when} the radius of curvature is {}, and half of the thickness {}: the body would \
                 fold",
                1.0 / curvature,
                body.half_width
            ),
            &format!("write a curvature well below {}", 1.0 / body.half_width),
        );
    } else if part > BENT {
        findings.warning(
            key,
            format!(
                "{when} the radius of curvature is {} only, and half of the thickness {}: that is no \
                 slender body",
                1.0 / curvature,
                body.half_width
            ),
            &format!("write a curvature below {}, or make the body thinner", BENT / body.half_width),
        );
    }
}

/// Rates that jump would need infinite loads of a body with mass.
fn has_rate(findings: &mut Findings<'_>, key: &str, stroke: &Stroke) {
    let name = match stroke {
        Stroke::Table(_) => "a `table`",
        Stroke::Legs { smooth: false, .. } => "`legs` of straight lines",
        _ => return,
    };
    findings.error(
        key,
        format!("the rate of {name} jumps, and a rod cannot follow that"),
        "write a `sine`, a `file`, or `legs` with smooth = true",
    );
}

fn activation(findings: &mut Findings<'_>, key: &str, active: &Activation, body: Slender) {
    if active.curvature.is_some() == active.moment.is_some() {
        findings.error(
            key,
            "an activation is either a `curvature` or a `moment`".to_owned(),
            "write curvature = ... (1/m), or moment = ... (N m; N planar)",
        );
    }
    if !active.envelope.is_empty() {
        rises_along(findings, &format!("{key}.envelope"), &active.envelope, body);
    }
    if let Some(curvature) = &active.curvature {
        let key = format!("{key}.curvature");
        has_rate(findings, &key, curvature);
        let factor = active.envelope.iter().map(|row| row[1].abs()).fold(0.0, f64::max);
        let factor = if active.envelope.is_empty() { 1.0 } else { factor };
        if let Stroke::Sine { mean, amplitude, .. } = curvature {
            let sharpest = factor * (mean.abs() + amplitude.abs());
            too_sharp(findings, &key, sharpest, body, "at its sharpest");
        } else if let Stroke::Constant(value) = curvature {
            too_sharp(findings, &key, factor * value.abs(), body, "at its sharpest");
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{Case, Severity, check};

    /// A case with this body.
    fn case_with(body: &str) -> String {
        format!(
            "title = 't'
geometry = 'planar'
fluid = {{ model = 'stokes', viscosity = 1.0 }}
domain.box = {{ min = [-4.0, -4.0], max = [4.0, 4.0] }}
boundary = {{ left = 'no-slip', right = 'do-nothing', bottom = 'no-slip', top = 'no-slip' }}
mesh = {{ size = 0.5, surface = 0.02 }}
time.unsteady = {{ step = 0.1, end = 1.0 }}
[[body]]
name = 'wall'
shape.disc.radius = 0.5
center = [2.0, 2.0]
motion = 'held'
[[body]]
name = 'b'
{body}
"
        )
    }

    /// Keys of the problems of a case with this body.
    fn problems(body: &str, severity: Severity) -> Vec<String> {
        of_case(&case_with(body), severity)
    }

    /// Keys of the problems of a case.
    fn of_case(text: &str, severity: Severity) -> Vec<String> {
        let file = Case::parse("t.toml", text, &[]).unwrap_or_else(|error| panic!("{error}"));
        let problems = check(&file).into_iter();
        problems.filter(|p| p.severity == severity).map(|p| p.key).collect()
    }

    /// A fish with these lines.
    fn fish(lines: &str) -> String {
        let center = if lines.starts_with("center") { "" } else { "center = [0, 0]\n" };
        format!("{center}shape.fish.length = 1.0\nmotion = 'free'\n{lines}")
    }

    #[test]
    fn rods_of_all_kinds_have_no_errors() {
        for lines in [
            "rod = { bending = 1 }",
            "rod = { young = 1e3, damping = 0.1, elements = 30, stretching = 1e6 }",
            "rod = { bending = [[0.0, 1.0], [1.0, 0.1]], rest.curvature = 2.0 }",
            "rod = { bending = 1.0, rest.table = [[0.0, 1.0], [1.0, -1.0]] }\n\
             attached.hold = 'clamped'",
            "rod.bending = 1.0\nattached.hold = { angle = { sine = { amplitude = '20 deg', period = 1.0 } } }",
            "center = [0.9, 2.0]\nrod.bending = 1.0\nattached = { to = 'wall', hold = 'hinged' }",
            "rod.bending = 1.0\nactivation = { moment = { sine = { amplitude = 0.1, period = 1.0 } }, \
             wave_speed = 1.0, envelope = [[0.0, 0.0], [1.0, 1.0]] }",
            "rod.bending = 1.0\nactivation.curvature.constant = 2.0",
        ] {
            assert_eq!(problems(&fish(lines), Severity::Error), Vec::<String>::new(), "{lines}");
        }
    }

    #[test]
    fn what_makes_no_rod_is_refused_at_its_key() {
        let rod = |lines: &str| fish(&format!("rod.bending = 1.0\n{lines}"));
        let cases = [
            (fish("rod = {}"), "rod"),
            (fish("rod = { bending = 1.0, young = 1.0 }"), "rod"),
            (fish("rod = { bending = -1.0 }"), "rod.bending"),
            (fish("rod = { bending = [[0.0, 1.0], [1.0, -1.0]] }"), "rod.bending.1.1"),
            (fish("rod = { bending = [[0.5, 1.0], [0.2, 1.0]] }"), "rod.bending"),
            (fish("rod = { bending = [[0.0, 1.0], [2.0, 1.0]] }"), "rod.bending"),
            (fish("rod = { bending = 1.0, elements = 1 }"), "rod.elements"),
            (fish("rod = { bending = 1.0, damping = -1.0 }"), "rod.damping"),
            (fish("rod = { bending = 1.0, rest.curvature = 30.0 }"), "rod.rest.curvature"),
            (fish("rod = { bending = 1.0, rest.table = [] }"), "rod.rest.table"),
            (rod("gait.carangiform.period = 1.0"), "gait"),
            (rod("locked = ['x']"), "locked"),
            (rod("torque = 1.0"), "torque"),
            (rod("magnetic_moment = [1.0, 0.0]"), "magnetic_moment"),
            (rod("load_frame = 'body'"), "load_frame"),
            (rod("spring = { torsion = 1.0 }"), "spring"),
            (rod("attached = { to = 'nobody', hold = 'clamped' }"), "attached.to"),
            (rod("attached = { to = 'b', hold = 'clamped' }"), "attached.to"),
            (rod("attached = { to = 'wall', hold = 'clamped' }"), "attached.to"),
            (rod("attached = { to = 'wall', hold.angle.constant = 1.0 }"), "attached.hold"),
            (
                rod("attached.hold = { angle.table = [[0.0, 0.0], [1.0, 1.0]] }"),
                "attached.hold.angle",
            ),
            (rod("activation = {}"), "activation"),
            (
                rod("activation = { moment.constant = 1.0, wave_speed = 0.0 }"),
                "activation.wave_speed",
            ),
            (
                rod("activation = { moment.constant = 1.0, envelope = [[1.0, 1.0], [0.0, 1.0]] }"),
                "activation.envelope",
            ),
            (rod("activation.curvature.constant = 40.0"), "activation.curvature"),
            (fish("attached.hold = 'clamped'"), "attached"),
            (fish("activation.moment.constant = 1.0"), "activation"),
            (
                "center = [0, 0]\nshape.disc.radius = 0.5\nmotion = 'free'\nrod.bending = 1.0"
                    .to_owned(),
                "rod",
            ),
            (
                "center = [0, 0]\nshape.fish.length = 1.0\nmotion = 'held'\nrod.bending = 1.0"
                    .to_owned(),
                "motion",
            ),
        ];
        for (body, key) in cases {
            assert_eq!(problems(&body, Severity::Error), [format!("body.1.{key}")], "{body}");
        }
    }

    /// What the run would refuse as it is built.
    #[test]
    fn what_rods_cannot_be_beside_is_refused_at_its_key() {
        const SIDES: &str =
            "left = 'no-slip', right = 'do-nothing', bottom = 'no-slip', top = 'no-slip'";
        const CELL: &str = "left = { periodic = 'right' }, right = { periodic = 'left' }, \
                            bottom = 'symmetry', top = 'symmetry'";
        let rod = fish("rod.bending = 1.0");
        let whole = case_with(&rod);
        let joint = "[[joint]]\nparent = 'wall'\nchild = 'c'\nkind.bent.angle = 0.0\n[[body]]\n\
                     name = 'c'\nshape.disc.radius = 0.5\ncenter = [0.0, -2.0]\nmotion = 'free'";
        let changed = |from: &str, to: &str| {
            assert!(whole.contains(from), "{from}");
            whole.replace(from, to)
        };
        let cell = changed(SIDES, CELL);
        for (text, key) in [
            (format!("{whole}[contact.quadratic]\nrange = 0.1\nepsilon = 1e-3\n"), "contact"),
            (format!("{whole}{joint}\n"), "body.1.rod"),
            (changed("step = 0.1,", "step = 0.1, scheme = 'rk3',"), "time.unsteady.scheme"),
            (changed("'planar'", "'axisymmetric'"), "body.1.rod"),
            (cell.replace("motion = 'held'", "motion = 'free'"), "body.1.rod"),
        ] {
            let found = of_case(&text, Severity::Error);
            assert!(found.contains(&key.to_owned()), "{found:?} of {text}");
        }
        // The other body holds the fluid
        assert!(!of_case(&cell, Severity::Error).contains(&"body.1.rod".to_owned()));
    }

    #[test]
    fn a_rod_that_is_bent_by_half_its_thickness_is_warned_about() {
        let bent = fish("rod = { bending = 1.0, rest.curvature = 16.0 }");
        assert_eq!(problems(&bent, Severity::Warning), ["body.1.rod.rest.curvature"]);
    }
}
