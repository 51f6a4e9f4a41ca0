//! `BlockMaps`: where the matrices of cells go among the blocks of a saddle-point matrix.

use alewife_interrupt::Listener;
use rayon::prelude::*;

use super::super::super::cell_unknowns::{CellUnknowns, NO_UNKNOWN};
use super::gradient::Gradient;
use super::numbering::Numbering;
use super::vector::{B, Place};
use crate::multigrid::BlockMatrix;
use crate::sparse::index::{to_u16, to_u32};
use crate::sparse::lists::Lists;

/// Rows or cells that one task works on.
const CHUNK: usize = 512;
/// Marks a row that has not been seen.
const UNSEEN: u32 = u32::MAX;
/// Marks what is no unknown of a cell: a row beyond all of its matrix.
const NO_ROW: u16 = u16::MAX;

/// For each cell the blocks of its rows and pressures.
#[derive(Debug, Clone)]
pub(super) struct BlockMaps {
    /// Start of each cell in `rows`, and the end of the last.
    row_starts: Vec<usize>,
    /// Of each row of blocks of each cell the rows of the cell's matrix, `NO_ROW` for what is no unknown.
    rows: Vec<[u16; B]>,
    /// Start of each cell in `pressures`, and the end of the last.
    pressure_starts: Vec<usize>,
    /// Of each pressure of each cell the row of the cell's matrix.
    pressures: Vec<u16>,
    /// Number of rows of the matrix of each cell.
    sizes: Vec<u16>,
    /// Start of each cell in `blocks`.
    block_starts: Vec<usize>,
    /// For each column and row of blocks of a cell the index of the block.
    blocks: Vec<u32>,
    /// Start of each cell in `entries`.
    entry_starts: Vec<usize>,
    /// For each pressure and row of blocks of a cell the index of the entry of the gradient.
    entries: Vec<u32>,
}

/// The rows and pressures that cells have.
#[derive(Debug, Default)]
pub(super) struct RowsOfCells {
    rows: Lists,
    pressures: Lists,
}

/// Columns of the blocks, and pressures, of all rows.
pub(super) struct BlockPattern {
    pub columns: Lists,
    pub pressures: Lists,
}

/// The blocks of a cell and where its matrix has them.
pub(super) struct CellBlocks<'a> {
    /// Number of rows of its matrix.
    pub size: usize,
    /// Of each row of blocks the rows of the matrix.
    pub rows: &'a [[u16; B]],
    /// Of each pressure the row of the matrix.
    pub pressures: &'a [u16],
    /// The block of each column and row.
    pub blocks: &'a [u32],
    /// The entry of the gradient of each pressure and row.
    pub entries: &'a [u32],
}

impl RowsOfCells {
    /// Of cells with these unknowns.
    pub fn new(cells: &CellUnknowns, numbering: &Numbering) -> Self {
        let mut all = Self::default();
        let (mut rows, mut pressures) = (Vec::new(), Vec::new());
        for cell in cells.cells() {
            rows.clear();
            pressures.clear();
            for &unknown in cell.iter().filter(|&&unknown| unknown != NO_UNKNOWN) {
                let (list, item) = match numbering.places[unknown as usize] {
                    Place::Velocity { row, .. } => (&mut rows, row),
                    Place::Pressure(index) => (&mut pressures, index),
                };
                if !list.contains(&item) {
                    list.push(item);
                }
            }
            all.rows.push(rows.iter().copied());
            all.pressures.push(pressures.iter().copied());
        }
        all
    }

    /// The blocks of rows that share a cell, and the pressures that share one with a row; both ascend.
    pub fn pattern(&self, numbering: &Numbering) -> BlockPattern {
        let n_rows = numbering.blocks.len();
        let cells = self.rows.inverted(n_rows);
        // A row without an unknown has a block on the diagonal, too
        let (columns, pressures) = rayon::join(
            || neighbours(&cells, &self.rows, n_rows, |row| Some(to_u32(row))),
            || neighbours(&cells, &self.pressures, numbering.pressures.len(), |_| None),
        );
        BlockPattern { columns, pressures }
    }
}

