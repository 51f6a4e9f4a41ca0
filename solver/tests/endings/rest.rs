//! Runs in which nothing moves but by rounding, and what is printed of scalars.

use super::{ADAPTIVE, AXIS, PLANE, SPACE, run, text};

/// A force by which a body goes less than its place is rounded by.
#[test]
fn ways_that_are_rounding_are_no_reason_for_shorter_steps() {
    let free = "body.0.motion='free'";
    let closed = ["boundary.left='no-slip'", "boundary.right='no-slip'"];
    // Off the origin, near which places are rounded less
    let [flat, on_axis, in_space] =
        ["[0.3, 0.2]", "[0.3, 0.0]", "[0.1, 0.2, 0.0]"].map(|at| format!("body.0.center={at}"));
    let [push, push_in_space] =
        ["body.0.force=[1e-18, 0.0]", "body.0.force=[1e-18, 0.0, 0.0]"].map(str::to_owned);
    let stokes = "fluid.model='stokes'";
    let directory = tempfile::tempdir().unwrap();
    for (case, center, force, more) in [
        (PLANE, &flat, &push, vec![]),
        (PLANE, &flat, &push, vec![stokes]),
        (PLANE, &flat, &push, vec![ADAPTIVE]),
        (AXIS, &on_axis, &push, vec![]),
        (SPACE, &in_space, &push_in_space, vec![stokes]),
    ] {
        let mut settings = vec![free, center, force];
        settings.extend(if case == PLANE { &closed[..] } else { &[] });
        settings.extend(&more);
        let output = run(directory.path(), case, &settings);
        let said = text(&output.stdout);
        assert_eq!(output.status.code(), Some(0), "{more:?}: {}", text(&output.stderr));
        assert!(!said.contains("too long") && !said.contains("ways"), "{more:?}: {said}");
        // What moves the body is no rounding, and is told
        let force = force.replace("e-18", "");
        settings[2] = &force;
        let output = run(directory.path(), case, &settings);
        assert!(text(&output.stdout).contains("ways"), "{more:?}: {}", text(&output.stdout));
    }
}

#[test]
fn scalars_are_in_the_table_at_the_end() {
    let directory = tempfile::tempdir().unwrap();
    let scalar = "scalar=[{ name = 'dye', diffusivity = 0.1, initial = 1.0, body = { b = { value = 2.0 } } }]";
    for (case, more) in
        [(PLANE, vec![]), (AXIS, vec![ADAPTIVE]), (PLANE, vec!["time={ steady = {} }"])]
    {
        let mut settings = vec![scalar];
        settings.extend(&more);
        let output = run(directory.path(), case, &settings);
        let said = text(&output.stdout);
        let total = said.lines().find(|line| line.starts_with("scalar.dye.total "));
        let total = total.unwrap_or_else(|| panic!("{said}{}", text(&output.stderr)));
        let value: f64 = total.split_whitespace().nth(1).unwrap().parse().unwrap();
        assert!(value > 0.0, "{total}");
        assert!(said.contains("scalar.dye.b."), "{said}");
    }
}
