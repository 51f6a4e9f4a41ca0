//! `Front`: what one front eliminates, and where its numbers go; `Subtree`: the fronts of one task.

use std::ops::Range;

/// A front: a dense matrix over the k unknowns eliminated in it and its border, the r unknowns these
/// are coupled to. Unknowns are named by their positions in the order of elimination.
#[derive(Debug, Clone)]
pub(super) struct Front {
    /// Position of the first eliminated unknown.
    pub start: usize,
    /// Its slot in the segment of the front.
    pub slot: usize,
    /// Number of unknowns eliminated.
    pub k: usize,
    /// Number of unknowns of the border.
    pub r: usize,
    /// Number of unknowns with dense rows at the end of the border.
    pub n_dense: usize,
    /// The front its contribution goes to.
    pub parent: Option<usize>,
    /// Its part of the list of all children.
    pub children: Range<usize>,
    /// Where its part of the borders and relative indices begins.
    pub border_start: usize,
    /// Where its factors begin: m x k columns of L (and U11), then k x r of U12.
    pub values: usize,
    /// Its part of the entries of the matrix: those among velocities, then those in rows or columns
    /// of pressures.
    pub entries: Range<usize>,
    /// The first of the latter.
    pub first_pressure_entry: usize,
    /// Where its contribution is kept in the stack until the parent takes it.
    pub contribution: usize,
    /// Whether that stack grows down: children and parents use opposite ends.
    pub grows_down: bool,
}

impl Front {
    /// A front of which only the size and the parent are known.
    pub fn new(start: usize, k: usize, r: usize, parent: Option<usize>) -> Self {
        Self {
            start,
            slot: 0,
            k,
            r,
            n_dense: 0,
            parent,
            children: 0..0,
            border_start: 0,
            values: 0,
            entries: 0..0,
            first_pressure_entry: 0,
            contribution: 0,
            grows_down: false,
        }
    }

    /// Order of the front.
    pub fn m(&self) -> usize {
        self.k + self.r
    }

    /// Number of stored factor entries.
    pub fn n_values(&self) -> usize {
        self.m() * self.k + self.k * self.r
    }

    /// Positions of the unknowns eliminated.
    pub fn positions(&self) -> Range<usize> {
        self.start..self.start + self.k
    }

    /// Slots of the unknowns eliminated.
    pub fn slots(&self) -> Range<usize> {
        self.slot..self.slot + self.k
    }

    /// Its part of the borders and relative indices of all fronts.
    pub fn border(&self) -> Range<usize> {
        self.border_start..self.border_start + self.r
    }
}

/// Fronts that one task factorises, children before parents, with a stack for their contributions: a
/// subtree, or all fronts above the subtrees.
#[derive(Debug, Clone, Default)]
pub(super) struct Subtree {
    pub fronts: Range<usize>,
    /// Size of the stack.
    pub stack_size: usize,
}
