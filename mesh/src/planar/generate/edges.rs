//! Boundary edges: every piece of the border cut by the size field, evenly in arc length over h.

use crate::number::{index_u32, whole};
use crate::planar::boundary::{BoundaryLoops, CopyOf};
use crate::{MeshError, Point, SizeField};

/// Largest number of boundary edges.
const MOST_EDGES: usize = 2_000_000;

/// A part of this length (in units of h) above a whole number of edges is shared among them
/// instead of making one more.
const SLACK: f64 = 0.3;

/// An edge of the boundary: part of a piece between two parameters, the fluid on its left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoundaryEdge {
    /// Vertices at its ends.
    pub vertices: [u32; 2],
    /// BoundaryPiece of the border.
    pub piece: u32,
    /// Parameters of its ends.
    pub parameters: [f64; 2],
}

/// Two edges of periodic sides, travelled in opposite directions.
#[derive(Debug, Clone, Copy)]
pub struct EdgePair {
    /// Index of the copy.
    pub copy: u32,
    /// Index of the original.
    pub original: u32,
}

/// All edges of the boundary with the places of their vertices.
#[derive(Debug, Clone)]
pub struct BoundaryEdges {
    /// Places of the vertices (m).
    pub points: Vec<Point<2>>,
    /// The edges, piece after piece in the order of travel.
    pub edges: Vec<BoundaryEdge>,
    /// Pairs of edges of periodic sides.
    pub periodic: Vec<EdgePair>,
}

impl BoundaryEdges {
    /// Cuts all pieces of a border.
    ///
    /// # Errors
    /// [`MeshError::TooManyCells`].
    pub fn new(border: &BoundaryLoops, sizes: &SizeField) -> Result<Self, MeshError> {
        let mut made = Self { points: Vec::new(), edges: Vec::new(), periodic: Vec::new() };
        // Edges of each piece, to be copied by its periodic partner
        let mut ranges: Vec<std::ops::Range<usize>> = Vec::new();
        for (nth, first) in border.loops.iter().enumerate() {
            let end = border.loops.get(nth + 1).copied().unwrap_or(border.pieces.len());
            let start = index_u32(made.points.len());
            for piece in *first..end {
                let from = made.edges.len();
                if let Some(CopyOf { original, shift }) = border.pieces[piece].copy_of {
                    made.copy(piece, ranges[original].clone(), shift);
                } else {
                    let cuts = cut(border, piece, sizes)?;
                    for pair in cuts.windows(2) {
                        let vertex = index_u32(made.points.len());
                        made.points.push(border.point(piece, pair[0]));
                        made.edges.push(BoundaryEdge {
                            vertices: [vertex, vertex + 1],
                            piece: index_u32(piece),
                            parameters: [pair[0], pair[1]],
                        });
                    }
                }
                ranges.push(from..made.edges.len());
                if made.edges.len() > MOST_EDGES {
                    return Err(MeshError::TooManyCells {
                        what: "boundary edges",
                        limit: MOST_EDGES,
                        smallest: sizes.smallest(),
                    });
                }
            }
            let last = made.edges.len() - 1;
            made.edges[last].vertices[1] = start;
        }
        Ok(made)
    }

    /// Repeats the edges of another piece backwards, moved by a vector.
    fn copy(&mut self, piece: usize, original: std::ops::Range<usize>, shift: Point<2>) {
        for edge in original.rev() {
            let BoundaryEdge { vertices, parameters, .. } = self.edges[edge];
            let vertex = index_u32(self.points.len());
            self.periodic
                .push(EdgePair { copy: index_u32(self.edges.len()), original: index_u32(edge) });
            self.edges.push(BoundaryEdge {
                vertices: [vertex, vertex + 1],
                piece: index_u32(piece),
                parameters: [1.0 - parameters[1], 1.0 - parameters[0]],
            });
            self.points.push(self.points[vertices[1] as usize] + shift);
        }
    }
}

/// Parameters that cut a piece in edges of length h, evenly in the integral of ds / h.
fn cut(border: &BoundaryLoops, piece: usize, sizes: &SizeField) -> Result<Vec<f64>, MeshError> {
    // Parts short enough for Simpson's rule: parameter and integral up to their ends
    let size = |t: f64| sizes.at(border.point(piece, t));
    let mut parts = vec![(0.0, 0.0)];
    let mut ends: Vec<(f64, f64, u32)> = vec![(1.0, size(1.0), 0)];
    let (mut from, mut at_from, mut total) = (0.0, size(0.0), 0.0);
    while let Some((to, at_to, depth)) = ends.pop() {
        let middle = 0.5 * (from + to);
        let at_middle = size(middle);
        let length = (border.point(piece, to) - border.point(piece, from)).norm();
        if depth < 3 || length > 0.5 * at_from.min(at_middle).min(at_to) {
            if parts.len() > 4 * MOST_EDGES || depth > 60 {
                return Err(MeshError::TooManyCells {
                    what: "boundary edges",
                    limit: MOST_EDGES,
                    smallest: sizes.smallest(),
                });
            }
            ends.push((to, at_to, depth + 1));
            ends.push((middle, at_middle, depth + 1));
            continue;
        }
        let length = border.arc(piece, from, to);
        total += length / 6.0 * (1.0 / at_from + 4.0 / at_middle + 1.0 / at_to);
        parts.push((to, total));
        (from, at_from) = (to, at_to);
    }
    // Rounding must not decide between two mirror images
    let n = whole((total - SLACK - 1e-9).ceil()).max(1);
    let mut cuts = vec![0.0];
    let mut part = 1;
    for k in 1..n {
        let wanted = total * k as f64 / n as f64;
        while parts[part].1 < wanted {
            part += 1;
        }
        let ((t0, i0), (t1, i1)) = (parts[part - 1], parts[part]);
        cuts.push(border.cut(piece, t0, t1, (wanted - i0) / (i1 - i0)));
    }
    cuts.push(1.0);
    Ok(cuts)
}
