//! `PresentGaps`: gaps between the bodies of a state, with the shapes and the places they have in its mesh.

use super::moving_mesh::{GapsAt, MovingMesh};
use crate::body::MeshPoses;
use crate::contact::{ContactPair, Partner};
use crate::coupling::{BodyShapes, Problem, ShapeError};
use crate::state::State;

/// Gaps between the bodies of a state, and walls. Sides travel with the frame, if there is one, and bodies are in the
/// mesh by whole periods away from their poses: who asks for these gaps has neither to think of.
pub struct PresentGaps<'a> {
    gaps: GapsAt<'a>,
    poses: MeshPoses,
}

impl<const D: usize> MovingMesh<D> {
    /// Gaps between the bodies of a state, and walls.
    ///
    /// # Errors
    /// When a gait gives its body no shape.
    pub fn present_gaps(
        &self,
        problem: &Problem<D>,
        state: &State<D>,
    ) -> Result<PresentGaps<'_>, ShapeError> {
        let shapes = BodyShapes::with(&problem.bodies, state.time, &state.shapes.now)?;
        let poses = state.in_own_frame(problem, &state.poses);
        Ok(PresentGaps { gaps: self.gaps_at(&shapes), poses })
    }
}

impl PresentGaps<'_> {
    /// All close pairs of points with gaps below `range` (m).
    #[must_use]
    pub fn pairs(&self, range: f64) -> Vec<ContactPair> {
        self.gaps.pairs(&self.poses, range)
    }

    /// The smallest gap (m) between two of these bodies, those on one pivot left out; `None` where there are no such two.
    #[must_use]
    pub fn minimum_gap_among(&self, bodies: &[usize]) -> Option<f64> {
        self.gaps.minimum_gap_among(&self.poses, bodies)
    }

    /// Name of a body or wall.
    #[must_use]
    pub fn partner_name(&self, partner: Partner) -> &str {
        self.gaps.partner_name(partner)
    }
}
