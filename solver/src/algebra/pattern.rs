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

/// For each cell, its free unknowns, how its raw unknowns depend on them, and where the entries
/// of its reduced matrix are stored.
#[derive(Debug, Clone)]
pub struct CellMaps {
    n_local_raw: usize,
    raw: Vec<u32>,
    unknown_offsets: Vec<u32>,
    position_offsets: Vec<usize>,
    positions: Vec<u32>,
    /// Index among the cell's unknowns of each entry of the rows of its raw unknowns.
    local: Vec<u16>,
    local_offsets: Vec<u32>,
    is_plain: Vec<bool>,
}

impl CellMaps {
    /// Pattern and maps for cells with `n_local_raw` raw unknowns each, listed in `raw`.
    ///
    /// `couples(i, j)` says whether two free unknowns of a cell have an entry (two pressures do
    /// not).
    #[must_use]
    pub fn new(
        n_local_raw: usize,
        raw: Vec<u32>,
        constraints: &AffineConstraints,
        couples: impl Fn(usize, usize) -> bool,
    ) -> (Pattern, Self) {
        let n_cells = raw.len() / n_local_raw;
        let mut unknowns: Vec<u32> = Vec::with_capacity(raw.len());
        let mut maps = Self {
            n_local_raw,
            raw,
            unknown_offsets: vec![0],
            position_offsets: vec![0],
            positions: Vec::new(),
            local: Vec::new(),
            local_offsets: vec![0],
            is_plain: Vec::with_capacity(n_cells),
        };
        for cell in 0..n_cells {
            let start = unknowns.len();
            let mut is_plain = true;
            for &raw in &maps.raw[cell * n_local_raw..(cell + 1) * n_local_raw] {
                let row = constraints.row(raw as usize);
                is_plain &= row.len() == 1 && row[0].1 == 1.0;
                for &(unknown, _) in row {
                    let known = unknowns[start..].iter().position(|&other| other == unknown);
                    let index = known.unwrap_or(unknowns.len() - start);
                    if known.is_none() {
                        unknowns.push(unknown);
                    }
                    maps.local.push(index as u16);
                }
            }
            let n_local = unknowns.len() - start;
            maps.is_plain.push(is_plain && n_local == n_local_raw);
            maps.local_offsets.push(maps.local.len() as u32);
            maps.unknown_offsets.push(unknowns.len() as u32);
            maps.position_offsets.push(maps.position_offsets[cell] + n_local * n_local);
        }
        let pattern = build_pattern(constraints.n_unknowns(), &unknowns, &maps, &couples);
        maps.positions = vec![NOT_STORED; maps.position_offsets[n_cells]];
        for cell in 0..n_cells {
            let range =
                maps.unknown_offsets[cell] as usize..maps.unknown_offsets[cell + 1] as usize;
            let local = &unknowns[range];
            let positions =
                &mut maps.positions[maps.position_offsets[cell]..maps.position_offsets[cell + 1]];
            for (i, &row) in local.iter().enumerate() {
                for (j, &column) in local.iter().enumerate() {
                    if let Some(position) = pattern.position(row as usize, column as usize) {
                        positions[i * local.len() + j] = position as u32;
                    }
                }
            }
        }
        (pattern, maps)
    }

    /// Number of cells.
    #[must_use]
    pub fn n_cells(&self) -> usize {
        self.is_plain.len()
    }

    /// Raw unknowns of a cell.
    #[must_use]
    pub fn raw_unknowns(&self, cell: usize) -> &[u32] {
        &self.raw[cell * self.n_local_raw..(cell + 1) * self.n_local_raw]
    }

    /// Number of free unknowns of a cell.
    #[must_use]
    pub fn n_local(&self, cell: usize) -> usize {
        (self.unknown_offsets[cell + 1] - self.unknown_offsets[cell]) as usize
    }

    /// P^T A P of one cell: `matrix` is its raw matrix, row by row; `reduced` is overwritten.
    pub fn reduce(
        &self,
        cell: usize,
        constraints: &AffineConstraints,
        matrix: &[f64],
        reduced: &mut Vec<f64>,
    ) {
        reduced.clear();
        if self.is_plain[cell] {
            reduced.extend_from_slice(matrix);
            return;
        }
        let n_local = self.n_local(cell);
        reduced.resize(n_local * n_local, 0.0);
        let mut local = self.local[self.local_offsets[cell] as usize..].iter();
        let rows: Vec<Vec<(usize, f64)>> = self
            .raw_unknowns(cell)
            .iter()
            .map(|&raw| {
                constraints
                    .row(raw as usize)
                    .iter()
                    .map(|&(_, weight)| {
                        let index = local.next().expect("one local index for each entry");
                        (usize::from(*index), weight)
                    })
                    .collect()
            })
            .collect();
        for (i, row_entries) in rows.iter().enumerate() {
            for (j, column_entries) in rows.iter().enumerate() {
                let value = matrix[i * self.n_local_raw + j];
                for &(row, row_weight) in row_entries {
                    for &(column, column_weight) in column_entries {
                        reduced[row * n_local + column] += row_weight * value * column_weight;
                    }
                }
            }
        }
    }

    /// Adds a cell's reduced matrix to the stored values.
    pub fn scatter(&self, cell: usize, reduced: &[f64], values: &mut [f64]) {
        let positions =
            &self.positions[self.position_offsets[cell]..self.position_offsets[cell + 1]];
        for (&position, value) in positions.iter().zip(reduced) {
            if position != NOT_STORED {
                values[position as usize] += value;
            }
        }
    }
}

/// Columns of all pairs of unknowns that share a cell and couple.
fn build_pattern(
    n: usize,
    unknowns: &[u32],
    maps: &CellMaps,
    couples: &impl Fn(usize, usize) -> bool,
) -> Pattern {
    let cells = || {
        maps.unknown_offsets.windows(2).map(|range| &unknowns[range[0] as usize..range[1] as usize])
    };
    let mut counts = vec![0usize; n];
    for cell in cells() {
        for &column in cell {
            counts[column as usize] += cell.len();
        }
    }
    let mut starts = vec![0usize; n + 1];
    for column in 0..n {
        starts[column + 1] = starts[column] + counts[column];
    }
    let mut fill = starts.clone();
    let mut all_rows = vec![0u32; starts[n]];
    for cell in cells() {
        for &column in cell {
            for &row in cell {
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
        let cell = [2.0, -1.0, -3.0, 4.0];
        let mut values = vec![0.0; pattern.rows.len()];
        let mut reduced = Vec::new();
        for index in 0..2 {
            maps.reduce(index, &constraints, &cell, &mut reduced);
            maps.scatter(index, &reduced, &mut values);
        }
        // Full matrix [[2,-1,0],[-3,6,-1],[0,-3,4]], P = [[1,0],[0,1],[0.5,0]].
        let expected = [[3.0, -2.5], [-3.5, 6.0]];
        for (row, line) in expected.iter().enumerate() {
            for (column, value) in line.iter().enumerate() {
                assert_eq!(values[pattern.position(row, column).unwrap()], *value);
            }
        }
    }
}
