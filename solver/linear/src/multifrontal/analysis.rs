//! `Analysis`: everything about a factorisation that the sparsity decides.

use std::ops::Range;

use super::graph::{Graph, bucket};
use super::ordering::{Ordering, order};
use super::tree::{NONE, Supernode, flops, supernodes};
use crate::sparse::{Pattern, Unknowns};

/// A subtree is cut off when it takes less than this part of all arithmetic.
const SUBTREE_SHARE: f64 = 1.0 / 24.0;
/// Matrices with less arithmetic are one subtree.
const MIN_PARALLEL_FLOPS: f64 = 2e7;

/// A front: a dense matrix over the unknowns that are eliminated in it and those they couple.
#[derive(Debug, Clone)]
pub(super) struct Front {
    /// First eliminated unknown, as a place in the elimination order.
    pub start: usize,
    /// Number of unknowns eliminated.
    pub k: usize,
    /// Number of the rest.
    pub r: usize,
    /// The front its contribution goes to.
    pub parent: Option<usize>,
    pub children: Range<usize>,
    /// Where its part of `rest` and `relative` begins.
    pub rest: usize,
    /// Where its factors begin: m x k columns of L (and U11), then k x r of U12.
    pub values: usize,
    /// Its part of the entries of the matrix: those among velocities, and from `mixed` on those of
    /// pressures.
    pub entries: Range<usize>,
    pub mixed: usize,
    /// Where its contribution is kept in the stack until the parent takes it.
    pub contribution: usize,
    /// Whether that stack grows down: children and parents use opposite ends.
    pub grows_down: bool,
}

impl Front {
    /// Order of the front.
    pub fn m(&self) -> usize {
        self.k + self.r
    }

    /// Number of stored factor entries.
    pub fn n_values(&self) -> usize {
        self.m() * self.k + self.k * self.r
    }
}

/// Fronts that one task works through, with a stack of their own.
#[derive(Debug, Clone)]
pub(super) struct Part {
    pub fronts: Range<usize>,
    /// Size of the stack of contributions.
    pub stack: usize,
}

/// Order of elimination, fronts, and where everything goes: valid while the sparsity lasts.
#[derive(Debug, Clone)]
pub struct Analysis {
    /// Number of unknowns.
    pub(super) n: usize,
    pub(super) n_entries: usize,
    /// Unknown at each place of the elimination order.
    pub(super) unknown_at: Vec<u32>,
    /// Whether the unknown at each place is a pressure.
    pub(super) is_pressure_at: Vec<bool>,
    /// Unknowns with dense rows, ascending.
    pub(super) dense: Vec<u32>,
    /// 0, 1, 2, ...: pivot columns of a front are a slice of it.
    pub(super) places: Vec<u32>,
    /// Diagonal entry of the unknown at each place, `NONE` where it is not stored.
    pub(super) diagonal: Vec<u32>,
    pub(super) fronts: Vec<Front>,
    pub(super) children: Vec<u32>,
    /// Places of the rest of each front, ascending.
    pub(super) rest: Vec<u32>,
    /// Where these are in the parent: its own unknowns, then its rest.
    pub(super) relative: Vec<u32>,
    /// Entries of the matrix by front, and where in the front's values they go.
    pub(super) sources: Vec<u32>,
    pub(super) targets: Vec<u32>,
    pub(super) n_values: usize,
    /// Subtrees without common ancestors among each other, then the fronts above them.
    pub(super) subtrees: Vec<Part>,
    pub(super) top: Part,
}

