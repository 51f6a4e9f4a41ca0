//! The same input gives the same bits, on any number of threads and in every run.

use alewife_core::run::RunSummary;
use tests::cases::{case, run};

const CASE: &str = r#"
    title = "disc in a channel"
    geometry = "planar"
    fluid = { model = "navier-stokes", density = 1.0, viscosity = 0.01 }
    domain.channel = { length = 2.2, height = 0.41 }
    boundary = { bottom = "no-slip", top = "no-slip", right = "do-nothing", left.parabolic.peak = 0.3 }
    mesh = { size = 0.05, surface = 0.015 }
    time.unsteady = { step = 0.02, end = 0.1 }
    [[body]]
    name = "disc"
    shape.disc = { radius = 0.05 }
    center = [0.2, 0.2]
    motion = "free"
    locked = ["x", "y"]
    density = 1.0
"#;

fn on_threads(n: usize) -> RunSummary {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("threads start");
    pool.install(|| run(&case(CASE)))
}

#[test]
fn results_have_the_same_bits_on_one_two_and_five_threads() {
    let one = on_threads(1);
    for n in [2, 5] {
        assert_eq!(one.series, on_threads(n).series);
    }
}
