//! The graph that is ordered: vertices are mesh nodes with all their unknowns.

use super::super::buckets::Buckets;
use crate::sparse::index::to_u32;
use crate::sparse::{Pattern, Unknowns};

/// The vertex of each unknown: those of mesh nodes first, then one for each unknown with a dense row.
#[derive(Debug, Clone)]
pub(in super::super) struct Vertices {
    pub of_unknown: Vec<u32>,
    /// Number of vertices that are mesh nodes.
    pub n_nodes: usize,
    /// Number of all vertices.
    pub n: usize,
}

impl Vertices {
    pub fn new(unknowns: &Unknowns) -> Self {
        let n = unknowns.node.len();
        let mut is_dense = vec![false; n];
        for &unknown in &unknowns.dense {
            is_dense[unknown] = true;
        }
        let sparse = || (0..n).filter(|&unknown| !is_dense[unknown]);
        let end = sparse().map(|unknown| unknowns.node[unknown] as usize + 1).max().unwrap_or(0);
        let mut vertex_of_node = vec![None; end];
        let mut n_vertices = 0;
        let mut of_unknown = vec![0; n];
        for unknown in sparse() {
            let vertex = vertex_of_node[unknowns.node[unknown] as usize].get_or_insert_with(|| {
                n_vertices += 1;
                n_vertices - 1
            });
            of_unknown[unknown] = *vertex;
        }
        let n_nodes = n_vertices as usize;
        for unknown in (0..n).filter(|&unknown| is_dense[unknown]) {
            of_unknown[unknown] = n_vertices;
            n_vertices += 1;
        }
        Self { of_unknown, n_nodes, n: n_vertices as usize }
    }
}

/// Vertices that share an entry of the matrix are neighbours; compressed rows.
#[derive(Debug, Clone)]
pub(in super::super) struct Graph {
    pub starts: Vec<u32>,
    pub neighbours: Vec<u32>,
    /// Number of unknowns of each vertex.
    pub weights: Vec<u32>,
}

impl Graph {
    pub fn n(&self) -> usize {
        self.weights.len()
    }

    pub fn neighbours(&self, vertex: usize) -> &[u32] {
        &self.neighbours[self.starts[vertex] as usize..self.starts[vertex + 1] as usize]
    }

    /// The graph of the union of a pattern and its transpose.
    pub fn new(pattern: &Pattern, vertices: &Vertices) -> Self {
        let n = vertices.n;
        let vertex = &vertices.of_unknown;
        let unknowns = Buckets::new(vertex, n);
        // Each pair (row, column) of vertices with an entry, once.
        let mut seen = vec![None; n];
        let (mut rows, mut columns) = (Vec::new(), Vec::new());
        let mut pair_starts = vec![0];
        for from in 0..to_u32(n) {
            seen[from as usize] = Some(from);
            for &row in unknowns.of(from as usize) {
                for &column in pattern.row(row as usize) {
                    let to = vertex[column as usize];
                    if seen[to as usize] != Some(from) {
                        seen[to as usize] = Some(from);
                        rows.push(from);
                        columns.push(to);
                    }
                }
            }
            pair_starts.push(columns.len());
        }
        // And its transpose, where that is another one.
        let pairs_of_column = Buckets::new(&columns, n);
        let weights = (0..n).map(|vertex| to_u32(unknowns.of(vertex).len())).collect();
        let mut graph = Self { starts: vec![0], neighbours: Vec::new(), weights };
        seen.fill(None);
        for from in 0..to_u32(n) {
            let vertex = from as usize;
            let own = &columns[pair_starts[vertex]..pair_starts[vertex + 1]];
            let across = pairs_of_column.of(vertex).iter().map(|&pair| rows[pair as usize]);
            let start = graph.neighbours.len();
            for to in own.iter().copied().chain(across) {
                if seen[to as usize] != Some(from) {
                    seen[to as usize] = Some(from);
                    graph.neighbours.push(to);
                }
            }
            graph.neighbours[start..].sort_unstable();
            graph.starts.push(to_u32(graph.neighbours.len()));
        }
        graph
    }

    /// The graph without the vertices from `n` on.
    pub fn truncated(&self, n: usize) -> Self {
        let mut graph = Self {
            starts: vec![0],
            neighbours: Vec::with_capacity(self.neighbours.len()),
            weights: self.weights[..n].to_vec(),
        };
        for vertex in 0..n {
            let kept = self.neighbours(vertex).iter().filter(|&&to| (to as usize) < n);
            graph.neighbours.extend(kept);
            graph.starts.push(to_u32(graph.neighbours.len()));
        }
        graph
    }
}
