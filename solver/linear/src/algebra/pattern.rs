//! Sparsity pattern of a constrained system, and where each cell's matrix goes in it.

use super::AffineConstraints;

/// Compressed columns of a square sparse matrix; rows sorted within a column.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pattern {
    /// Start of each column in `rows`, and the end of the last.
    pub columns: Vec<usize>,
    /// Row of each stored entry.
    pub rows: Vec<usize>,
}

impl Pattern {
    /// Number of unknowns.
    #[must_use]
    pub fn n(&self) -> usize {
        self.columns.len() - 1
    }

    /// Where entry (row, column) is stored, if it is.
    #[must_use]
    pub fn position(&self, row: usize, column: usize) -> Option<usize> {
        let range = self.columns[column]..self.columns[column + 1];
        self.rows[range.clone()].binary_search(&row).ok().map(|offset| range.start + offset)
    }

    /// |A| |x|: how large the terms of each row are.
    #[must_use]
    pub fn multiply_sizes(&self, values: &[f64], x: &[f64]) -> Vec<f64> {
        let mut sizes = vec![0.0; self.n()];
        for (column, &factor) in x.iter().enumerate() {
            for entry in self.columns[column]..self.columns[column + 1] {
                sizes[self.rows[entry]] += (values[entry] * factor).abs();
            }
        }
        sizes
    }

    /// y += A x.
    pub fn multiply_add(&self, values: &[f64], x: &[f64], y: &mut [f64]) {
        for (column, &factor) in x.iter().enumerate() {
            for entry in self.columns[column]..self.columns[column + 1] {
                y[self.rows[entry]] += values[entry] * factor;
            }
        }
    }
}

/// Marks an entry of a cell's matrix that is not stored.
const NOT_STORED: u32 = u32::MAX;
/// Stands for the unknown of a given value.
const NO_UNKNOWN: u32 = u32::MAX;

/// For each cell, its free unknowns, how its raw unknowns depend on them, and where the entries
/// of its reduced matrix are stored.
///
/// Most cells have raw unknowns that are free or given. Their matrix is not reduced: what belongs
/// to a given value has no place. The others, at bodies that move freely and at periodic sides,
/// are folded to the unknowns behind.
#[derive(Debug, Clone)]
pub struct CellMaps {
    n_local_raw: usize,
    raw: Vec<u32>,
    position_offsets: Vec<usize>,
    /// Column by column.
    positions: Vec<u32>,
    /// The folded cells, in order.
    folded: Vec<FoldedCell>,
    /// Index in `folded` of each cell, if it is one of them.
    folded_index: Vec<u32>,
    largest: usize,
}

/// A cell with raw unknowns that depend on others.
#[derive(Debug, Clone)]
struct FoldedCell {
    n_local: usize,
    /// Index among the cell's unknowns of each entry of the rows of its raw unknowns.
    local: Vec<u16>,
}

/// Marks a cell that is not folded.
const NOT_FOLDED: u32 = u32::MAX;

