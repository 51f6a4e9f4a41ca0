//! What a step in time leaves in the flow and in the ways of bodies: by how much they leave a line.
//!
//! A step is right to second order, so that its error is in proportion to the second difference of the velocity: what the new
//! velocity differs by from that on the line through the two before. It counts with a factor that was measured.

use super::error_estimate::pose_errors;
use crate::body::{Mode, Pose, RigidVector};
use crate::case::Convection;
use crate::coupling::{Problem, Solution};
use crate::state::{ErrorOfChange, SquaredError, State, StepErrors};
use crate::step::context::StepContext;
use crate::step::stepper::{Step, TimeStepper};

/// Error over second difference, with convection extrapolated: in the lift of `dfg-2d-2` with `mesh.scale = 2` it was 3.3,
/// 3.3, 2.5 and 2.3 times with steps of 0.0025, 0.005, 0.01 and 0.02.
const EXTRAPOLATED: f64 = 3.0;

/// The same by Newton's method, where it was 1.3 and 1.8 times with steps of 0.01 and 0.02, or without convection.
const IMPLICIT: f64 = 1.3;

/// Error over first difference by the implicit Euler method: it lags by half a step.
const FIRST_ORDER: f64 = 0.5;

/// Steps after the start that say nothing of the flow: what it is set in motion by there, it forgets.
const START_STEPS: usize = 20;

/// By how much a quantity is wrong where it has a second difference of one, by a method of second order.
#[must_use]
pub fn error_of_second_difference<const D: usize>(
    problem: &Problem<D>,
    convection: Convection,
) -> f64 {
    if convection == Convection::Extrapolated && problem.has_convection {
        EXTRAPOLATED
    } else {
        IMPLICIT
    }
}

impl<const D: usize> StepContext<'_, D> {
    /// The errors of a step to a flow and to poses; none after a jump.
    pub(in crate::step) fn step_errors(&self, new: &Solution<D>, reached: &[Pose]) -> StepErrors {
        let Self { stepper, state, history, .. } = self;
        let step = &history.step;
        let errors = if step.bdf.is_second_order() {
            pose_errors(state, step, reached)
        } else {
            first_order_pose_errors(state, step, reached)
        };
        let flow = if stepper.problem.has_inertia && state.step >= START_STEPS {
            SquaredError {
                error: step.bdf.step * self.squared_flow_error(new),
                size: step.bdf.step * mean(new.velocity.iter().map(|now| now.norm_squared())),
            }
        } else {
            SquaredError::default()
        };
        StepErrors { flow, ways: stepper.errors_of_ways(state, reached, &errors) }
    }

    /// Mean square over the nodes of the error of the velocity (m2/s2).
    fn squared_flow_error(&self, new: &Solution<D>) -> f64 {
        let Self { stepper, state, history, .. } = self;
        let step = &history.step;
        if state.last_step == 0.0 {
            return 0.0;
        }
        let (growth, share) = if step.bdf.is_second_order() {
            (growth(state, step), error_of_second_difference(stepper.problem, stepper.convection))
        } else {
            (0.0, FIRST_ORDER)
        };
        let levels = state.now.velocity.iter().zip(&state.previous.velocity);
        let off = new.velocity.iter().zip(levels);
        let squares =
            off.map(|(new, (now, before))| (new - now - (now - before) * growth).norm_squared());
        share * share * mean(squares)
    }
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.sum::<f64>() / count
}

/// The step over the one before; 0 where there is none that counts.
fn growth<const D: usize>(state: &State<D>, step: &Step) -> f64 {
    if state.last_step > 0.0 { step.bdf.step / state.last_step } else { 0.0 }
}

/// The same as [`pose_errors`] of a step of first order: over its difference from a line through two poses before.
fn first_order_pose_errors<const D: usize>(
    state: &State<D>,
    step: &Step,
    reached: &[Pose],
) -> Vec<RigidVector> {
    let growth = growth(state, step);
    let share = growth / (1.0 + growth);
    let levels = state.poses.iter().zip(&state.previous_poses);
    let errors = reached.iter().zip(levels).map(|(reached, (now, before))| {
        (reached.displacement_from(now) - now.displacement_from(before) * growth) * share
    });
    errors.collect()
}

impl<const D: usize> TimeStepper<'_, D> {
    /// Errors of new poses beside the ways to them; rotations count by the reach of a body.
    pub(in crate::step) fn errors_of_ways(
        &self,
        state: &State<D>,
        reached: &[Pose],
        errors: &[RigidVector],
    ) -> Vec<ErrorOfChange> {
        let length = |body: usize, vector: &RigidVector| {
            let part = |mode: Mode| self.path.length_of(body, mode) * vector[mode];
            self.problem.modes().iter().map(|mode| part(mode).powi(2)).sum::<f64>().sqrt()
        };
        let ways = reached.iter().zip(&state.poses).zip(errors).enumerate();
        ways.map(|(body, ((reached, now), error))| ErrorOfChange {
            error: length(body, error),
            change: length(body, &reached.displacement_from(now)),
        })
        .collect()
    }
}
