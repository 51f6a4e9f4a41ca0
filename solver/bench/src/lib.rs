//! Speed of assembly, linear solver and mesh motion: `cargo bench -p benches`.
//!
//! Here is what benchmarks write for other programs: arrays in NumPy's format, version 1.0.

use std::fs::File;
use std::io::{Result, Write as _};
use std::path::Path;

use alewife_core::algebra::SparseMatrix;

/// A matrix by compressed columns: `columns.npy` (u64, n + 1), `rows.npy` (u64), `values.npy` (f64).
///
/// # Errors
/// When a file cannot be written.
pub fn write_matrix(folder: &Path, matrix: &SparseMatrix) -> Result<()> {
    let transposed = transposed(matrix);
    let pattern = transposed.pattern();
    write_integers(&folder.join("columns.npy"), pattern.starts())?;
    write_integers(&folder.join("rows.npy"), &pattern.columns())?;
    write_reals(&folder.join("values.npy"), transposed.values())
}

/// The transposed of a matrix whose pattern is symmetric: its rows are the columns of the matrix.
///
/// # Panics
/// When an entry has none across the diagonal.
#[must_use]
pub fn transposed(matrix: &SparseMatrix) -> SparseMatrix {
    let pattern = matrix.pattern();
    let mut values = Vec::with_capacity(pattern.n_entries());
    for row in 0..matrix.n() {
        let of_row = pattern.row(row).iter();
        let across = of_row.map(|&column| pattern.entry(column as usize, row));
        values.extend(across.map(|entry| matrix.values()[entry.expect("a symmetric pattern")]));
    }
    SparseMatrix::new(matrix.shared_pattern(), values)
}

/// Numbers as u64.
///
/// # Errors
/// When the file cannot be written.
pub fn write_integers(path: &Path, values: &[usize]) -> Result<()> {
    let bytes: Vec<u8> = values.iter().flat_map(|&value| (value as u64).to_le_bytes()).collect();
    write_array(path, "<u8", values.len(), &bytes)
}

/// Numbers as f64.
///
/// # Errors
/// When the file cannot be written.
pub fn write_reals(path: &Path, values: &[f64]) -> Result<()> {
    let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    write_array(path, "<f8", values.len(), &bytes)
}

fn write_array(path: &Path, kind: &str, length: usize, bytes: &[u8]) -> Result<()> {
    let mut header =
        format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({length},), }}");
    // The header with its prefix of 10 bytes ends in a line feed at a multiple of 64.
    let padded = (10 + header.len() + 1).next_multiple_of(64) - 10;
    header.extend(std::iter::repeat_n(' ', padded - 1 - header.len()));
    header.push('\n');
    let mut file = File::create(path)?;
    file.write_all(b"\x93NUMPY\x01\x00")?;
    file.write_all(&u16::try_from(padded).expect("the header is short").to_le_bytes())?;
    file.write_all(header.as_bytes())?;
    file.write_all(bytes)
}
