//! `Pattern`: where the entries of symmetric matrices of a solid are, and their values.

use std::collections::BTreeSet;

use super::mixed::pressures::Pressures;
use super::rigid::ties::Ties;

/// Unknown of a component of a node that is held.
const HELD: usize = usize::MAX;

/// An entry that falls away since a component is held.
const NOWHERE: u32 = u32::MAX;

/// The lower triangle of symmetric matrices, column by column; unknowns are those of rigid parts, and behind them the
/// components that are free.
#[derive(Debug, Clone)]
pub struct Pattern {
    /// Number of components of all nodes.
    n_components: usize,
    /// Unknowns of rigid parts, which come first.
    n_rigid: usize,
    /// The component of each unknown behind them.
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
    /// Nodes that move with rigid parts.
    pub ties: &'a Ties,
}

impl Pattern {
    /// The pattern of cells; `held` says which components of places are held.
    pub(super) fn new<const D: usize>(cells: &Cells<'_, D>, held: &[bool]) -> Self {
        let Cells { nodes, n_local, pressures, ties } = *cells;
        let n_rigid = ties.n_unknowns();
        let n_nodes = held.len() / D;
        let n_components = held.len() + pressures.count();
        let mut unknowns = vec![HELD; n_components];
        let is_free = |c: &usize| held.get(*c) != Some(&true) && !ties.has(*c / D);
        let is_free = |c: &usize| *c >= held.len() || is_free(c);
        let components: Vec<usize> = (0..n_components).filter(is_free).collect();
        for (unknown, component) in components.iter().enumerate() {
            unknowns[*component] = n_rigid + unknown;
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
        for column in rigid_columns(cells, &unknowns) {
            rows.extend(column);
            starts.push(rows.len());
        }
        for (column, component) in components.iter().enumerate() {
            let column = n_rigid + column;
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
        let n_places = n_rigid + components.len() - pressures.count();
        let (scatter, cell_starts) = (Vec::new(), vec![0]);
        let mut pattern = Self {
            n_components,
            n_rigid,
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
        self.entry(self.unknowns[one], self.unknowns[other])
    }

    /// The unknown of a component that is free.
    pub(super) fn unknown(&self, component: usize) -> Option<usize> {
        Some(self.unknowns[component]).filter(|unknown| *unknown != HELD)
    }

    /// Where the entry of two unknowns is.
    pub(super) fn entry(&self, one: usize, other: usize) -> u32 {
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
        self.n_rigid + self.components.len()
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

    /// The unknowns of a list of all components; zero for those of rigid parts.
    #[must_use]
    pub fn free(&self, all: &[f64]) -> Vec<f64> {
        let rigid = std::iter::repeat_n(0.0, self.n_rigid);
        rigid.chain(self.components.iter().map(|component| all[*component])).collect()
    }

    /// All components from unknowns; zero where held, or in a rigid part.
    #[must_use]
    pub fn all(&self, free: &[f64]) -> Vec<f64> {
        let mut all = vec![0.0; self.n_components];
        for (component, value) in self.components.iter().zip(&free[self.n_rigid..]) {
            all[*component] = *value;
        }
        all
    }
}

/// Rows of the unknowns of rigid parts, column by column.
fn rigid_columns<const D: usize>(cells: &Cells<'_, D>, unknowns: &[usize]) -> Vec<Vec<usize>> {
    let Cells { nodes, n_local, pressures, ties } = *cells;
    let mut rows: Vec<BTreeSet<usize>> = ties.parts.iter().map(|_| BTreeSet::new()).collect();
    for (number, cell) in nodes.chunks_exact(n_local).enumerate() {
        let parts: BTreeSet<usize> = cell.iter().filter_map(|node| ties.part_of(*node)).collect();
        let components = || {
            let places = cell.iter().flat_map(|node| node * D..(node + 1) * D);
            places.chain(pressures.of(number).iter().copied()).map(|one| unknowns[one])
        };
        for part in &parts {
            rows[*part].extend(components().filter(|unknown| *unknown != HELD));
            rows[*part].extend(parts.iter().flat_map(|other| ties.unknowns(*other)));
        }
    }
    let columns = (0..ties.n_unknowns()).map(|column| (column, &rows[column / ties.n_each]));
    columns.map(|(column, rows)| rows.range(column..).copied().collect()).collect()
}
