//! One entry, `generate`: from a domain with bodies and a sizing to a mesh of tetrahedra.
//!
//! A lattice refined to the sizes wanted, cut by the surfaces, improved, with quadratic nodes. Nothing
//! is random: equal input, equal bits.

mod bisection;
mod cut;
mod cut_sheets;
mod given;
mod improve;
mod lattice;
mod opened;
mod purpose;
mod quadratic;
mod straighten;
mod surface_faces;
mod tetrahedra;

use improve::{Improver, Verdict};
use purpose::Asked;
pub use purpose::Purpose;

use super::domain::Domain;
use super::region::Region;
use super::shape::Body;
use super::size_field::SizeField;
use crate::{Mesh, MeshError, Sizing, interrupt};

/// Edge of the cubes of the lattice over the largest size wanted.
const CUBE: f64 = 1.3;

/// Parts of a cube by which the lattice is moved, one after the other until the mesh is good; a given mesh
/// cannot be moved, and has edges bisected that are so much shorter instead.
const SHIFTS: [f64; 4] = [0.013, 0.231, 0.372, 0.117];

/// Parts of the longest edges of the lattice, each tried where the one before gave no mesh that can be used:
/// halving leaves edges between the longest and half of it, and the longest are those of a thin body's radius.
const LATTICES: [f64; 3] = [1.0, 0.75, 0.6];

/// Places of the lattice after which a finer one is tried where no mesh can be used yet.
const ENOUGH_PLACES: usize = 2;

/// A mesh and what is to be said of it.
struct Candidate<'a> {
    improver: Improver<'a>,
    verdict: Verdict,
}

/// Mesh of the fluid in a domain around bodies.
///
/// Boundaries are the sides in the order of [`Domain::sides`], then the bodies in theirs. A given mesh
/// stays as it is where there are no bodies, and keeps its sides.
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
    if let (Domain::Imported(imported), []) = (domain, bodies) {
        return Ok(imported.mesh().clone());
    }
    let asked = Purpose::Flow.asks(sizing.curved);
    let Candidate { improver, verdict } = best_candidate(&sizes, asked)?;
    verdict.check()?;
    Ok(improver.quadratic(sizing.curved))
}

/// Part by which the volume of a mesh may differ from that of its region, plus that of its sizes: sharp edges
/// that are missed cost more.
const MISSED: f64 = 0.02;

/// Mesh of the inside of a surface, whose sharp edges are edges of it.
///
/// Boundaries are the sides of the region in their order. For a solid, bent edges that would fold a cell stay
/// straight.
///
/// # Errors
/// What [`Sizing::check`] refuses, [`MeshError::TooManyCells`], and [`MeshError::PoorTetrahedra`] where no
/// good cells are found, or a side has none.
pub fn generate_inside(
    region: &Region,
    sizing: &Sizing<3>,
    purpose: Purpose,
) -> Result<Mesh<3>, MeshError> {
    let names: Vec<&str> = region.sides().iter().map(String::as_str).collect();
    sizing.check(&names)?;
    let sizes = SizeField::of(region.geometry(sizing), sizing);
    let asked = purpose.asks(sizing.curved);
    let Candidate { improver, verdict } = best_candidate(&sizes, asked)?;
    verdict.check()?;
    let mesh = improver.quadratic(sizing.curved);
    let wanted = region.volume();
    // Straight edges cut off what is round: that is no edge missed
    let found = if sizing.curved { mesh.measure() } else { improver.quadratic(true).measure() };
    let missed = (found - wanted).abs() / wanted;
    let at = region.triangles().corners(0)[0].into();
    if missed > MISSED {
        let reason = "the mesh leaves out or adds a part of the volume";
        return Err(MeshError::PoorTetrahedra { reason, value: missed, at });
    }
    for side in 0..names.len() {
        if !mesh.facets.iter().any(|facet| facet.boundary.index() == side) {
            let reason = "a side is smaller than the cells at it, its number";
            return Err(MeshError::PoorTetrahedra { reason, value: side as f64, at });
        }
    }
    Ok(mesh)
}

/// The first mesh that is good, or the best one of all.
fn best_candidate(sizes: &SizeField, asked: Asked) -> Result<Candidate<'_>, MeshError> {
    let mut best: Option<Candidate<'_>> = None;
    for part in LATTICES {
        for (tried, shift) in SHIFTS.into_iter().enumerate() {
            let can_be_used = best.as_ref().is_some_and(|best| best.verdict.is_acceptable());
            if tried >= ENOUGH_PLACES && !can_be_used {
                break;
            }
            let improver = attempt(Improver::new(sizes, asked), shift, part)?;
            let verdict = Verdict::of(&improver);
            // The angles of a given mesh stay as they are where no body is near
            let is_given = sizes.geometry().imported.is_some();
            let is_enough = verdict.is_good() || (is_given && verdict.is_acceptable());
            if best.as_ref().is_none_or(|known| verdict.is_better_than(&known.verdict)) {
                best = Some(Candidate { improver, verdict });
            }
            if is_enough {
                break;
            }
        }
        if best.as_ref().is_some_and(|best| best.verdict.is_acceptable()) {
            break;
        }
    }
    best.ok_or(MeshError::Invariant { what: "no mesh was made", index: 0 })
}

/// The mesh from a lattice moved by a part of its cubes, which in a periodic box are smaller by half of it, or
/// from a given one; with a part of the longest edges that are left before it is cut.
fn attempt(mut improver: Improver<'_>, shift: f64, part: f64) -> Result<Improver<'_>, MeshError> {
    let sizes = improver.sizes;
    let cube = CUBE * sizes.largest();
    let is_periodic = sizes.geometry().periods.is_any();
    let mut first = 0;
    if let Some(imported) = &sizes.geometry().imported {
        improver.fill_with_mesh(imported.mesh());
        first = sizes.geometry().groups[0].last;
    } else if is_periodic {
        improver.fill_box_with_lattice(cube * (1.0 - 0.5 * shift), shift);
        // The sides are those of the lattice
        first = sizes.geometry().groups[0].last;
    } else {
        improver.fill_with_lattice(cube, shift);
    }
    let shorter = if sizes.geometry().imported.is_some() { shift - SHIFTS[0] } else { 0.0 };
    interrupt::check()?;
    improver.refine_lattice(part * (1.0 - shorter))?;
    if sizes.geometry().enclosure.is_some() {
        improver.cut_by_sheets()?;
        first = sizes.geometry().surfaces.len();
    }
    for index in first..sizes.geometry().surfaces.len() {
        let index = u16::try_from(index).map_err(|_| too_many_surfaces(sizes))?;
        improver.cut(index)?;
    }
    improver.settle_boundary();
    interrupt::check()?;
    improver.improve();
    improver.pull_vertices();
    if improver.asked.bent_edges && !improver.asked.bent_shapes {
        improver.straighten_folded_cells();
    }
    interrupt::check()?;
    Ok(improver)
}

fn too_many_surfaces(sizes: &SizeField) -> MeshError {
    let what = "surfaces";
    MeshError::TooManyCells { what, limit: usize::from(u16::MAX), smallest: sizes.largest() }
}
