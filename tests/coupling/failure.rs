//! A run that fails says what, and hands its last fields to those who look on.

use std::sync::{Arc, Mutex};

use alewife_core::run::{LastState, Observer, RunError, Snapshot, simulate};
use alewife_core::step::FlowError;
use tests::cases::case;

/// Remembers the largest speed and the reason of a failure.
struct Witness(Arc<Mutex<Option<(f64, String)>>>);

impl Observer<2> for Witness {
    fn on_step(&mut self, _snapshot: &Snapshot<'_, 2>) -> std::io::Result<()> {
        Ok(())
    }

    fn on_failure(
        &mut self,
        error: &RunError,
        remains: Option<&LastState<'_, 2>>,
    ) -> std::io::Result<()> {
        let fields = remains.expect("the mesh was made before the failure");
        let speed = fields.velocity.iter().map(|velocity| velocity.norm()).fold(0.0, f64::max);
        *self.0.lock().expect("nobody else holds it") = Some((speed, error.to_string()));
        Ok(())
    }
}

/// One iteration is too few at every part of the density, however small.
#[test]
fn a_stalled_newton_method_is_an_error_that_shows_the_last_flow_that_was_found() {
    let case = case(
        r#"
        title = "driven cavity"
        geometry = "planar"
        fluid = { model = "navier-stokes", density = 1.0, viscosity = 1e-4 }
        domain.box = { min = [0.0, 0.0], max = [1.0, 1.0] }
        mesh = { size = 0.2 }
        time.steady = { max_iterations = 1 }
        boundary.top.velocity.value = [1.0, 0.0]
        boundary.left = "no-slip"
        boundary.right = "no-slip"
        boundary.bottom = "no-slip"
        "#,
    );
    let seen = Arc::new(Mutex::new(None));
    let mut observers: Vec<Box<dyn Observer<2>>> = vec![Box::new(Witness(Arc::clone(&seen)))];
    let error = simulate(&case, &mut observers).expect_err("one iteration is too few");
    assert!(matches!(error, RunError::Flow(FlowError::NewtonStalled { .. })), "{error}");
    let (speed, reason) = seen.lock().expect("the run is over").take().expect("it was reported");
    // That of the lid
    assert!((speed - 1.0).abs() < 1e-9, "largest speed {speed}");
    assert!(reason.contains("refine the mesh"), "{reason}");
    assert!(reason.contains("found, without convection, is in failure/flow.vtu"), "{reason}");
}

/// Stokes flow with open sides all around may drift with the body at any speed.
#[test]
fn a_system_without_a_solution_names_what_is_not_determined() {
    let case = case(
        r#"
        title = "nothing holds the fluid"
        geometry = "planar"
        fluid = { model = "stokes", density = 1.0, viscosity = 0.01, gravity = [0.0, -1.0] }
        domain.box = { min = [0.0, 0.0], max = [1.0, 1.0] }
        boundary = { bottom = "do-nothing", top = "do-nothing", right = "do-nothing", left = "do-nothing" }
        mesh = { size = 0.2, surface = 0.05 }
        time.steady = {}
        [[body]]
        name = "disc"
        shape.disc = { radius = 0.1 }
        center = [0.5, 0.5]
        motion = "free"
        density = 2.0
        "#,
    );
    let error = simulate::<2>(&case, &mut []).expect_err("the body may drift");
    assert!(matches!(error, RunError::Flow(FlowError::Singular { .. })), "{error}");
    let message = error.to_string();
    assert!(message.contains("velocity of body \"disc\""), "{message}");
    assert!(message.contains("a wall, a given velocity"), "{message}");
}

#[test]
fn a_flow_that_blows_up_stops_the_run_with_the_place() {
    let case = case(
        r#"
        title = "a disc in a stream that its mesh does not resolve"
        geometry = "planar"
        fluid = { model = "navier-stokes", density = 1.0, viscosity = 1e-6 }
        domain.channel = { length = 2.2, height = 0.41 }
        boundary = { left.parabolic.peak = 1.5, right = "do-nothing", bottom = "no-slip", top = "no-slip" }
        mesh = { size = 0.05, surface = 0.02 }
        time.unsteady = { step = 0.01, end = 2.0 }
        [[body]]
        name = "disc"
        shape.disc.radius = 0.05
        center = [0.2, 0.2]
        motion = "held"
        "#,
    );
    let error = simulate::<2>(&case, &mut []).expect_err("it blows up");
    let RunError::BlownUp { time, near, cell_reynolds, .. } = &error else {
        panic!("{error}");
    };
    assert!(*time < 1.5 && near.len() == 2 && *cell_reynolds > 1e3, "{error}");
    assert!(error.to_string().contains("the flow has blown up"), "{error}");
}
