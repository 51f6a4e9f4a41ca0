//! Expressions of a case that are no finite number somewhere or at some time: refused by key, place and time.

use super::{ADAPTIVE, AXIS, PLANE, SPACE, run, text};

/// What a run with these settings is refused with.
fn refused(case: &str, settings: &[&str]) -> String {
    let directory = tempfile::tempdir().unwrap();
    let output = run(directory.path(), case, settings);
    let told = text(&output.stderr);
    assert_eq!(output.status.code(), Some(65), "{settings:?}: {told}");
    told
}

#[test]
fn an_expression_without_a_value_is_refused_where_it_is_written() {
    let directory = tempfile::tempdir().unwrap();
    let case = PLANE.replace("['1-(y/2)^2', 0]", "['sqrt(y)', 0]");
    let told = text(&run(directory.path(), &case, &[]).stderr);
    assert!(
        told.contains("step 1: `boundary.left.velocity.value.0` = \"sqrt(y)\" is NaN at (-2"),
        "{told}"
    );
    assert!(
        told.contains("case.toml:6:") && told.contains("an expression that is finite"),
        "{told}"
    );
}

#[test]
fn expressions_of_all_kinds_are_refused_by_key_place_and_time() {
    let stokes = "fluid.model='stokes'";
    let scalar = |rest: &str| format!("scalar=[{{ name = 'c', diffusivity = 0.1, {rest} }}]");
    let [initial, source, on_body] = [
        "initial = 'log(x)'",
        "initial = 1.0, source = 'sqrt(0.12 - t)'",
        "initial = 1.0, body = { b = { value = 'sqrt(0.12 - t)' } }",
    ]
    .map(scalar);
    let between = "body.0.gait={ slip = { velocity = [0, 'sqrt(cos(64*atan2(y, x)) + 0.1)'] } }";
    let band = "body.0.gait={ slip = { velocity = [0, 'sqrt(abs(x + 0.09) - 0.002)', 0] } }";
    let late = "boundary.left.velocity.value=['sqrt(0.12 - t)', 0]";
    for (case, settings, key, rest) in [
        (PLANE, vec![late], "boundary.left.velocity.value.0", "and t = 0.15"),
        (PLANE, vec![late, stokes], "boundary.left.velocity.value.0", "and t = 0.15"),
        (PLANE, vec![late, ADAPTIVE], "boundary.left.velocity.value.0", "and t = 0.1"),
        (
            PLANE,
            vec!["boundary.right={ pressure = { value = '1/(t - 0.1)' } }"],
            "boundary.right.pressure.value",
            "is inf",
        ),
        (
            PLANE,
            vec!["boundary.right={ traction = { value = [0, 'log(x - 3)'] } }"],
            "boundary.right.traction.value.1",
            "at (2.0",
        ),
        (PLANE, vec!["fluid.force=[0, 'sqrt(x)']"], "fluid.force.1", "NaN"),
        (
            PLANE,
            vec!["fluid.force=[0, 'sqrt(x)']", "time={ steady = {} }"],
            "fluid.force.1",
            "step 0",
        ),
        // Without a value anywhere
        (
            PLANE,
            vec!["boundary.right={ pressure = { value = 'log(y - 9)' } }", "time={ steady = {} }"],
            "boundary.right.pressure.value",
            "NaN",
        ),
        (
            PLANE,
            vec!["fluid.force=['log(y - 9)', 0]", "time={ steady = {} }", stokes],
            "fluid.force.0",
            "NaN",
        ),
        (
            SPACE,
            vec!["fluid.force=['log(y - 9)', 0, 0]", "time={ steady = {} }", stokes],
            "fluid.force.0",
            "NaN",
        ),
        (PLANE, vec!["initial.velocity=['sqrt(y)', 0]"], "initial.velocity.0", "t = 0"),
        (PLANE, vec![&initial], "scalar.0.initial", "t = 0"),
        (PLANE, vec![&source], "scalar.0.source", "t = 0.15"),
        (PLANE, vec![&on_body], "scalar.0.body.b.value", "t = 0.15"),
        (
            AXIS,
            vec!["boundary.wall={ velocity = { value = ['sqrt(x)', 0] } }"],
            "boundary.wall.velocity.value.0",
            "NaN",
        ),
        (
            SPACE,
            vec![stokes, "boundary.wall={ velocity = { value = [0, 0, 'sqrt(z)'] } }"],
            "boundary.wall.velocity.value.2",
            "NaN",
        ),
        (SPACE, vec!["fluid.force=['sqrt(0.12 - t)', 0, 0]"], "fluid.force.0", "t = 0.15"),
        // Between the places that are looked at before a run, in the frame of the body
        (
            PLANE,
            vec![between, "body.0.center=[0.3, 0.2]", "body.0.angle=0.3"],
            "body.0.gait.slip.velocity.1",
            " of the body and t = 0",
        ),
        (
            AXIS,
            vec![between, stokes, "mesh.surface=0.15"],
            "body.0.gait.slip.velocity.1",
            " of the body and t = 0",
        ),
        (SPACE, vec![band, stokes], "body.0.gait.slip.velocity.1", " of the body and t = 0"),
    ] {
        let told = refused(case, &settings);
        assert!(told.contains(&format!("`{key}` = ")), "{settings:?}: {told}");
        assert!(told.contains(rest) && told.contains("--set:1:"), "{settings:?}: {told}");
    }
}

#[test]
fn a_case_is_checked_for_expressions_at_the_start_and_in_the_first_step() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("case.toml"), PLANE).unwrap();
    let late = "boundary.left.velocity.value=['sqrt(0.01 - t)', 0]";
    let coarse = "mesh.size=1.0";
    let scalar = |rest: &str| format!("scalar=[{{ name = 'c', diffusivity = 0.1, {rest} }}]");
    let [initial, source, steady] = [
        "initial = 'log(x)'",
        "initial = 1.0, source = 'sqrt(0.01 - t)'",
        "boundary = { left = { value = 'sqrt(y)' } }",
    ]
    .map(scalar);
    let read = ["check", "case.toml", "--threads", "1"];
    let gradient = ["gradient", "case.toml", "--of=b.force.x", "--by=fluid.viscosity"];
    let stokes = "time={ steady = {} }";
    for (command, settings, told_first) in [
        (read, ["fluid.force=['sqrt(x)', 0]", stokes], "`fluid.force.0` = \"sqrt(x)\" is NaN"),
        (read, [late, coarse], "`boundary.left.velocity.value.0` = \"sqrt(0.01 - t)\" is NaN"),
        (read, [&initial, coarse], "`scalar.0.initial` = \"log(x)\" is NaN"),
        (read, [&source, coarse], "`scalar.0.source` = \"sqrt(0.01 - t)\" is NaN"),
        (read, [&steady, stokes], "`scalar.0.boundary.left.value` = \"sqrt(y)\" is NaN"),
        (gradient, ["fluid.force=['sqrt(x)', 0]", stokes], "`fluid.force.0` = \"sqrt(x)\" is NaN"),
    ] {
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_alewife"))
            .args(command)
            .args(settings.iter().flat_map(|setting| ["--set", setting]))
            .current_dir(directory.path())
            .output()
            .unwrap();
        let told = text(&output.stderr);
        assert_eq!(output.status.code(), Some(65), "{told}");
        assert!(told.contains(told_first) && told.contains("--set:1:"), "{told}");
    }
}
