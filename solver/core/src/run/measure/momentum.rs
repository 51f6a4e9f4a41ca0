//! What the balance of momentum records: momentum of fluid and bodies, and the forces on them.

use nalgebra::Vector3;

use super::bodies::flexible_states;
use crate::body::Mode;
use crate::coupling::{Drive, Problem, SurfaceLoads, flexible_report};
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
    let flexible = flexible_bodies(problem, state, loads);
    let mut bodies = Vec::new();
    for (body, rigid) in problem.bodies.iter().enumerate() {
        let external =
            rigid.external(state.time, &state.poses[body]).fixed_rows::<3>(0).into_owned();
        let fluid = loads.bodies[body].load.force;
        let others = fluid + external + flexible.base_forces[body];
        let force = others + state.contact.wrenches[body].force;
        // Forces in joints, springs and clamps in the laboratory are not known here
        let is_alone =
            !problem.has_joints() && rigid.spring.is_none() && !flexible.is_clamped[body];
        let counts =
            |axis: usize| is_alone && matches!(rigid.drive(Mode::along(axis)), Drive::Free);
        let along = |vector: &Vector3<f64>| {
            Vector3::from_fn(|i, _| if counts(i) { vector[i] } else { 0.0 })
        };
        let momentum = state.now.twists[body].linear * rigid.inertia.mass + flexible.momenta[body];
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

/// What bodies with coordinates have and do, by body.
struct FlexibleBodies {
    /// Momenta (kg m/s), of rigid ones zero.
    momenta: Vec<Vector3<f64>>,
    /// Forces on bodies by bases that are attached to them, and on what has these bases (N).
    base_forces: Vec<Vector3<f64>>,
    /// Whether the laboratory holds a body by its base.
    is_clamped: Vec<bool>,
}

fn flexible_bodies<const D: usize>(
    problem: &Problem<D>,
    state: &State<D>,
    loads: &SurfaceLoads,
) -> FlexibleBodies {
    let n = problem.bodies.len();
    let mut all = FlexibleBodies {
        momenta: vec![Vector3::zeros(); n],
        base_forces: vec![Vector3::zeros(); n],
        is_clamped: vec![false; n],
    };
    for (body, rigid) in problem.bodies.iter().enumerate() {
        let Some(report) = flexible_report(problem, body, &flexible_states(state, &loads.bodies))
        else {
            continue;
        };
        all.momenta[body] = report.momentum;
        match (&rigid.attachment, report.base) {
            (Some(attachment), Some(base)) => {
                all.base_forces[body] += base.load.force;
                all.base_forces[attachment.to] -= base.load.force;
            }
            (None, Some(_)) => all.is_clamped[body] = true,
            (_, None) => {}
        }
    }
    all
}
