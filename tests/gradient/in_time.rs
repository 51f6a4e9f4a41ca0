//! Gradients of motions without inertia, against differences of complete motions and against what is known exactly.

use tests::cases::{case, last, run};

use super::{agrees, gradients_of, refusal};

/// Two discs that sink side by side, turn, and drift apart.
const PAIR: &str = r#"
    title = "two discs that sink"
    geometry = "planar"
    fluid = { model = "stokes", viscosity = 1.5 }
    domain.disc = { radius = 4.0 }
    boundary = { wall = "no-slip" }
    mesh = { size = 1.0, surface = 0.3 }
    time.unsteady = { step = 0.5, end = 1.5, scheme = "rk3" }
    [[body]]
    name = "one"
    shape = { ellipse = { semi_axes = [0.6, 0.4] } }
    center = [-0.8, 1.0]
    angle = 0.3
    motion = "free"
    force = [0.0, -6.0]
    [[body]]
    name = "other"
    shape = { disc = { radius = 0.5 } }
    center = [0.7, 1.2]
    motion = "free"
    force = [0.0, -5.0]
"#;

const ENDS: [&str; 5] = ["one.x", "one.y", "one.angle", "other.x", "other.y"];

#[test]
fn places_at_the_end_follow_numbers_of_bodies_that_feel_each_other() {
    let by = [
        "body.0.center.0",
        "body.0.angle",
        "body.0.shape.ellipse.semi_axes.1",
        "body.1.force.1",
        "fluid.viscosity",
    ];
    agrees(PAIR, &ENDS, &by, 1e-4);
}

/// The discs of before, until they have worn four meshes.
fn far() -> String {
    PAIR.replace("step = 0.5, end = 1.5", "step = 1.0, end = 20.0")
}

/// Runs make meshes, too; those of gradients differ from them a little, and places by the error of a mesh.
#[test]
fn places_follow_numbers_across_new_meshes() {
    agrees(&far(), &ENDS, &["body.1.force.1", "fluid.viscosity"], 1e-4);
    let run = run(&case(&far()));
    assert!(last(&run, "flow.remeshes") >= 3.0);
    for found in gradients_of(&far(), &ENDS, &["fluid.viscosity"], false).unwrap() {
        let wanted = last(&run, &found.of);
        assert!((found.value - wanted).abs() < 5e-4, "{}: {} {wanted}", found.of, found.value);
    }
}

/// Places depend on time over viscosity alone: mu dx/dmu = -t v.
#[test]
fn motions_under_forces_are_slower_in_proportion_to_the_viscosity() {
    let of = &ENDS[..3];
    let found = gradients_of(PAIR, of, &["fluid.viscosity"], false).unwrap();
    let end = |time: f64| {
        let settings = format!("step = {:?}, end = {time:?}", time / 3.0);
        let text = PAIR.replace("step = 0.5, end = 1.5", &settings);
        gradients_of(&text, of, &["fluid.viscosity"], false).unwrap()
    };
    let change = 1e-3;
    let (before, after) = (end(1.5 * (1.0 - change)), end(1.5 * (1.0 + change)));
    for ((found, before), after) in found.iter().zip(&before).zip(&after) {
        let way = (after.value - before.value) / (2.0 * change);
        let by = 1.5 * found.by[0];
        assert!((by + way).abs() < 1e-5 * way.abs().max(0.1), "{}: {by} and {way}", found.of);
    }
}

/// Three spheres on arms that swing.
const SPHERES: &str = r#"
    title = "three spheres"
    geometry = "axisymmetric"
    fluid = { model = "stokes", viscosity = 2.0 }
    domain.half-disc = { radius = 1e4 }
    boundary = { wall = "no-slip" }
    mesh = { size = 2e3, surface = 0.5, growth = 0.4 }
    time.unsteady = { step = 0.125, end = 1.0, scheme = "rk3" }
    [[swimmer]]
    name = "swimmer"
    resistance = 113.0
    [swimmer.kind.linked-spheres]
    radii = [1.0, 1.0, 1.0]
    [[swimmer.kind.linked-spheres.arms]]
    sine = { mean = 6.0, amplitude = 1.5, period = 1.0, phase = 0.1 }
    [[swimmer.kind.linked-spheres.arms]]
    legs = { period = 1.0, knots = [[0.0, 6.0], [0.3, 5.0], [0.5, 5.0], [0.8, 6.5]] }
"#;

