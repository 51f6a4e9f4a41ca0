//! One entry, `generate`: from a domain with bodies and a sizing to a mesh.
//!
//! Boundary as curves, size field, boundary edges, interior points by a front, constrained Delaunay
//! triangulation, improvement, quadratic nodes. Nothing is random: equal input, equal bits.

mod border;
mod edges;
mod front;
mod improve;
mod placement;
mod planar;
mod point_tree;
mod quadratic;
mod size_tree;
mod surface_sizes;
mod trial;
mod triangulation;

use crate::{Domain, Mesh, MeshError, PlacedShape, SizeField, Sizing};

pub(crate) use border::Border;
pub use placement::check_placement;
pub(crate) use placement::place;
pub(crate) use size_tree::SizeTree;
pub(crate) use surface_sizes::surface_sizes;

use edges::BoundaryEdges;

/// Mesh of the fluid in a domain around bodies.
///
/// Boundaries are the sides in the order of [`Domain::sides`], then the bodies in theirs. In an
/// axisymmetric domain the mesh is the meridian half plane y >= 0.
///
/// # Errors
/// What [`check_placement`] and [`Sizing::check`] refuse, [`MeshError::TooManyCells`], and
/// [`MeshError::FoldedCell`] when a curved cell cannot be made valid.
///
/// # Example
/// ```
/// use alewife_mesh::{Domain, PlacedShape, Point, Shape, Sizing, generate};
///
/// let domain = Domain::HalfDisc { center: 0.0, radius: 100.0 };
/// let sphere = PlacedShape {
///     name: "sphere".into(),
///     shape: Shape::Sphere { radius: 1.0 },
///     center: Point::<2>::zeros(),
///     angle: 0.0,
///     size: None,
/// };
/// let mesh = generate(&domain, &[sphere], &Sizing::graded(0.1, 0.2, 20.0))?;
/// assert_eq!(mesh.boundaries[2].name, "sphere");
/// # Ok::<(), alewife_mesh::MeshError>(())
/// ```
pub fn generate(
    domain: &Domain,
    bodies: &[PlacedShape],
    sizing: &Sizing,
) -> Result<Mesh<2>, MeshError> {
    sizing.check(domain)?;
    let outlines = place(domain, bodies)?;
    let border = Border::new(domain, bodies, outlines);
    let sizes = SizeField::from_border(domain, bodies, sizing, &border)?;
    let boundary = BoundaryEdges::new(&border, &sizes)?;
    let interior = front::lay_points(&boundary, &sizes)?;
    let mut triangles = planar::triangulate(&boundary, &interior, &sizes)?;
    improve::improve(&mut triangles, &border, sizing.curved);
    quadratic::finish(triangles, &border, &boundary.periodic, sizing.curved)
}
