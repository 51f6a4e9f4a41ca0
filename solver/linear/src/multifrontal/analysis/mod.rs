//! `Analysis`: everything about a factorisation that the sparsity decides.

mod entries;
mod stacks;
mod subtrees;
mod tree;

use self::entries::{EntryMap, Positions};
use self::stacks::plan_stack;
use self::subtrees::CutTree;
pub(super) use self::subtrees::MIN_PARALLEL_FLOPS;
use self::tree::{Supernode, flops, supernodes};
use super::buckets::Buckets;
use super::front::{Front, Subtree};
use super::ordering::{Graph, Ordering, Vertices, order};
use super::segments::{Segment, Slot};
use crate::sparse::index::to_u32;
use crate::sparse::{Pattern, Unknowns};

/// Order of elimination, fronts, and where everything goes: valid while the sparsity lasts.
///
/// A position is an index in the order of elimination.
#[derive(Debug, Clone)]
pub struct Analysis {
    /// Number of stored entries of the matrix.
    pub(super) n_entries: usize,
    /// Unknown at each position.
    pub(super) unknown_at: Vec<u32>,
    /// Whether the unknown at each position is a pressure.
    pub(super) is_pressure_at: Vec<bool>,
    /// Unknowns with dense rows, ascending.
    pub(super) dense: Vec<u32>,
    /// 0, 1, 2, ...: the slots of the pivot columns of a front are a slice of it.
    pub(super) pivot_slots: Vec<u32>,
    /// Diagonal entry of the unknown at each position, where one is stored.
    pub(super) diagonal: Vec<Option<u32>>,
    pub(super) fronts: Vec<Front>,
    pub(super) children: Vec<u32>,
    /// Positions of the border of each front, ascending.
    pub(super) border: Vec<u32>,
    /// Slots of these in the segment of the front.
    pub(super) border_slots: Vec<u32>,
    /// Indices of these in the parent front: its own unknowns, then its border.
    pub(super) relative: Vec<u32>,
    pub(super) entries: EntryMap,
    /// Number of stored entries of all factors.
    pub(super) n_values: usize,
    /// Subtrees, none of which contains another.
    pub(super) subtrees: Vec<Subtree>,
    /// The fronts above the subtrees.
    pub(super) top: Subtree,
    /// Of each subtree, then of the fronts above.
    pub(super) segments: Vec<Segment>,
    /// Where each unknown is.
    pub(super) slots: Vec<Slot>,
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
        Self::cut(pattern, unknowns, ordering, MIN_PARALLEL_FLOPS)
    }

    /// The same, cut into subtrees where a factorisation has that many operations.
    pub(super) fn cut(
        pattern: &Pattern,
        unknowns: &Unknowns,
        ordering: Ordering,
        least: f64,
    ) -> Self {
        let n = pattern.n();
        assert_eq!(unknowns.node.len(), n, "a node for each unknown");
        assert_eq!(unknowns.is_pressure.len(), n, "a kind for each unknown");
        let vertices = Vertices::new(unknowns);
        let graph = Graph::new(pattern, &vertices);
        let mut sequence = order(&graph.truncated(vertices.n_nodes), ordering);
        sequence.extend(to_u32(vertices.n_nodes)..to_u32(vertices.n));
        let tree = CutTree::new(supernodes(&graph, &sequence), least);

        let members = Members {
            sequence: &sequence,
            unknowns: Buckets::new(&vertices.of_unknown, vertices.n),
        };
        let mut dense: Vec<u32> = unknowns.dense.iter().map(|&unknown| to_u32(unknown)).collect();
        dense.sort_unstable();
        let kinds = Kinds { is_pressure: &unknowns.is_pressure, dense: &dense };
        let mut layout = Layout::new(&tree.supernodes, &members, kinds);
        let border = layout.borders(&tree.supernodes, &members);
        layout.count_dense(&border, kinds);
        let Layout { mut fronts, unknown_at, position_of, n_values } = layout;
        let (children, relative) = (list_children(&mut fronts), relative_indices(&fronts, &border));
        let is_pressure_at: Vec<bool> =
            unknown_at.iter().map(|&unknown| unknowns.is_pressure[unknown as usize]).collect();
        let positions = Positions { of_unknown: &position_of, is_pressure: &is_pressure_at };
        let entries = EntryMap::new(pattern, positions, &mut fronts, &border);

        let mut first = 0;
        let mut next_subtree = |size: usize| {
            let range = first..first + size;
            first = range.end;
            plan_stack(&mut fronts, &children, range)
        };
        let subtrees: Vec<Subtree> =
            tree.subtree_sizes.iter().map(|&size| next_subtree(size)).collect();
        let top = next_subtree(tree.n_above);
        let segments = segments(&subtrees, &top, &fronts, &border);
        let border_slots = border_slots(&segments, &mut fronts, &border);
        Self {
            n_entries: pattern.n_entries(),
            diagonal: diagonal(pattern, &unknown_at),
            is_pressure_at,
            slots: slots(&segments, &unknown_at),
            unknown_at,
            dense,
            pivot_slots: (0..to_u32(n)).collect(),
            fronts,
            children,
            border,
            border_slots,
            relative,
            entries,
            n_values,
            subtrees,
            top,
            segments,
        }
    }

    /// Number of unknowns.
    #[must_use]
    pub fn n(&self) -> usize {
        self.unknown_at.len()
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

    /// Estimated time of one factorisation on one core (ns): a function of the fronts.
    #[must_use]
    pub fn factorisation_cost(&self) -> f64 {
        self.fronts.iter().map(|front| Supernode::time(front.k, front.r)).sum()
    }

    /// Estimated time of the substitutions for one right-hand side on one core (ns).
    #[must_use]
    pub fn substitution_cost(&self) -> f64 {
        // Factors are read once, at some 9 GB/s.
        0.9 * self.n_values as f64 + 150.0 * self.fronts.len() as f64
    }

    pub(super) fn border_of(&self, front: &Front) -> &[u32] {
        &self.border[front.border()]
    }

    pub(super) fn border_slots_of(&self, front: &Front) -> &[u32] {
        &self.border_slots[front.border()]
    }

    pub(super) fn relative_of(&self, front: &Front) -> &[u32] {
        &self.relative[front.border()]
    }

    pub(super) fn children_of(&self, front: &Front) -> &[u32] {
        &self.children[front.children.clone()]
    }

    /// The subtree of a front that is not above the subtrees.
    pub(super) fn subtree_of(&self, front: usize) -> usize {
        self.subtrees.partition_point(|subtree| subtree.fronts.end <= front)
    }
}

