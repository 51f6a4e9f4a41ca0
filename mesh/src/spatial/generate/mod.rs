//! One entry, `generate`: from a domain with bodies and a sizing to a mesh of tetrahedra.
//!
//! A lattice refined to the sizes wanted, cut by the surfaces, improved, with quadratic nodes. Nothing
//! is random: equal input, equal bits.

mod bisection;
mod boundary_edges;
mod collapse;
mod cut;
mod edge_removal;
mod face_swap;
mod improver;
mod lattice;
mod measure;
mod passes;
mod peel;
mod projections;
mod quadratic;
mod replace;
mod schedule;
mod smooth;
mod split;
mod surface_faces;
mod surface_set;
mod tetrahedra;
mod worst_cells;

use improver::Improver;

use super::domain::Domain;
use super::shape::Body;
use super::size_field::SizeField;
use crate::{Mesh, MeshError, Sizing};

/// Edge of the cubes of the lattice over the largest size wanted.
const CUBE: f64 = 1.3;

/// Part of a cube by which the lattice is moved.
const SHIFT: f64 = 0.013;

/// Mesh of the fluid in a domain around bodies.
///
/// Boundaries are the sides in the order of [`Domain::sides`], then the bodies in theirs.
///
/// # Errors
/// What [`check_placement`](super::check_placement) and [`Sizing::check`] refuse,
/// [`MeshError::TooManyCells`], and [`MeshError::PoorTetrahedra`] where no good cells are found.
pub fn generate(
    domain: &Domain,
    bodies: &[Body],
    sizing: &Sizing<3>,
) -> Result<Mesh<3>, MeshError> {
    let sizes = SizeField::new(domain, bodies, sizing)?;
    let mut improver = Improver::new(&sizes);
    improver.fill_with_lattice(CUBE * sizes.largest(), SHIFT);
    improver.refine_lattice()?;
    for index in 0..sizes.geometry().surfaces.len() {
        improver.cut(u16::try_from(index).unwrap_or(u16::MAX))?;
    }
    improver.settle_boundary();
    improver.improve();
    improver.pull_vertices();
    Ok(improver.quadratic(sizing.curved))
}
