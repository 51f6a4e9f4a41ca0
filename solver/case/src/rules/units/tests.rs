//! Amplitudes in degrees in all places that have angles in time, and what is no mistake.

use super::column::has_word;
use crate::{Case, check};

/// What is said of a case with a motion of its body, or of a rod in it.
fn said(geometry: &str, body: &str) -> String {
    let (box_, sphere) = match geometry {
        "planar" => ("[-4, -4], max = [4, 4]", "shape.disc.radius = 1.0, center = [0, 0]"),
        _ => ("[-4, -4, -4], max = [4, 4, 4]", "shape.sphere.radius = 1.0, center = [0, 0, 0]"),
    };
    let sides = if geometry == "planar" { "" } else { "front = 'no-slip'\nback = 'no-slip'\n" };
    let text = format!(
        "
title = 't'
geometry = '{geometry}'
fluid = {{ model = 'stokes', viscosity = 1.0 }}
domain.box = {{ min = {box_} }}
mesh = {{ size = 0.5 }}
time = {{ unsteady = {{ step = 0.01, end = 1.0 }} }}
body = [{{ name = 'a', {sphere}, {body} }}]
[boundary]
left = 'no-slip'
right = 'no-slip'
top = 'no-slip'
bottom = 'no-slip'
{sides}"
    );
    let file = Case::parse("t.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"));
    let found = check(&file);
    found.iter().map(|one| format!("{}: {} {}\n", one.key, one.message, one.help)).collect()
}

#[test]
fn amplitudes_above_half_a_turn_are_asked_about_in_all_places() {
    let asks = |geometry: &str, body: &str| said(geometry, body).contains(" deg\"");
    let turning = |value: &str| format!("motion = {{ rotation = {{ imposed = {value} }} }}");
    let in_space = |value: &str| {
        format!("motion = {{ axis = [0, 0, 1], rotation = {{ imposed = {value} }} }}")
    };
    for (value, is_asked) in [
        ("{ sine = { amplitude = 5, period = 1.0 } }", true),
        ("{ sine = { amplitude = '5 rad', period = 1.0 } }", false),
        ("{ sine = { amplitude = '5 deg', period = 1.0 } }", false),
        ("{ sine = { amplitude = 3.1, period = 1.0 } }", false),
        ("{ sine = { amplitude = -20, period = 1.0, ramp = 1.0 } }", true),
        // What turns on and on, and back
        ("{ steady = { rate = 40.0 } }", false),
        ("{ table = [[0, 0], [0.5, 20], [1, 0]] }", false),
        ("{ legs = { knots = [[0, 0], [0.5, 5]], period = 1.0, smooth = true } }", false),
        ("{ table = [[0, 0], [0.1, 8], [0.2, -8], [0.3, 8], [1, 8]] }", true),
    ] {
        assert_eq!(
            asks("planar", &turning(value)),
            is_asked,
            "{}",
            said("planar", &turning(value))
        );
        assert_eq!(asks("spatial", &in_space(value)), is_asked, "{value}");
    }
    let squirmer = |amplitude: &str| {
        format!(
            "motion = 'free', gait.squirmer = {{ modes = [1.0], turn = {{ sine = {{ amplitude = {amplitude}, \
             period = 1.0 }} }} }}"
        )
    };
    assert!(asks("planar", &squirmer("10")) && !asks("planar", &squirmer("1")));
}

#[test]
fn a_unit_is_a_word_of_its_own() {
    for name in ["t_ms", "time [ms]", "time/ms", "ms", "t(ms)"] {
        assert!(has_word(name, &["ms"]), "{name}");
    }
    for name in ["t", "ms1", "forms", "items_s"] {
        assert!(!has_word(name, &["ms"]), "{name}");
    }
}

/// A tetrahedron of a size in the middle of a domain of 8, from a file.
fn tetrahedron(size: f64, scale: &str) -> String {
    let directory = tempfile::tempdir().unwrap();
    let at = |x: f64| x * size;
    let vertices = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let lines = vertices.map(|[x, y, z]| format!("v {} {} {}\n", at(x), at(y), at(z)));
    let obj = lines.concat() + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    std::fs::write(directory.path().join("body.obj"), obj).unwrap();
    let text = format!(
        "
title = 't'
geometry = 'spatial'
fluid = {{ model = 'stokes', viscosity = 1.0 }}
domain.box = {{ min = [-4, -4, -4], max = [4, 4, 4] }}
mesh = {{ size = 1.0, surface = 0.3 }}
time.steady = {{}}
boundary = {{ left = 'no-slip', right = 'no-slip', top = 'no-slip', bottom = 'no-slip', front = 'no-slip', back = 'no-slip' }}
[[body]]
name = 'a'
center = [0, 0, 0]
motion = 'held'
shape.surface = {{ file = 'body.obj', smooth = 180{scale} }}
"
    );
    let path = directory.path().join("t.toml");
    std::fs::write(&path, text).unwrap();
    let file = Case::read(&path.display().to_string(), &[]).unwrap();
    check(&file).iter().map(|one| format!("{}: {} {}\n", one.key, one.message, one.help)).collect()
}

#[test]
fn surfaces_in_another_unit_of_length_are_asked_about() {
    let large = tetrahedron(1000.0, "");
    assert!(large.contains("body.0.shape.surface") && large.contains("scale = 0.001"), "{large}");
    let small = tetrahedron(1e-3, "");
    assert!(small.contains("scale = 1000"), "{small}");
    for (size, scale) in [(1.0, ""), (1000.0, ", scale = 1e-3"), (1e-3, ", scale = 1000")] {
        let said = tetrahedron(size, scale);
        assert!(!said.contains("another unit"), "{said}");
    }
}
