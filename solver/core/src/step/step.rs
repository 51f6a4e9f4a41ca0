//! One time step: backward differences for fluid and bodies together, convection extrapolated or by Newton's method.
//!
//! The poses of the bodies are found by a fixed-point iteration. Predicted to second order, they give the mesh; on it fluid,
//! bodies and contact are one system, linear but for contact and for convection by Newton's method; its velocities
//! give the poses again. The iteration ends where they differ from those of the mesh by 1e-3 of an edge, or 6e-3 in contact.
//!
//! The mesh velocity w is the backward difference of the positions of the nodes, the same as for the
//! flow: a uniform flow stays uniform, and on the surface of a body w has the body's velocity (that of
//! its centre where it is round, but for the rolling of its mesh). The mesh may also travel with a body as a
//! whole (`frame`); the unknown stays the velocity seen from the laboratory, so that no inertial force
//! appears.

use super::context::StepContext;
use super::error::StepError;
use super::placement::Passes;
use super::stepper::{StepResult, TimeStepper};
use super::workspace::Workspace;
use crate::state::State;
use crate::time::Bdf;

/// Most iterations for the poses.
const MAX_POSE_ITERATIONS: usize = 12;

impl<const D: usize> TimeStepper<'_, D> {
    /// What a step of `bdf` leads to from a state, which stays as it is.
    ///
    /// # Errors
    /// When the system is singular, the solution not finite, Newton's method stalls, the mesh
    /// degenerates, a gait fails, or contact forces or poses of bodies are not found.
    pub fn advance(
        &self,
        work: &mut Workspace<D>,
        state: &State<D>,
        bdf: Bdf,
    ) -> Result<StepResult<D>, StepError> {
        let step = StepContext::new(*self, state, bdf)?;
        let mut contact = step.contact_method(work);
        let mut passes = Passes::default();
        let mut iterate = step.predict(work)?;
        for _ in 0..MAX_POSE_ITERATIONS {
            self.check_stop(state)?;
            step.keep_gaps_open(&mut iterate)?;
            let mut configuration = step.place(work, iterate.placement)?;
            let flow = step.solve(work, &mut configuration, contact.as_mut(), iterate.guess)?;
            let reached = step.integrate(&flow.solution)?;
            if step.has_converged(&configuration.placement, &reached, &flow.contact) {
                return step.finish(work, &configuration, flow, reached);
            }
            iterate = step.iterate_again(configuration, flow, reached, &mut passes)?;
        }
        Err(StepError::PosesNotConverged { iterations: MAX_POSE_ITERATIONS })
    }
}
