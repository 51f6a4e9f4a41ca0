//! What a new mesh in the middle of a run leaves as it was.

use std::sync::{Arc, Mutex};

use alewife_core::run::{Observer, Snapshot, simulate};
use alewife_core::space::{CellValues, Metric, Tables};
use tests::cases::{PERIODIC_BOX, case, column, last, run};
use tests::figure;

use super::tank;

/// A disc sinks far enough for several meshes.
#[test]
fn forces_go_on_smoothly_across_a_new_mesh() {
    let mesh = "size = 0.2, surface = 0.05, moving.quality = 0.8";
    let text = tank("navier-stokes", "step = 0.02, end = 2.4", mesh)
        + r#"
        [[body]]
        name = "disc"
        shape = { disc = { radius = 0.25 } }
        center = [0.1, 1.0]
        density = 1.25
        motion = "free"
        "#;
    let outcome = run(&case(&text));
    let remeshes = column(&outcome, "flow.remeshes");
    let force = column(&outcome, "disc.force.y");
    let mut jumps: Vec<f64> = Vec::new();
    for step in 2..force.len() - 2 {
        if remeshes[step] == remeshes[step - 1] {
            continue;
        }
        // The first force on the new mesh against the line through those before.
        let ahead = 2.0 * force[step - 1] - force[step - 2];
        jumps.push((force[step] - ahead).abs() / force[step].abs());
    }
    figure!(jumps.iter().copied().fold(0.0, f64::max), "largest jump of the force");
    assert!(jumps.len() >= 2, "{} meshes", jumps.len());
    assert!(jumps.iter().all(|jump| *jump < 0.01), "{jumps:?}");
}

/// Velocities without inertia differ from mesh to mesh by what the meshes leave, and no shorter step helps against that.
#[test]
fn steps_by_their_error_are_no_shorter_on_a_new_mesh() {
    let plane = r#"
        title = "two pullers that turn away, on a coarse mesh"
        geometry = "planar"
        fluid = { model = "stokes", viscosity = 1.0 }
        domain.box = { min = [-12.0, -10.0], max = [12.0, 10.0] }
        boundary = { left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }
        mesh = { size = 2.5, surface = 0.25, growth = 0.3, gap_layers = 3 }
        time.unsteady = { end = 3.5 }
        contact.barrier = { range = 0.1, stiffness = 200.0 }
        [[body]]
        name = "a"
        shape.disc = { radius = 1.0 }
        center = [-3.0, 0.0]
        motion = "free"
        gait.squirmer = { modes = [2.0, 4.0] }
        [[body]]
        name = "b"
        shape.disc = { radius = 1.0 }
        center = [3.0, 1.5]
        motion = "free"
        gait.squirmer = { modes = [2.0, 4.0], heading = "180 deg" }
        "#;
    let axis = r#"
        title = "a puller along the axis of a short tube"
        geometry = "axisymmetric"
        fluid = { model = "stokes", viscosity = 1.0 }
        domain.cylinder = { x = [-4.0, 4.0], radius = 2.5 }
        boundary = { left = "no-slip", right = "no-slip", wall = "no-slip" }
        mesh = { size = 1.5, surface = 0.4, growth = 0.5, moving.quality = 0.8 }
        time.unsteady = { end = 6.0 }
        [[body]]
        name = "a"
        shape.sphere = { radius = 1.0 }
        center = [-2.5, 0.0]
        motion = "free"
        gait.squirmer = { modes = [1.5, 4.0] }
        "#;
    for text in [plane, axis] {
        let outcome = run(&case(text));
        let (time, remeshes) = (&outcome.series.times, column(&outcome, "flow.remeshes"));
        let mut shares = Vec::new();
        for step in 2..time.len() - 2 {
            if remeshes[step] > remeshes[step - 1] {
                shares.push((time[step] - time[step - 1]) / (time[step - 1] - time[step - 2]));
            }
        }
        assert!(shares.len() >= 2, "{} meshes", shares.len());
        assert!(shares.iter().all(|share| *share > 0.2), "{shares:?}");
    }
}

/// Sums the momentum of the fluid, step by step.
struct Momentum(Arc<Mutex<Vec<[f64; 2]>>>);

