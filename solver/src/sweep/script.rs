//! `ArrayScript`: a job script that runs a sweep as a Slurm array, several points a task.

/// Most tasks of an array: Slurm's `MaxArraySize` is 1001 unless its administrators change it.
pub const MOST_TASKS: usize = 1001;

/// Times a task is put back into the queue at most.
const MOST_RESTARTS: usize = 100;

/// What a script runs, and with which cores.
#[derive(Debug, Clone)]
pub struct ArrayScript<'a> {
    /// Name of the job.
    pub name: &'a str,
    /// The command up to `sweep run` and its case, as a shell reads it.
    pub command: &'a str,
    /// Points of the sweep.
    pub n_points: usize,
    /// Points of a task.
    pub per_task: usize,
    /// Points a task runs at once.
    pub jobs: usize,
    /// Threads of each.
    pub threads: usize,
    /// Limit of time of a task, as Slurm reads it.
    pub time: &'a str,
}

impl ArrayScript<'_> {
    /// Points a task has to take so that there are not too many tasks, whole rounds of its jobs.
    #[must_use]
    pub fn least_per_task(n_points: usize, jobs: usize) -> usize {
        n_points.div_ceil(MOST_TASKS).next_multiple_of(jobs.max(1))
    }

    /// The script.
    #[must_use]
    pub fn text(&self) -> String {
        let Self { name, command, n_points, per_task, jobs, threads, time } = self;
        let last = n_points.div_ceil(*per_task) - 1;
        let cores = jobs * threads;
        format!(
            r#"#!/bin/bash
# Points: {n_points}; of a task: {per_task}; at once: {jobs}; threads of each: {threads}.
# A task that ends with 75 has left checkpoints and goes back into the queue.
#SBATCH --job-name={name}
#SBATCH --array=0-{last}
#SBATCH --ntasks=1
#SBATCH --cpus-per-task={cores}
#SBATCH --time={time}
#SBATCH --signal=USR1@60
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=slurm-%A_%a.out

first=$((SLURM_ARRAY_TASK_ID * {per_task} + 1))
last=$((first + {per_task} - 1))
if ((last > {n_points})); then
    last={n_points}
fi

srun --cpus-per-task={cores} {command} \
    --index "$first-$last" --jobs {jobs} --threads {threads}
code=$?

if ((code == 75 && ${{SLURM_RESTART_COUNT:-0}} < {MOST_RESTARTS})); then
    scontrol requeue "${{SLURM_ARRAY_JOB_ID}}_${{SLURM_ARRAY_TASK_ID}}"
fi
exit "$code"
"#
        )
    }
}