impl CellMaps {
    /// Pattern and maps for cells with `n_local_raw` raw unknowns each, listed in `raw`.
    ///
    /// `couples(i, j)` says whether two free unknowns of a cell have an entry (two pressures do
    /// not). Which unknowns a constraint refers to must not change later; its weights may.
    #[must_use]
    pub fn new(
        n_local_raw: usize,
        raw: Vec<u32>,
        constraints: &AffineConstraints,
        couples: impl Fn(usize, usize) -> bool,
    ) -> (Pattern, Self) {
        let n_cells = raw.len() / n_local_raw;
        // The unknown of each row and column of the cells' matrices, none of a given value.
        let mut unknowns: Vec<u32> = Vec::with_capacity(raw.len());
        let mut unknown_offsets = vec![0];
        let mut maps = Self {
            n_local_raw,
            raw,
            position_offsets: vec![0],
            positions: Vec::new(),
            folded: Vec::new(),
            folded_index: vec![NOT_FOLDED; n_cells],
            largest: n_local_raw * n_local_raw,
        };
        for cell in 0..n_cells {
            let start = unknowns.len();
            let raw = &maps.raw[cell * n_local_raw..(cell + 1) * n_local_raw];
            let is_free = |raw: usize| constraints.unknown(raw).is_some();
            let is_given = |raw: usize| constraints.row(raw).is_empty();
            if raw.iter().all(|&raw| is_free(raw as usize) || is_given(raw as usize)) {
                unknowns.extend(raw.iter().map(|&raw| {
                    constraints.unknown(raw as usize).map_or(NO_UNKNOWN, |unknown| unknown as u32)
                }));
            } else {
                let mut local = Vec::new();
                for &raw in raw {
                    for &(unknown, _) in constraints.row(raw as usize) {
                        let known = unknowns[start..].iter().position(|&other| other == unknown);
                        let index = known.unwrap_or(unknowns.len() - start);
                        if known.is_none() {
                            unknowns.push(unknown);
                        }
                        local.push(index as u16);
                    }
                }
                maps.folded_index[cell] = maps.folded.len() as u32;
                maps.folded.push(FoldedCell { n_local: unknowns.len() - start, local });
            }
            let n_entries = (unknowns.len() - start).pow(2);
            maps.largest = maps.largest.max(n_entries);
            unknown_offsets.push(unknowns.len());
            maps.position_offsets.push(maps.position_offsets[cell] + n_entries);
        }
        let cells = || unknown_offsets.windows(2).map(|range| &unknowns[range[0]..range[1]]);
        let pattern = build_pattern(constraints.n_unknowns(), cells, &couples);
        maps.positions.reserve_exact(maps.position_offsets[n_cells]);
        for local in cells() {
            for &column in local {
                maps.positions.extend(local.iter().map(|&row| {
                    let is_entry = row != NO_UNKNOWN && column != NO_UNKNOWN;
                    is_entry
                        .then(|| pattern.position(row as usize, column as usize))
                        .flatten()
                        .map_or(NOT_STORED, |position| position as u32)
                }));
            }
        }
        (pattern, maps)
    }

    /// Number of cells.
    #[must_use]
    pub fn n_cells(&self) -> usize {
        self.folded_index.len()
    }

    /// Raw unknowns of a cell.
    #[must_use]
    pub fn raw_unknowns(&self, cell: usize) -> &[u32] {
        &self.raw[cell * self.n_local_raw..(cell + 1) * self.n_local_raw]
    }

    /// Entries of the largest matrix of a cell, raw or folded.
    #[must_use]
    pub fn largest_matrix(&self) -> usize {
        self.largest
    }

    /// Whether the matrix of a cell has to be folded before it is scattered.
    #[must_use]
    pub fn is_folded(&self, cell: usize) -> bool {
        self.folded_index[cell] != NOT_FOLDED
    }

    /// P^T A P of a folded cell: `matrix` is its raw matrix, column by column; the beginning of
    /// `folded` is overwritten.
    ///
    /// # Panics
    /// When the cell is not a folded one.
    pub fn fold(
        &self,
        cell: usize,
        constraints: &AffineConstraints,
        matrix: &[f64],
        folded: &mut [f64],
    ) {
        let FoldedCell { n_local, local } = &self.folded[self.folded_index[cell] as usize];
        let folded = &mut folded[..n_local * n_local];
        folded.fill(0.0);
        let raw = self.raw_unknowns(cell);
        let mut column_local = local.as_slice();
        for (&raw_column, column) in raw.iter().zip(matrix.chunks_exact(self.n_local_raw)) {
            let column_entries = constraints.row(raw_column as usize);
            let (column_indices, rest) = column_local.split_at(column_entries.len());
            column_local = rest;
            let mut row_local = local.as_slice();
            for (&raw_row, value) in raw.iter().zip(column) {
                let row_entries = constraints.row(raw_row as usize);
                let (row_indices, rest) = row_local.split_at(row_entries.len());
                row_local = rest;
                for (&column, &(_, column_weight)) in column_indices.iter().zip(column_entries) {
                    let value = value * column_weight;
                    for (&row, &(_, row_weight)) in row_indices.iter().zip(row_entries) {
                        folded[usize::from(column) * n_local + usize::from(row)] +=
                            row_weight * value;
                    }
                }
            }
        }
    }

