//! CPU time of the sparse LU, phase by phase, and of faer's on the same matrices, on one thread.
//!
//! `cargo bench -p benches --bench linear_solver`

mod systems;

use alewife_core::multifrontal::{Analysis, Factors, Ordering};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::lu::{LuRef, LuSymbolicParams, NumericLu, factorize_symbolic_lu};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par};

use systems::{CpuTime, LinearSystem, TimeStep, name_of_size};

/// Wanted numbers of unknowns.
const SIZES: [usize; 3] = [10_000, 50_000, 200_000];
/// Right-hand sides of a block solve.
const SIDES: usize = 8;

fn phases(criterion: &mut Criterion<CpuTime>) {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("no pool is there yet");
    for size in SIZES {
        let system = TimeStep::new(size).linear_system();
        multifrontal(criterion, size, &system);
        by_faer(criterion, size, &system);
    }
}

fn time(criterion: &mut Criterion<CpuTime>, phase: &str, size: usize, mut work: impl FnMut()) {
    let mut group = criterion.benchmark_group(phase);
    group.sample_size(10);
    group.bench_function(BenchmarkId::from_parameter(name_of_size(size)), |bencher| {
        bencher.iter(&mut work);
    });
    group.finish();
}

fn multifrontal(criterion: &mut Criterion<CpuTime>, size: usize, system: &LinearSystem) {
    let LinearSystem { matrix, rhs, unknowns } = system;
    for (name, ordering) in [("analyse", Ordering::Best), ("analyse-amd", Ordering::MinimumDegree)]
    {
        time(criterion, name, size, || {
            let _ = Analysis::new(matrix.pattern(), unknowns, ordering);
        });
    }
    let analysis = Analysis::new(matrix.pattern(), unknowns, Ordering::Best);
    time(criterion, "factorise", size, || {
        let mut factors = Factors::new(&analysis);
        factors.factorise(&analysis, matrix).expect("the matrix is regular");
    });
    let mut factors = Factors::new(&analysis);
    time(criterion, "refactorise", size, || {
        factors.factorise(&analysis, matrix).expect("the matrix is regular");
    });
    let mut x = rhs.clone();
    time(criterion, "solve", size, || {
        x.copy_from_slice(rhs);
        factors.solve(&analysis, &mut x);
    });
    let mut many = rhs.repeat(SIDES);
    time(criterion, "solve-8", size, || factors.solve(&analysis, &mut many));
}

fn by_faer(criterion: &mut Criterion<CpuTime>, size: usize, system: &LinearSystem) {
    let LinearSystem { matrix, rhs, .. } = system;
    let matrix = &benches::transposed(matrix);
    let (n, pattern) = (matrix.n(), matrix.pattern());
    let rows = pattern.columns();
    let shape = SymbolicSparseColMatRef::new_checked(n, n, pattern.starts(), None, &rows);
    let symbolic = factorize_symbolic_lu(shape, LuSymbolicParams::default())
        .expect("the analysis fits into memory");
    time(criterion, "faer-analyse", size, || {
        let _ = factorize_symbolic_lu(shape, LuSymbolicParams::default());
    });
    let scratch = symbolic.factorize_numeric_lu_scratch::<f64>(Par::Seq, Default::default());
    let scratch = scratch.or(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
    let mut memory = MemBuffer::new(scratch);
    let mut numeric = NumericLu::new();
    time(criterion, "faer-refactorise", size, || {
        let matrix = SparseColMatRef::new(shape, matrix.values());
        let stack = MemStack::new(&mut memory);
        symbolic
            .factorize_numeric_lu(&mut numeric, matrix, Par::Seq, stack, Default::default())
            .expect("the matrix is regular");
    });
    let mut x = rhs.clone();
    time(criterion, "faer-solve", size, || {
        x.copy_from_slice(rhs);
        LuRef::new_unchecked(&symbolic, &numeric).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(&mut x, n, 1),
            Par::Seq,
            MemStack::new(&mut memory),
        );
    });
}

criterion_group! {
    name = benches;
    config = Criterion::default().with_measurement(CpuTime);
    targets = phases
}
criterion_main!(benches);
