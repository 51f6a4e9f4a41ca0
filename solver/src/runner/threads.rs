//! How many threads a run uses.

use alewife_interrupt::Listener;

use super::failure::{Exit, Failure};
use crate::observer::print_line;

/// Variables that say how many threads there are to be, the first one set decides.
///
/// A batch system may give fewer cores to a job than the machine shows.
const VARIABLES: [&str; 3] = ["RAYON_NUM_THREADS", "SLURM_CPUS_PER_TASK", "SLURM_CPUS_ON_NODE"];

/// More threads than any machine a run fits on has cores.
const MOST: usize = 1024;

/// Stack of a thread (bytes): what a main thread has.
const STACK: usize = 8 << 20;

/// Makes the threads of the program; their number is handed back.
pub fn start(wanted: Option<usize>) -> Result<usize, Failure> {
    let threads = wanted
        .or_else(from_environment)
        .unwrap_or_else(|| std::thread::available_parallelism().map_or(1, std::num::NonZero::get));
    if !(1..=MOST).contains(&threads) {
        let message = format!("{threads} threads are asked for; write a number from 1 to {MOST}");
        return Err(Failure::new(Exit::Usage, message));
    }
    let cores = granted();
    if threads > cores {
        print_line(&format!(
            "warning: {threads} threads share {cores} {}: more than there are cores make a run slower",
            if cores == 1 { "core" } else { "cores" }
        ));
    }
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .stack_size(STACK)
        .build_global()
        .map_err(|error| Failure::new(Exit::Bug, format!("no threads: {error}")))?;
    Ok(threads)
}

/// Cores this process may use: those of the machine, of its affinity and control group, or fewer where
/// the batch system grants fewer to a task.
pub fn granted() -> usize {
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    first_of(&VARIABLES[1..]).map_or(cores, |granted| granted.min(cores))
}

/// Does work on one of the threads: what it does in parallel then begins there, where each piece would have to be
/// handed over from the main thread, which takes longer than many of them.
pub fn within<R: Send>(work: impl FnOnce() -> R + Send) -> R {
    let listener = Listener::here();
    rayon::scope(|_| listener.along(work))
}

fn from_environment() -> Option<usize> {
    first_of(&VARIABLES)
}

fn first_of(variables: &[&str]) -> Option<usize> {
    variables
        .iter()
        .filter_map(|name| std::env::var(name).ok()?.parse().ok())
        .find(|threads| *threads > 0)
}
