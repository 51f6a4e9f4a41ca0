//! `sweep script`: a job script that runs a sweep as an array of Slurm.

use std::path::PathBuf;

use clap::Args;

use super::points::check_points;
use super::swept::{Swept, directory_of};
use crate::cli::exit::{Exit, Failure};
use crate::cli::run;
use crate::cli::style::say;
use crate::sweep::{ArrayScript, MOST_TASKS};

/// What `sweep script` is asked for.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  alewife sweep script my.toml --jobs 4 --time 02:00:00 > my.sh
  sbatch my.sh
  alewife sweep status sweeps/my
  alewife sweep collect sweeps/my

Each task runs some points, those of --jobs at once. A task that has to stop leaves checkpoints, ends
with 75 and goes back into the queue. Change the script as your cluster wants it: partition, account,
modules.")]
pub struct Options {
    #[command(flatten)]
    swept: Swept,
    /// Directory of the sweep; `sweeps/<case>` if absent
    #[arg(long, short, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Points a task runs at once
    #[arg(long, short, value_name = "N", default_value_t = 1)]
    jobs: usize,
    /// Threads of each point
    #[arg(long, short, value_name = "N", default_value_t = 1)]
    threads: usize,
    /// Points of a task; by default so many that there are 1001 tasks at most
    #[arg(long, value_name = "N")]
    per_task: Option<usize>,
    /// Limit of time of a task, as Slurm reads it
    #[arg(long, value_name = "TIME", default_value = "04:00:00")]
    time: String,
}

/// Prints the script, after all points have been checked.
pub fn script(options: &Options) -> Result<Exit, Failure> {
    let sweep = options.swept.read()?;
    let n_points = sweep.n_points();
    check_points(&sweep, 0..n_points)?;
    let Options { jobs, threads, .. } = *options;
    let refuse = |reason: String| Err(Failure::new(Exit::Usage, reason));
    let least = ArrayScript::least_per_task(n_points, jobs);
    let per_task = options.per_task.unwrap_or(least);
    if jobs == 0 || threads == 0 || per_task == 0 {
        return refuse("--jobs, --threads and --per-task are 1 at least".to_owned());
    }
    let n_tasks = n_points.div_ceil(per_task);
    if n_tasks > MOST_TASKS {
        return refuse(format!(
            "{per_task} points a task are {n_tasks} tasks, and an array has {MOST_TASKS} at most; give \
             --per-task {least} or more"
        ));
    }
    let is_time = |c: char| c.is_ascii_digit() || ":-".contains(c);
    if options.time.is_empty() || !options.time.chars().all(is_time) {
        return refuse(format!(
            "--time: \"{}\" is no limit of Slurm; write minutes, hours:minutes:seconds or \
             days-hours:minutes:seconds",
            options.time
        ));
    }
    let script = ArrayScript {
        name: &job_name(&sweep.name()),
        command: &command(options, &directory_of(options.out.as_ref(), &sweep)),
        n_points,
        per_task,
        jobs,
        threads,
        time: &options.time,
    };
    say(script.text().trim_end());
    Ok(Exit::Done)
}

/// A name as Slurm takes it without quotes.
fn job_name(case: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '-' };
    case.chars().map(plain).collect()
}

/// The command of a task, without what differs from task to task.
fn command(options: &Options, out: &std::path::Path) -> String {
    let mut words = vec!["sweep".to_owned(), "run".to_owned(), options.swept.case.clone()];
    for setting in &options.swept.set {
        words.extend(["--set".to_owned(), setting.clone()]);
    }
    words.extend(["--out".into(), out.display().to_string()]);
    run::command(&words)
}
