//! Wrong cases in three dimensions: places of bodies and probes.

use super::{assert_accepted, assert_refused, check};

/// A case with nothing wrong in it: two bodies in a box.
const RIGHT: &str = r#"title = "A sphere and an ellipsoid in a box"
geometry = "spatial"
fluid = { model = "stokes", viscosity = 1.0 }
domain.box = { min = [-2.0, -2.0, -2.0], max = [2.0, 2.0, 2.0] }
mesh = { size = 0.5 }
time = { steady = {} }

[boundary]
left = "no-slip"
right = "no-slip"
bottom = "no-slip"
top = "no-slip"
back = "no-slip"
front = "symmetry"

[[body]]
name = "ball"
shape = { sphere = { radius = 0.5 } }
center = [-0.8, 0.0, 0.0]
motion = "held"

[[body]]
name = "egg"
shape = { ellipsoid = { semi_axes = [0.8, 0.5, 0.4] } }
center = [0.8, 0.0, 0.0]
motion = "held"

[[probe]]
name = "between"
point = [-0.2, 0.0, 0.0]
"#;

#[track_caller]
fn refused(setting: &str, wanted: &[&str]) {
    assert_refused(&check(RIGHT, &["--set", setting]), wanted);
}

#[test]
fn bodies_in_space_are_apart_from_each_other_and_from_walls() {
    assert_accepted(&check(RIGHT, &[]));
    // Across the direction in which they are apart
    assert_accepted(&check(RIGHT, &["--set", "body.1.center=[-0.8, 1.1, 0.0]"]));
    let text = RIGHT.replace("center = [0.8, 0.0, 0.0]", "center = [0.4, 0.0, 0.0]");
    let overlap =
        ["bodies \"ball\" and \"egg\" touch or overlap at (", "gap -1.0", "wrong.toml:25:10"];
    assert_refused(&check(&text, &[]), &overlap);
    let text = RIGHT.replace("center = [0.8, 0.0, 0.0]", "center = [0.8, 1.7, 0.0]");
    let outside =
        ["body \"egg\" touches or leaves the domain at side `top`", "wrong.toml:25:10", "enlarge"];
    assert_refused(&check(&text, &[]), &outside);
    refused("body.0.center=[-1.5, 0.0, 0.0]", &["side `left`", "gap 0.000e0"]);
    refused(
        "body.0.center=[-0.5000000001, 0.0, 0.0]",
        &["bodies \"ball\" and \"egg\" are 1.000e-10 apart"],
    );
    // All of them are found
    refused("body.0.center=[-3.0, 0.0, 1.0]", &["side `left`"]);
    // A plane of symmetry may cut a body
    assert_accepted(&check(RIGHT, &["--set", "body.0.center=[-0.8, 0.0, 2.0]"]));
}

#[test]
fn probes_in_space_are_in_the_fluid() {
    assert_accepted(&check(RIGHT, &["--set", "probe.0.point=[0.0, 0.0, 0.0]"]));
    refused("probe.0.point=[0.0, 0.0, 2.1]", &["outside the domain", "to [2.0, 2.0, 2.0]"]);
    refused("probe.0.point=[1.5, 0.0, 0.0]", &["inside the body \"egg\""]);
    refused("probe.0.point=[0.0, 0.0]", &["has 2 numbers", "write [x, y, z]"]);
}
