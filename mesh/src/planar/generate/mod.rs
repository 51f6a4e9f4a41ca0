//! One entry, `generate`: from a domain with bodies and a sizing to a mesh.
//!
//! Boundary as curves, size field, boundary edges, interior points by a front, constrained Delaunay
//! triangulation, improvement, quadratic nodes, numbering. Nothing is random: equal input, equal bits.

mod copies;
mod delaunay;
mod edges;
mod front;
mod improve;
mod interior;
mod mirror;
mod opened;
mod order;
mod point_tree;
mod quadratic;
mod relax;
mod scattered;
mod trial;
mod triangulation;

pub use interior::{Triangles, bulge, points_of_outline, triangulate_inside};
pub use scattered::{Scattered, Shares};

use edges::BoundaryEdges;
use mirror::Mirror;

use crate::planar::boundary::BoundaryLoops;
use crate::planar::placement::{place, place_wrapped};
use crate::{Domain, Mesh, MeshError, Outline, PlacedShape, Quality, SizeField, Sizing, interrupt};

/// A mesh made by reflection is taken unless an angle is below this (degrees), as where the line of
/// symmetry passes a narrow place.
const SMALLEST_ANGLE: f64 = 27.0;

/// Nor is it taken where det J of a curved cell falls below this part of its mean.
const FOLDED: f64 = 0.15;

/// Mesh of the fluid in a domain around bodies.
///
/// Where domain, bodies and sizing are mirror-symmetric about a line y = const or x = const, so is
/// the mesh, to the last bit: half of it is made and reflected. Bodies on the line must be cut by
/// it at extreme points of their own frame; where it passes a place too narrow for good cells, the
/// mesh is made as a whole.
///
/// Boundaries are the sides in the order of [`Domain::sides`], then the bodies in theirs. In an
/// axisymmetric domain the mesh is the meridian half plane y >= 0.
///
/// # Errors
/// What [`crate::check_placement`] and [`Sizing::check`] refuse, [`MeshError::TooManyCells`], and
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
    sizing.check(domain.sides())?;
    let border = BoundaryLoops::new(domain, bodies, place(domain, bodies)?);
    generate_within(&border, domain, bodies, sizing)
}

/// The same where bodies may lie across the periodic sides of a domain: where one does, or nearly so, this
/// is a triangulation of the torus that the domain is.
///
/// The sides of a periodic pair are then the sides of triangles along which it is cut open to be shown, with
/// bodies whole and elsewhere near the sides of the domain.
///
/// # Errors
/// What [`check_wrapped_placement`](crate::check_wrapped_placement) and [`Sizing::check`] refuse,
/// [`MeshError::TooManyCells`], [`MeshError::Boundary`] and [`MeshError::FoldedCell`].
pub fn generate_wrapped(
    domain: &Domain,
    bodies: &[PlacedShape],
    sizing: &Sizing,
) -> Result<Mesh<2>, MeshError> {
    sizing.check(domain.sides())?;
    let outlines = place_wrapped(domain, bodies)?;
    let sides = || (0..domain.sides().len()).filter(|side| domain.is_periodic(*side));
    // Straight sides would ask for smaller cells between them and a body than there are around it
    let is_clear = |(outline, body): (&Outline, &PlacedShape)| {
        let room = outline.reach() + body.size.unwrap_or(sizing.surface);
        sides().all(|side| domain.side_gap(side, outline.center()) > room)
    };
    let border = if outlines.iter().zip(bodies).all(is_clear) {
        BoundaryLoops::new(domain, bodies, outlines)
    } else {
        BoundaryLoops::on_torus(domain, bodies, outlines)
    };
    generate_within(&border, domain, bodies, sizing)
}

/// Mesh of what lies on the left of the border of a domain with bodies, by its half where it is
/// mirror-symmetric.
fn generate_within(
    border: &BoundaryLoops,
    domain: &Domain,
    bodies: &[PlacedShape],
    sizing: &Sizing,
) -> Result<Mesh<2>, MeshError> {
    let sizes = SizeField::from_border(domain, bodies, sizing, border)?;
    let outlines = &border.outlines[..bodies.len()];
    let mirror = Mirror::find(domain, outlines, sizing).filter(|m| m.keeps_sizes_of(bodies));
    if let Some(mirror) = mirror
        && let Ok(half) = fill(&mirror.half(domain, border), &sizes, sizing.curved)
    {
        let mesh = mirror.whole(half);
        let quality = Quality::of(&mesh);
        if quality.min_angle > SMALLEST_ANGLE && quality.min_curved_jacobian > FOLDED {
            return Ok(order::renumber(&mesh));
        }
    }
    fill(border, &sizes, sizing.curved).map(|mesh| order::renumber(&mesh))
}

/// Mesh of what lies on the left of a border.
fn fill(border: &BoundaryLoops, sizes: &SizeField, is_curved: bool) -> Result<Mesh<2>, MeshError> {
    let boundary = BoundaryEdges::new(border, sizes)?;
    let interior = front::advance_front(&boundary, sizes, border.torus)?;
    let mut triangles = delaunay::triangulate(&boundary, &interior, sizes, border.torus)?;
    interrupt::check()?;
    improve::improve(&mut triangles, border, is_curved);
    interrupt::check()?;
    quadratic::finish(triangles, border, &boundary.periodic, is_curved)
}
