//! Bodies that bend in space, with inertia: momentum, angular momentum, and a gait that is none.

use alewife_core::case::Model;
use alewife_core::coupling::BodyShapes;
use alewife_core::run::{RunSummary, build_mesh, build_problem, simulate, simulation_on};
use tests::cases::{case, column, last};
use tests::figure;

fn run(model: &Model) -> RunSummary {
    simulate::<3>(model, &mut []).expect("the case runs")
}

/// A stout fish in a closed box.
fn fish(body: &str, time: &str, [growth, scale]: [f64; 2]) -> String {
    format!(
        r#"
        title = "a fish in a box in space"
        geometry = "spatial"
        fluid = {{ model = "navier-stokes", density = 1.0, viscosity = 0.05 }}
        domain.box = {{ min = [-1.1, -0.8, -0.8], max = [1.1, 0.8, 0.8] }}
        boundary = {{ left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip", back = "no-slip", front = "no-slip" }}
        mesh = {{ size = 0.8, surface = 0.2, growth = {growth}, gap_layers = 1, scale = {scale} }}
        time.unsteady = {{ {time} }}
        [[body]]
        name = "fish"
        shape.fish = {{ length = 1.0, head_width = 0.15, head_end = 0.15, tail_width = 0.08, tail_start = 0.8, tip_radius = 0.05, corner_radius = 0.05, height = 0.2 }}
        center = [0.0, 0.05, 0.0]
        density = 1.2
        motion = "free"
        {body}
        "#
    )
}

/// In the frame of the body Newton's and Euler's equations are those of BDF2, in which the tensor of inertia
/// follows the shape; and the surface keeps its volume.
#[test]
fn force_and_torque_in_space_are_the_rates_of_momentum_and_angular_momentum() {
    let step = 0.03;
    let gait = "gait.carangiform = { period = 1.0, ramp = 0.5 }";
    let case = case(&fish(gait, &format!("step = {step}, end = 0.18"), [0.65, 1.5]));
    let mesh = build_mesh::<3>(&case).expect("it is meshed");
    let problem = build_problem(&case, &mesh).expect("it is a problem");
    let body = &problem.bodies[0];
    let outcome = run(&case);
    let times = &outcome.series.times;
    let rate = |values: &[f64], n: usize| {
        (3.0 * values[n] - 4.0 * values[n - 1] + values[n - 2]) / (2.0 * step)
    };
    let inertia: Vec<f64> = times
        .iter()
        .map(|time| {
            let shapes = BodyShapes::at(&problem.bodies, *time).expect("the gait has a shape");
            body.inertia_with(shapes.deformed(0)).about_z()
        })
        .collect();
    let turn = column(&outcome, "fish.angular_velocity.z");
    let momentum: Vec<f64> = inertia.iter().zip(turn).map(|(i, turn)| i * turn).collect();
    let torque = column(&outcome, "fish.torque.z");
    let [speed, force] = ["velocity", "force"].map(|of| column(&outcome, &format!("fish.{of}.y")));
    let (mut off, mut most, mut worst, mut size) = (0.0f64, 0.0f64, 0.0f64, 0.0f64);
    for n in 3..times.len() {
        off = off.max((rate(&momentum, n) - torque[n]).abs());
        most = most.max(torque[n].abs());
        worst = worst.max((body.inertia.mass * rate(&speed, n) - force[n]).abs());
        size = size.max(force[n].abs());
    }
    let defect = column(&outcome, "flow.mass_defect").iter().fold(0.0f64, |m, d| m.max(d.abs()));
    let [least, largest] =
        inertia.iter().fold([f64::INFINITY, 0.0], |[a, b], i| [a.min(*i), b.max(*i)]);
    figure!(worst / size, "force");
    figure!(off / most, "torque");
    figure!(defect, "mass defect");
    // Iterations leave 1e-9 of the residual
    assert!(worst < 1e-6 * size && off < 1e-6 * most, "{worst:e} {off:e}");
    assert!(largest > 1.002 * least, "the inertia changes by {}", largest / least - 1.0);
    assert!(defect < 1e-4, "{defect:e}");
}

/// A gait without amplitude is no gait, however the plane in which it would bend is turned.
#[test]
fn a_fish_in_space_that_does_not_bend_is_rigid() {
    let pulled = "force = [0.01, -0.03, 0.02]\ntorque = [0.001, 0.002, -0.003]\n\
                  orientation = { turned = { axis = [1.0, 0.5, 0.2], angle = 0.3 } }\n";
    let names = ["x", "z", "direction.y", "velocity.z", "torque.x", "angular_velocity.y", "power"];
    let end = |gait: &str| {
        let outcome =
            run(&case(&fish(&format!("{pulled}{gait}"), "step = 0.05, end = 0.1", [0.8, 1.2])));
        names.map(|name| last(&outcome, &format!("fish.{name}")))
    };
    let rigid = end("");
    let still = end("gait.carangiform = { period = 1.0, curvature = [[0.0, 0.0], [1.0, 0.0]] }");
    let off = rigid.iter().zip(still).map(|(one, other)| (one / other - 1.0).abs());
    figure!(off.fold(0.0, f64::max), "rigid or still");
    // The surface is the same to rounding, which makes other meshes: they differ by 0.2 %
    for (name, (one, other)) in names.iter().zip(rigid.iter().zip(still)) {
        assert!((one - other).abs() < 0.01 * one.abs(), "{name}: {rigid:?} {still:?}");
    }
}

/// Part of its quality that a cell keeps in a mesh that is not replaced, as cases have it by default.
const KEPT: f64 = 0.4;

/// The end of the tail moves by twenty times its radius and turns by seventy degrees; by k = d^-1/2, as around rigid
/// bodies, cells would be inverted at all phases.
#[test]
fn one_mesh_follows_a_thin_tail_through_its_beat() {
    let model = case(
        r#"
        title = "a head with a tail in a tube"
        geometry = "spatial"
        fluid = { model = "stokes", viscosity = 1.0 }
        domain.cylinder = { x = [-5.0, 18.0], radius = 5.0 }
        boundary = { left = "traction-free", right = "traction-free", wall = "no-slip" }
        mesh = { size = 2.0, surface = 0.2, growth = 0.5, scale = 1.2 }
        time.unsteady = { step = 0.1, end = 1.0, scheme = "rk3" }
        [[body]]
        name = "sperm"
        shape.flagellate = { head = [1.0, 0.6], tail_length = 10.0, thickness = 0.4 }
        center = [1.0, 0.0, 0.0]
        orientation = { along = [-1.0, 0.0, 0.0] }
        motion = "free"
        gait.flagellum = { period = 1.0, wavelength = 15.0, amplitude = 2.0, ramp = 0.1, inextensible = true }
        "#,
    );
    let simulation = simulation_on(&model, build_mesh::<3>(&model).expect("it is meshed"));
    let simulation = simulation.expect("the case is a problem");
    let moving = simulation.moving_mesh.as_ref().expect("its mesh moves");
    let when_new = simulation.state.mesh.cell_qualities();
    let mut mesh = simulation.state.mesh.clone();
    let mut least = f64::INFINITY;
    for eighth in 0..8 {
        let time = 1.0 + f64::from(eighth) / 8.0;
        let shapes =
            BodyShapes::at(&simulation.problem.bodies, time).expect("the gait has a shape");
        mesh.nodes = moving
            .nodes(&simulation.state.in_mesh(&simulation.state.poses), &shapes)
            .expect("it is moved");
        let kept = mesh.cell_qualities().into_iter().zip(&when_new).map(|(now, new)| now / new);
        let kept = kept.fold(f64::INFINITY, f64::min);
        println!("{} cells, {time}: {kept:.3} kept", mesh.n_cells());
        least = least.min(kept);
    }
    figure!(least, "quality kept");
    assert!(least > KEPT, "{least}");
}
