//! Elimination tree and relaxed supernodes of an ordered graph (@liu1990, @ashcraft1989).
//!
//! Vertices are named by their rank, their position in the order of elimination.

use super::super::ordering::Graph;
use crate::sparse::index::to_u32;

/// Vertices eliminated together, and those their elimination couples.
#[derive(Debug, Clone, Default)]
pub(super) struct Supernode {
    /// Vertices eliminated here, in order.
    pub own: Vec<u32>,
    /// Later vertices that the front holds.
    pub border: Vec<u32>,
    /// The supernode its contribution goes to.
    pub parent: Option<u32>,
    /// Number of unknowns eliminated.
    pub k: usize,
    /// Number of unknowns of the border.
    pub r: usize,
}

impl Supernode {
    /// Estimated time of a front (ns): what every front costs, memory traffic of assembly, arithmetic.
    /// Fitted to fronts of planar meshes on one core with AVX2.
    pub fn time(k: usize, r: usize) -> f64 {
        let (columns, m) = (k as f64, (k + r) as f64);
        // Kernels reach their speed with some tens of columns.
        let flops_per_ns = 36.0 * columns / (columns + 8.0);
        300.0 + 0.7 * m * m + flops(k, r) / flops_per_ns
    }

    /// That time with a price on the entries of the factors: they are read in several
    /// substitutions for each factorisation, and they are most of the memory of a run.
    fn cost(k: usize, r: usize) -> f64 {
        let entries = (k + r).pow(2) - r.pow(2);
        Self::time(k, r) + 8.0 * entries as f64
    }
}

/// Floating-point operations that eliminate k unknowns of a front with a border of r others.
pub(super) fn flops(k: usize, r: usize) -> f64 {
    let (k, r) = (k as f64, r as f64);
    k * k * k * 2.0 / 3.0 + 2.0 * k * k * r + 2.0 * k * r * r
}

/// A graph with the order in which its vertices are eliminated.
struct OrderedGraph<'a> {
    graph: &'a Graph,
    /// Vertex of each rank.
    sequence: &'a [u32],
    /// Rank of each vertex.
    rank: Vec<u32>,
}

impl<'a> OrderedGraph<'a> {
    fn new(graph: &'a Graph, sequence: &'a [u32]) -> Self {
        let mut rank = vec![0u32; sequence.len()];
        for (position, &vertex) in (0..to_u32(sequence.len())).zip(sequence) {
            rank[vertex as usize] = position;
        }
        Self { graph, sequence, rank }
    }

    fn n(&self) -> usize {
        self.sequence.len()
    }

    /// Ranks of the neighbours of a vertex.
    fn neighbours(&self, rank: u32) -> impl Iterator<Item = u32> {
        let vertex = self.sequence[rank as usize] as usize;
        self.graph.neighbours(vertex).iter().map(|&neighbour| self.rank[neighbour as usize])
    }

    /// Number of unknowns of a vertex.
    fn weight(&self, rank: u32) -> usize {
        self.graph.weights[self.sequence[rank as usize] as usize] as usize
    }
}

/// Supernodes, children before parents, of a graph whose vertices are eliminated in the order of
/// `sequence`.
pub(super) fn supernodes(graph: &Graph, sequence: &[u32]) -> Vec<Supernode> {
    let ordered = OrderedGraph::new(graph, sequence);
    let parents = elimination_tree(&ordered);
    amalgamated(fundamental(&ordered, &parents))
}

/// Parent of each vertex in the elimination tree.
fn elimination_tree(ordered: &OrderedGraph<'_>) -> Vec<Option<u32>> {
    let mut parent = vec![None; ordered.n()];
    let mut ancestor = vec![None; ordered.n()];
    for later in 0..to_u32(ordered.n()) {
        for neighbour in ordered.neighbours(later).filter(|&neighbour| neighbour < later) {
            let mut vertex = neighbour as usize;
            // Paths to the root are shortened as they are walked.
            loop {
                let next = ancestor[vertex];
                if next == Some(later) {
                    break;
                }
                ancestor[vertex] = Some(later);
                let Some(next) = next else {
                    parent[vertex] = Some(later);
                    break;
                };
                vertex = next as usize;
            }
        }
    }
    parent
}

