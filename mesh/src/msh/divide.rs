//! The division of cells without enough free velocities: those with two sides on the boundary.

use super::parts::{Parts, edges_of, facet_of};
use crate::{Point, Simplex};

/// Divides cells with two facets on the boundary, or with all their edges there, at their centroids:
/// too few velocities of such a cell are free for the pressures at its corners.
pub fn divide<const D: usize>(parts: &mut Parts<D>) {
    let on_boundary = edges_of(&parts.sides);
    let is_closed = |cell: &[usize]| {
        let sides = (0..=D).filter(|side| parts.sides.contains_key(&facet_of::<D>(cell, *side)));
        let edges = || Simplex::<D>::EDGES.iter().map(|ends| ends.map(|local| cell[local]));
        sides.count() > 1 || edges().all(|[a, b]| on_boundary.contains(&[a.min(b), a.max(b)]))
    };
    let mut cells = Vec::with_capacity(parts.cells.len());
    let mut tags = Vec::with_capacity(parts.cells.len());
    for (cell, tag) in parts.cells.iter().zip(&parts.tags) {
        if !is_closed(cell) {
            cells.push(cell.clone());
            tags.push(*tag);
            continue;
        }
        let sum: Point<D> = cell.iter().map(|vertex| parts.vertices[*vertex]).sum();
        parts.vertices.push(sum / (D + 1) as f64);
        for local in 0..=D {
            let mut part = cell.clone();
            part[local] = parts.vertices.len() - 1;
            cells.push(part);
            tags.push(*tag);
        }
    }
    parts.cells = cells;
    parts.tags = tags;
}
