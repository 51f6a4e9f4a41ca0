//! Writes the matrices of the benchmarks, with our figures and faer's on them, for `compare.py`.
//!
//! `cargo bench -p benches --bench write_systems -- FOLDER`, then
//! `compare.py FOLDER/10k FOLDER/50k FOLDER/200k --figures FOLDER/figures.json`.

mod systems;

use std::fs;
use std::path::{Path, PathBuf};

use alewife_core::multifrontal::{Analysis, Factors, Ordering};
use alewife_core::timing::cpu_seconds;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::lu::{LuRef, LuSymbolicParams, NumericLu, factorize_symbolic_lu};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par};

use benches::{write_matrix, write_reals};
use systems::{LinearSystem, TimeStep, name_of_size};

const SIZES: [usize; 3] = [10_000, 50_000, 200_000];
/// A phase is repeated for so many seconds at least, and the fastest counts.
const SECONDS: f64 = 3.0;

/// Figures of one solver on one system.
struct Figures {
    analyse: f64,
    refactorise: f64,
    solve: f64,
    factor_entries: usize,
    memory: f64,
    x: Vec<f64>,
}

fn best(mut work: impl FnMut()) -> f64 {
    let begin = cpu_seconds();
    let mut best = f64::INFINITY;
    while cpu_seconds() - begin < SECONDS {
        let start = cpu_seconds();
        work();
        best = best.min(cpu_seconds() - start);
    }
    best
}

/// A line of the kernel's account of this process, in bytes.
fn status(key: &str) -> f64 {
    let text = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = text.lines().find_map(|line| line.strip_prefix(key));
    let kilobytes = line.and_then(|line| line.split_whitespace().nth(1)?.parse::<f64>().ok());
    kilobytes.map_or(f64::NAN, |kilobytes| kilobytes * 1024.0)
}

/// The rise of the peak of resident memory over `work`.
fn memory_of<T>(work: impl FnOnce() -> T) -> (T, f64) {
    // Sets the peak back to the present size; without the right to do so it is an upper bound.
    let _ = fs::write("/proc/self/clear_refs", "5");
    let before = status("VmRSS");
    let result = work();
    (result, status("VmHWM") - before)
}

fn multifrontal(system: &LinearSystem) -> Figures {
    let LinearSystem { matrix, rhs, unknowns } = system;
    let ((analysis, mut factors, x), memory) = memory_of(|| {
        let analysis = Analysis::new(matrix.pattern(), unknowns, Ordering::Best);
        let mut factors = Factors::new(&analysis);
        factors.factorise(&analysis, matrix).expect("the matrix is regular");
        let mut x = rhs.clone();
        factors.solve(&analysis, &mut x);
        (analysis, factors, x)
    });
    let mut y = rhs.clone();
    Figures {
        analyse: best(|| {
            let _ = Analysis::new(matrix.pattern(), unknowns, Ordering::Best);
        }),
        refactorise: best(|| {
            factors.factorise(&analysis, matrix).expect("the matrix is regular");
        }),
        solve: best(|| factors.solve(&analysis, &mut y)),
        factor_entries: analysis.n_factor_entries(),
        memory,
        x,
    }
}

fn by_faer(system: &LinearSystem) -> Figures {
    let LinearSystem { matrix, rhs, .. } = system;
    let matrix = &benches::transposed(matrix);
    let (n, pattern) = (matrix.n(), matrix.pattern());
    let rows = pattern.columns();
    let shape = SymbolicSparseColMatRef::new_checked(n, n, pattern.starts(), None, &rows);
    let matrix = SparseColMatRef::new(shape, matrix.values());
    let analyse =
        || factorize_symbolic_lu(shape, LuSymbolicParams::default()).expect("it fits into memory");
    let mut numeric = NumericLu::new();
    let ((symbolic, mut buffer, x), memory) = memory_of(|| {
        let symbolic = analyse();
        let scratch = symbolic.factorize_numeric_lu_scratch::<f64>(Par::Seq, Default::default());
        let scratch = scratch.or(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        let mut buffer = MemBuffer::new(scratch);
        let stack = MemStack::new(&mut buffer);
        symbolic
            .factorize_numeric_lu(&mut numeric, matrix, Par::Seq, stack, Default::default())
            .expect("the matrix is regular");
        let mut x = rhs.clone();
        LuRef::new_unchecked(&symbolic, &numeric).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(&mut x, n, 1),
            Par::Seq,
            MemStack::new(&mut buffer),
        );
        (symbolic, buffer, x)
    });
    let mut y = rhs.clone();
    Figures {
        analyse: best(|| {
            let _ = analyse();
        }),
        refactorise: best(|| {
            let stack = MemStack::new(&mut buffer);
            symbolic
                .factorize_numeric_lu(&mut numeric, matrix, Par::Seq, stack, Default::default())
                .expect("the matrix is regular");
        }),
        solve: best(|| {
            LuRef::new_unchecked(&symbolic, &numeric).solve_in_place_with_conj(
                Conj::No,
                MatMut::from_column_major_slice_mut(&mut y, n, 1),
                Par::Seq,
                MemStack::new(&mut buffer),
            );
        }),
        // Not told by the library: left out of the comparison.
        factor_entries: 0,
        memory,
        x,
    }
}

fn residual(system: &LinearSystem, x: &[f64]) -> f64 {
    let mut image = vec![0.0; x.len()];
    system.matrix.multiply(x, &mut image);
    let norm = |values: &mut dyn Iterator<Item = f64>| values.map(|v| v * v).sum::<f64>().sqrt();
    let defect = norm(&mut image.iter().zip(&system.rhs).map(|(a, b)| a - b));
    defect / norm(&mut system.rhs.iter().copied())
}

fn write_system(folder: &Path, system: &LinearSystem) -> std::io::Result<()> {
    fs::create_dir_all(folder)?;
    write_matrix(folder, &system.matrix)?;
    write_reals(&folder.join("rhs.npy"), &system.rhs)
}

fn main() -> std::io::Result<()> {
    // Cargo adds `--bench`.
    let folder = std::env::args().skip(1).find(|argument| !argument.starts_with('-'));
    let Some(folder) = folder.map(PathBuf::from) else {
        println!("write_systems: name a folder after `--` to write the systems into");
        return Ok(());
    };
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("no pool is there yet");
    let mut all = serde_json::json!({ "alewife": {}, "faer": {} });
    for size in SIZES {
        let system = TimeStep::new(size).linear_system();
        let name = name_of_size(size);
        write_system(&folder.join(&name), &system)?;
        for (solver, figures) in [("alewife", multifrontal(&system)), ("faer", by_faer(&system))] {
            println!(
                "{name} {solver}: analyse {:.4} s, refactorise {:.4} s, solve {:.5} s, memory \
                 {:.1} MB",
                figures.analyse,
                figures.refactorise,
                figures.solve,
                figures.memory * 1e-6
            );
            all[solver][&name] = serde_json::json!({
                "n": system.rhs.len(),
                "nnz": system.matrix.pattern().n_entries(),
                "analyse_s": figures.analyse,
                "refactorise_s": figures.refactorise,
                "solve_s": figures.solve,
                "factor_entries": figures.factor_entries,
                "memory_bytes": figures.memory,
                "residual": residual(&system, &figures.x),
            });
        }
    }
    fs::write(folder.join("figures.json"), format!("{all:#}\n"))
}
