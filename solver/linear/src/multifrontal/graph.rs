//! The graph that is ordered: vertices are mesh nodes with all their unknowns.

use crate::sparse::Pattern;

/// Vertices that share an entry of the matrix are neighbours; compressed rows.
#[derive(Debug, Clone)]
pub(super) struct Graph {
    pub starts: Vec<u32>,
    pub neighbours: Vec<u32>,
    /// Unknowns of each vertex.
    pub weights: Vec<u32>,
}

impl Graph {
    pub fn n(&self) -> usize {
        self.weights.len()
    }

    pub fn neighbours(&self, vertex: usize) -> &[u32] {
        &self.neighbours[self.starts[vertex] as usize..self.starts[vertex + 1] as usize]
    }

    /// The graph of `n` vertices of a pattern made symmetric, `vertex` naming that of each unknown.
    pub fn new(pattern: &Pattern, vertex: &[u32], n: usize) -> Self {
        let mut weights = vec![0u32; n];
        for &vertex in vertex {
            weights[vertex as usize] += 1;
        }
        let (unknown_starts, unknowns) = bucket(vertex, n);
        let columns = |of: usize| &unknowns[unknown_starts[of]..unknown_starts[of + 1]];
        // Each pair a column names, once.
        let mut seen = vec![u32::MAX; n];
        let (mut owners, mut named) = (Vec::new(), Vec::new());
        let mut named_starts = vec![0];
        for from in 0..n as u32 {
            seen[from as usize] = from;
            for &column in columns(from as usize) {
                for &row in pattern.column(column as usize) {
                    let to = vertex[row];
                    if seen[to as usize] != from {
                        seen[to as usize] = from;
                        owners.push(from);
                        named.push(to);
                    }
                }
            }
            named_starts.push(named.len());
        }
        // And its mirror image, where that is another one.
        let (mirror_starts, mirror) = bucket(&named, n);
        let mut graph = Self { starts: vec![0], neighbours: Vec::new(), weights };
        seen.fill(u32::MAX);
        for from in 0..n {
            let back = mirror[mirror_starts[from]..mirror_starts[from + 1]].iter();
            let back = back.map(|&pair| owners[pair as usize]);
            let start = graph.neighbours.len();
            for to in named[named_starts[from]..named_starts[from + 1]].iter().copied().chain(back)
            {
                if seen[to as usize] != from as u32 {
                    seen[to as usize] = from as u32;
                    graph.neighbours.push(to);
                }
            }
            graph.neighbours[start..].sort_unstable();
            graph.starts.push(graph.neighbours.len() as u32);
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
            graph.starts.push(graph.neighbours.len() as u32);
        }
        graph
    }
}

/// Members of each of `n` buckets in ascending order: starts and members.
pub(super) fn bucket(bucket_of: &[u32], n: usize) -> (Vec<usize>, Vec<u32>) {
    let mut starts = vec![0usize; n + 1];
    for &bucket in bucket_of {
        starts[bucket as usize + 1] += 1;
    }
    for bucket in 0..n {
        starts[bucket + 1] += starts[bucket];
    }
    let mut fill = starts.clone();
    let mut members = vec![0u32; bucket_of.len()];
    for (member, &bucket) in bucket_of.iter().enumerate() {
        members[fill[bucket as usize]] = member as u32;
        fill[bucket as usize] += 1;
    }
    (starts, members)
}
