//! `CellMaps`: the sparsity pattern of a constrained system, and where each cell's matrix goes in it.

use std::sync::Arc;

use super::cell_pattern::{CellEntries, build_pattern};
use super::cell_unknowns::CellUnknowns;
use crate::sparse::Pattern;

/// Where the entries of the matrix of each cell are stored.
#[derive(Debug, Clone)]
pub struct CellMaps {
    pattern: Arc<Pattern>,
    /// None where the work of the thread was to end before they were known.
    entries: Option<CellEntries>,
}

impl CellMaps {
    /// Pattern and maps for cells with these unknowns.
    ///
    /// `couples(i, j)` says whether two free unknowns of a cell have an entry (two pressures do
    /// not), in whatever order they are named. Where the work of this thread is to end on the way, nothing is
    /// stored: what solves such a system says so.
    #[must_use]
    pub fn new(cells: &CellUnknowns, couples: impl Fn(usize, usize) -> bool) -> Self {
        let known = build_pattern(cells.n(), cells, &couples).and_then(|pattern| {
            let entries = CellEntries::new(&pattern, cells)?;
            Some((pattern, entries))
        });
        match known {
            Some((pattern, entries)) => Self { pattern: Arc::new(pattern), entries: Some(entries) },
            None => {
                let rows = (0..cells.n()).map(|_| []);
                Self { pattern: Arc::new(Pattern::from_rows(rows)), entries: None }
            }
        }
    }

    /// The sparsity pattern of the constrained system.
    #[must_use]
    pub fn pattern(&self) -> &Arc<Pattern> {
        &self.pattern
    }

    /// Adds a cell's matrix, folded where it has to be, to the stored values.
    pub fn scatter(&self, cell: usize, matrix: &[f64], values: &mut [f64]) {
        if let Some(entries) = &self.entries {
            entries.for_each(cell, |local, entry| values[entry] += matrix[local]);
        }
    }
}

#[cfg(test)]
mod tests {
    use alewife_interrupt::hearing;

    use super::*;
    use crate::algebra::constraints::Term;
    use crate::algebra::{CellFolds, ConstraintBuilder};

    /// Two one-dimensional cells in a row; the last unknown equals half the first plus one.
    #[test]
    fn scattering_reduced_cells_equals_the_triple_product() {
        let mut builder = ConstraintBuilder::new(3);
        builder.constrain(2, vec![Term { unknown: 0, weight: 0.5 }], 1.0);
        let constraints = builder.build();
        let folds = CellFolds::new(2, vec![0, 1, 1, 2], &constraints);
        let maps = CellMaps::new(&folds.unknowns(&constraints), |_, _| true);
        let pattern = maps.pattern();
        // Columns of [[2, -1], [-3, 4]].
        let cell = [2.0, -3.0, -1.0, 4.0];
        let mut values = vec![0.0; pattern.n_entries()];
        let mut folded = vec![0.0; folds.largest_matrix()];
        assert!(!folds.is_folded(0) && folds.is_folded(1));
        maps.scatter(0, &cell, &mut values);
        folds.fold(1, &constraints, &cell, &mut folded);
        maps.scatter(1, &folded, &mut values);
        // Full matrix [[2,-1,0],[-3,6,-1],[0,-3,4]], P = [[1,0],[0,1],[0.5,0]].
        let expected = [[3.0, -2.5], [-3.5, 6.0]];
        for (row, line) in expected.iter().enumerate() {
            for (column, value) in line.iter().enumerate() {
                assert_eq!(values[pattern.entry(row, column).unwrap()], *value);
            }
        }
    }

    /// Velocities with two components in cells that share nodes, pressures and a folded cell.
    #[test]
    fn each_entry_of_a_cell_is_where_its_row_and_column_say() {
        let mut builder = ConstraintBuilder::new(12);
        builder.equate(10, 1);
        builder.fix(4, 1.0);
        let constraints = builder.build();
        let raw: Vec<u32> = vec![0, 2, 1, 3, 8, 2, 6, 3, 7, 9, 4, 6, 5, 10, 11];
        let is_pressure = |unknown: usize| unknown >= 7;
        let couples = |row, column| !(is_pressure(row) && is_pressure(column));
        let folds = CellFolds::new(5, raw.clone(), &constraints);
        let maps = CellMaps::new(&folds.unknowns(&constraints), couples);
        for (cell, raw) in raw.chunks_exact(5).enumerate() {
            // Every row of a folded cell has one unknown here
            let unknown = |raw: u32| constraints.row(raw as usize).first().map(|term| term.unknown);
            let mut local: Vec<_> = raw.iter().map(|&raw| unknown(raw)).collect();
            if folds.is_folded(cell) {
                local.retain(Option::is_some);
            }
            let mut expected = Vec::new();
            for (i, row) in local.iter().enumerate() {
                for (j, column) in local.iter().enumerate() {
                    let entry = row.zip(*column).and_then(|(row, column)| {
                        maps.pattern().entry(row as usize, column as usize)
                    });
                    expected.extend(entry.map(|entry| (j * local.len() + i, entry)));
                }
            }
            let mut entries = Vec::new();
            maps.entries
                .as_ref()
                .unwrap()
                .for_each(cell, |local, entry| entries.push((local, entry)));
            assert_eq!(entries, expected);
        }
    }

    /// Where the work is to end nothing is stored, and the solver of the system says so.
    #[test]
    fn work_that_is_to_end_stores_nothing() {
        let constraints = ConstraintBuilder::new(300).build();
        let cells: Vec<u32> = (0..299).flat_map(|cell| [cell, cell + 1]).collect();
        let folds = CellFolds::new(2, cells, &constraints);
        let unknowns = folds.unknowns(&constraints);
        let whole = CellMaps::new(&unknowns, |_, _| true);
        assert_eq!(whole.pattern().n_entries(), 300 + 2 * 299);
        let heard = hearing(Arc::new(|| true), || {
            let maps = CellMaps::new(&unknowns, |_, _| true);
            maps.scatter(298, &[1.0; 4], &mut []);
            (maps.pattern().n(), maps.pattern().n_entries())
        });
        assert!(heard.was_ended);
        assert_eq!(heard.result, (300, 0));
    }

    /// Two cells in a row whose last unknown is given.
    #[test]
    fn rows_and_columns_of_given_values_are_not_stored() {
        let mut builder = ConstraintBuilder::new(3);
        builder.fix(2, 5.0);
        let constraints = builder.build();
        let folds = CellFolds::new(2, vec![0, 1, 1, 2], &constraints);
        let maps = CellMaps::new(&folds.unknowns(&constraints), |_, _| true);
        let pattern = maps.pattern();
        let cell = [2.0, -3.0, -1.0, 4.0];
        let mut values = vec![0.0; pattern.n_entries()];
        for index in 0..2 {
            assert!(!folds.is_folded(index));
            maps.scatter(index, &cell, &mut values);
        }
        assert_eq!(values, [2.0, -1.0, -3.0, 6.0]);
    }
}
