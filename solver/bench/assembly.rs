//! CPU time of the assembly of the matrix and of the residual, on one thread.
//!
//! `cargo bench -p benches --bench assembly`; throughputs are microseconds a cell.

mod systems;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

use systems::{CpuTime, TimeStep, name_of_size};

/// Wanted numbers of unknowns.
const SIZES: [usize; 3] = [10_000, 50_000, 200_000];

fn matrix_and_residual(criterion: &mut Criterion<CpuTime>) {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("no pool is there yet");
    for size in SIZES {
        let straight = TimeStep::new(size);
        time(criterion, "", size, &straight);
        time(criterion, "-curved", size, &straight.with_curved_cells());
    }
}

fn time(criterion: &mut Criterion<CpuTime>, kind: &str, size: usize, step: &TimeStep) {
    let mut values = vec![0.0; step.maps.pattern().n_entries()];
    let cells = Throughput::Elements(step.mesh.n_cells() as u64);
    let mut group = criterion.benchmark_group(format!("matrix{kind}"));
    group.sample_size(10).throughput(cells.clone());
    group.bench_function(BenchmarkId::from_parameter(name_of_size(size)), |bencher| {
        bencher.iter(|| step.assemble(&mut values));
    });
    group.finish();
    let mut group = criterion.benchmark_group(format!("residual{kind}"));
    group.sample_size(10).throughput(cells);
    group.bench_function(BenchmarkId::from_parameter(name_of_size(size)), |bencher| {
        bencher.iter(|| step.residual());
    });
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().with_measurement(CpuTime);
    targets = matrix_and_residual
}
criterion_main!(benches);
