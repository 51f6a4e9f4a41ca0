//! `Pattern`: where the entries of symmetric matrices of a solid are, and their values.

/// Unknown of a component of a node that is held.
const HELD: usize = usize::MAX;

/// An entry that falls away since a component is held.
const NOWHERE: u32 = u32::MAX;

/// The lower triangle of symmetric matrices, column by column; unknowns are the components that are free.
#[derive(Debug, Clone)]
pub struct Pattern {
    /// Number of components of all nodes.
    n_components: usize,
    /// The component of each unknown.
    pub(super) components: Vec<usize>,
    /// The unknown of each component.
    unknowns: Vec<usize>,
    /// Where each column starts, and where the last ends.
    pub(super) starts: Vec<usize>,
    /// Rows of all entries, ascending in a column, the diagonal first.
    pub(super) rows: Vec<usize>,
    /// Places of the entries of each cell's matrix, its lower triangle row by row.
    scatter: Vec<u32>,
    /// Components of the nodes of a cell.
    n_local: usize,
}

impl Pattern {
    /// The pattern of cells of `n_local` nodes with `d` components each.
    pub(super) fn new(cells: &[usize], n_local: usize, held: &[bool], d: usize) -> Self {
        let n_nodes = held.len() / d;
        let mut unknowns = vec![HELD; held.len()];
        let components: Vec<usize> = (0..held.len()).filter(|c| !held[*c]).collect();
        for (unknown, component) in components.iter().enumerate() {
            unknowns[*component] = unknown;
        }
        let mut neighbours = vec![Vec::new(); n_nodes];
        for cell in cells.chunks_exact(n_local) {
            for a in cell {
                neighbours[*a].extend_from_slice(cell);
            }
        }
        for list in &mut neighbours {
            list.sort_unstable();
            list.dedup();
        }
        let (mut starts, mut rows) = (vec![0], Vec::new());
        for (column, component) in components.iter().enumerate() {
            for node in &neighbours[component / d] {
                let others = (node * d..(node + 1) * d).map(|other| unknowns[other]);
                rows.extend(others.filter(|row| *row != HELD && *row >= column));
            }
            starts.push(rows.len());
        }
        let mut pattern = Self {
            n_components: held.len(),
            components,
            unknowns,
            starts,
            rows,
            scatter: Vec::new(),
            n_local: n_local * d,
        };
        for cell in cells.chunks_exact(n_local) {
            let local: Vec<usize> = cell.iter().flat_map(|node| node * d..(node + 1) * d).collect();
            for p in 0..local.len() {
                for q in 0..=p {
                    let place = pattern.place(local[p], local[q]);
                    pattern.scatter.push(place);
                }
            }
        }
        pattern
    }

    /// Where the entry of two components is.
    pub(super) fn place(&self, one: usize, other: usize) -> u32 {
        let (one, other) = (self.unknowns[one], self.unknowns[other]);
        if one == HELD || other == HELD {
            return NOWHERE;
        }
        let (row, column) = (one.max(other), one.min(other));
        let entries = &self.rows[self.starts[column]..self.starts[column + 1]];
        let found = entries.binary_search(&row).ok();
        let place = found.map(|at| self.starts[column] + at);
        place.and_then(|place| u32::try_from(place).ok()).unwrap_or(NOWHERE)
    }

    /// Number of unknowns.
    #[must_use]
    pub fn n_unknowns(&self) -> usize {
        self.components.len()
    }

    /// Number of entries of the lower triangle.
    #[must_use]
    pub fn n_entries(&self) -> usize {
        self.rows.len()
    }

    /// Adds the matrix of a cell, `matrix(p, q)` for its components p >= q.
    pub(super) fn add_cell(
        &self,
        cell: usize,
        values: &mut [f64],
        matrix: impl Fn(usize, usize) -> f64,
    ) {
        let n = self.n_local;
        let places = &self.scatter[cell * n * (n + 1) / 2..(cell + 1) * n * (n + 1) / 2];
        let mut places = places.iter();
        for p in 0..n {
            for q in 0..=p {
                if let Some(place) = places.next().filter(|place| **place != NOWHERE) {
                    values[*place as usize] += matrix(p, q);
                }
            }
        }
    }

    /// Adds a number to the entry of two components, where both are free.
    pub(super) fn add(&self, place: u32, values: &mut [f64], value: f64) {
        if place != NOWHERE {
            values[place as usize] += value;
        }
    }

    /// The unknowns of a list of all components.
    #[must_use]
    pub fn free(&self, all: &[f64]) -> Vec<f64> {
        self.components.iter().map(|component| all[*component]).collect()
    }

    /// All components from unknowns; zero where held.
    #[must_use]
    pub fn all(&self, free: &[f64]) -> Vec<f64> {
        let mut all = vec![0.0; self.n_components];
        for (component, value) in self.components.iter().zip(free) {
            all[*component] = *value;
        }
        all
    }
}
