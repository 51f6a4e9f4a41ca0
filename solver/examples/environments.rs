//! What an environment of the reduced model costs: steps a second on one core, and memory.
//!
//! `cargo run --release -p alewife --example environments`; `environments.py` beside it does the same from Python.

use std::time::Instant;

use alewife::case::{Case, SplitMix64};
use alewife::environment::{Autoreset, Batch};

/// Decisions that are timed.
const DECISIONS: usize = 40;

/// Resident memory of this process (bytes), where the system tells it.
fn resident() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with("VmRSS:")).unwrap_or_default();
    let number = line.split_whitespace().nth(1).and_then(|number| number.parse::<f64>().ok());
    number.map_or(f64::NAN, |kilobytes| 1024.0 * kilobytes)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = Case::read("eel-to-target", &[])?;
    for n in [1, 64, 2048] {
        let mut batch = Batch::open(&file, n, 1)?;
        batch.reset(None, None)?;
        let mut random = SplitMix64(1);
        let actions: Vec<f64> = (0..5 * n).map(|_| 2.0 * random.uniform() - 1.0).collect();
        batch.step(&actions, Autoreset::NextStep)?;
        let repeats = (2048 / n).clamp(1, 20) * DECISIONS;
        let start = Instant::now();
        for _ in 0..repeats {
            batch.step(&actions, Autoreset::NextStep)?;
        }
        let seconds = start.elapsed().as_secs_f64();
        let decisions = (repeats * n) as f64 / seconds;
        let steps = decisions * batch.task().n_steps() as f64;
        println!(
            "{n:>6} environments: {decisions:>9.0} decisions/s, {steps:>9.0} steps/s, {:.2} us a step",
            1e6 / steps
        );
    }
    let before = resident();
    let n = 200_000;
    let mut batch = Batch::open(&file, n, 1)?;
    batch.reset(None, None)?;
    println!("{:>6} environments: {:.0} bytes each", n, (resident() - before) / n as f64);
    Ok(())
}