impl Analysis {
    /// Orders a matrix and lays out its factors.
    ///
    /// The pattern need not be symmetric; its union with the transpose is factorised.
    ///
    /// # Panics
    /// When `unknowns` does not fit the pattern.
    #[must_use]
    pub fn new(pattern: &Pattern, unknowns: &Unknowns, ordering: Ordering) -> Self {
        let n = pattern.n();
        assert_eq!(unknowns.node.len(), n, "a node for each unknown");
        assert_eq!(unknowns.is_pressure.len(), n, "a kind for each unknown");
        let (vertex, n_sparse, n_vertices) = vertices(unknowns);
        let graph = Graph::new(pattern, &vertex, n_vertices);
        let mut sequence = order(&graph.truncated(n_sparse), ordering);
        sequence.extend(n_sparse as u32..n_vertices as u32);
        let (nodes, n_parts) = by_subtree(supernodes(&graph, &sequence));

        let mut dense: Vec<u32> = unknowns.dense.iter().map(|&unknown| unknown as u32).collect();
        dense.sort_unstable();

        let (starts, members) = bucket(&vertex, n_vertices);
        let members = |position: u32| {
            let vertex = sequence[position as usize] as usize;
            &members[starts[vertex]..starts[vertex + 1]]
        };
        let mut unknown_at: Vec<u32> = Vec::with_capacity(n);
        let mut fronts: Vec<Front> = Vec::with_capacity(nodes.len());
        for node in &nodes {
            let start = unknown_at.len();
            // Velocities first: a pressure has no pivot before its velocities are eliminated.
            for pressures in [false, true] {
                let own = node.own.iter().flat_map(|&position| members(position));
                unknown_at.extend(
                    own.filter(|&&unknown| unknowns.is_pressure[unknown as usize] == pressures),
                );
            }
            fronts.push(Front {
                start,
                k: unknown_at.len() - start,
                r: node.r,
                parent: (node.parent != NONE).then_some(node.parent as usize),
                children: 0..0,
                rest: 0,
                values: 0,
                entries: 0..0,
                mixed: 0,
                contribution: 0,
                grows_down: false,
            });
        }
        let mut place_of = vec![0u32; n];
        for (place, &unknown) in unknown_at.iter().enumerate() {
            place_of[unknown as usize] = place as u32;
        }
        let mut rest: Vec<u32> = Vec::new();
        let mut n_values = 0;
        for (front, node) in fronts.iter_mut().zip(&nodes) {
            front.rest = rest.len();
            front.values = n_values;
            n_values += front.n_values();
            let unknowns = node.rest.iter().flat_map(|&position| members(position));
            rest.extend(unknowns.map(|&unknown| place_of[unknown as usize]));
            rest[front.rest..].sort_unstable();
        }
        let mut analysis = Self {
            n,
            n_entries: pattern.rows.len(),
            dense,
            is_pressure_at: unknown_at
                .iter()
                .map(|&unknown| unknowns.is_pressure[unknown as usize])
                .collect(),
            unknown_at,
            places: (0..n as u32).collect(),
            diagonal: Vec::new(),
            children: Vec::new(),
            relative: vec![0; rest.len()],
            rest,
            sources: Vec::new(),
            targets: Vec::new(),
            n_values,
            subtrees: Vec::new(),
            top: Part { fronts: 0..0, stack: 0 },
            fronts,
        };
        analysis.diagonal = diagonal(pattern, &analysis.unknown_at);
        analysis.link();
        analysis.place_entries(pattern, &place_of);
        analysis.plan_stacks(&n_parts);
        analysis
    }

    /// Number of unknowns.
    #[must_use]
    pub fn n(&self) -> usize {
        self.n
    }

    /// Number of stored entries of L and U.
    #[must_use]
    pub fn n_factor_entries(&self) -> usize {
        self.n_values
    }

    /// Floating-point operations of one factorisation.
    #[must_use]
    pub fn flops(&self) -> f64 {
        self.fronts.iter().map(|front| flops(front.k, front.r)).sum()
    }

    /// A rough time of one factorisation, in nanoseconds of one core: a function of the fronts.
    #[must_use]
    pub fn factorisation_cost(&self) -> f64 {
        self.fronts.iter().map(|front| Supernode::work(front.k, front.r)).sum()
    }

    /// A rough time of the substitutions for one right-hand side, in nanoseconds of one core.
    #[must_use]
    pub fn substitution_cost(&self) -> f64 {
        // Factors are read once, at some 9 GB/s.
        0.9 * self.n_values as f64 + 150.0 * self.fronts.len() as f64
    }

    pub(super) fn rest_of(&self, front: &Front) -> &[u32] {
        &self.rest[front.rest..front.rest + front.r]
    }

    pub(super) fn relative_of(&self, front: &Front) -> &[u32] {
        &self.relative[front.rest..front.rest + front.r]
    }

    pub(super) fn children_of(&self, front: &Front) -> &[u32] {
        &self.children[front.children.clone()]
    }

    /// The subtree a front outside the top part belongs to.
    pub(super) fn subtree_of(&self, front: usize) -> usize {
        self.subtrees.partition_point(|part| part.fronts.end <= front)
    }

