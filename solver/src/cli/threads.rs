//! How many threads a run uses.

use super::exit::{Exit, Failure};

/// Variables that say how many threads there are to be, the first one set decides.
///
/// A batch system may give fewer cores to a job than the machine shows.
const VARIABLES: [&str; 3] = ["RAYON_NUM_THREADS", "SLURM_CPUS_PER_TASK", "SLURM_CPUS_ON_NODE"];

/// More threads than any machine a run fits on has cores.
const MOST: usize = 1024;

/// Makes the threads of the program; their number is handed back.
pub fn start(wanted: Option<usize>) -> Result<usize, Failure> {
    let threads = wanted
        .or_else(from_environment)
        .unwrap_or_else(|| std::thread::available_parallelism().map_or(1, std::num::NonZero::get));
    if !(1..=MOST).contains(&threads) {
        let message = format!("{threads} threads are asked for; write a number from 1 to {MOST}");
        return Err(Failure::new(Exit::Usage, message));
    }
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build_global()
        .map_err(|error| Failure::new(Exit::Bug, format!("no threads: {error}")))?;
    Ok(threads)
}

fn from_environment() -> Option<usize> {
    VARIABLES
        .iter()
        .filter_map(|name| std::env::var(name).ok()?.parse().ok())
        .find(|threads| *threads > 0)
}
