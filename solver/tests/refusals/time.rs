//! Wrong steps in time, moving meshes and frames.

use super::{RIGHT, assert_accepted, assert_refused, check, refused, unsteady};

#[test]
fn adaptive_steps_have_bounds_around_the_first_one() {
    let text = unsteady("").replace(
        "end = 1.0",
        "end = 0.95\n\n[time.unsteady.adaptive]\ntolerance = 1e-3\nlargest = 0.2\nsmallest = 1e-4",
    );
    let said = check(&text, &[]);
    assert_accepted(&said);
    // Nobody expects adaptive steps to divide the end.
    assert_eq!(said.stderr, "");
    for (setting, wanted) in [
        ("tolerance=0", "must be positive"),
        ("tolerance=1", "must be less than 1"),
        ("largest=-1", "must be positive"),
        ("largest=0.05", "the largest step, 0.05, is shorter than the first one, 0.1"),
        ("smallest=0", "must be positive"),
        ("smallest=0.15", "the smallest step, 0.15, is longer than the first one, 0.1"),
        ("cfl=0", "must be positive"),
        ("gap=0", "must be positive"),
        ("gap=1", "must be less than 1"),
    ] {
        let setting = format!("time.unsteady.adaptive.{setting}");
        assert_refused(&check(&text, &["--set", &setting]), &[wanted, "--> --set:1:"]);
    }
}

#[test]
fn a_moving_mesh_has_limits_a_new_one_meets() {
    let text = unsteady("");
    for (setting, wanted) in [
        ("quality=0", "must be positive"),
        ("quality=1", "must be less than 1"),
        ("layers=0", "must be positive"),
        ("layers=5", "a new mesh has 4"),
        ("equation=elastc", "`elastic`?"),
    ] {
        let setting = format!("mesh.moving.{setting}");
        assert_refused(&check(&text, &["--set", &setting]), &[wanted, "--> --set:1:"]);
    }
    // The default is right on every mesh, and so is what the scale of the mesh makes of it.
    for setting in ["mesh.gap_layers=1", "mesh.scale=4", "mesh.moving.layers=4"] {
        assert_accepted(&check(&text, &["--set", setting]));
    }
    let still = check(RIGHT, &["--set", "mesh.moving.quality=0.3"]);
    assert_accepted(&still);
    assert!(still.stderr.contains("`mesh.moving` has no effect"), "{}", still.stderr);
}

#[test]
fn the_frame_is_that_of_a_body() {
    refused(
        "[fluid]",
        "frame = \"disk\"\n[fluid]",
        &["no body or swimmer has that name", "`disc`?"],
    );
}

#[test]
fn unsteady_stokes_is_not_steady() {
    refused(
        "model = \"navier-stokes\"",
        "model = \"unsteady-stokes\"",
        &["no steady solution", "wrong.toml:29:7", "[time.unsteady]"],
    );
}

#[test]
fn steps_and_cycles_are_of_a_number_that_can_be_made() {
    let text = unsteady("");
    assert_refused(
        &check(&text, &["--set", "time.unsteady.step=1e-12"]),
        &["the run would have 1.0e12 steps", "--> --set:1:"],
    );
    let fast = unsteady("torque = 1.0\nload_factor.sine = { period = 1e-7 }");
    let fast = fast.replace("end = 1.0", "end = 1.0\nadaptive = {}");
    let told =
        ["`body.0.load_factor.sine.period` is 1e-7: 1.0e7 cycles to the end", "wrong.toml:25:"];
    assert_refused(&check(&fast, &[]), &told);
    // A step that is none is one mistake, not two
    let said = check(&text, &["--set", "time.unsteady.step=-0.1"]);
    assert_refused(&said, &["must be positive"]);
    assert!(!said.stderr.contains("warning"), "{}", said.stderr);
}

