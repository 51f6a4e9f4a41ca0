//! `CaseMesh`: what makes meshes of a case; the planar and the spatial one are in folders of their own.

use alewife_mesh::{Mesh, Point};
use nalgebra::Vector3;

use super::RunError;
use super::resume::Reference;
use crate::body::MeshPoses;
use crate::case::{Case, Model};
use crate::coupling::Problem;
use crate::motion::MovingMesh;

/// The dimension of a run: cases become meshes in 2 (planar and axisymmetric) and in 3.
#[derive(Debug, Clone, Copy)]
pub struct Dimension<const D: usize>;

/// How cases of a dimension become meshes, and what moves those.
pub trait CaseMesh<const D: usize> {
    /// Generates the mesh of a case at time zero.
    ///
    /// # Errors
    /// When a body does not fit, or the mesh cannot be generated.
    fn generate(model: &Model) -> Result<InitialMesh<D>, RunError>;

    /// A mesh of a case from elsewhere.
    ///
    /// # Errors
    /// When the bodies of the case have no shape.
    fn adopt(model: &Model, mesh: Mesh<D>) -> Result<InitialMesh<D>, RunError>;

    /// The vectors (m) by which a mesh repeats around itself, zero first.
    fn images(case: &Case, mesh: &Mesh<D>) -> Vec<Point<D>>;

    /// The nearest points on the surfaces of the bodies of a case at time zero, one function for each.
    ///
    /// # Errors
    /// When a body has no shape.
    fn nearest_on_bodies(model: &Model) -> Result<Vec<NearestOnBody<D>>, RunError>;

    /// What moves the mesh of a saved state.
    ///
    /// # Errors
    /// When it cannot be set up.
    fn moving_mesh_of(
        model: &Model,
        problem: &Problem<D>,
        reference: &Reference<'_, D>,
    ) -> Result<MovingMesh<D>, RunError>;
}

/// The point of the surface of a body nearest to another one (m).
pub type NearestOnBody<const D: usize> = Box<dyn Fn(&Point<D>) -> Point<D>>;

/// Makes what moves a mesh, with the bodies at these poses.
pub(super) type MakeMovingMesh<const D: usize> =
    Box<dyn FnOnce(&Model, &Problem<D>, &Mesh<D>, MeshPoses) -> Result<MovingMesh<D>, RunError>>;

/// The mesh of a case at time zero.
pub struct InitialMesh<const D: usize> {
    /// The mesh.
    pub mesh: Mesh<D>,
    /// Whole periods by which each body has been moved into it (m).
    pub(super) shifts: Vec<Vector3<f64>>,
    /// Makes what moves it, where bodies or sides move.
    pub(super) make_moving: MakeMovingMesh<D>,
}

/// The mesh of a case.
///
/// # Errors
/// When a body does not fit, or the mesh cannot be generated.
pub fn build_mesh<const D: usize>(model: &Model) -> Result<Mesh<D>, RunError>
where
    Dimension<D>: CaseMesh<D>,
{
    Ok(Dimension::<D>::generate(model)?.mesh)
}
