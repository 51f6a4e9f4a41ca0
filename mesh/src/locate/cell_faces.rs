//! `Face`: a face of a straight cell, and how far a curved cell with the same vertices may be beyond it.

use super::cell_point::solve;
use crate::mesh::determinant;
use crate::{Point, Simplex};

/// The shape functions of the middles of edges sum to this at most: 2 - 2 sum(l^2) with coordinates l.
const MIDDLES: f64 = 1.5;

/// How far a curved cell may be beyond a face of the straight one with the same vertices.
#[derive(Debug, Clone, Copy)]
pub struct Face {
    /// Height of the opposite vertex (m), zero where the straight cell is turned inside out.
    pub height: f64,
    /// Part of the height by which the cell may be beyond.
    pub beyond: f64,
}

/// Adds the faces of a cell.
///
/// A quadratic map is the straight one and the offsets of the middles of its edges times their shape functions.
pub fn push_faces<const D: usize>(nodes: &[Point<D>], is_curved: bool, faces: &mut Vec<Face>) {
    let columns: [Point<D>; D] = std::array::from_fn(|k| nodes[k + 1] - nodes[0]);
    let determinant = determinant(&columns);
    // Rates of the barycentric coordinates along a vector
    let rates = |vector: Point<D>| {
        let others = solve(&columns, vector, determinant);
        std::iter::once(-others.iter().sum::<f64>()).chain(others)
    };
    let first = faces.len();
    faces.resize(first + D + 1, Face { height: 0.0, beyond: 0.0 });
    let faces = &mut faces[first..];
    if determinant <= 0.0 {
        return;
    }
    for axis in 0..D {
        let unit = Point::from_fn(|row, _| if row == axis { 1.0 } else { 0.0 });
        faces.iter_mut().zip(rates(unit)).for_each(|(face, rate)| face.height += rate * rate);
    }
    faces.iter_mut().for_each(|face| face.height = face.height.sqrt().recip());
    if !is_curved {
        return;
    }
    for (edge, &[i, j]) in Simplex::<D>::EDGES.iter().enumerate() {
        for middle in &nodes[Simplex::<D>::edge_nodes(edge)] {
            let offset = middle - (nodes[i] + nodes[j]) * 0.5;
            for (face, rate) in faces.iter_mut().zip(rates(offset)) {
                face.beyond = face.beyond.max(MIDDLES * rate.abs());
            }
        }
    }
}
