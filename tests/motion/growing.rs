//! Gaps that close without contact: meshes do not grow without bound, and what is left goes on with more.

use std::sync::{Arc, Mutex};

use alewife_core::run::{
    AllowedBy, Dimension, LastState, Observer, RunError, SavedState, Snapshot, Solve, build_mesh,
    simulate, simulate_from,
};
use tests::cases::case;

const PLANE: &str = r#"
    geometry = "planar"
    domain.box = { min = [-2.0, 0.0], max = [2.0, 4.0] }
    boundary = { left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }
    body = [{ name = "disc", shape.disc.radius = 0.5, center = [0.0, 0.8], motion = "free", force = [0.0, -10.0] }]
    mesh = { size = 0.8, surface = 0.25, growth = 0.4"#;
const AXIS: &str = r#"
    geometry = "axisymmetric"
    domain.cylinder = { x = [0.0, 4.0], radius = 2.0 }
    boundary = { left = "no-slip", right = "no-slip", wall = "no-slip" }
    body = [{ name = "sphere", shape.sphere.radius = 0.5, center = [0.8, 0.0], motion = "free", force = [-10.0, 0.0] }]
    mesh = { size = 0.8, surface = 0.25, growth = 0.4"#;
const SPACE: &str = r#"
    geometry = "spatial"
    domain.sphere.radius = 2.0
    boundary.wall = "no-slip"
    body = [{ name = "egg", shape.ellipsoid.semi_axes = [0.6, 0.5, 0.5], center = [0.0, -1.2, 0.1], motion = "free", force = [0.0, -30.0, 0.0] }]
    mesh = { size = 1.2, surface = 0.5, growth = 0.7, gap_layers = 1.5"#;

/// Keeps the state that a run leaves.
struct Keeper<const D: usize>(Arc<Mutex<Option<SavedState<D>>>>);

impl<const D: usize> Observer<D> for Keeper<D> {
    fn on_step(&mut self, _: &Snapshot<'_, D>) -> std::io::Result<()> {
        Ok(())
    }

    fn on_failure(&mut self, _: &RunError, last: Option<&LastState<'_, D>>) -> std::io::Result<()> {
        *self.0.lock().expect("nobody else holds it") = last.and_then(|last| last.saved.cloned());
        Ok(())
    }
}

/// A body sinks on to a wall, with a few cells more than its first mesh has; what is left goes on for two steps when
/// it may have more.
fn sinks<const D: usize>(text: &str, step: f64)
where
    Dimension<D>: Solve<D>,
{
    let with = |max_cells: usize, end: f64| {
        case(&format!(
            "title = 'a body sinks on to a wall'\nunits = 'dimensionless'\n\
             fluid = {{ model = 'stokes', viscosity = 1.0 }}\n\
             time.unsteady = {{ step = {step}, end = {end} }}\n{text}, max_cells = {max_cells} }}"
        ))
    };
    let first = build_mesh::<D>(&with(10_000_000, 1.0)).expect("it is meshed").n_cells();
    let too_many =
        simulate::<D>(&with(first / 2, 1.0), &mut []).expect_err("the first mesh has more");
    let RunError::BeyondMaxCells { most, .. } = too_many else { panic!("{too_many}") };
    assert_eq!(most, first / 2);

    let kept = Arc::new(Mutex::new(None));
    let keeper = Keeper::<D>(Arc::clone(&kept));
    let error = simulate(&with(first + first / 50, 100.0 * step), &mut [Box::new(keeper)])
        .expect_err("the gap closes");
    let said = error.to_string();
    let RunError::MeshTooLarge { n_cells, allowed, time, .. } = error else { panic!("{said}") };
    assert_eq!(allowed.by, AllowedBy::Case);
    assert!(n_cells > allowed.most && time > 0.0, "{said}");
    for words in ["step ", "(t = ", "the smallest gap, ", "between `", "[contact]", "max_cells"] {
        assert!(said.contains(words), "{words}: {said}");
    }
    let state = kept.lock().expect("the run is over").take().expect("there is a state");
    assert_eq!(state.time(), time);
    let more = with(10 * first, time + 2.0 * step);
    let outcome = simulate_from(&more, Some(&state), &mut []).expect("there is room for more");
    let remeshes = outcome.series.column("flow.remeshes").expect("the mesh moves");
    assert!(outcome.steps > state.step() && remeshes.last() > Some(&0.0), "{remeshes:?}");
}

#[test]
fn a_disc_that_sinks_on_to_a_wall_has_no_meshes_without_end() {
    sinks::<2>(PLANE, 0.05);
}

#[test]
fn a_sphere_on_the_axis_has_no_meshes_without_end() {
    sinks::<2>(AXIS, 0.05);
}

#[test]
fn an_ellipsoid_in_space_has_no_meshes_without_end() {
    sinks::<3>(SPACE, 0.05);
}
