//! What the balance of momentum records: momentum of fluid and bodies, and the forces on them.

use nalgebra::Vector3;

use crate::body::Mode;
use crate::coupling::{Drive, Problem, SurfaceLoads};
use crate::state::State;
use crate::state::{MomentumRecord, Part};

/// What the fluid has as a whole.
#[derive(Debug, Clone, Copy)]
pub(super) struct FluidMomentum {
    /// Its momentum (kg m/s).
    pub momentum: Vector3<f64>,
    /// Force of a mean flow on it (N).
    pub mean_force: Vector3<f64>,
    /// The largest momentum at its kinetic energy (kg m/s).
    pub scale: f64,
}

/// Momentum and forces at the state of a simulation.
pub(super) fn momentum_record<const D: usize>(
    problem: &Problem<D>,
    state: &State<D>,
    loads: &SurfaceLoads,
    fluid: &FluidMomentum,
) -> MomentumRecord {
    let mut exchange = loads.sides_force.norm();
    let mut bodies = Vec::new();
    for (body, rigid) in problem.bodies.iter().enumerate() {
        let external =
            rigid.external(state.time, &state.poses[body]).fixed_rows::<3>(0).into_owned();
        let fluid = loads.bodies[body].load.force;
        let others = fluid + external;
        let force = others + state.contact.wrenches[body].force;
        // Forces in joints, springs and clamps are not known here
        let is_alone =
            !problem.has_joints() && rigid.spring.is_none() && rigid.flexible().is_none();
        let counts =
            |axis: usize| is_alone && matches!(rigid.drive(Mode::along(axis)), Drive::Free);
        let along = |vector: &Vector3<f64>| {
            Vector3::from_fn(|i, _| if counts(i) { vector[i] } else { 0.0 })
        };
        let momentum = state.now.twists[body].linear * rigid.inertia.mass;
        let contact = state.contact.impulses.get(body).map_or(Vector3::zeros(), along);
        let part = Part { momentum: along(&momentum), force: along(&others), contact };
        exchange += along(&force).norm() + (fluid - along(&fluid)).norm();
        bodies.push(part);
    }
    MomentumRecord {
        time: state.time,
        fluid: Part {
            momentum: fluid.momentum,
            force: loads.boundary_force + fluid.mean_force,
            contact: Vector3::zeros(),
        },
        bodies,
        exchange,
        scale: fluid.scale,
    }
}
