//! `MeshPath`: how the nodes of the mesh move in a step.

use alewife_mesh::{NodeId, Point};

use super::error::StepError;
use super::placement::Placement;
use super::workspace::Workspace;
use crate::body::{Pose, on_mesh};
use crate::contact::ContactLoads;
use crate::coupling::{BodyShapes, Problem, RigidBody};
use crate::motion::{GapsAt, MovingMesh};
use crate::state::State;
use crate::timing::Stage;

/// Largest difference of poses at convergence, over the shortest edge on the body.
const TOLERANCE: f64 = 1e-3;
/// The same where there is contact: twenty squirmers had forces of contact that differed by
/// 0.2 % from those of further iterations, a twentieth of what half the time step changed.
const TOLERANCE_IN_CONTACT: f64 = 6e-3;

/// Position (m) of a node at a time (s).
pub type NodePath<'a, const D: usize> = &'a (dyn Fn(NodeId, f64) -> Point<D> + Sync);

/// How the nodes of the mesh move, seen from the frame.
#[derive(Clone, Copy)]
pub enum MeshPath<'a, const D: usize> {
    /// Not at all.
    Fixed,
    /// To given positions.
    Given(NodePath<'a, D>),
    /// With the bodies.
    FollowsBodies(&'a MovingMesh<D>),
}

impl<'a, const D: usize> MeshPath<'a, D> {
    /// Whether the mesh stays as it is.
    #[must_use]
    pub fn is_fixed(&self) -> bool {
        matches!(self, Self::Fixed)
    }

    /// The mesh that follows the bodies, if one does.
    #[must_use]
    pub fn moving_mesh(&self) -> Option<&'a MovingMesh<D>> {
        match self {
            Self::FollowsBodies(moving) => Some(moving),
            Self::Fixed | Self::Given(_) => None,
        }
    }

    /// The gaps between bodies of these shapes and walls, where the mesh follows bodies.
    pub(super) fn gaps(&self, shapes: &BodyShapes) -> Option<GapsAt<'a>> {
        self.moving_mesh().map(|moving| moving.gaps_at(shapes))
    }

    /// The gaps between bodies at a time (s), where the mesh follows bodies.
    ///
    /// # Errors
    /// When a gait gives its body no shape.
    pub(super) fn gaps_at_time(
        &self,
        bodies: &[RigidBody],
        time: f64,
    ) -> Result<Option<GapsAt<'a>>, StepError> {
        Ok(self.gaps(&BodyShapes::at(bodies, time)?))
    }

    /// Moves the mesh with bodies of these shapes to poses; returns the positions of its nodes
    /// seen from the frame.
    ///
    /// # Errors
    /// When the equation of mesh motion cannot be solved, or a cell degenerates.
    pub(super) fn move_mesh(
        &self,
        work: &mut Workspace<D>,
        problem: &Problem<D>,
        state: &State<D>,
        poses: &[Pose],
        shapes: &BodyShapes,
    ) -> Result<Vec<Point<D>>, StepError> {
        let origin = state.origin_at(problem, poses);
        let Workspace { mesh, timing, .. } = work;
        timing.measure(Stage::MeshMotion, || {
            let nodes = match self {
                Self::Fixed => state.nodes.clone(),
                Self::Given(path) => {
                    mesh.node_ids().map(|node| path(node, shapes.time())).collect()
                }
                Self::FollowsBodies(moving) => {
                    moving.nodes(&state.in_frame(&origin, poses), shapes)?
                }
            };
            let origin = on_mesh::<D>(&origin);
            for (node, seen) in mesh.nodes.iter_mut().zip(&nodes) {
                *node = seen + origin;
            }
            if let Self::FollowsBodies(moving) = self
                && let Some(cell) = moving.degenerate_cell(mesh)
            {
                let center = cell.center.as_slice().to_vec();
                return Err(StepError::DegenerateCell { center, quality: cell.quality });
            }
            Ok(nodes)
        })
    }

    /// How far bodies are at most from where the flow was solved, over the shortest edges on them.
    pub(super) fn misplacement(&self, solved_at: &Placement, reached: &Placement) -> f64 {
        let Some(moving) = self.moving_mesh() else { return 0.0 };
        let of_poses = moving.misplacement(&solved_at.poses, &reached.poses);
        of_poses.max(moving.misshape([&solved_at.shapes, &reached.shapes]))
    }

    /// Whether bodies get to where the flow was solved for, with these loads of contact: the fixed-point
    /// iteration for the poses ends there.
    pub(super) fn has_converged(
        &self,
        solved_at: &Placement,
        reached: &Placement,
        contact: &ContactLoads,
    ) -> bool {
        if self.moving_mesh().is_none() {
            return true;
        }
        let has_contact = !contact.contacts.is_empty();
        let tolerance = if has_contact { TOLERANCE_IN_CONTACT } else { TOLERANCE };
        self.misplacement(solved_at, reached) <= tolerance
    }
}
