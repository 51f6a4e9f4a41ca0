//! Many points of a sweep, each in a process of its own.

use std::ops::Range;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::collect;
use super::points::check_points;
use super::run_options::Options;
use super::swept::directory_of;
use crate::case::Sweep;
use crate::cli::exit::{Exit, Failure};
use crate::cli::parent;
use crate::cli::style::{self, complain, say};
use crate::observer::{STOP, Status, Tally, remove_if_there};
use crate::runner::{SignalWatch, WallLimit, threads};
use crate::sweep::{
    Ended, Ending, Launch, Plan, PointFailure, PointState, SweepDirectory, run_children, stand,
};

/// Time that has to be left for a point to be started: what its run keeps for its last state, and a
/// little more.
const LEAST_TIME: Duration = Duration::from_secs(12);
/// Points that failed which are listed at most.
const MOST_LISTED: usize = 20;

/// What becomes of the points of a call.
#[derive(Debug, Default)]
struct Score {
    finished: usize,
    failed: Vec<FailedPoint>,
}

#[derive(Debug)]
struct FailedPoint {
    index: usize,
    failure: PointFailure,
}

/// Runs all points that are asked for and missing.
pub fn run(options: &Options) -> Result<Exit, Failure> {
    let started = Instant::now();
    let n_threads = options.threads.unwrap_or(1);
    let jobs = n_jobs(options.jobs, n_threads)?;
    let end = WallLimit::end(options.max_walltime);
    let sweep = options.sweep()?;
    let range = match options.index {
        Some(index) => index.range(sweep.n_points())?,
        None => 0..sweep.n_points(),
    };
    let warnings = check_points(&sweep, range.clone())?;
    if !warnings.is_empty() {
        complain(&style::diagnostics(&warnings));
    }
    let directory = directory(options, &sweep)?;
    let ToMake { points, mut score } = points_to_make(&directory, range.clone(), options.retry);
    let [before, failed_before] = [score.finished, score.failed.len()];
    tell_beginning(options, &directory, &score, points.len());

    let watch = SignalWatch::start()?;
    let mut tally = Tally::new(points.len(), jobs, options.quiet);
    let calls = Calls { options, directory: &directory, n_threads, end };
    let stop_file = directory.path().join(STOP);
    run_children(
        points,
        jobs,
        &|index| calls.launch(index),
        &|| watch.has_come() || stop_file.is_file(),
        &mut |ended| {
            count(ended, &mut score, &tally, &directory);
            let failed = score.failed.len() - failed_before;
            tally.show(score.finished - before + failed, failed);
        },
    );
    drop(tally);
    // The same on any number of cores
    score.failed.sort_by_key(|point| point.index);
    let is_stopped = watch.has_come() || stop_file.is_file();
    remove_if_there(&stop_file)?;
    let n_left = range.len() - score.finished - score.failed.len();
    if options.index.is_none() {
        collect::write(&directory, None, &[])?;
    }
    tell_end(&directory, &score, range.len(), started.elapsed());
    if n_left > 0 {
        let why = if is_stopped { "asked to stop" } else { "stopped" };
        let reason = format!("{why} with {n_left} points to go; the same call again continues");
        return Err(Failure::new(Exit::Stopped, reason));
    }
    Ok(score.failed.first().map_or(Exit::Done, |failed| exit_of(&failed.failure)))
}

/// How many points run at once, so that their threads have the cores that are granted.
fn n_jobs(asked: Option<usize>, n_threads: usize) -> Result<usize, Failure> {
    let granted = threads::granted();
    let refuse = |reason: String| Err(Failure::new(Exit::Usage, reason));
    let jobs = asked.unwrap_or_else(|| (granted / n_threads.max(1)).max(1));
    if jobs == 0 || n_threads == 0 {
        return refuse("--jobs and --threads are 1 at least".to_owned());
    }
    if jobs.saturating_mul(n_threads) > granted {
        let most = granted / n_threads;
        let remedy = match most {
            0 => format!("give --threads up to {granted}"),
            _ => format!("give --jobs up to {most}, or fewer --threads"),
        };
        return refuse(format!(
            "{jobs} jobs of {n_threads} threads each want {} cores, and {granted} are granted; {remedy}",
            jobs.saturating_mul(n_threads)
        ));
    }
    Ok(jobs)
}

fn directory(options: &Options, sweep: &Sweep) -> Result<SweepDirectory, Failure> {
    let plan = Plan::new(sweep)?;
    Ok(SweepDirectory::create(&directory_of(options.out.as_ref(), sweep), plan, sweep)?)
}

/// The points of a call to be made, and the score of the others.
struct ToMake {
    points: Vec<usize>,
    score: Score,
}

fn points_to_make(directory: &SweepDirectory, range: Range<usize>, retry: bool) -> ToMake {
    let (mut points, mut score) = (Vec::new(), Score::default());
    for index in range {
        let stand = stand(directory, index);
        match stand.failure {
            _ if stand.state == PointState::Finished => score.finished += 1,
            Some(failure) if failure.is_for_good() && !retry => {
                score.failed.push(FailedPoint { index, failure });
            }
            _ => points.push(index),
        }
    }
    ToMake { points, score }
}