    /// Children of each front, and where the rest of each child is in its parent.
    fn link(&mut self) {
        let n_fronts = self.fronts.len();
        let parents: Vec<u32> =
            self.fronts.iter().map(|front| front.parent.map_or(n_fronts, |p| p) as u32).collect();
        let (starts, children) = bucket(&parents, n_fronts + 1);
        self.children = children;
        for index in 0..n_fronts {
            self.fronts[index].children = starts[index]..starts[index + 1];
            let front = &self.fronts[index];
            let Some(parent) = front.parent.map(|parent| &self.fronts[parent]) else { continue };
            let parent_rest = &self.rest[parent.rest..parent.rest + parent.r];
            let mut at = 0;
            for offset in front.rest..front.rest + front.r {
                let place = self.rest[offset] as usize;
                self.relative[offset] = if place < parent.start + parent.k {
                    (place - parent.start) as u32
                } else {
                    at += parent_rest[at..]
                        .iter()
                        .take_while(|&&other| (other as usize) < place)
                        .count();
                    (parent.k + at) as u32
                };
            }
        }
    }

    /// For each front, which entries of the matrix it takes, and where they go in its values.
    fn place_entries(&mut self, pattern: &Pattern, place_of: &[u32]) {
        let n = self.n;
        let mut front_of = vec![0u32; n];
        for (index, front) in self.fronts.iter().enumerate() {
            front_of[front.start..front.start + front.k].fill(index as u32);
        }
        // Two buckets a front: entries among velocities, entries of pressures.
        let mut buckets = Vec::with_capacity(pattern.rows.len());
        let mut columns = Vec::with_capacity(pattern.rows.len());
        for column in 0..n {
            let own = place_of[column];
            for &row in pattern.column(column) {
                let row = place_of[row];
                let mixed = self.is_pressure_at[row as usize] || self.is_pressure_at[own as usize];
                buckets.push(2 * front_of[row.min(own) as usize] + u32::from(mixed));
                columns.push(own);
            }
        }
        let (starts, sources) = bucket(&buckets, 2 * self.fronts.len());
        self.sources = sources;
        for (index, front) in self.fronts.iter_mut().enumerate() {
            front.entries = starts[2 * index]..starts[2 * index + 2];
            front.mixed = starts[2 * index + 1];
        }
        let mut local = vec![0u32; n];
        self.targets = Vec::with_capacity(columns.len());
        for front in &self.fronts {
            for (index, place) in local[front.start..front.start + front.k].iter_mut().enumerate() {
                *place = index as u32;
            }
            for (index, &place) in self.rest_of(front).iter().enumerate() {
                local[place as usize] = (front.k + index) as u32;
            }
            for &entry in &self.sources[front.entries.clone()] {
                let row = place_of[pattern.rows[entry as usize]];
                let column = columns[entry as usize];
                let (row, column) = (local[row as usize] as usize, local[column as usize] as usize);
                self.targets.push(if column < front.k {
                    row + column * front.m()
                } else {
                    front.m() * front.k + row + (column - front.k) * front.k
                } as u32);
            }
        }
    }

    /// Where each contribution lies in the stack of its part, and how large the stacks get.
    fn plan_stacks(&mut self, part_sizes: &[usize]) {
        let mut first = 0;
        let mut parts = Vec::new();
        for &size in part_sizes {
            parts.push(self.plan_stack(first..first + size));
            first += size;
        }
        self.top = parts.pop().expect("the fronts above the subtrees are the last part");
        self.subtrees = parts;
    }

    fn plan_stack(&mut self, fronts: Range<usize>) -> Part {
        let is_inside = |front: usize| fronts.contains(&front);
        // Ends used by now from below and from above.
        let (mut low, mut high, mut most) = (0usize, 0usize, 0usize);
        for index in fronts.clone().rev() {
            // Parents come after their children.
            let parent = self.fronts[index].parent.filter(|&parent| is_inside(parent));
            self.fronts[index].grows_down =
                parent.is_some_and(|parent| !self.fronts[parent].grows_down);
        }
        for index in fronts.clone() {
            let front = &self.fronts[index];
            let (size, down) = (front.r * front.r, front.grows_down);
            let leaves_part = !front.parent.is_some_and(is_inside);
            let taken: usize = self
                .children_of(front)
                .iter()
                .filter(|&&child| is_inside(child as usize))
                .map(|&child| self.fronts[child as usize].r.pow(2))
                .sum();
            // What leaves the part is kept outside the stack.
            let size = if leaves_part { 0 } else { size };
            if down {
                high += size;
                most = most.max(low + high);
                low -= taken;
                self.fronts[index].contribution = high;
            } else {
                self.fronts[index].contribution = low;
                low += size;
                most = most.max(low + high);
                high -= taken;
            }
        }
        for index in fronts.clone() {
            if self.fronts[index].grows_down {
                self.fronts[index].contribution = most - self.fronts[index].contribution;
            }
        }
        Part { fronts, stack: most }
    }
}