impl Observer<2> for Momentum {
    fn on_step(&mut self, snapshot: &Snapshot<'_, 2>) -> std::io::Result<()> {
        let tables = Tables::new(Metric::Cartesian);
        let mut workspace = CellValues::default();
        let mut sum = [0.0; 2];
        for cell in snapshot.mesh.cell_ids() {
            let nodes = snapshot.mesh.cell(cell);
            workspace.for_each_point(&tables, snapshot.mesh, cell, |at| {
                for (&node, phi) in nodes.iter().zip(at.phi) {
                    let velocity = snapshot.velocity[node];
                    sum[0] += phi * velocity.x * at.dx;
                    sum[1] += phi * velocity.y * at.dx;
                }
            });
        }
        self.0.lock().expect("nobody else holds it").push(sum);
        Ok(())
    }
}

/// Two discs in a doubly periodic box are pulled apart by opposite forces: what they and the fluid
/// have together is zero, up to the error of the scheme in time, and new meshes change little.
#[test]
fn momentum_of_fluid_and_bodies_is_conserved() {
    let at = |step: f64| {
        let text = format!(
            r#"
            title = "two discs, opposite forces"
            geometry = "planar"
            fluid = {{ model = "navier-stokes", density = 1.0, viscosity = 0.05 }}
            domain.box = {{ min = [-1.0, -1.0], max = [1.0, 1.0] }}
            mesh = {{ size = 0.15, surface = 0.05 }}
            time.unsteady = {{ step = {step}, end = 1.0 }}
            {PERIODIC_BOX}
            [[body]]
            name = "one"
            shape = {{ disc = {{ radius = 0.2 }} }}
            center = [-0.4, 0.1]
            density = 2.0
            motion = "free"
            force = [-0.4, 0.5]
            [[body]]
            name = "two"
            shape = {{ disc = {{ radius = 0.2 }} }}
            center = [0.3, -0.1]
            density = 2.0
            motion = "free"
            force = [0.4, -0.5]
            "#
        );
        let seen = Arc::new(Mutex::new(Vec::new()));
        let mut observers: Vec<Box<dyn Observer<2>>> = vec![Box::new(Momentum(Arc::clone(&seen)))];
        let outcome = simulate(&case(&text), &mut observers).expect("the case runs");
        let mass = 2.0 * std::f64::consts::PI * 0.04;
        let fluid = *seen.lock().expect("the run is over").last().expect("it has steps");
        let of_body = |name: &str| {
            ["x", "y"].map(|axis| mass * last(&outcome, &format!("{name}.velocity.{axis}")))
        };
        let (one, two) = (of_body("one"), of_body("two"));
        let sum = [0, 1].map(|axis| fluid[axis] + one[axis] + two[axis]);
        let size = one[0].hypot(one[1]);
        figure!(sum[0].hypot(sum[1]) / size, "step {step}: momentum");
        assert!(last(&outcome, "flow.remeshes") >= 1.0);
        sum[0].hypot(sum[1]) / size
    };
    let (coarse, fine) = (at(0.04), at(0.02));
    assert!(coarse < 5e-3, "{coarse:e}");
    assert!(fine < 0.5 * coarse || fine < 5e-4, "{coarse:e} {fine:e}");
}

/// The film between two discs that pass each other is not sheared, as the mesh rolls with them: two meshes for a way of 20
/// thicknesses of the film, the second one as the gap has narrowed. Nine where it is sheared.
#[test]
fn discs_that_pass_each_other_hardly_need_new_meshes() {
    let outcome = run(&case(
        r#"
        title = "two discs pass each other"
        geometry = "planar"
        fluid = { model = "stokes", viscosity = 1.0 }
        domain.box = { min = [-4.0, -4.0], max = [4.0, 4.0] }
        boundary = { left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }
        mesh = { size = 0.8, surface = 0.2 }
        time.unsteady = { step = 0.1, end = 2.0 }
        [[body]]
        name = "lower"
        shape.disc.radius = 1.0
        center = [-0.5, -1.05]
        motion.imposed = { velocity = [0.5, 0.0] }
        [[body]]
        name = "upper"
        shape.disc.radius = 1.0
        center = [0.5, 1.05]
        motion.imposed = { velocity = [-0.5, 0.0] }
        "#,
    ));
    let remeshes = last(&outcome, "flow.remeshes");
    assert!(remeshes <= 1.0, "{remeshes}");
}
