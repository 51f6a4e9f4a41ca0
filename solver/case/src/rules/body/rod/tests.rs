//! Rods that are refused, and those that are not.

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
        // What bends from within may jump, by its rate as by its value
        "rod.bending = 1.0\nactivation.curvature.table = [[0.0, 2.0], [1.0, 1.0]]",
        "rod.bending = 1.0\nactivation = { moment.legs = { knots = [[0.0, 0.0], [0.5, 1.0]], period = 1.0 }, \
         wave_speed = 1.0 }",
    ] {
        assert_eq!(problems(&fish(lines), Severity::Error), Vec::<String>::new(), "{lines}");
    }
}

#[test]
fn of_two_keys_that_exclude_each_other_both_and_none_are_told_apart() {
    for (lines, wanted) in [
        ("rod = {}", "a rod has neither `bending` nor `young`"),
        ("rod = { bending = 1.0, young = 1.0 }", "a rod has both `bending` and `young`"),
        (
            "rod.bending = 1.0\nactivation = { moment.constant = 1.0, curvature.constant = 1.0 }",
            "an activation has both `curvature` and `moment`",
        ),
    ] {
        let file = Case::parse("t.toml", &case_with(&fish(lines)), &[]).unwrap();
        let found = check(&file).into_iter().find(|one| one.severity == Severity::Error).unwrap();
        assert_eq!(found.message, wanted);
        let verb =
            if wanted.contains("both") { "leave one of them out: " } else { "write one of them: " };
        assert!(found.help.starts_with(verb), "{}", found.help);
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
        (rod("attached.hold = { angle.table = [[0.0, 0.0], [1.0, 1.0]] }"), "attached.hold.angle"),
        (rod("activation = {}"), "activation"),
        (rod("activation = { moment.constant = 1.0, wave_speed = 0.0 }"), "activation.wave_speed"),
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
            rod("activation.moment.legs = { knots = [[0.5, 0.0]], period = 1.0, smooth = true }"),
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
    let force =
        |force: f64| format!("load.tip.force = [{{ constant = 0.0 }}, {{ constant = {force} }}]");
    let moment = |moment: f64| format!("load.tip.moment.constant = {moment}");
    for (load, hold, key) in [
        (moment(-90.0), "", Some("moment")),
        (moment(-1.0), "", None),
        (force(900.0), "\nattached.hold = 'clamped'", Some("force")),
        (force(1.0), "\nattached.hold = 'clamped'", None),
        (force(900.0), "\nattached.hold = 'hinged'", None),
    ] {
        let found =
            problems(&fish(&format!("rod = {{ bending = 1.0, {load} }}{hold}")), Severity::Warning);
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

/// A case in space with this body, and these lines behind it.
fn in_space(lines: &str, behind: &str) -> String {
    format!(
        "title = 't'
geometry = 'spatial'
fluid = {{ model = 'stokes', viscosity = 1.0 }}
domain.box = {{ min = [-2.0, -2.0, -2.0], max = [2.0, 2.0, 2.0] }}
boundary = {{ left = 'no-slip', right = 'do-nothing', bottom = 'no-slip', top = 'no-slip', back = 'no-slip', front = 'no-slip' }}
mesh = {{ size = 0.5, surface = 0.1 }}
time.unsteady = {{ step = 0.1, end = 1.0 }}
[[body]]
name = 'b'
center = [0.0, 0.0, 0.0]
shape.fish.length = 1.0
motion = 'free'
{lines}
{behind}
"
    )
}

/// A ball ahead of it.
fn sphere_at(x: f64) -> String {
    format!(
        "[[body]]\nname = 'c'\nshape.sphere.radius = 0.2\ncenter = [{x}, 0.0, 0.0]\nmotion = 'free'"
    )
}

#[test]
fn rods_in_space_bend_in_two_directions_and_twist() {
    for lines in [
        "rod.bending = 1.0\nattached = { to = 'c', hold = 'clamped' }",
        "rod = { bending = 1.0, load.base.moment = [{ constant = 1.0 }, { constant = 0.0 }, { constant = -1.0 }] }\n\
         attached = { to = 'c', hold = 'hinged' }",
        "rod = { bending = 1.0, twisting = 0.5, rest.turning = [-2.0, 0.0, 1.0] }",
        "rod = { young = 10.0, load.tip.force = [{ constant = 0.0 }, { constant = 0.0 }, { constant = 1.0 }] }\n\
         attached.hold = 'clamped'",
        "rod.bending = [[0.0, 1.0], [1.0, 0.5]]\nattached.hold = 'hinged'\n\
         activation = { wave_speed = 1.0, curvature.sine = { amplitude = 1.0, period = 1.0 }, \
         curvature_y.sine = { amplitude = 1.0, period = 1.0, phase = 0.25 } }",
    ] {
        let found = of_case(&in_space(lines, &sphere_at(0.9)), Severity::Error);
        assert_eq!(found, Vec::<String>::new(), "{lines}");
    }
}

/// What is not made in space, and what is not of the plane.
#[test]
fn what_rods_in_space_cannot_do_is_refused_at_its_key() {
    let (near, far) = (sphere_at(0.9), sphere_at(1.5));
    let contact = "[contact.quadratic]\nrange = 0.01\nepsilon = 1e-6";
    for (lines, behind, key) in [
        (
            "rod.bending = 1.0\nattached = { to = 'c', hold = 'clamped' }",
            far.as_str(),
            "body.0.attached.to",
        ),
        (
            "rod.bending = 1.0\nattached = { to = 'c', hold.angle.constant = 0.1 }",
            near.as_str(),
            "body.0.attached.hold",
        ),
        ("rod.bending = 1.0", contact, "contact"),
        (
            "rod = { bending = 1.0, load.tip.moment.constant = 1.0 }",
            "",
            "body.0.rod.load.tip.moment",
        ),
        (
            "rod = { bending = 1.0, load.tip.moment = [{ constant = 1.0 }, { constant = 1.0 }] }",
            "",
            "body.0.rod.load.tip.moment",
        ),
        (
            "rod = { bending = 1.0, load.base.moment = [{ constant = 1.0 }, { constant = 1.0 }, { constant = 1.0 }] }\n\
             attached = { to = 'c', hold = 'clamped' }",
            near.as_str(),
            "body.0.rod.load.base.moment",
        ),
        (
            "rod = { bending = 1.0, load.tip.force = [{ constant = 1.0 }, { constant = 1.0 }] }",
            "",
            "body.0.rod.load.tip.force",
        ),
        ("rod = { bending = 1.0, rest.turning = [0.0, 0.0, 60.0] }", "", "body.0.rod.rest.turning"),
        ("rod = { bending = 1.0, rest.turning = [0.0, 9.0, 0.0] }", "", "body.0.rod.rest.turning"),
        (
            "rod = { bending = 1.0, twisting = [[0.0, -1.0], [1.0, 1.0]] }",
            "",
            "body.0.rod.twisting.0.1",
        ),
    ] {
        assert_eq!(of_case(&in_space(lines, behind), Severity::Error), [key], "{lines}");
    }
    for (lines, key) in [
        ("rod = { bending = 1.0, twisting = 1.0 }", "rod.twisting"),
        ("rod = { bending = 1.0, rest.turning = [0.0, 0.0, 1.0] }", "rod.rest"),
        ("rod.bending = 1.0\nactivation.moment_y.constant = 1.0", "activation.moment_y"),
        ("rod = { bending = 1.0, load.tip.moment = [{ constant = 1.0 }] }", "rod.load.tip.moment"),
    ] {
        assert_eq!(problems(&fish(lines), Severity::Error), [format!("body.1.{key}")], "{lines}");
    }
}

/// A case with this rod across a periodic domain of length 1.02.
fn sheet(rod: &str, more: &str) -> String {
    let body = format!("{}\nrod = {{ bending = 1.0, periodic = true{rod} }}\n{more}", fish(""));
    case_with(&body)
        .replace("'no-slip', right = 'do-nothing'", "{ periodic = 'right' }")
        .replace("min = [-4.0, -4.0], max = [4.0, 4.0]", "min = [-0.51, -4.0], max = [0.51, 4.0]")
        .replace("center = [2.0, 2.0]", "center = [0.0, 2.0]")
        .replace("radius = 0.5", "radius = 0.2")
}

#[test]
fn sheets_without_ends_go_from_head_to_tail_across_a_period() {
    let errors = |text: &str| of_case(text, Severity::Error);
    let soft = ", stretching = 1.0";
    assert_eq!(errors(&sheet(soft, "")), Vec::<String>::new());
    for (text, key) in [
        (sheet("", ""), "body.1.rod"),
        (sheet(soft, "angle = 1.5707963267948966"), "body.1.rod.periodic"),
        (sheet(soft, "attached.hold = 'clamped'"), "body.1.attached"),
        (sheet(soft, "[contact.barrier]\nrange = 0.1\nstiffness = 1.0"), "contact"),
        (sheet(", stretching = 1.0, rest.curvature = 0.1", ""), "body.1.rod.rest"),
        (sheet(soft, "").replace("0.51", "0.49"), "body.1.rod.periodic"),
        (sheet(soft, "").replace("0.51", "0.6"), "body.1.rod.periodic"),
    ] {
        let found = errors(&text);
        assert!(found.contains(&key.to_owned()), "{key}: {found:?}\n{text}");
    }
}

#[test]
fn waves_of_muscles_that_do_not_fit_a_sheet_without_ends_are_warned_about() {
    let with = |active: &str| {
        let text = sheet(", stretching = 1.0", &format!("activation = {{ {active} }}"));
        assert_eq!(of_case(&text, Severity::Error), Vec::<String>::new(), "{text}");
        let found = of_case(&text, Severity::Warning).into_iter();
        found.filter(|key| key.contains("activation")).collect::<Vec<String>>()
    };
    const SINE: &str = "moment.sine = { amplitude = 0.1, period = 0.5, ramp = 0.2 }";
    for (speed, fits) in [(2.04, true), (-1.02, true), (0.68, true), (2.0, false), (-1.5, false)] {
        let wanted = if fits { vec![] } else { vec!["body.1.activation.wave_speed".to_owned()] };
        assert_eq!(with(&format!("{SINE}, wave_speed = {speed}")), wanted, "{speed}");
    }
    assert_eq!(with(SINE), Vec::<String>::new());
    let ends = |last: f64| with(&format!("{SINE}, envelope = [[0.0, 1.0], [1.0, {last}]]"));
    assert_eq!(ends(1.0), Vec::<String>::new());
    assert_eq!(ends(0.5), ["body.1.activation.envelope"]);
    let stepwise = "moment.table = [[0.0, 0.0], [1.0, 1.0]], wave_speed = 1.02";
    assert_eq!(with(stepwise), ["body.1.activation.wave_speed"]);
}