/// Where the diagonal entry of each place is stored.
fn diagonal(pattern: &Pattern, unknown_at: &[u32]) -> Vec<u32> {
    let position = |unknown: &u32| {
        let column = *unknown as usize;
        let found = pattern.column(column).iter().position(|&row| row == column);
        found.map_or(NONE, |offset| (pattern.columns[column] + offset) as u32)
    };
    unknown_at.iter().map(position).collect()
}

/// A vertex of the graph for each unknown: those of the mesh nodes first, then the dense unknowns.
fn vertices(unknowns: &Unknowns) -> (Vec<u32>, usize, usize) {
    let n = unknowns.node.len();
    let mut is_dense = vec![false; n];
    for &unknown in &unknowns.dense {
        is_dense[unknown] = true;
    }
    let sparse = || (0..n).filter(|&unknown| !is_dense[unknown]);
    let n_nodes = sparse().map(|unknown| unknowns.node[unknown] as usize + 1).max().unwrap_or(0);
    let mut vertex_of_node = vec![NONE; n_nodes];
    let mut n_vertices = 0u32;
    let mut vertex = vec![0u32; n];
    for unknown in sparse() {
        let slot = &mut vertex_of_node[unknowns.node[unknown] as usize];
        if *slot == NONE {
            *slot = n_vertices;
            n_vertices += 1;
        }
        vertex[unknown] = *slot;
    }
    let n_sparse = n_vertices as usize;
    for unknown in (0..n).filter(|&unknown| is_dense[unknown]) {
        vertex[unknown] = n_vertices;
        n_vertices += 1;
    }
    (vertex, n_sparse, n_vertices as usize)
}

/// Supernodes reordered so that each subtree is contiguous and the fronts above come last, with
/// the number of fronts of each part. The cut does not depend on the number of threads.
fn by_subtree(nodes: Vec<Supernode>) -> (Vec<Supernode>, Vec<usize>) {
    let n = nodes.len();
    let mut total = vec![0.0; n];
    let mut size = vec![1usize; n];
    for (index, node) in nodes.iter().enumerate() {
        total[index] += flops(node.k, node.r);
        if node.parent != NONE {
            let (below, above) = (total[index], node.parent as usize);
            total[above] += below;
            size[above] += size[index];
        }
    }
    let roots = (0..n).filter(|&index| nodes[index].parent == NONE);
    let all: f64 = roots.map(|index| total[index]).sum();
    let limit = if all < MIN_PARALLEL_FLOPS { f64::INFINITY } else { all * SUBTREE_SHARE };
    let in_subtree = |index: usize| total[index] <= limit;
    let mut sequence = Vec::with_capacity(n);
    let mut parts = Vec::new();
    for root in 0..n {
        let above = nodes[root].parent;
        if in_subtree(root) && (above == NONE || !in_subtree(above as usize)) {
            // In postorder a subtree ends with its root.
            sequence.extend(root + 1 - size[root]..=root);
            parts.push(size[root]);
        }
    }
    let n_below = sequence.len();
    sequence.extend((0..n).filter(|&index| !in_subtree(index)));
    parts.push(n - n_below);
    let mut renamed = vec![0u32; n];
    for (new, &old) in sequence.iter().enumerate() {
        renamed[old] = new as u32;
    }
    let mut nodes: Vec<Option<Supernode>> = nodes.into_iter().map(Some).collect();
    let reordered = sequence
        .iter()
        .map(|&old| {
            let mut node = nodes[old].take().expect("each supernode is taken once");
            if node.parent != NONE {
                node.parent = renamed[node.parent as usize];
            }
            node
        })
        .collect();
    (reordered, parts)
}
