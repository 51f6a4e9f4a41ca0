//! What the balance of momentum records: momenta of fluid and bodies, and the forces on them.

use nalgebra::Vector3;

use super::bodies::flexible_states;
use crate::body::Mode;
use crate::coupling::{Drive, Problem, RigidBody, SurfaceLoads, flexible_report};
use crate::run::simulation::Simulation;
use crate::state::{MomentumRecord, State};
use crate::time::Bdf;

/// What the fluid has as a whole.
#[derive(Debug, Clone, Copy)]
pub(super) struct FluidMomentum {
    /// Its momentum (kg m/s).
    pub momentum: Vector3<f64>,
    /// The largest momentum at its kinetic energy (kg m/s).
    pub scale: f64,
}

/// Momenta at the state of a simulation, with these loads of the fluid.
pub(super) fn momentum_record<const D: usize>(
    problem: &Problem<D>,
    state: &State<D>,
    loads: &SurfaceLoads,
    fluid: &FluidMomentum,
) -> MomentumRecord {
    let mut exchange = loads.sides_force.norm();
    let mut momenta = vec![fluid.momentum];
    for (body, BodyMomentum { momentum, force, is_free }) in
        body_momenta(problem, state, loads).into_iter().enumerate()
    {
        let of_fluid = loads.bodies[body].load.force;
        exchange += is_free.of(&force).norm() + (of_fluid - is_free.of(&of_fluid)).norm();
        momenta.push(is_free.of(&momentum));
    }
    MomentumRecord { time: state.time, momenta, exchange, scale: fluid.scale }
}

impl<const D: usize> Simulation<D> {
    /// Notes the forces on fluid and bodies at the end of a step of these differences, with these loads of the fluid.
    pub(in crate::run) fn record_forces(&mut self, loads: &SurfaceLoads, bdf: &Bdf) {
        let Self { problem, state, work, .. } = self;
        if !problem.has_inertia {
            return;
        }
        let mean_flow = work.system.mean_flow(&problem.mean_flow_at(state.time), &state.now);
        let mean_force = mean_flow.map_or(Vector3::zeros(), |report| report.force);
        let bodies = body_momenta(problem, state, loads);
        let on_bodies = bodies.iter().map(|body| body.is_free.of(&body.force));
        let forces: Vec<Vector3<f64>> =
            std::iter::once(loads.boundary_force + mean_force).chain(on_bodies).collect();
        state.record_forces(&forces, bdf);
    }
}

/// Along which axes all forces on a body are known, and change its momentum.
#[derive(Debug, Clone, Copy)]
struct FreeAxes([bool; 3]);

impl FreeAxes {
    /// The components of a vector along them.
    fn of(self, vector: &Vector3<f64>) -> Vector3<f64> {
        Vector3::from_fn(|axis, _| if self.0[axis] { vector[axis] } else { 0.0 })
    }
}

/// A body, whose momentum (kg m/s) all forces on it (N) change.
struct BodyMomentum {
    momentum: Vector3<f64>,
    force: Vector3<f64>,
    is_free: FreeAxes,
}

fn body_momenta<const D: usize>(
    problem: &Problem<D>,
    state: &State<D>,
    loads: &SurfaceLoads,
) -> Vec<BodyMomentum> {
    let flexible = flexible_bodies(problem, state, loads);
    let of_body = |(body, rigid): (usize, &RigidBody)| {
        let external =
            rigid.external(state.time, &state.poses[body]).fixed_rows::<3>(0).into_owned();
        let held = flexible.end_forces[body] + flexible.base_forces[body];
        let contact = state.contact.wrenches[body].force;
        // Forces in joints, springs and clamps in the laboratory are not known here
        let is_alone =
            !problem.has_joints() && rigid.spring.is_none() && !flexible.is_clamped[body];
        let is_free =
            |axis: usize| is_alone && matches!(rigid.drive(Mode::along(axis)), Drive::Free);
        BodyMomentum {
            momentum: state.now.twists[body].linear * rigid.inertia.mass + flexible.momenta[body],
            force: loads.bodies[body].load.force + external + held + contact,
            is_free: FreeAxes([0, 1, 2].map(is_free)),
        }
    };
    problem.bodies.iter().enumerate().map(of_body).collect()
}

/// What bodies with coordinates have and do, by body.
struct FlexibleBodies {
    /// Momenta (kg m/s), of rigid ones zero.
    momenta: Vec<Vector3<f64>>,
    /// Forces that are given at their ends (N).
    end_forces: Vec<Vector3<f64>>,
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
        end_forces: vec![Vector3::zeros(); n],
        base_forces: vec![Vector3::zeros(); n],
        is_clamped: vec![false; n],
    };
    for (body, rigid) in problem.bodies.iter().enumerate() {
        let Some(report) = flexible_report(problem, body, &flexible_states(state, &loads.bodies))
        else {
            continue;
        };
        all.momenta[body] = report.momentum;
        all.end_forces[body] = report.end_force;
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
