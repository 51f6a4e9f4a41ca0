//! `status.json`: whether a run is alive, how far it is, and what each stage has cost.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use super::read_back::History;
use super::restarts::Restarts;
use super::write_times::WriteTimes;
use crate::case::{Case, TimeSettings};
use crate::observer::system::{process, write_atomic, write_whole};
use crate::observer::warnings::{self, Warning};
use crate::run::{LastState, Observer, RunError, Snapshot, StepErrorReport};
use crate::step::FlowError;
use crate::timing::{Stage, Timing, cpu_seconds};

/// Longest time a status on the disk may be behind.
const INTERVAL: Duration = Duration::from_secs(1);

/// Where a run stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RunState {
    /// It runs, or its process was killed: `pid` and `updated_at` show which.
    Running,
    /// It came to its end.
    Finished,
    /// It stopped with an error.
    Failed,
    /// A signal stopped it.
    Stopped,
}

impl RunState {
    /// In a word, of a run that a process holds or not.
    #[must_use]
    pub fn in_a_word(self, is_held: bool) -> &'static str {
        match self {
            Self::Running if !is_held => "killed",
            Self::Running => "running",
            Self::Finished => "finished",
            Self::Failed => "failed",
            Self::Stopped => "stopped",
        }
    }
}

/// Where a process was when it had its first row: what comes later is steps.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FirstRow {
    /// Time of the run (s).
    pub time: f64,
    /// Wall-clock seconds since the start of the process's run.
    pub wall: f64,
}

/// What a run without a flow is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// Its model, by its name on the command line.
    pub fidelity: &'static str,
    /// Its steps, once they are made.
    pub steps: usize,
    /// Time at which it ends (s).
    pub end: f64,
    /// Its unknowns.
    pub dofs: usize,
}

/// The content of `status.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Status {
    /// Where the run stands.
    pub state: RunState,
    /// The model of a run without a flow, by its name on the command line.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fidelity: Option<String>,
    /// Why it stopped.
    pub reason: Option<String>,
    /// Accepted steps so far.
    pub step: usize,
    /// Steps expected in all, not counting the short ones a run may start with; the true number
    /// once it is known, nothing for a steady solution.
    pub steps: Option<usize>,
    /// Time reached (s).
    pub time: f64,
    /// Time at which the run ends (s); nothing for a steady solution.
    pub end: Option<f64>,
    /// Unknowns of the linear system.
    pub dofs: usize,
    /// CPU seconds of all threads by stage, and of the whole process as `total`.
    pub cpu_seconds: BTreeMap<String, f64>,
    /// Wall-clock seconds by stage, and since the start of the run as `total`.
    pub wall_seconds: BTreeMap<String, f64>,
    /// The first row of this process, once it has one.
    #[serde(default)]
    pub first_row: Option<FirstRow>,
    /// Most memory the process ever held (bytes).
    pub peak_memory: Option<u64>,
    /// How often in a row it was restarted at one and the same step.
    #[serde(default)]
    pub restarts: Restarts,
    /// The longest time a state took to write (s), once one was.
    #[serde(default)]
    pub longest_checkpoint: Option<f64>,
    /// Whether it ended for a reason outside of it, and continues when it is run again.
    #[serde(default)]
    pub is_interrupted: bool,
    /// What the run warned of so far.
    #[serde(default)]
    pub warnings: Vec<Warning>,
    /// What the steps so far leave, as parts of what they are in; nothing for a steady solution.
    #[serde(default)]
    pub step_errors: Option<StepErrorReport>,
    /// The process.
    pub pid: u32,
    /// When this was written (UTC).
    pub updated_at: String,
}

impl Status {
    /// Wall-clock seconds to the end, at the rate of the steps that this process has made.
    #[must_use]
    pub fn seconds_left(&self) -> Option<f64> {
        let FirstRow { time, wall } = self.first_row?;
        let taken = self.wall_seconds.get("total")? - wall;
        let made = self.time - time;
        let to_go = (self.end? - self.time).max(0.0);
        (made > 0.0).then(|| taken * to_go / made)
    }

    /// That of a run whose own is lost: it was under way, and its checkpoints have more.
    #[must_use]
    pub fn lost(case: &Case) -> Self {
        Self::beginning(case, 0, 0.0)
    }

    /// That of a run which came to its end, and whose own is lost: it made so many steps up to a time (s).
    #[must_use]
    pub fn lost_end(case: &Case, step: usize, time: f64) -> Self {
        Self { state: RunState::Finished, ..Self::beginning(case, step, time) }
    }