/// For each row the items of its cells, of n, each once and in ascending order; of a row in no cell, what is said.
fn neighbours(
    cells: &Lists,
    items: &Lists,
    n: usize,
    of_none: impl Fn(usize) -> Option<u32> + Sync,
) -> Lists {
    let chunks: Vec<usize> = (0..cells.n()).step_by(CHUNK).collect();
    let parts = chunks.par_iter().map_init(
        || vec![UNSEEN; n],
        |last, &start| {
            let mut lists = Lists::default();
            let mut near: Vec<u32> = Vec::new();
            for row in start..(start + CHUNK).min(cells.n()) {
                near.clear();
                for &item in cells.list(row).iter().flat_map(|&cell| items.list(cell as usize)) {
                    if last[item as usize] != to_u32(row) {
                        last[item as usize] = to_u32(row);
                        near.push(item);
                    }
                }
                if near.is_empty() && cells.list(row).is_empty() {
                    near.extend(of_none(row));
                }
                near.sort_unstable();
                lists.push(near.iter().copied());
            }
            lists
        },
    );
    let parts: Vec<Lists> = parts.collect();
    let mut all = Lists::default();
    parts.iter().for_each(|part| all.append(part));
    all
}

impl BlockMaps {
    /// Into matrices of this pattern.
    pub fn new(
        cells: &CellUnknowns,
        numbering: &Numbering,
        of_cells: &RowsOfCells,
        velocity: &BlockMatrix<B>,
        gradient: &Gradient,
    ) -> Self {
        let RowsOfCells { rows, pressures } = of_cells;
        let mut maps = Self {
            row_starts: rows.starts().to_vec(),
            rows: Vec::with_capacity(rows.starts()[rows.n()]),
            pressure_starts: pressures.starts().to_vec(),
            pressures: vec![NO_ROW; pressures.starts()[pressures.n()]],
            sizes: Vec::with_capacity(rows.n()),
            block_starts: vec![0],
            blocks: Vec::new(),
            entry_starts: vec![0],
            entries: Vec::new(),
        };
        for (cell, unknowns) in cells.cells().enumerate() {
            maps.push_places(unknowns, numbering, rows.list(cell), pressures.list(cell));
            let n = rows.list(cell).len();
            maps.block_starts.push(maps.block_starts[cell] + n * n);
            maps.entry_starts.push(maps.entry_starts[cell] + n * pressures.list(cell).len());
        }
        let block = |row: u32, column: u32| velocity.find(row as usize, column);
        maps.blocks = indices(rows, rows, block);
        maps.entries =
            indices(pressures, rows, |row, pressure| gradient.find(row as usize, pressure));
        maps
    }

    /// Appends where the rows of the matrix of a cell stand.
    fn push_places(
        &mut self,
        unknowns: &[u32],
        numbering: &Numbering,
        rows: &[u32],
        pressures: &[u32],
    ) {
        let first = self.rows.len();
        let first_pressure = self.pressure_starts[self.sizes.len()];
        self.rows.resize(first + rows.len(), [NO_ROW; B]);
        self.sizes.push(to_u16(unknowns.len()));
        for (local, &unknown) in unknowns.iter().enumerate() {
            if unknown == NO_UNKNOWN {
                continue;
            }
            match numbering.places[unknown as usize] {
                Place::Velocity { row, component } => {
                    let index = rows.iter().take_while(|&&other| other != row).count();
                    self.rows[first + index][usize::from(component)] = to_u16(local);
                }
                Place::Pressure(pressure) => {
                    let index = pressures.iter().take_while(|&&other| other != pressure).count();
                    self.pressures[first_pressure + index] = to_u16(local);
                }
            }
        }
    }

    /// The blocks of a cell.
    pub fn of_cell(&self, cell: usize) -> CellBlocks<'_> {
        CellBlocks {
            size: usize::from(self.sizes[cell]),
            rows: &self.rows[self.row_starts[cell]..self.row_starts[cell + 1]],
            pressures: &self.pressures[self.pressure_starts[cell]..self.pressure_starts[cell + 1]],
            blocks: &self.blocks[self.block_starts[cell]..self.block_starts[cell + 1]],
            entries: &self.entries[self.entry_starts[cell]..self.entry_starts[cell + 1]],
        }
    }
}

/// What `find` gives for each row and each column of each cell, column by column. Where the work of this thread is to end,
/// some is left out.
fn indices(
    columns: &Lists,
    rows: &Lists,
    find: impl Fn(u32, u32) -> Option<usize> + Sync,
) -> Vec<u32> {
    let chunks: Vec<usize> = (0..rows.n()).step_by(CHUNK).collect();
    let listener = Listener::here();
    let parts = chunks.par_iter().map(|&start| {
        let mut indices = Vec::new();
        if listener.check().is_err() {
            return indices;
        }
        for cell in start..(start + CHUNK).min(rows.n()) {
            for &column in columns.list(cell) {
                let found = rows.list(cell).iter().filter_map(|&row| find(row, column));
                indices.extend(found.map(to_u32));
            }
        }
        indices
    });
    let parts: Vec<Vec<u32>> = parts.collect();
    parts.concat()
}
