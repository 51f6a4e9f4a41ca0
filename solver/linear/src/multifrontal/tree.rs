//! Elimination tree and relaxed supernodes of an ordered graph (@liu1990, @ashcraft1989).

use super::graph::Graph;

/// No parent.
pub(super) const NONE: u32 = u32::MAX;

/// Vertices eliminated together, and those their elimination couples.
#[derive(Debug, Clone, Default)]
pub(super) struct Supernode {
    /// Vertices eliminated here, in order.
    pub own: Vec<u32>,
    /// Later vertices that the front holds.
    pub rest: Vec<u32>,
    /// The supernode its contribution goes to.
    pub parent: u32,
    /// Unknowns eliminated, and unknowns of the rest.
    pub k: usize,
    pub r: usize,
}

impl Supernode {
    /// A rough time of a front in nanoseconds: what every front costs, memory traffic of assembly,
    /// arithmetic. Fitted to fronts of planar meshes on one core with AVX2.
    pub fn work(k: usize, r: usize) -> f64 {
        let (columns, m) = (k as f64, (k + r) as f64);
        // Kernels reach their speed with some tens of columns.
        let flops_per_ns = 36.0 * columns / (columns + 8.0);
        300.0 + 0.7 * m * m + flops(k, r) / flops_per_ns
    }

    /// That time with a price on the entries of the factors: they are read in several
    /// substitutions for each factorisation, and they are most of the memory of a run.
    fn cost(k: usize, r: usize) -> f64 {
        let entries = (k + r).pow(2) - r.pow(2);
        Self::work(k, r) + 8.0 * entries as f64
    }
}

/// Operations that eliminate k unknowns of a front with r others.
pub(super) fn flops(k: usize, r: usize) -> f64 {
    let (k, r) = (k as f64, r as f64);
    k * k * k * 2.0 / 3.0 + 2.0 * k * k * r + 2.0 * k * r * r
}

/// Parent of each vertex in the elimination tree, vertices named by their place in the order.
fn elimination_tree(graph: &Graph, order: &[u32], place: &[u32]) -> Vec<u32> {
    let n = order.len();
    let mut parent = vec![NONE; n];
    let mut ancestor = vec![NONE; n];
    for later in 0..n as u32 {
        for &neighbour in graph.neighbours(order[later as usize] as usize) {
            let mut vertex = place[neighbour as usize];
            if vertex >= later {
                continue;
            }
            // Paths to the root are shortened as they are walked.
            loop {
                let next = ancestor[vertex as usize];
                if next == later {
                    break;
                }
                ancestor[vertex as usize] = later;
                if next == NONE {
                    parent[vertex as usize] = later;
                    break;
                }
                vertex = next;
            }
        }
    }
    parent
}

/// Supernodes, children before parents, of a graph whose vertices are eliminated in `order`.
pub(super) fn supernodes(graph: &Graph, order: &[u32]) -> Vec<Supernode> {
    let n = order.len();
    let mut place = vec![0u32; n];
    for (position, &vertex) in order.iter().enumerate() {
        place[vertex as usize] = position as u32;
    }
    let parent = elimination_tree(graph, order, &place);
    relaxed(fundamental(graph, order, &place, &parent))
}

/// Supernodes whose vertices have the same rest, from the structure of every column.
fn fundamental(graph: &Graph, order: &[u32], place: &[u32], parent: &[u32]) -> Vec<Supernode> {
    let n = order.len();
    let mut children: Vec<Vec<u32>> = vec![Vec::new(); n];
    let mut found: Vec<Supernode> = Vec::new();
    let mut seen = vec![NONE; n];
    for j in 0..n {
        seen[j] = j as u32;
        let mut rest: Vec<u32> = Vec::new();
        let mut push = |position: u32| {
            if position > j as u32 && seen[position as usize] != j as u32 {
                seen[position as usize] = j as u32;
                rest.push(position);
            }
        };
        graph.neighbours(order[j] as usize).iter().for_each(|&to| push(place[to as usize]));
        for &child in &children[j] {
            found[child as usize].rest.iter().for_each(|&position| push(position));
        }
        let mergeable = children[j]
            .iter()
            .copied()
            .find(|&child| found[child as usize].rest.len() == rest.len() + 1);
        let weight = graph.weights[order[j] as usize] as usize;
        let index = match mergeable {
            Some(child) => child,
            None => {
                found.push(Supernode { parent: NONE, ..Default::default() });
                found.len() as u32 - 1
            }
        };
        let node = &mut found[index as usize];
        node.own.push(j as u32);
        node.k += weight;
        node.rest = rest;
        for child in std::mem::take(&mut children[j]) {
            if child != index {
                found[child as usize].parent = index;
            }
        }
        if parent[j] != NONE {
            children[parent[j] as usize].push(index);
        }
    }
    for node in &mut found {
        node.r =
            node.rest.iter().map(|&at| graph.weights[order[at as usize] as usize] as usize).sum();
    }
    found
}

/// Merges children into parents where one larger front costs less than two.
fn relaxed(mut nodes: Vec<Supernode>) -> Vec<Supernode> {
    let mut children: Vec<Vec<u32>> = vec![Vec::new(); nodes.len()];
    let mut roots = Vec::new();
    for (index, node) in nodes.iter().enumerate() {
        match node.parent {
            NONE => roots.push(index as u32),
            parent => children[parent as usize].push(index as u32),
        }
    }
    let sequence = postorder(&roots, &children);
    for &index in &sequence {
        let mut own_children = std::mem::take(&mut children[index as usize]);
        let mut kept = Vec::new();
        own_children.sort_by_key(|&child| {
            let child = &nodes[child as usize];
            // Fewest zeros first.
            (nodes[index as usize].k + nodes[index as usize].r).saturating_sub(child.r)
        });
        for child in own_children {
            let (k, r) = (nodes[index as usize].k, nodes[index as usize].r);
            let (k_child, r_child) = (nodes[child as usize].k, nodes[child as usize].r);
            let merged = Supernode::cost(k + k_child, r);
            if merged <= Supernode::cost(k, r) + Supernode::cost(k_child, r_child) {
                let mut own = std::mem::take(&mut nodes[child as usize].own);
                own.append(&mut nodes[index as usize].own);
                nodes[index as usize].own = own;
                nodes[index as usize].k += k_child;
                nodes[child as usize].k = 0;
                kept.append(&mut children[child as usize]);
            } else {
                kept.push(child);
            }
        }
        kept.sort_unstable();
        children[index as usize] = kept;
    }
    let roots: Vec<u32> = roots.into_iter().filter(|&root| nodes[root as usize].k > 0).collect();
    let sequence = postorder(&roots, &children);
    let mut renamed = vec![NONE; nodes.len()];
    for (new, &old) in sequence.iter().enumerate() {
        renamed[old as usize] = new as u32;
    }
    let mut result: Vec<Supernode> =
        sequence.iter().map(|&old| std::mem::take(&mut nodes[old as usize])).collect();
    for node in &mut result {
        node.parent = NONE;
    }
    for (&old, new) in sequence.iter().zip(0u32..) {
        for &child in &children[old as usize] {
            result[renamed[child as usize] as usize].parent = new;
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
