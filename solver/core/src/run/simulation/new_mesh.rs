//! A new mesh of a simulation, where the present one would not do.

use super::{Simulation, fluid_system, stepper};
use crate::coupling::BodyShapes;
use crate::motion::{RemeshError, replace_mesh};
use crate::run::error::RunError;
use crate::run::watch::{AtHand, nearest_gap};
use crate::step::StepResult;
use crate::time::Bdf;
use crate::timing::Stage;

/// Part of the last step in which velocities change by next to nothing: a step of this size gives those of the present.
const INSTANT: f64 = 1e-6;

impl<const D: usize> Simulation<D> {
    /// Replaces the mesh before a step where it would not do, one whose error is within a tolerance.
    ///
    /// # Errors
    /// When there is no new mesh, or one that is too large.
    pub(super) fn remesh_where_needed(&mut self, tolerance: f64) -> Result<(), RunError> {
        let Self { problem, state, work, moving_mesh: Some(moving), .. } = self else {
            return Ok(());
        };
        let shapes = BodyShapes::with(&problem.bodies, state.time, &state.shapes.now)?;
        let reason =
            work.timing.measure(Stage::MeshMotion, || moving.remesh_reason(state, &shapes));
        match reason {
            None => Ok(()),
            Some(reason) => self.remesh(&reason, tolerance),
        }
    }

    /// The same for a reason.
    ///
    /// # Errors
    /// As above.
    pub(super) fn remesh(&mut self, reason: &str, tolerance: f64) -> Result<(), RunError> {
        let Self {
            problem, state, work, moving_mesh: Some(moving), scheme, law, cell_bound, ..
        } = self
        else {
            return Ok(());
        };
        let (step, time) = (state.step, state.time);
        let n_cells = state.mesh.n_cells();
        let at_hand = AtHand { n_cells, is_iterative: work.system.is_iterative() };
        let allowed = cell_bound.allowed::<D>(at_hand);
        let most = allowed.cells();
        let made = work.timing.measure(Stage::Mesh, || replace_mesh(problem, state, moving, most));
        *moving = made.map_err(|error| match error {
            RemeshError::TooManyCells { n_cells, .. } => RunError::MeshTooLarge {
                step,
                time,
                n_cells,
                allowed,
                reason: reason.to_owned(),
                nearest: nearest_gap(state, moving),
                closes: law.is_none(),
            },
            error => RunError::Remesh { step, time, reason: Box::new(error) },
        })?;
        tracing::info!(step, time, cells = state.mesh.n_cells(), reason, "remeshed");
        if let Some(scalars) = &mut self.scalars {
            scalars.forget_mesh();
        }
        work.mesh = state.mesh.clone();
        work.system = work.timing.measure(Stage::Assembly, || {
            // A state on a new mesh with the solver of the old one would not be one
            fluid_system(problem, state, Some(moving), scheme.unknown_frame, || Ok(()))
        })?;
        self.is_fresh = true;
        if tolerance.is_finite() {
            self.find_flow_again();
        }
        Ok(())
    }

    /// Without inertia velocities have no memory: on a new mesh they differ by what the meshes leave of them. The error of
    /// a step, whatever its size, would be that difference, so that they are found again at present, where there was
    /// a step before.
    fn find_flow_again(&mut self) {
        let Self { problem, state, work, moving_mesh, law, scheme, stop, .. } = self;
        if problem.has_inertia || state.last_step == 0.0 {
            return;
        }
        let stepper = stepper(problem, *scheme, moving_mesh.as_ref(), law.as_ref(), stop.as_ref());
        let instant = Bdf::after(INSTANT * state.last_step, 0.0);
        // What fails here does so in the step that follows, which says why
        if let Ok(StepResult { level, .. }) = stepper.advance(work, state, instant) {
            state.replace_flow(level.solution);
        }
    }
}
