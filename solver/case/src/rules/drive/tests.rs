//! What drives a case and what does not, in all geometries.

use super::at_rest;
use crate::{Case, check, library};

/// Whether there is a warning that nothing drives a case: in a geometry, with a condition on its left side.
fn is_at_rest(geometry: &str, left: &str, lines: &str) -> bool {
    let (domain, sides) = match geometry {
        "planar" => ("box = { min = [-9.0, -9.0], max = [9.0, 9.0] }", "bottom = W, top = W"),
        "axisymmetric" => ("cylinder = { x = [-9.0, 9.0], radius = 9.0 }", "wall = W"),
        _ => (
            "box = { min = [-9.0, -9.0, -9.0], max = [9.0, 9.0, 9.0] }",
            "bottom = W, top = W, back = W, front = W",
        ),
    };
    let sides = sides.replace('W', "'no-slip'");
    let text = format!(
        "
title = 'at rest'
geometry = '{geometry}'
domain.{domain}
mesh = {{ size = 2.0, surface = 0.2 }}
time.unsteady = {{ step = 0.1, end = 1.0 }}
boundary = {{ left = {left}, right = 'do-nothing', {sides} }}
{lines}
"
    );
    let file = Case::parse("t.toml", &text, &[]).unwrap();
    let found = check(&file);
    let has_error = found.iter().any(|one| one.severity == crate::Severity::Error);
    assert!(!has_error, "{found:#?}\n{text}");
    at_rest(&file).is_some()
}

const FLUID: &str =
    "fluid = { model = 'navier-stokes', viscosity = 1.0, density = 1.0, gravity = G }";

/// A round body of the geometry with lines of its own, after a fluid with gravity or none.
fn body(geometry: &str, gravity: bool, lines: &str) -> bool {
    let (gravity, shape, center) = match (geometry, gravity) {
        ("planar", true) => ("[0.0, -1.0]", "disc", "[0.0, 0.0]"),
        ("planar", false) => ("[0.0, 0.0]", "disc", "[0.0, 0.0]"),
        ("axisymmetric", true) => ("[-1.0, 0.0]", "sphere", "[0.0, 0.0]"),
        ("axisymmetric", false) => ("[0.0, 0.0]", "sphere", "[0.0, 0.0]"),
        (_, true) => ("[0.0, 0.0, -1.0]", "sphere", "[0.0, 0.0, 0.0]"),
        (_, false) => ("[0.0, 0.0, 0.0]", "sphere", "[0.0, 0.0, 0.0]"),
    };
    let fluid = FLUID.replace('G', gravity);
    let own = if lines.contains("motion") { "" } else { "motion = 'free'" };
    is_at_rest(
        geometry,
        "'no-slip'",
        &format!(
            "{fluid}\n[[body]]\nname = 'one'\nshape.{shape}.radius = 0.5\ncenter = {center}\n{own}\n{lines}"
        ),
    )
}

#[test]
fn what_drives_is_known_in_all_geometries() {
    for geometry in ["planar", "axisymmetric", "spatial"] {
        let zeros = if geometry == "spatial" { ", 0.0, 0.0" } else { ", 0.0" };
        let vector = |x: &str| format!("[{x}{zeros}]");
        let is_driven = |gravity: bool, lines: &str| !body(geometry, gravity, lines);
        // Neutrally buoyant, held, or locked where it would fall
        assert!(!is_driven(true, ""), "{geometry}");
        assert!(!is_driven(true, "density = 1.0"), "{geometry}");
        assert!(!is_driven(false, "density = 2.0"), "{geometry}");
        assert!(!is_driven(true, "density = 2.0\nmotion = 'held'"), "{geometry}");
        assert!(is_driven(true, "density = 2.0"), "{geometry}");
        let force = format!("force = {}", vector("0.1"));
        assert!(is_driven(false, &force), "{geometry}");
        assert!(!is_driven(false, &(force.clone() + "\nlocked = ['x']")), "{geometry}");
        let never =
            "\nload_factor.sine = { mean = 0.0, amplitude = 0.0, period = 1.0, phase = 0.0 }";
        assert!(!is_driven(false, &(force + never)), "{geometry}");
        let moved = |x: &str| format!("motion.imposed.velocity = {}", vector(x));
        assert!(is_driven(false, &moved("0.3")) && !is_driven(false, &moved("0.0")));
        let anchor = |x: &str| {
            format!("spring = {{ stiffness = {}, anchor = {} }}", vector("2.0"), vector(x))
        };
        assert!(is_driven(false, &anchor("0.2")) && !is_driven(false, &anchor("0.0")));
        let gait = |mode: &str, motion: &str| {
            format!("motion = '{motion}'\ngait.squirmer = {{ modes = [{mode}] }}")
        };
        for motion in ["free", "held"] {
            assert!(is_driven(false, &gait("1.0", motion)), "{geometry} {motion}");
            assert!(!is_driven(false, &gait("0.0", motion)), "{geometry} {motion}");
        }
        let slip = |x: &str| format!("gait.slip.velocity = {}", vector(x));
        assert!(is_driven(false, &slip("'x'")) && is_driven(false, &slip("1.0")), "{geometry}");
        assert!(!is_driven(false, &slip("0.0")), "{geometry}");
        let scalar = "\n[[scalar]]\nname = 'c'\ndiffusivity = 1.0\ninitial = 'x'";
        assert!(is_driven(false, scalar), "{geometry}: it diffuses");
        let side = |x: &str| {
            let left = format!("{{ velocity = {{ value = {} }} }}", vector(x));
            is_at_rest(geometry, &left, &FLUID.replace('G', &vector("0.0")))
        };
        assert!(!side("1.0") && side("0.0"), "{geometry}");
    }
}

