//! `Pattern`: where the entries of symmetric matrices of a solid are, and their values.

use super::mixed::pressures::Pressures;

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
    /// Where those of each cell begin, and where those of the last end.
    cell_starts: Vec<usize>,
    /// Number of unknowns that are places; those behind are pressures.
    pub(super) n_places: usize,
}

/// Cells and the components of their nodes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cells<'a, const D: usize> {
    /// Nodes of all cells.
    pub nodes: &'a [usize],
    /// Nodes of a cell.
    pub n_local: usize,
    /// Their pressures.
    pub pressures: &'a Pressures,
}

impl Pattern {
    /// The pattern of cells; `held` says which components of places are held.
    pub(super) fn new<const D: usize>(cells: &Cells<'_, D>, held: &[bool]) -> Self {
        let Cells { nodes, n_local, pressures } = *cells;
        let n_nodes = held.len() / D;
        let n_components = held.len() + pressures.count();
        let mut unknowns = vec![HELD; n_components];
        let is_free = |c: &usize| held.get(*c) != Some(&true);
        let components: Vec<usize> = (0..n_components).filter(is_free).collect();
        for (unknown, component) in components.iter().enumerate() {
            unknowns[*component] = unknown;
        }
        let mut neighbours = vec![Vec::new(); n_nodes];
        let mut pressed = vec![Vec::new(); n_nodes];
        for (number, cell) in nodes.chunks_exact(n_local).enumerate() {
            for a in cell {
                neighbours[*a].extend_from_slice(cell);
                pressed[*a].extend_from_slice(pressures.of(number));
            }
        }
        for list in neighbours.iter_mut().chain(&mut pressed) {
            list.sort_unstable();
            list.dedup();
        }
        let (mut starts, mut rows) = (vec![0], Vec::new());
        for (column, component) in components.iter().enumerate() {
            if *component < held.len() {
                for node in &neighbours[component / D] {
                    let others = (node * D..(node + 1) * D).map(|other| unknowns[other]);
                    rows.extend(others.filter(|row| *row != HELD && *row >= column));
                }
                rows.extend(pressed[component / D].iter().map(|one| unknowns[*one]));
            } else {
                // Pressures do not know each other
                rows.push(column);
            }
            starts.push(rows.len());
        }
        let n_places = components.len() - pressures.count();
        let (scatter, cell_starts) = (Vec::new(), vec![0]);
        let mut pattern = Self {
            n_components,
            components,
            unknowns,
            starts,
            rows,
            scatter,
            cell_starts,
            n_places,
        };
        for (number, cell) in nodes.chunks_exact(n_local).enumerate() {
            let places = cell.iter().flat_map(|node| node * D..(node + 1) * D);
            let local: Vec<usize> = places.chain(pressures.of(number).iter().copied()).collect();
            for p in 0..local.len() {
                for q in 0..=p {
                    let place = pattern.place(local[p], local[q]);
                    pattern.scatter.push(place);
                }
            }
            pattern.cell_starts.push(pattern.scatter.len());
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
        let mut places = self.scatter[self.cell_starts[cell]..self.cell_starts[cell + 1]].iter();
        for p in 0.. {
            for q in 0..=p {
                let Some(place) = places.next() else { return };
                if *place != NOWHERE {
                    values[*place as usize] += matrix(p, q);
                }
            }
        }
    }

    /// Whether there are pressures.
    #[must_use]
    pub fn is_mixed(&self) -> bool {
        self.n_places < self.n_unknowns()
    }

    /// Adds a number to the entry of two components, where both are free.
    pub(super) fn add(&self, place: u32, values: &mut [f64], value: f64) {
        if place != NOWHERE {
            values[place as usize] += value;
        }
    }

    /// A symmetric matrix, by its values, times a list of unknowns.
    #[must_use]
    pub fn times(&self, values: &[f64], free: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; free.len()];
        for column in 0..free.len() {
            let (first, end) = (self.starts[column], self.starts[column + 1]);
            // The diagonal comes first
            let mut sum = values[first] * free[column];
            for entry in first + 1..end {
                let row = self.rows[entry];
                product[row] += values[entry] * free[column];
                sum += values[entry] * free[row];
            }
            product[column] += sum;
        }
        product
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