/// The unknowns of vertices, which are named by their rank in the order of elimination.
struct Members<'a> {
    /// Vertex of each rank.
    sequence: &'a [u32],
    /// Unknowns of each vertex.
    unknowns: Buckets,
}

impl Members<'_> {
    fn of<'a>(&'a self, ranks: &'a [u32]) -> impl Iterator<Item = u32> {
        let vertices = ranks.iter().map(|&rank| self.sequence[rank as usize] as usize);
        vertices.flat_map(|vertex| self.unknowns.of(vertex).iter().copied())
    }
}

/// What the unknowns are.
#[derive(Debug, Clone, Copy)]
struct Kinds<'a> {
    is_pressure: &'a [bool],
    /// Unknowns with dense rows, ascending.
    dense: &'a [u32],
}

impl Kinds<'_> {
    fn is_dense(self, unknown: u32) -> bool {
        self.dense.binary_search(&unknown).is_ok()
    }

    /// Unknowns of a front are eliminated by ascending rank. Velocities first: a pressure has no pivot
    /// before its velocities are eliminated. Rigid velocities last, as in the fronts below.
    fn rank(self, unknown: u32) -> u8 {
        if self.is_dense(unknown) { 2 } else { u8::from(self.is_pressure[unknown as usize]) }
    }
}

/// The fronts of supernodes, and the order of elimination that they give.
struct Layout {
    fronts: Vec<Front>,
    unknown_at: Vec<u32>,
    position_of: Vec<u32>,
    n_values: usize,
}

impl Layout {
    fn new(supernodes: &[Supernode], members: &Members<'_>, kinds: Kinds<'_>) -> Self {
        let n = kinds.is_pressure.len();
        let mut unknown_at: Vec<u32> = Vec::with_capacity(n);
        let mut fronts = Vec::with_capacity(supernodes.len());
        for node in supernodes {
            let start = unknown_at.len();
            unknown_at.extend(members.of(&node.own));
            unknown_at[start..].sort_by_key(|&unknown| kinds.rank(unknown));
            let parent = node.parent.map(|parent| parent as usize);
            fronts.push(Front::new(start, unknown_at.len() - start, node.r, parent));
        }
        let mut position_of = vec![0u32; n];
        for (position, &unknown) in (0..to_u32(n)).zip(&unknown_at) {
            position_of[unknown as usize] = position;
        }
        let mut n_values = 0;
        for front in &mut fronts {
            front.values = n_values;
            n_values += front.n_values();
        }
        Self { fronts, unknown_at, position_of, n_values }
    }

