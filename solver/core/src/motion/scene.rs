//! `Scene`: domain and bodies as they were meshed, and what a run asks of their exact surfaces.

use std::fmt::Debug;

use alewife_mesh::{BoundaryId, Mesh, MeshError, NodeId, Point};
use nalgebra::Vector3;
use thiserror::Error;

use crate::body::MeshPoses;
use crate::contact::{ContactError, Gaps};
use crate::coupling::{BodyShapes, ShapeError};
use crate::motion::MotionError;

/// Why a mesh could not be generated, or the flow not be taken over to it.
#[derive(Debug, Error)]
pub enum RemeshError {
    /// The mesh cannot be generated.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The mesh could not be moved.
    #[error(transparent)]
    Motion(#[from] MotionError),
    /// The surfaces have no gaps.
    #[error(transparent)]
    Gaps(#[from] ContactError),
    /// A gait gives its body no shape.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// The flow on it could not be made divergence-free.
    #[error("the flow on the new mesh: {0}")]
    Projection(#[from] crate::algebra::LinearError),
    /// A node of the new mesh is not found in the old one.
    #[error("the flow of the {level} could not be found in the old mesh")]
    NotFound {
        /// Which level.
        level: &'static str,
    },
    /// More cells than the run may have; there may be no mesh yet.
    #[error("the mesh would have about {n_cells:.1e} cells, and may have {most:.1e}")]
    TooManyCells {
        /// How many, about.
        n_cells: f64,
        /// How many it may have.
        most: f64,
    },
    /// A side that moves is not meshed again.
    #[error("a side that waves is not remeshed; take a smaller amplitude")]
    MovingWall,
    /// A mesh from a file is moved, and not made again.
    #[error(
        "the cells of the given mesh are worn by the motion of its bodies, and a mesh from a file is not made again; \
         lower mesh.moving.quality, give it larger or more even cells around the bodies, let them move less, or let the \
         program mesh: domain.box or domain.channel with the bodies by their shapes"
    )]
    Given,
}

/// A mesh with the scene it was generated for.
pub struct Meshed<const D: usize> {
    /// The mesh, seen from the frame.
    pub mesh: Mesh<D>,
    /// What it was generated for.
    pub scene: Box<dyn Scene<D>>,
    /// Poses of the bodies in it.
    pub poses: MeshPoses,
    /// Whole periods by which each body has been moved (m).
    pub shifts: Vec<Vector3<f64>>,
}

/// A node on a body with coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RestPlace {
    /// The node.
    pub node: NodeId,
    /// The body.
    pub body: usize,
    /// Where its material point is at rest (m).
    pub place: Vector3<f64>,
}

/// Part by which an estimate of cells may be too high.
pub const UNCERTAIN: f64 = 1.4;

/// The most cells that a mesh may have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MostCells(pub f64);

impl MostCells {
    /// Refuses a mesh before it is made, by an estimate of its cells that ends at a limit.
    ///
    /// # Errors
    /// When there would be more, by more than an estimate may be too high.
    pub fn check_before(
        self,
        estimate: impl FnOnce(f64) -> Result<f64, MeshError>,
    ) -> Result<(), RemeshError> {
        let limit = UNCERTAIN * self.0;
        if limit.is_infinite() {
            return Ok(());
        }
        // Ten times as many are not counted to the last
        let counted = 10.0 * limit;
        match estimate(counted)?.min(counted) {
            n_cells if n_cells > limit => Err(RemeshError::TooManyCells { n_cells, most: self.0 }),
            _ => Ok(()),
        }
    }

    /// Refuses a mesh that has more.
    ///
    /// # Errors
    /// When it has.
    pub fn check<const D: usize>(self, mesh: &Mesh<D>) -> Result<(), RemeshError> {
        let n_cells = mesh.n_cells() as f64;
        if n_cells > self.0 {
            return Err(RemeshError::TooManyCells { n_cells, most: self.0 });
        }
        Ok(())
    }
}

/// Poses of bodies that have been moved by whole periods (m).
pub type PosesByShift<'a> = &'a dyn Fn(&[Vector3<f64>]) -> MeshPoses;

/// Domain and bodies as they were meshed: the reference configuration of a moving mesh.
///
/// What is said of bodies that deform and of sides that move is, unless said otherwise, that there are
/// none.
pub trait Scene<const D: usize>: Debug + Send + Sync {
    /// Gaps between bodies in the shapes they had then, and walls.
    fn gaps(&self) -> &dyn Gaps;

    /// Gaps between bodies of these shapes, and walls; `None` where no body deforms.
    fn deformed_gaps(&self, _shapes: &BodyShapes) -> Option<Box<dyn Gaps>> {
        None
    }

    /// Position of a node on a body that deforms, in the frame of the body (m); `None` for a node that
    /// is on none.
    fn material_position(
        &self,
        _node: NodeId,
        _body: usize,
        _shapes: &BodyShapes,
    ) -> Option<Vector3<f64>> {
        None
    }

    /// Where nodes on bodies with coordinates are at rest, in the frames of the bodies.
    fn rest_places(&self, _shapes: &BodyShapes) -> Vec<RestPlace> {
        Vec::new()
    }

    /// Displacement (m) at a time (s) of a point of a side that moves; `None` for other sides.
    fn side_displacement(
        &self,
        _boundary: BoundaryId,
        _reference: &Point<D>,
        _time: f64,
    ) -> Option<Point<D>> {
        None
    }

    /// Whether a side moves, so that the mesh is not at rest even where bodies are.
    fn has_moving_wall(&self) -> bool {
        false
    }

    /// Lowest quality of a cell then.
    fn lowest_quality(&self) -> f64;

    /// Whether a mesh that has moved since then must be replaced, with bodies of these shapes at poses
    /// seen from the frame, and why.
    fn remesh_reason(
        &mut self,
        mesh: &Mesh<D>,
        poses: &MeshPoses,
        shapes: &BodyShapes,
    ) -> Option<String>;

    /// Generates a mesh with bodies of these shapes at poses seen from the frame.
    ///
    /// # Errors
    /// When it cannot be generated, or would have more cells than it may have.
    fn remesh(
        &self,
        poses: &MeshPoses,
        shapes: &BodyShapes,
        shifted: PosesByShift<'_>,
        most: MostCells,
    ) -> Result<Meshed<D>, RemeshError>;

    /// The vectors by which the domain repeats (m), for points of these meshes.
    fn images(&self, meshes: [&Mesh<D>; 2]) -> Vec<Point<D>>;
}