#[test]
fn degrees_and_phases_in_radians_are_warned_about() {
    let ellipse = unsteady("angle = 0.5\ngait.pulsating = { amplitude = 0.1, period = 1.0 }");
    let text = unsteady("torque = 1.0\nload_factor.sine = { period = 1.0 }");
    assert!(!check(&ellipse, &[]).stderr.contains("radians"));
    for (setting, wanted) in [
        (
            "body.0.angle=45",
            ["`body.0.angle` is 45: angles are in radians", "degrees write \"45 deg\""],
        ),
        ("body.0.angle=-180", ["is -180: angles are in radians", "write \"-180 deg\""]),
        (
            "body.0.load_factor.sine.phase=1.5707963",
            ["phases are parts of a period", "for 1.5707963 rad write 0.25"],
        ),
        (
            "body.0.load_factor.sine.phase=90",
            ["phases are parts of a period", "for 90 degrees write 0.25"],
        ),
        (
            "body.0.gait.squirmer={modes=[1.0], turn={table=[[0.0, 0.0], [60.0, 90.0]]}}",
            ["`body.0.gait.squirmer.turn.table.1.1` is 90", "write \"90 deg\""],
        ),
        (
            "body.0.gait.squirmer={modes=[1.0], heading=180.0}",
            ["`body.0.gait.squirmer.heading` is 180", "write \"180 deg\""],
        ),
    ] {
        let said = check(&text, &["--set", setting]);
        assert_accepted(&said);
        for wanted in wanted {
            assert!(said.stderr.contains(wanted), "`{wanted}` is not in:\n{}", said.stderr);
        }
    }
    let said = check(&text, &["--set", "body.0.gait.squirmer={modes=[1.0], heading='180 deg'}"]);
    assert_accepted(&said);
    assert!(said.stdout.contains("heading 3.14159 rad (180.0 degrees)"), "{}", said.stdout);
    assert_accepted(&check(&text, &["--set", "body.0.angle=45 deg"]));
    let wrong = check(&text, &["--set", "body.0.angle=45 grad"]);
    assert_refused(&wrong, &["`body.0.angle`: \"45 grad\" is not an angle", "\"30 deg\""]);
    // More than a turn in time is one
    let turning = "body.0.gait.squirmer={modes=[1.0], turn={table=[[0.0, 0.0], [60.0, 12.5]]}}";
    assert_eq!(check(&text, &["--set", turning]).stderr, "");
    let said = check(&text, &["--set", "body.0.gait.squirmer={modes=[1.0], heading=0.785398}"]);
    assert!(said.stdout.contains("heading 0.785398 rad (45.0 degrees)"), "{}", said.stdout);
}

#[test]
fn a_key_of_another_name_leads_to_the_one_there_is() {
    let text = unsteady("torque = 1.0\nload_factor.sine = { frequency = 2.0 }");
    let told = ["unknown key `frequency`", "write `period = ...`, the inverse of the frequency"];
    assert_refused(&check(&text, &[]), &told);
    let fish = unsteady("gait.carangiform = { period = 1.0, start_phase = 0.5 }");
    let told = ["unknown key `start_phase`", "write `phase = ...`, a part of the period"];
    assert_refused(&check(&fish, &[]), &told);
}

#[test]
fn what_follows_from_a_wrong_number_is_not_told() {
    let swims = unsteady("gait.carangiform = { period = -1.0 }");
    for (text, setting, error) in [
        (unsteady(""), "time.unsteady.end=-1", "`time.unsteady.end` is -1"),
        (unsteady(""), "mesh.scale=-1", "`mesh.scale` is -1"),
        (swims, "mesh.scale=1", "`body.0.gait.carangiform.period` is -1"),
    ] {
        let said = check(&text, &["--set", setting]);
        assert_refused(&said, &[error]);
        assert!(!said.stderr.contains("warning"), "{}", said.stderr);
    }
}

#[test]
fn too_many_steps_are_told_where_the_number_stands() {
    for (setting, key) in
        [("time.unsteady.end=1e9", "`end` = 1e9"), ("time.unsteady.step=1e-12", "`step` = 1e-12")]
    {
        let said = check(&unsteady(""), &["--set", setting]);
        assert_refused(&said, &[key, "--> --set:1:", "for 1e9 steps"]);
    }
}

#[test]
fn a_number_where_a_point_is_wanted_is_told_by_an_example() {
    let said = check(RIGHT, &["--set", "body.0.center=3.0"]);
    assert_refused(&said, &["where an array is wanted", "[x, y], such as [3.0, 0.0]"]);
}
