//! The reference triangle and tetrahedron: numbering of vertices, edges, facets and their nodes.
//!
//! Local nodes of a cell: its D + 1 vertices, then the inner nodes of its edges, edge after edge.
//! Vertices, edges and facets are in VTK's order (types 22 and 24), so that a positive cell has its
//! facets seen from outside counter-clockwise: the triangle on the left of its sides.

use std::ops::{Deref, Range};

/// The simplex of dimension D, 2 or 3, with the nodes of the quadratic element.
#[derive(Debug, Clone, Copy)]
pub struct Simplex<const D: usize>;

/// Edges of the triangle.
const TRIANGLE_EDGES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

/// Edges of the tetrahedron.
const TETRAHEDRON_EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];

/// Nodes of the sides of the triangle: vertices, then inner nodes.
const TRIANGLE_FACETS: [&[usize]; 3] = [&[0, 1, 3], &[1, 2, 4], &[2, 0, 5]];

/// Nodes of the faces of the tetrahedron: vertices, then those of the edges between the first and
/// the second, the second and the third, the third and the first.
const TETRAHEDRON_FACETS: [&[usize]; 4] =
    [&[0, 1, 3, 4, 8, 7], &[1, 2, 3, 5, 9, 8], &[2, 0, 3, 6, 7, 9], &[0, 2, 1, 6, 5, 4]];

impl<const D: usize> Simplex<D> {
    /// Number of vertices, which is also that of facets.
    pub const N_VERTICES: usize = D + 1;

    /// Local vertices at the two ends of each edge.
    pub const EDGES: &'static [[usize; 2]] = match D {
        2 => &TRIANGLE_EDGES,
        3 => &TETRAHEDRON_EDGES,
        _ => panic!("a cell is a triangle or a tetrahedron"),
    };

    /// Parameters of the inner nodes of an edge, from 0 at its first end to 1 at its second.
    pub const EDGE_PARAMETERS: &'static [f64] = &[0.5];

    /// Number of nodes: 6 of a triangle, 10 of a tetrahedron.
    pub const N_NODES: usize = Self::N_VERTICES + Self::EDGES.len() * Self::EDGE_PARAMETERS.len();

    /// Local nodes of each facet: its D vertices, then its inner nodes.
    pub const FACETS: &'static [&'static [usize]] = match D {
        2 => &TRIANGLE_FACETS,
        3 => &TETRAHEDRON_FACETS,
        _ => panic!("a cell is a triangle or a tetrahedron"),
    };

    /// Local nodes in the interior of an edge, at [`Simplex::EDGE_PARAMETERS`].
    #[must_use]
    pub const fn edge_nodes(edge: usize) -> Range<usize> {
        let n = Self::EDGE_PARAMETERS.len();
        let first = Self::N_VERTICES + edge * n;
        first..first + n
    }

    /// Local vertices of a facet.
    #[must_use]
    pub fn facet_vertices(side: usize) -> [usize; D] {
        std::array::from_fn(|i| Self::FACETS[side][i])
    }

    /// Local nodes of a facet that are no vertices.
    #[must_use]
    pub fn facet_inner_nodes(side: usize) -> &'static [usize] {
        &Self::FACETS[side][D..]
    }
}

/// Nodes of the element with the most of them, the quadratic tetrahedron.
const MAX_NODES: usize = 10;

/// One value for each node of a simplex, in the order of its nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NodeArray<const D: usize, T>([T; MAX_NODES]);

impl<const D: usize, T: Copy> NodeArray<D, T> {
    /// The values `value` gives for the local nodes.
    #[must_use]
    pub fn from_fn(mut value: impl FnMut(usize) -> T) -> Self {
        let mut values = [value(0); MAX_NODES];
        for (node, entry) in values[..Simplex::<D>::N_NODES].iter_mut().enumerate().skip(1) {
            *entry = value(node);
        }
        Self(values)
    }
}

