//! `GivenNodes`: the nodes in bent edges of the sides of a given mesh.

use std::collections::HashMap;

use crate::Point;

/// Nodes in the bent edges of given sides, by the ends of the edges.
#[derive(Debug, Clone, Default)]
pub struct GivenNodes(HashMap<[u32; 2], Point<3>>);

/// A node in an edge from a vertex.
#[derive(Debug, Clone, Copy)]
pub struct GivenPart {
    /// The other end of the edge.
    pub end: u32,
    /// The node (m).
    pub node: Point<3>,
}

impl GivenNodes {
    /// Adds the nodes in edges from a vertex.
    pub fn add(&mut self, vertex: u32, parts: &[GivenPart]) {
        for part in parts {
            self.0.insert([vertex.min(part.end), vertex.max(part.end)], part.node);
        }
    }

    /// The node in an edge (m), if it is a bent one of a given side.
    #[inline]
    pub fn of(&self, [a, b]: [u32; 2]) -> Option<Point<3>> {
        self.0.get(&[a.min(b), a.max(b)]).copied()
    }
}
