//! The local error of a step, from its difference from a prediction of the same order.

use super::state::State;
use super::stepper::{Step, TimeStepper};
use crate::body::Mode;
use crate::coupling::Solution;

/// Speed over the largest so far below which the error of a step is no longer relative to it.
const NEARLY_AT_REST: f64 = 1e-3;

/// Estimate of the error of a step, relative to the size of the velocities; zero for a step of first
/// order.
pub(super) fn local_error<const D: usize>(
    stepper: &TimeStepper<'_, D>,
    state: &State<D>,
    step: &Step,
    new: &Solution<D>,
) -> f64 {
    let bdf = &step.bdf;
    if !bdf.is_second_order() {
        return 0.0;
    }
    // What has come to rest is not to be followed down to rounding
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
        let rate = state.accelerations[body];
        let predicted = bdf.predict(now.to_vector(), before.to_vector(), rate.to_vector());
        for mode in stepper.problem.modes().iter() {
            let off = new.component(mode) - predicted[mode];
            largest = largest.max(stepper.path.length_of(body, mode) * off.abs());
        }
    }
    bdf.error_share() * largest / scale
}

impl<const D: usize> super::mesh_path::MeshPath<'_, D> {
    /// Length by which a rigid motion counts as a displacement of the surface (m): the reach of the body
    /// for rotations, where the mesh follows bodies.
    pub(super) fn length_of(&self, body: usize, mode: Mode) -> f64 {
        if !mode.is_rotation() {
            return 1.0;
        }
        self.moving_mesh().map_or(0.0, |moving| moving.gaps().reach(body))
    }
}
