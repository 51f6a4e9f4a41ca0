//! Where bodies in contact get to: velocities that are extrapolated know nothing of how contact changes in the step.
//!
//! Contact is solved for as after the flow, with a mobility that is estimated, and all other loads on the bodies stay as they
//! are. With the inertia M, the resistance R and the acceleration a of the present level, the load that extrapolated
//! velocities V imply beside those is
//!
//! f + (M rate + R) (V - U) + M (rate U + h - a),
//!
//! with velocities U and loads f of contact at present, and h the older part of the rate of velocities.

use nalgebra::DMatrix;

use super::contact_estimate::Bodies;
use super::contact_rows::Rows;
use super::contact_step::{candidate_bodies, loaded_bodies};
use super::history::StepHistory;
use super::predict::{integrate_poses, predicted_twists};
use super::state::State;
use super::stepper::TimeStepper;
use super::workspace::Workspace;
use crate::body::{Pose, Twist};
use crate::contact::{ContactStep, Gaps};
use crate::coupling::BodiesAt;

/// Poses at the new time of bodies that would get to `poses` with extrapolated velocities, changed where there may be
/// contact. None where there is none, or where it is not found.
pub(super) fn predict_contact<const D: usize>(
    stepper: &TimeStepper<'_, D>,
    work: &Workspace<D>,
    state: &State<D>,
    history: &StepHistory<D>,
    gaps: Option<&dyn Gaps>,
    poses: &[Pose],
) -> Option<Vec<Pose>> {
    let (law, gaps) = (stepper.contact?, gaps?);
    let (problem, bdf) = (stepper.problem, &history.step.bdf);
    let origin = state.origin_at(problem, poses);
    let [from, to] = [&state.poses[..], poses].map(|poses| state.in_frame(&origin, poses));
    let bodies = candidate_bodies(gaps, law, [&from, &to], &state.contact);
    if bodies.is_empty() {
        return None;
    }
    let rows = Rows { bodies: &bodies, modes: problem.modes() };
    let equations = history.body_equations(problem, &state.poses);
    let estimated = Bodies {
        gaps,
        law,
        bodies: &bodies,
        motions: free_motions(stepper, work, state, history, gaps, &bodies),
        equations: &equations,
        viscosity: problem.viscosity,
    };
    let mut twists = predicted_twists(stepper, state, &history.step);
    let [now, then] = [&state.now.twists, &twists].map(|twists| rows.of_twists(twists));
    let older = rows.of(|body| equations.bodies[body].history);
    let rates = &now * bdf.next + older - rows.of_twists(&state.accelerations);
    let loads = rows.of(|body| state.contact.wrenches[body].to_vector());
    let resistance = estimated.resistance_at(&to);
    let implied = loads + &resistance * (&then - now) + estimated.inertia() * rates;
    let mobility = estimated.mobility(&resistance);
    let pushed = &mobility * implied;
    let predicted_velocity = |&body: &usize| {
        state.poses[body].velocity_to(bdf, &poses[body], &state.previous_poses[body])
    };
    let contact = ContactStep {
        gaps,
        law,
        modes: rows.modes,
        bodies: &bodies,
        free_velocities: &rows.twists(&(then - &pushed)),
        mobility: &mobility,
        predicted: &to,
        predicted_velocities: &bodies.iter().map(predicted_velocity).collect::<Vec<_>>(),
        coefficient: 1.0 / bdf.next,
        start: &from,
    };
    let found = contact.solve().ok()?;
    let change = mobility * rows.of(|body| found.loads.wrenches[body].to_vector()) - pushed;
    for (&body, change) in bodies.iter().zip(rows.twists(&change)) {
        twists[body] = Twist::from_vector(&(twists[body].to_vector() + change.to_vector()));
    }
    Some(integrate_poses(stepper, state, &history.step, &twists))
}

/// How the velocities of bodies follow from those that are free.
fn free_motions<const D: usize>(
    stepper: &TimeStepper<'_, D>,
    work: &Workspace<D>,
    state: &State<D>,
    history: &StepHistory<D>,
    gaps: &dyn Gaps,
    bodies: &[usize],
) -> DMatrix<f64> {
    let in_mesh = state.in_mesh(&state.poses);
    let at = BodiesAt { poses: &in_mesh, shapes: history.boundary_shapes() };
    let constraints = work.system.constraints(stepper.problem, &work.mesh, at);
    work.system.free_motions(&constraints, &loaded_bodies(gaps, bodies))
}