    /// Positions of the borders of all fronts, ascending within each.
    fn borders(&mut self, supernodes: &[Supernode], members: &Members<'_>) -> Vec<u32> {
        let mut border: Vec<u32> = Vec::new();
        for (front, node) in self.fronts.iter_mut().zip(supernodes) {
            front.border_start = border.len();
            let unknowns = members.of(&node.border);
            border.extend(unknowns.map(|unknown| self.position_of[unknown as usize]));
            border[front.border_start..].sort_unstable();
        }
        border
    }

    /// Counts the unknowns with dense rows at the end of each border.
    fn count_dense(&mut self, border: &[u32], kinds: Kinds<'_>) {
        for front in &mut self.fronts {
            let from_the_end = border[front.border()].iter().rev();
            let is_dense = |&&at: &&u32| kinds.is_dense(self.unknown_at[at as usize]);
            front.n_dense = from_the_end.take_while(is_dense).count();
        }
    }
}

/// The children of all fronts, one front after the other, then the roots.
fn list_children(fronts: &mut [Front]) -> Vec<u32> {
    let n_fronts = fronts.len();
    let parents: Vec<u32> =
        fronts.iter().map(|front| to_u32(front.parent.unwrap_or(n_fronts))).collect();
    let Buckets { starts, members } = Buckets::new(&parents, n_fronts + 1);
    for (front, range) in fronts.iter_mut().zip(starts.windows(2)) {
        front.children = range[0]..range[1];
    }
    members
}

/// The index in its parent of each unknown of the border of each front.
fn relative_indices(fronts: &[Front], border: &[u32]) -> Vec<u32> {
    let mut relative = vec![0; border.len()];
    for front in fronts {
        let Some(parent) = front.parent.map(|parent| &fronts[parent]) else { continue };
        let parent_border = &border[parent.border()];
        let mut at = 0;
        for (index, &position) in relative[front.border()].iter_mut().zip(&border[front.border()]) {
            *index = to_u32(if (position as usize) < parent.start + parent.k {
                position as usize - parent.start
            } else {
                // Both borders ascend.
                at += parent_border[at..].iter().take_while(|&&other| other < position).count();
                parent.k + at
            });
        }
    }
    relative
}

/// The segments of subtrees, then that of the fronts above.
fn segments(subtrees: &[Subtree], top: &Subtree, fronts: &[Front], border: &[u32]) -> Vec<Segment> {
    let all = subtrees.iter().chain([top]);
    all.map(|subtree| Segment::new(subtree, fronts, border)).collect()
}

/// Slots of the borders of all fronts; those of their own unknowns are set.
fn border_slots(segments: &[Segment], fronts: &mut [Front], border: &[u32]) -> Vec<u32> {
    let mut slots = vec![0; border.len()];
    for segment in segments {
        for front in &mut fronts[segment.fronts.clone()] {
            front.slot = front.start - segment.positions.start;
            for (slot, &position) in slots[front.border()].iter_mut().zip(&border[front.border()]) {
                *slot = segment.slot(position).expect("a border is in that of the root");
            }
        }
    }
    slots
}

/// Where each unknown is.
fn slots(segments: &[Segment], unknown_at: &[u32]) -> Vec<Slot> {
    let mut slots = vec![Slot::default(); unknown_at.len()];
    for (segment, of_segment) in (0..).zip(segments) {
        for (index, &unknown) in (0..).zip(&unknown_at[of_segment.positions.clone()]) {
            slots[unknown as usize] = Slot { segment, index };
        }
    }
    slots
}

/// Where the diagonal entry of each position is stored.
fn diagonal(pattern: &Pattern, unknown_at: &[u32]) -> Vec<Option<u32>> {
    let entry = |&unknown: &u32| pattern.entry(unknown as usize, unknown as usize).map(to_u32);
    unknown_at.iter().map(entry).collect()
}