#[test]
fn ways_and_work_of_a_stroke_follow_it() {
    let of = [
        "swimmer.cycle.x",
        "swimmer.cycle.power",
        "swimmer.cycle.cost_of_transport",
        "swimmer.cycle.lighthill_efficiency",
        "swimmer.x",
    ];
    let arm = "swimmer.0.kind.linked-spheres.arms";
    let by = [
        format!("{arm}.0.sine.phase"),
        format!("{arm}.1.legs.knots.1.1"),
        "fluid.viscosity".to_owned(),
    ];
    let by: Vec<&str> = by.iter().map(String::as_str).collect();
    agrees(SPHERES, &of, &by, 1e-4);
    // Ways of given strokes do not depend on the viscosity, and powers are proportional to it
    let found = gradients_of(SPHERES, &of[..2], &by[2..], false).unwrap();
    assert!(found[0].by[0].abs() < 1e-9 * found[0].value.abs(), "{found:?}");
    assert!((2.0 * found[1].by[0] / found[1].value - 1.0).abs() < 1e-9, "{found:?}");
}

/// A ball and an ellipsoid that sink in a box.
const BOX: &str = r#"
    title = "an ellipsoid that sinks in a box"
    geometry = "spatial"
    fluid = { model = "stokes", viscosity = 2.0 }
    domain.box = { min = [-2.0, -2.0, -2.0], max = [2.0, 2.0, 2.0] }
    boundary = { left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip", back = "no-slip", front = "no-slip" }
    mesh = { size = 2.0, surface = 0.9, gap_layers = 1 }
    time.unsteady = { step = 0.3, end = 0.6, scheme = "rk3" }
    [[body]]
    name = "ball"
    shape = { ellipsoid = { semi_axes = [0.9, 0.7, 0.8] } }
    center = [0.3, 0.2, 0.0]
    motion = "free"
    force = [3.0, -20.0, 0.0]
"#;

#[test]
#[ignore = "long: 15 s; small: places_at_the_end_follow_numbers_of_bodies_that_feel_each_other"]
fn places_in_space_follow_numbers() {
    let by = ["body.0.shape.ellipsoid.semi_axes.0", "body.0.center.1", "body.0.force.0"];
    agrees(BOX, &["ball.x", "ball.y", "ball.z"], &by, 1e-3);
}

#[test]
fn what_has_no_gradient_in_time_is_refused_with_what_has_one() {
    let ok = ["fluid.viscosity"];
    let refused = |from: &str, to: &str, wanted: &[&str]| {
        let text = PAIR.replace(from, to);
        assert_ne!(text, PAIR);
        let found = refusal(&text, &["one.x"], &ok);
        wanted.iter().for_each(|wanted| assert!(found.contains(wanted), "{found}"));
    };
    refused("scheme = \"rk3\"", "scheme = \"bdf2\"", &["`rk3`", "case.toml:8"]);
    refused("title", "frame = \"one\"\n    title", &["frame that travels", "case.toml:2"]);
    refused(
        "title",
        "contact.quadratic = { range = 0.1, epsilon = 0.01 }\n    title",
        &["contact yet"],
    );
    let found = refusal(PAIR, &["one.force.x"], &ok);
    assert!(found.contains("no quantity whose gradient is known"), "{found}");
    // Averages over a cycle ask for one
    let short = SPHERES.replace("end = 1.0", "end = 0.5");
    let found = refusal(&short, &["swimmer.cycle.x"], &ok);
    assert!(found.contains("has no value at the end") && found.contains("case.toml:8"), "{found}");
    // Kinks at other times, and cycles that are not whole on one side
    let arm = "swimmer.0.kind.linked-spheres.arms";
    let key = format!("{arm}.1.legs.knots.1.0");
    let found = refusal(SPHERES, &["swimmer.cycle.x"], &[&key]);
    assert!(found.contains("rate of a stroke jumps") && found.contains("case.toml:17"), "{found}");
    let smooth = SPHERES.replace(
        "legs = {",
        "sine = { mean = 6.0, amplitude = 1.0, period = 1.0, phase = 0.3 }\n#",
    );
    let key = format!("{arm}.0.sine.period");
    let found = refusal(&smooth, &["swimmer.cycle.x"], &[&key]);
    assert!(found.contains("a little more than a period"), "{found}");
    // Bodies that go far in one step tear the mesh
    let far = PAIR.replace("step = 0.5, end = 1.5", "step = 20.0, end = 80.0");
    let found = refusal(&far, &["one.x"], &ok);
    assert!(found.contains("torn a cell of the mesh") && found.contains("case.toml:8"), "{found}");
}
