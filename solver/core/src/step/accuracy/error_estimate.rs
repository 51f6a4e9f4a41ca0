//! The local error of a step, from its difference from a prediction of the same order.

use crate::body::{Mode, Pose, RigidVector};
use crate::contact::Gaps;
use crate::coupling::Solution;
use crate::state::State;
use crate::step::mesh_path::MeshPath;
use crate::step::stepper::{Step, TimeStepper};

/// An error of the smallest gap, relative to it, counts as one of the velocities so many times as
/// large: while a gap closes its errors have one sign and add up, over some seventy steps from a
/// radius to a hundredth of it.
const WEIGHT_OF_GAPS: f64 = 10.0;

/// Speed over the largest so far, or still to be given, below which the error of a step is no longer relative to it.
pub const NEARLY_AT_REST: f64 = 1e-3;

/// Rounding of the places of an elastic body over its size: forces that are differences of large ones amplify that of a
/// number.
const ROUNDING_OF_PLACES: f64 = 1e-12;

/// Estimate of the error of a step, relative to the size of the velocities; zero for a step of first
/// order.
pub(in crate::step) fn local_error<const D: usize>(
    stepper: &TimeStepper<'_, D>,
    state: &State<D>,
    step: &Step,
    new: &Solution<D>,
) -> f64 {
    let bdf = &step.bdf;
    if !bdf.is_second_order() {
        return 0.0;
    }
    // What comes to rest, or begins, is not to be followed down to rounding
    let scale = new.top_speed().max(NEARLY_AT_REST * state.top_speed);
    if scale == 0.0 {
        return 0.0;
    }
    let mut squares = 0.0;
    if stepper.problem.has_inertia {
        for (node, new) in new.velocity.iter().enumerate() {
            let (now, before) = (state.now.velocity[node], state.previous.velocity[node]);
            squares += (new - bdf.predict(now, before, state.rates[node])).norm_squared();
        }
        squares /= new.velocity.len() as f64;
    }
    let mut largest = squares.sqrt();
    for (body, new) in new.twists.iter().enumerate() {
        let (now, before) = (state.now.twists[body], state.previous.twists[body]);
        let rate = state.twist_rates[body];
        let predicted = bdf.predict(now.to_vector(), before.to_vector(), rate.to_vector());
        for mode in stepper.problem.modes().iter() {
            let off = new.component(mode) - predicted[mode];
            largest = largest.max(stepper.path.length_of(body, mode) * off.abs());
        }
    }
    if !new.rates.is_empty() {
        largest = largest.max(stepper.error_of_rates(state, step, new));
        largest = (largest - stepper.rounding_of_speeds(step)).max(0.0);
    }
    bdf.error_share() * largest / scale
}

impl<const D: usize> TimeStepper<'_, D> {
    /// Speed (m/s) within which a step does not tell those of bodies with coordinates: their velocities are differences of
    /// places.
    fn rounding_of_speeds(&self, step: &Step) -> f64 {
        let reach = |body: usize| self.path.length_of(body, Mode::AboutZ);
        let largest = (0..self.problem.bodies.len()).map(reach).fold(0.0, f64::max);
        ROUNDING_OF_PLACES * largest * step.bdf.next
    }

    /// Largest difference (m/s) on bodies with coordinates between the velocity that their rates give and a prediction.
    fn error_of_rates(&self, state: &State<D>, step: &Step, new: &Solution<D>) -> f64 {
        let Some(moving) = self.path.moving_mesh().filter(|_| !new.rates.is_empty()) else {
            return 0.0;
        };
        let levels = state.now.rates.iter().zip(&state.previous.rates);
        let levels = levels.zip(&state.shapes.accelerations).zip(&new.rates);
        let off: Vec<f64> = levels
            .map(|(((now, before), rate), new)| new - step.bdf.predict(*now, *before, *rate))
            .collect();
        moving.fastest(&self.problem.bodies, &state.shapes.now, &off)
    }
}

/// Estimate of the errors of the poses that a step of BDF2 leads to.
pub(in crate::step) fn pose_errors<const D: usize>(
    state: &State<D>,
    step: &Step,
    reached: &[Pose],
) -> Vec<RigidVector> {
    let bdf = &step.bdf;
    let error = |(body, reached): (usize, &Pose)| {
        let (now, before) = (&state.poses[body], &state.previous_poses[body]);
        let last = now.displacement_from(before);
        let rate = state.now.twists[body].to_vector();
        let predicted = bdf.predict(RigidVector::zeros(), -last, rate);
        (reached.displacement_from(now) - predicted) * bdf.error_share()
    };
    reached.iter().enumerate().map(error).collect()
}

impl<const D: usize> TimeStepper<'_, D> {
    /// The change of the smallest gap by errors of poses, relative to it or to the range of contact
    /// where that is larger, as it counts beside errors of velocities.
    pub(in crate::step) fn gap_error(
        &self,
        gaps: Option<&dyn Gaps>,
        state: &State<D>,
        poses: &[Pose],
        errors: &[RigidVector],
    ) -> f64 {
        let Some(gaps) = gaps else { return 0.0 };
        let gap = |poses: &[Pose]| gaps.minimum_gap(&state.in_own_frame(self.problem, poses));
        let corrected: Vec<Pose> = poses
            .iter()
            .zip(errors)
            .enumerate()
            .map(|(body, (pose, error))| pose.displaced(&self.restricted(body, &-error)))
            .collect();
        let (Some(found), Some(corrected)) = (gap(poses), gap(&corrected)) else { return 0.0 };
        let range = self.contact.map_or(0.0, |law| law.range());
        let size = found.gap.max(range);
        if size > 0.0 { WEIGHT_OF_GAPS * (found.gap - corrected.gap).abs() / size } else { 0.0 }
    }
}

impl<const D: usize> MeshPath<'_, D> {
    /// Length by which a rigid motion counts as a displacement of the surface (m): the reach of the body
    /// for rotations, where the mesh follows bodies.
    pub(in crate::step) fn length_of(&self, body: usize, mode: Mode) -> f64 {
        if !mode.is_rotation() {
            return 1.0;
        }
        self.moving_mesh().map_or(0.0, |moving| moving.gaps().reach(body))
    }
}
