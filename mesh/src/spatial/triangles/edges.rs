//! Edges of triangles, with the triangles beside each.

use std::collections::BTreeMap;

use super::TriangleMesh;

/// A triangle at an edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beside {
    /// Its number.
    pub triangle: usize,
    /// Whether it runs from the smaller number of a vertex to the larger.
    pub is_forward: bool,
}

/// The triangles beside each edge, by the numbers of its ends, the smaller first.
pub fn edges_of(mesh: &TriangleMesh) -> BTreeMap<[u32; 2], Vec<Beside>> {
    let mut edges: BTreeMap<[u32; 2], Vec<Beside>> = BTreeMap::new();
    for (triangle, [a, b, c]) in mesh.triangles.iter().copied().enumerate() {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            let beside = Beside { triangle, is_forward: from < to };
            edges.entry([from.min(to), from.max(to)]).or_default().push(beside);
        }
    }
    edges
}

/// Sets that grow together.
#[derive(Debug)]
pub struct Groups(Vec<usize>);

impl Groups {
    /// So many sets of one.
    pub fn new(n: usize) -> Self {
        Self((0..n).collect())
    }

    /// The smallest member known of the set of one.
    pub fn root(&mut self, mut member: usize) -> usize {
        while self.0[member] != member {
            self.0[member] = self.0[self.0[member]];
            member = self.0[member];
        }
        member
    }

    /// Makes one set of two.
    pub fn join(&mut self, one: usize, other: usize) {
        let (one, other) = (self.root(one), self.root(other));
        self.0[one.max(other)] = one.min(other);
    }
}