/// How the processes of points are called.
struct Calls<'a> {
    options: &'a Options,
    directory: &'a SweepDirectory,
    n_threads: usize,
    /// When the time of the sweep is over.
    end: Option<Instant>,
}

impl Calls<'_> {
    fn launch(&self, index: usize) -> Launch {
        let stand = stand(self.directory, index);
        match stand.state {
            PointState::Finished => return Launch::IsDone,
            PointState::Running => return Launch::Busy,
            PointState::Missing | PointState::Stopped | PointState::Failed => {}
        }
        // Another process of this sweep has run it since the call began
        if let Some(failure) = stand.failure.filter(|one| one.is_for_good() && !self.options.retry)
        {
            return Launch::HasFailed(failure);
        }
        let left = self.end.map(|end| end.saturating_duration_since(Instant::now()));
        if left.is_some_and(|left| left < LEAST_TIME) {
            return Launch::TimeIsOver;
        }
        let mut command = Command::new(this_program());
        command.arg0(std::env::args_os().next().unwrap_or_else(|| "alewife".into()));
        command.args(["sweep", "run", &self.options.swept.case]);
        for setting in &self.options.swept.set {
            command.args(["--set", setting]);
        }
        for quantity in &self.options.quantities {
            command.args(["--quantity", quantity]);
        }
        command.arg("--out").arg(self.directory.path());
        command.args(["--index", &(index + 1).to_string()]);
        command.args(["--threads", &self.n_threads.to_string()]);
        if self.options.retry {
            command.arg("--retry");
        }
        command.args(["--parent", &std::process::id().to_string()]);
        if let Some(left) = left {
            command.args(["--max-walltime", &format!("{} s", left.as_secs_f64())]);
        }
        // Of this process, and not of its points
        command.env_remove(parent::VARIABLE);
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
        Launch::Start(Box::new(command))
    }
}

/// This program: the file it was started from, even where another one has taken its place since.
fn this_program() -> PathBuf {
    let of_process = Path::new("/proc/self/exe");
    if of_process.exists() {
        return of_process.to_owned();
    }
    std::env::current_exe().unwrap_or_else(|_| "alewife".into())
}

fn count(ended: Ended, score: &mut Score, tally: &Tally, directory: &SweepDirectory) {
    let Ended { index, ending } = ended;
    match ending {
        Ending::Finished => score.finished += 1,
        // It is neither, and continues with the next call
        Ending::Stopped => {}
        Ending::Failed(failure) => {
            tally.line(&failure_line(directory, index, &failure));
            score.failed.push(FailedPoint { index, failure });
        }
    }
}

/// A point that failed, what it sets, and why it failed.
pub fn failure_line(directory: &SweepDirectory, index: usize, failure: &PointFailure) -> String {
    let label = directory.plan().label(index);
    let code = failure.exit.map_or_else(String::new, |exit| format!(" with exit code {exit}"));
    format!("point {} ({label}) failed{code}: {}", index + 1, failure.line())
}

fn tell_beginning(options: &Options, directory: &SweepDirectory, score: &Score, n_points: usize) {
    if options.quiet {
        return;
    }
    let path = directory.path().display();
    let mut line = format!("points to make in {path}: {n_points}");
    if score.finished > 0 {
        line += &format!("; finished already: {}", score.finished);
    }
    if !score.failed.is_empty() {
        line += &format!("; failed, and not run again without --retry: {}", score.failed.len());
    }
    complain(&line);
}

fn tell_end(directory: &SweepDirectory, score: &Score, n: usize, elapsed: Duration) {
    let finished = score.finished;
    let statuses: Vec<Status> = (0..directory.n_points())
        .filter_map(|index| Status::read(&directory.point(index)).ok())
        .collect();
    let cpu_seconds = statuses.iter().filter_map(|status| status.cpu_seconds.get("total"));
    let seconds: f64 = cpu_seconds.sum();
    let warned = match statuses.iter().filter(|status| !status.warnings.is_empty()).count() {
        0 => String::new(),
        n => format!(", {n} with warnings"),
    };
    let failed = match score.failed.len() {
        0 => String::new(),
        n => format!(", {n} failed"),
    };
    let path = directory.path().display();
    let place = if finished > 0 { "written to" } else { "in" };
    let elapsed = elapsed.as_secs_f64();
    say(&format!(
        "{finished} of {n} points finished{failed}{warned}; {elapsed:.1} s for {seconds:.1} s of CPU time; \
         {place} {path}"
    ));
    for FailedPoint { index, failure } in score.failed.iter().take(MOST_LISTED) {
        say(&failure_line(directory, *index, failure));
    }
    if score.failed.len() > MOST_LISTED {
        say(&format!(
            "... and {} more; alewife sweep status {path}",
            score.failed.len() - MOST_LISTED
        ));
    }
}

/// The code of a point that failed.
pub fn exit_of(failure: &PointFailure) -> Exit {
    let known = [Exit::Diverged, Exit::Mesh, Exit::BadCase, Exit::NoInput, Exit::InputOutput];
    let more = [Exit::NoProgress, Exit::OutOfMemory, Exit::Usage];
    let all = known.into_iter().chain(more);
    all.into_iter().find(|exit| Some(*exit as u8) == failure.exit).unwrap_or(Exit::Bug)
}