#[test]
fn a_chain_is_driven_by_what_is_not_at_rest_in_it() {
    let chain = |hinge: &str, more: &str| {
        let fluid = FLUID.replace('G', "[0.0, -1.0]");
        is_at_rest(
            "planar",
            "'no-slip'",
            &format!(
                "{fluid}\n[[swimmer]]\nname = 'flapper'\n{more}\n[swimmer.kind.chain]\n\
                 links = [[0.5, 0.06], [0.5, 0.06]]\ngap = 0.1\njoints = [{hinge}]"
            ),
        )
    };
    assert!(chain("{ hinge = { stiffness = 1.0, damping = 0.05 } }", ""));
    assert!(chain("{ hinge = { stiffness = 1.0, rest = 0.3 } }", ""));
    assert!(!chain("{ hinge = { stiffness = 1.0, torque = { constant = 0.1 } } }", ""));
    assert!(!chain("{ hinge = { stiffness = 1.0 } }", "density = 2.0"));
    assert!(!chain("{ bent = { angle = { sine = { amplitude = 0.5, period = 1.0 } } } }", ""));
    assert!(chain("{ bent = { angle = { constant = 0.5 } } }", ""));
}

/// Two bodies with a joint, the second turned by an angle about the end of the first.
fn joint(geometry: &str, angle: f64, kind: &str) -> bool {
    let [x, y] = [0.5 + 0.5 * angle.cos(), 0.5 * angle.sin()];
    let (zero, shape, turned, ends) = match geometry {
        "spatial" => (
            ", 0.0",
            "sphere",
            format!("orientation = {{ turned = {{ axis = [0.0, 0.0, 1.0], angle = {angle} }} }}"),
            "on_parent = [0.5, 0.0, 0.0]\non_child = [-0.5, 0.0, 0.0]",
        ),
        _ => (
            "",
            "disc",
            format!("angle = {angle}"),
            "on_parent = [0.5, 0.0]\non_child = [-0.5, 0.0]",
        ),
    };
    let fluid = FLUID.replace('G', &format!("[0.0, -1.0{zero}]"));
    let body = |name: &str, x: f64, y: f64, turned: &str| {
        format!(
            "[[body]]\nname = '{name}'\nshape.{shape}.radius = 0.3\ncenter = [{x}, {y}{zero}]\n\
             motion = 'free'\n{turned}\n"
        )
    };
    let bodies = body("one", 0.0, 0.0, "") + &body("two", x, y, &turned);
    let joint = format!("[[joint]]\nparent = 'one'\nchild = 'two'\n{ends}\nkind.{kind}\n");
    is_at_rest(geometry, "'no-slip'", &format!("{fluid}\n{bodies}{joint}"))
}

#[test]
fn springs_of_joints_drive_unless_they_are_at_rest() {
    for (geometry, axis, along) in
        [("planar", "", ""), ("spatial", ", axis = [0.0, 0.0, 2.0]", ", along = [3.0, 0.0, 0.0]")]
    {
        for (angle, rest, is_rest) in
            [(0.0, 0.0, true), (0.2, 0.2, true), (0.2, 0.0, false), (0.0, 0.3, false)]
        {
            let hinge = format!("hinge = {{ stiffness = 1.0, rest = {rest}{axis} }}");
            assert_eq!(joint(geometry, angle, &hinge), is_rest, "{geometry} {angle} {rest}");
        }
        for (rest, is_rest) in [(0.0, true), (0.1, false)] {
            let slider = format!("slider = {{ stiffness = 1.0, rest = {rest}{along} }}");
            assert_eq!(joint(geometry, 0.0, &slider), is_rest, "{geometry} {rest}");
            let loose = slider.replace("stiffness = 1.0", "stiffness = 0.0");
            assert!(joint(geometry, 0.0, &loose), "{geometry}");
        }
    }
    assert!(joint("spatial", 0.2, "ball = { stiffness = 1.0 }"));
}

#[test]
fn contact_drives_bodies_that_are_within_its_range() {
    let discs = |y: f64| {
        let contact = "contact.barrier = { range = 0.2, stiffness = 1.0 }";
        let fluid = FLUID.replace('G', "[0.0, -1.0]");
        let body = |name: &str, y: f64| {
            format!(
                "[[body]]\nname = '{name}'\nshape.disc.radius = 0.5\ncenter = [0.0, {y}]\nmotion = 'free'\n"
            )
        };
        let bodies = body("one", 0.0) + &body("two", y);
        is_at_rest("planar", "'no-slip'", &format!("{fluid}\n{contact}\n{bodies}"))
    };
    assert!(discs(1.5) && !discs(1.1) && !discs(8.4));
}

#[test]
fn shipped_cases_are_driven() {
    for shipped in library::list() {
        let file = Case::read(shipped.name, &[]).unwrap();
        assert_eq!(at_rest(&file), None, "{}", shipped.name);
    }
}
