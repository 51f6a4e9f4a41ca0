//! The graph that is ordered: vertices are mesh nodes with all their unknowns.

use super::PatternRef;

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
    pub fn new(pattern: PatternRef<'_>, vertex: &[u32], n: usize) -> Self {
        let mut weights = vec![0u32; n];
        for &vertex in vertex {
            weights[vertex as usize] += 1;
        }
        let (unknown_starts, unknowns) = bucket(vertex, n);
        let columns = |of: usize| &unknowns[unknown_starts[of]..unknown_starts[of + 1]];
        // Once each pair a column names, then its mirror image.
        let mut seen = vec![u32::MAX; n];
        let mut pairs_starts = vec![0u32; n + 1];
        let mut pairs: Vec<u32> = Vec::new();
        for from in 0..n {
            seen[from] = from as u32;
            for &column in columns(from) {
                for &row in pattern.column(column as usize) {
                    let to = vertex[row];
                    if seen[to as usize] != from as u32 {
                        seen[to as usize] = from as u32;
                        pairs.push(to);
                    }
                }
            }
            pairs_starts[from + 1] = pairs.len() as u32;
        }
        let forward = Self { starts: pairs_starts, neighbours: pairs, weights };
        let (mirror_starts, mirror) = forward.transposed();
        let mut symmetric = Self { starts: vec![0], neighbours: Vec::new(), weights: Vec::new() };
        seen.fill(u32::MAX);
        for from in 0..n {
            let back = &mirror[mirror_starts[from]..mirror_starts[from + 1]];
            for &to in forward.neighbours(from).iter().chain(back) {
                if seen[to as usize] != from as u32 {
                    seen[to as usize] = from as u32;
                    symmetric.neighbours.push(to);
                }
            }
            let start = symmetric.starts[from] as usize;
            symmetric.neighbours[start..].sort_unstable();
            symmetric.starts.push(symmetric.neighbours.len() as u32);
        }
        symmetric.weights = forward.weights;
        symmetric
    }

    fn transposed(&self) -> (Vec<usize>, Vec<u32>) {
        let mut starts = vec![0usize; self.n() + 1];
        for &to in &self.neighbours {
            starts[to as usize + 1] += 1;
        }
        for vertex in 0..self.n() {
            starts[vertex + 1] += starts[vertex];
        }
        let mut fill = starts.clone();
        let mut back = vec![0u32; self.neighbours.len()];
        for from in 0..self.n() {
            for &to in self.neighbours(from) {
                back[fill[to as usize]] = from as u32;
                fill[to as usize] += 1;
            }
        }
        (starts, back)
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