/// Supernodes whose vertices have the same border, from the structure of every column.
fn fundamental(ordered: &OrderedGraph<'_>, parents: &[Option<u32>]) -> Vec<Supernode> {
    let mut children: Vec<Vec<u32>> = vec![Vec::new(); ordered.n()];
    let mut found: Vec<Supernode> = Vec::new();
    let mut seen = vec![None; ordered.n()];
    for j in 0..to_u32(ordered.n()) {
        seen[j as usize] = Some(j);
        let mut border: Vec<u32> = Vec::new();
        let mut push = |rank: u32| {
            if rank > j && seen[rank as usize] != Some(j) {
                seen[rank as usize] = Some(j);
                border.push(rank);
            }
        };
        ordered.neighbours(j).for_each(&mut push);
        let own_children = std::mem::take(&mut children[j as usize]);
        for &child in &own_children {
            found[child as usize].border.iter().copied().for_each(&mut push);
        }
        let mergeable = own_children
            .iter()
            .copied()
            .find(|&child| found[child as usize].border.len() == border.len() + 1);
        let index = mergeable.unwrap_or_else(|| {
            found.push(Supernode::default());
            to_u32(found.len() - 1)
        });
        let node = &mut found[index as usize];
        node.own.push(j);
        node.k += ordered.weight(j);
        node.border = border;
        for child in own_children {
            if child != index {
                found[child as usize].parent = Some(index);
            }
        }
        if let Some(parent) = parents[j as usize] {
            children[parent as usize].push(index);
        }
    }
    for node in &mut found {
        node.r = node.border.iter().map(|&rank| ordered.weight(rank)).sum();
    }
    found
}

/// Merges children into parents where one larger front costs less than two.
fn amalgamated(mut nodes: Vec<Supernode>) -> Vec<Supernode> {
    let mut children: Vec<Vec<u32>> = vec![Vec::new(); nodes.len()];
    let mut roots = Vec::new();
    for (index, node) in (0..to_u32(nodes.len())).zip(&nodes) {
        match node.parent {
            None => roots.push(index),
            Some(parent) => children[parent as usize].push(index),
        }
    }
    for index in postorder(&roots, &children) {
        let index = index as usize;
        let mut own_children = std::mem::take(&mut children[index]);
        let mut kept = Vec::new();
        // Those that add fewest zeros first
        let m = nodes[index].k + nodes[index].r;
        own_children.sort_by_key(|&child| m.saturating_sub(nodes[child as usize].r));
        for child in own_children {
            let (k, r) = (nodes[index].k, nodes[index].r);
            let (k_child, r_child) = (nodes[child as usize].k, nodes[child as usize].r);
            let merged = Supernode::cost(k + k_child, r);
            if merged <= Supernode::cost(k, r) + Supernode::cost(k_child, r_child) {
                let mut own = std::mem::take(&mut nodes[child as usize].own);
                own.append(&mut nodes[index].own);
                nodes[index].own = own;
                nodes[index].k += k_child;
                nodes[child as usize].k = 0;
                kept.append(&mut children[child as usize]);
            } else {
                kept.push(child);
            }
        }
        kept.sort_unstable();
        children[index] = kept;
    }
    let roots: Vec<u32> = roots.into_iter().filter(|&root| nodes[root as usize].k > 0).collect();
    renumbered(nodes, &postorder(&roots, &children), &children)
}

/// The supernodes of a sequence in its order, with the parents that `children` gives them.
fn renumbered(
    mut nodes: Vec<Supernode>,
    sequence: &[u32],
    children: &[Vec<u32>],
) -> Vec<Supernode> {
    let mut index_of = vec![None; nodes.len()];
    for (index, &node) in sequence.iter().enumerate() {
        index_of[node as usize] = Some(index);
    }
    let mut result: Vec<Supernode> = sequence
        .iter()
        .map(|&node| Supernode { parent: None, ..std::mem::take(&mut nodes[node as usize]) })
        .collect();
    for (parent, &node) in (0..to_u32(sequence.len())).zip(sequence) {
        for &child in &children[node as usize] {
            let child = index_of[child as usize].expect("children of kept supernodes are kept");
            result[child].parent = Some(parent);
        }
    }
    result
}

/// Children before parents, without recursion: a chain may be as long as the matrix.
fn postorder(roots: &[u32], children: &[Vec<u32>]) -> Vec<u32> {
    let mut sequence = Vec::with_capacity(children.len());
    let mut stack: Vec<(u32, usize)> = Vec::new();
    for &root in roots {
        stack.push((root, 0));
        while let Some((node, next)) = stack.pop() {
            if let Some(&child) = children[node as usize].get(next) {
                stack.push((node, next + 1));
                stack.push((child, 0));
            } else {
                sequence.push(node);
            }
        }
    }
    sequence
}