    /// Writes it to the directory of a run.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn write(&self, directory: &Path) -> io::Result<()> {
        let mut text = serde_json::to_vec_pretty(self)?;
        text.push(b'\n');
        write_atomic(&directory.join("status.json"), &text)
    }

    /// That of a run which begins in this process, after so many steps up to a time (s).
    fn beginning(case: &Case, step: usize, time: f64) -> Self {
        let (steps, end) = match &case.time {
            TimeSettings::Steady(_) => (None, None),
            TimeSettings::Unsteady(settings) => {
                let left = settings.n_steps().saturating_sub(settings.n_steps_to(time));
                let steps = settings.adaptive.is_none().then_some(step + left);
                (steps, Some(settings.end))
            }
        };
        Self { steps, end, ..Self::empty(step, time) }
    }

    /// That of a run without a flow which begins in this process.
    #[must_use]
    pub fn of_motion(motion: &Motion) -> Self {
        Self {
            fidelity: Some(motion.fidelity.to_owned()),
            steps: Some(motion.steps).filter(|steps| *steps > 0),
            end: Some(motion.end),
            dofs: motion.dofs,
            ..Self::empty(0, 0.0)
        }
    }

    /// That of a run of which nothing is known but the steps made up to a time (s).
    fn empty(step: usize, time: f64) -> Self {
        Self {
            state: RunState::Running,
            fidelity: None,
            reason: None,
            step,
            steps: None,
            time,
            end: None,
            dofs: 0,
            cpu_seconds: BTreeMap::new(),
            wall_seconds: BTreeMap::new(),
            first_row: None,
            peak_memory: None,
            restarts: Restarts::default(),
            longest_checkpoint: None,
            is_interrupted: false,
            warnings: Vec::new(),
            step_errors: None,
            pid: std::process::id(),
            updated_at: String::new(),
        }
    }

    /// The status of the run in `directory`.
    ///
    /// # Errors
    /// When there is none, or it cannot be read.
    pub fn read(directory: &Path) -> io::Result<Self> {
        Ok(serde_json::from_slice(&std::fs::read(directory.join("status.json"))?)?)
    }
}

/// Keeps `status.json` at most a second behind the run.
#[derive(Debug)]
pub struct StatusFile {
    path: PathBuf,
    status: Status,
    times: WriteTimes,
    started: Instant,
    /// CPU seconds the process had taken when the run started: it may have had others before.
    cpu_before: f64,
    written: Instant,
}

impl StatusFile {
    /// Marks `directory` as that of a run under way.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn create(
        directory: &Path,
        case: &Case,
        history: Option<&History>,
        times: WriteTimes,
    ) -> io::Result<Self> {
        let (step, time) = history.map_or((0, 0.0), |history| (history.step, history.time));
        let restarts = history.map_or_else(Restarts::default, |history| history.restarts);
        let status = Status { restarts, ..Status::beginning(case, step, time) };
        let now = Instant::now();
        let path = directory.join("status.json");
        let cpu_before = cpu_seconds();
        let mut file = Self { path, status, times, started: now, cpu_before, written: now };
        file.write(write_atomic)?;
        Ok(file)
    }

    fn write(&mut self, how: fn(&Path, &[u8]) -> io::Result<()>) -> io::Result<()> {
        self.written = Instant::now();
        let wall = self.written.duration_since(self.started).as_secs_f64();
        self.status.wall_seconds.insert("total".to_owned(), wall);
        let cpu = cpu_seconds() - self.cpu_before;
        self.status.cpu_seconds.insert("total".to_owned(), cpu);
        self.status.longest_checkpoint = self.times.longest().map(|time| time.as_secs_f64());
        self.status.peak_memory = process::peak_memory();
        self.status.warnings = warnings::warnings();
        self.status.updated_at = process::now();
        let mut text = serde_json::to_vec_pretty(&self.status)?;
        text.push(b'\n');
        how(&self.path, &text)
    }
}

impl<const D: usize> Observer<D> for StatusFile {
    fn on_step(&mut self, snapshot: &Snapshot<'_, D>) -> io::Result<()> {
        self.status.step = snapshot.step;
        self.status.time = snapshot.time;
        self.status.dofs = snapshot.n_dofs;
        warnings::reach(snapshot.time);
        let wall = self.started.elapsed().as_secs_f64();
        self.status.first_row.get_or_insert(FirstRow { time: snapshot.time, wall });
        by_stage(&mut self.status, snapshot.timing);
        if snapshot.is_last {
            self.status.steps = self.status.steps.map(|_| snapshot.step);
        }
        let is_due = snapshot.is_last || snapshot.step == 0 || self.written.elapsed() >= INTERVAL;
        if is_due { self.write(write_whole) } else { Ok(()) }
    }

    fn on_end(&mut self, timing: &Timing) -> io::Result<()> {
        by_stage(&mut self.status, timing);
        // The last state is on the disk now, too
        self.status.state = RunState::Finished;
        self.write(write_atomic)
    }

    fn on_failure(&mut self, error: &RunError, _last: Option<&LastState<'_, D>>) -> io::Result<()> {
        self.status.state = match error {
            RunError::Flow(FlowError::Stopped { .. }) => RunState::Stopped,
            _ => RunState::Failed,
        };
        self.status.is_interrupted =
            matches!(error, RunError::Flow(FlowError::Stopped { .. }) | RunError::Output(_));
        self.status.reason = Some(error.to_string());
        self.write(write_atomic)
    }
}

fn by_stage(status: &mut Status, timing: &Timing) {
    for stage in Stage::ALL {
        status.cpu_seconds.insert(stage.name().to_owned(), timing.cpu[stage as usize]);
        status.wall_seconds.insert(stage.name().to_owned(), timing.wall[stage as usize]);
    }
}