    /// Adds a cell's matrix, folded where it has to be, to the stored values.
    pub fn scatter(&self, cell: usize, matrix: &[f64], values: &mut [f64]) {
        let positions =
            &self.positions[self.position_offsets[cell]..self.position_offsets[cell + 1]];
        for (&position, value) in positions.iter().zip(matrix) {
            if position != NOT_STORED {
                values[position as usize] += value;
            }
        }
    }
}

/// Columns of all pairs of unknowns that share a cell and couple.
fn build_pattern<'a, C: Iterator<Item = &'a [u32]>>(
    n: usize,
    cells: impl Fn() -> C,
    couples: &impl Fn(usize, usize) -> bool,
) -> Pattern {
    let cells =
        || cells().map(|cell| cell.iter().copied().filter(|&unknown| unknown != NO_UNKNOWN));
    let mut counts = vec![0usize; n];
    for cell in cells() {
        for column in cell.clone() {
            counts[column as usize] += cell.clone().count();
        }
    }
    let mut starts = vec![0usize; n + 1];
    for column in 0..n {
        starts[column + 1] = starts[column] + counts[column];
    }
    let mut fill = starts.clone();
    let mut all_rows = vec![0u32; starts[n]];
    for cell in cells() {
        for column in cell.clone() {
            for row in cell.clone() {
                if couples(row as usize, column as usize) {
                    all_rows[fill[column as usize]] = row;
                    fill[column as usize] += 1;
                }
            }
        }
    }
    let mut pattern = Pattern { columns: vec![0], rows: Vec::new() };
    for column in 0..n {
        let rows = &mut all_rows[starts[column]..fill[column]];
        rows.sort_unstable();
        let mut last = None;
        for &row in rows.iter() {
            if last != Some(row) {
                pattern.rows.push(row as usize);
                last = Some(row);
            }
        }
        pattern.columns.push(pattern.rows.len());
    }
    pattern
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::ConstraintBuilder;

    /// Two one-dimensional cells in a row; the last unknown equals half the first plus one.
    #[test]
    fn scattering_reduced_cells_equals_the_triple_product() {
        let mut builder = ConstraintBuilder::new(3);
        builder.constrain(2, vec![(0, 0.5)], 1.0);
        let constraints = builder.build();
        let (pattern, maps) = CellMaps::new(2, vec![0, 1, 1, 2], &constraints, |_, _| true);
        // Columns of [[2, -1], [-3, 4]].
        let cell = [2.0, -3.0, -1.0, 4.0];
        let mut values = vec![0.0; pattern.rows.len()];
        let mut folded = vec![0.0; maps.largest_matrix()];
        assert!(!maps.is_folded(0) && maps.is_folded(1));
        maps.scatter(0, &cell, &mut values);
        maps.fold(1, &constraints, &cell, &mut folded);
        maps.scatter(1, &folded, &mut values);
        // Full matrix [[2,-1,0],[-3,6,-1],[0,-3,4]], P = [[1,0],[0,1],[0.5,0]].
        let expected = [[3.0, -2.5], [-3.5, 6.0]];
        for (row, line) in expected.iter().enumerate() {
            for (column, value) in line.iter().enumerate() {
                assert_eq!(values[pattern.position(row, column).unwrap()], *value);
            }
        }
    }

    /// Two cells in a row whose last unknown is given.
    #[test]
    fn what_belongs_to_a_given_value_is_not_stored() {
        let mut builder = ConstraintBuilder::new(3);
        builder.constrain(2, vec![], 5.0);
        let constraints = builder.build();
        let (pattern, maps) = CellMaps::new(2, vec![0, 1, 1, 2], &constraints, |_, _| true);
        let cell = [2.0, -3.0, -1.0, 4.0];
        let mut values = vec![0.0; pattern.rows.len()];
        for index in 0..2 {
            assert!(!maps.is_folded(index));
            maps.scatter(index, &cell, &mut values);
        }
        assert_eq!(values, [2.0, -3.0, -1.0, 6.0]);
    }
}
