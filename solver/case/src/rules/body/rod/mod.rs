//! Problems of `body.rod`, `attached` and `activation`: rods of no body, that fold, or that are held nowhere.

mod activation;
mod attached;
pub mod bent;
pub(in crate::rules) mod beside;
mod end_load;
mod slender;

use self::slender::{Slender, rises_along, too_sharp};
use alewife_mesh::whole;

use crate::rules::Findings;
use crate::{AlongBody, Body, Hold, RestShape, RodSpec};

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
    beside::check(findings, key, body);
    stiffness(findings, &format!("{key}.rod"), rod, body_of);
    rest(findings, &format!("{key}.rod.rest"), rod, body_of);
    end_load::check(findings, &format!("{key}.rod.load"), body);
    if let Some(attached) = &body.attached {
        attached::check(findings, &format!("{key}.attached"), body, attached, body_of.length);
        if let Hold::Angle(angle) = &attached.hold {
            activation::stroke(findings, &format!("{key}.attached.hold.angle"), angle);
        }
    }
    if let Some(active) = &body.activation {
        activation::check(findings, &format!("{key}.activation"), active, body_of);
    }
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
    if rest.sharpest() * body.half_width < 1.0
        && let Some([from, to]) = crossing(rest, body)
    {
        findings.error(
            &key,
            format!("at rest the body meets itself, {from} and {to} from its head"),
            "write smaller curvatures: over the length they turn it too far round",
        );
    }
}

/// Distances from the head (m) of two points of a body that are on each other at rest, if there are any.
fn crossing(rest: &RestShape, body: Slender) -> Option<[f64; 2]> {
    const POINTS: u32 = 256;
    let step = body.length / f64::from(POINTS);
    let (mut places, mut place, mut angle) = (vec![[0.0_f64; 2]], [0.0, 0.0], 0.0_f64);
    for nth in 0..POINTS {
        let curvature = rest.at((f64::from(nth) + 0.5) * step);
        let (sin, cos) = (angle + 0.5 * curvature * step).sin_cos();
        place = [place[0] + cos * step, place[1] + sin * step];
        angle += curvature * step;
        places.push(place);
    }
    // Nearer ones are neighbours
    let apart = whole((4.0 * body.half_width / step).ceil());
    let meets = |one: &[f64; 2], other: &[f64; 2]| {
        (one[0] - other[0]).hypot(one[1] - other[1]) < 2.0 * body.half_width
    };
    places.iter().enumerate().find_map(|(first, one)| {
        let later = places.iter().enumerate().skip(first + apart);
        let (second, _) = later.into_iter().find(|(_, other)| meets(one, other))?;
        Some([first as f64 * step, second as f64 * step])
    })
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
            "rod = { bending = 1.0, rest.curvature = -5.0 }",
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
            (fish("rod = { bending = 1.0, rest.curvature = 7.0 }"), "rod.rest.curvature"),
            (
                fish("rod = { bending = 1.0, rest.table = [[0.0, 10.0], [1.0, 10.0]] }"),
                "rod.rest.table",
            ),
            (fish("rod = { bending = 1.0, elements = 100000 }"), "rod.elements"),
            (fish("rod = { bending = 1.0, load = {} }"), "rod.load"),
            (fish("rod = { bending = 1.0, load.tip = {} }"), "rod.load.tip"),
            (
                fish("rod = { bending = 1.0, load.tip.force = [{ constant = 1.0 }] }"),
                "rod.load.tip.force",
            ),
            (
                fish(
                    "rod = { bending = 1.0, load.tip.moment.sine = { amplitude = 1.0, period = -1.0 } }",
                ),
                "rod.load.tip.moment.sine.period",
            ),
            (
                fish(
                    "rod = { bending = 1.0, load.base.moment.constant = 1.0 }\nattached.hold = 'clamped'",
                ),
                "rod.load.base.moment",
            ),
            (
                fish(
                    "rod = { bending = 1.0, load.base.force = [{ constant = 1.0 }, { constant = 0.0 }] }\nattached.hold = 'hinged'",
                ),
                "rod.load.base.force",
            ),
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
            (
                rod("activation.curvature.command = { filter = 0.5 }"),
                "activation.curvature.command.limits",
            ),
            (
                rod("activation = { wave_speed = -1.0, moment.command = { filter = 0.5 } }"),
                "activation.wave_speed",
            ),
            (
                rod(
                    "activation = { wave_speed = 1.0, moment.cubic = [[0.0, 0.0, 0.0], [2.0, 1.0, 0.0]] }",
                ),
                "activation.moment.cubic",
            ),
            (
                rod(
                    "activation.moment.legs = { knots = [[0.5, 0.0]], period = 1.0, smooth = true }",
                ),
                "activation.moment.legs.knots",
            ),
            (
                rod(
                    "attached.hold.angle.command = { start = 2.0, limits = [-1.0, 1.0], filter = 0.5 }",
                ),
                "attached.hold.angle.command.start",
            ),
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

    #[test]
    fn loads_that_bend_a_rod_too_sharply_are_warned_about() {
        let force = |force: f64| {
            format!("load.tip.force = [{{ constant = 0.0 }}, {{ constant = {force} }}]")
        };
        let moment = |moment: f64| format!("load.tip.moment.constant = {moment}");
        for (load, hold, key) in [
            (moment(-90.0), "", Some("moment")),
            (moment(-1.0), "", None),
            (force(900.0), "\nattached.hold = 'clamped'", Some("force")),
            (force(1.0), "\nattached.hold = 'clamped'", None),
            (force(900.0), "\nattached.hold = 'hinged'", None),
        ] {
            let found = problems(
                &fish(&format!("rod = {{ bending = 1.0, {load} }}{hold}")),
                Severity::Warning,
            );
            let wanted = key.map(|key| format!("body.1.rod.load.tip.{key}"));
            let own: Vec<String> = found.into_iter().filter(|key| key.contains("load")).collect();
            assert_eq!(own, Vec::from_iter(wanted), "{load}{hold}");
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
            (format!("{whole}{joint}\n"), "body.1.rod"),
            (changed("step = 0.1,", "step = 0.1, scheme = 'rk3',"), "time.unsteady.scheme"),
            (changed("'planar'", "'axisymmetric'"), "body.1.rod"),
            (cell.replace("motion = 'held'", "motion = 'free'"), "body.1.rod"),
        ] {
            let found = of_case(&text, Severity::Error);
            assert!(found.contains(&key.to_owned()), "{found:?} of {text}");
        }
        let touching = format!("{whole}[contact.quadratic]\nrange = 0.01\nepsilon = 1e-6\n");
        assert_eq!(of_case(&touching, Severity::Error), Vec::<String>::new());
        // The other body holds the fluid
        assert!(!of_case(&cell, Severity::Error).contains(&"body.1.rod".to_owned()));
    }

    #[test]
    fn a_rod_that_is_bent_by_half_its_thickness_is_warned_about() {
        let bent = fish("rod = { bending = 1.0, rest.curvature = 16.0 }");
        assert_eq!(problems(&bent, Severity::Warning), ["body.1.rod.rest.curvature"]);
    }
}