impl<const D: usize, T> Deref for NodeArray<D, T> {
    type Target = [T];

    #[inline]
    fn deref(&self) -> &[T] {
        &self.0[..Simplex::<D>::N_NODES]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reference coordinates of all nodes.
    fn nodes<const D: usize>() -> Vec<[f64; D]> {
        let vertex = |i: usize| std::array::from_fn(|axis| f64::from(u8::from(axis + 1 == i)));
        let mut nodes: Vec<[f64; D]> = (0..=D).map(vertex).collect();
        for &[from, to] in Simplex::<D>::EDGES {
            for t in Simplex::<D>::EDGE_PARAMETERS {
                let (from, to) = (nodes[from], nodes[to]);
                nodes.push(std::array::from_fn(|axis| (1.0 - t) * from[axis] + t * to[axis]));
            }
        }
        nodes
    }

    fn check<const D: usize>() {
        let nodes = nodes::<D>();
        assert_eq!(nodes.len(), Simplex::<D>::N_NODES);
        assert_eq!(Simplex::<D>::FACETS.len(), Simplex::<D>::N_VERTICES);
        let mut seen = vec![0; nodes.len()];
        for side in 0..=D {
            let local = Simplex::<D>::FACETS[side];
            let vertices = Simplex::<D>::facet_vertices(side);
            assert_eq!(local[..D], vertices);
            assert_eq!(&local[D..], Simplex::<D>::facet_inner_nodes(side));
            let opposite = (0..=D).find(|v| !vertices.contains(v)).unwrap();
            // On a facet, and nowhere else, the barycentric coordinate of the other vertex is zero
            let coordinate = |node: &[f64; D]| match opposite {
                0 => 1.0 - node.iter().sum::<f64>(),
                i => node[i - 1],
            };
            for (node, x) in nodes.iter().enumerate() {
                assert_eq!(local.contains(&node), coordinate(x).abs() < 1e-15);
            }
            for node in local {
                seen[*node] += 1;
            }
        }
        // A vertex is on all facets but one, an edge of a cell on two or, in the plane, on one
        assert!(seen[..=D].iter().all(|n| *n == D));
        assert!(seen[D + 1..].iter().all(|n| *n == D - 1));
    }

    #[test]
    fn a_facet_has_the_nodes_that_lie_on_it() {
        check::<2>();
        check::<3>();
    }

    #[test]
    fn inner_nodes_of_a_facet_follow_its_own_edges() {
        let nodes = nodes::<3>();
        for local in Simplex::<3>::FACETS {
            for (edge, [from, to]) in Simplex::<2>::EDGES.iter().enumerate() {
                let middle = Simplex::<2>::edge_nodes(edge).start;
                for axis in 0..3 {
                    let mean = 0.5 * (nodes[local[*from]][axis] + nodes[local[*to]][axis]);
                    assert_eq!(nodes[local[middle]][axis], mean);
                }
            }
        }
        for (side, edge) in Simplex::<2>::EDGES.iter().enumerate() {
            assert_eq!(Simplex::<2>::facet_vertices(side), *edge);
            assert_eq!(
                Simplex::<2>::facet_inner_nodes(side),
                [Simplex::<2>::edge_nodes(side).start]
            );
        }
    }

    #[test]
    fn faces_of_the_tetrahedron_are_counter_clockwise_from_outside() {
        let nodes = nodes::<3>();
        let center = [0.25; 3];
        for side in 0..4 {
            let [a, b, c] = Simplex::<3>::facet_vertices(side).map(|v| nodes[v]);
            let difference = |p: [f64; 3], q: [f64; 3]| [q[0] - p[0], q[1] - p[1], q[2] - p[2]];
            let (u, v, out) = (difference(a, b), difference(a, c), difference(center, a));
            let normal =
                [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
            assert!((0..3).map(|i| normal[i] * out[i]).sum::<f64>() > 0.0);
        }
    }
}
