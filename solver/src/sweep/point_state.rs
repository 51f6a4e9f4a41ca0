//! `PointState`: where a point of a sweep stands, from its files.

use super::directory::SweepDirectory;
use super::failure::PointFailure;
use super::misplaced::misplaced;
use crate::observer::{RunLock, RunState, Status};

/// Where a point stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PointState {
    /// Nothing was run yet.
    Missing,
    /// A process runs it.
    Running,
    /// It stopped on its way, and continues.
    Stopped,
    /// It came to its end.
    Finished,
    /// It failed.
    Failed,
}

impl PointState {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::Finished, Self::Running, Self::Stopped, Self::Missing, Self::Failed];

    /// Name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Missing => "missing",
            Self::Running => "running",
            Self::Stopped => "stopped",
            Self::Finished => "finished",
            Self::Failed => "failed",
        }
    }
}

/// Where a point stands, and what is known of it.
#[derive(Debug, Clone)]
pub struct Stand {
    /// Where it stands.
    pub state: PointState,
    /// The status of its run, if there is one.
    pub status: Option<Status>,
    /// Why it failed, if it did.
    pub failure: Option<PointFailure>,
}

impl Stand {
    /// Whether its run left what a new one has to replace.
    #[must_use]
    pub fn has_failed_run(&self) -> bool {
        self.status.as_ref().is_some_and(|status| status.state == RunState::Failed)
    }
}

/// Where a point stands, by its index from 0.
#[must_use]
pub fn stand(directory: &SweepDirectory, index: usize) -> Stand {
    let path = directory.point(index);
    // A process that has come to the end of a run may still compare it with references
    if RunLock::is_held(&path, &[]) {
        let status = Status::read(&path).ok();
        return Stand { state: PointState::Running, status, failure: None };
    }
    stand_of_own(directory, index)
}

/// The same for a point that this process holds, or nobody.
#[must_use]
pub fn stand_of_own(directory: &SweepDirectory, index: usize) -> Stand {
    let path = directory.point(index);
    let status = Status::read(&path).ok();
    if let Some(failure) = misplaced(directory.plan(), &path, index) {
        return Stand { state: PointState::Failed, status, failure: Some(failure) };
    }
    let mut failure = PointFailure::read(directory, index);
    let state = match status.as_ref().map(|status| status.state) {
        Some(RunState::Finished) => PointState::Finished,
        _ if failure.is_some() => PointState::Failed,
        None => PointState::Missing,
        Some(RunState::Failed) => {
            let reason = status.as_ref().and_then(|status| status.reason.clone());
            failure = Some(PointFailure::new(None, reason.unwrap_or_default()));
            PointState::Failed
        }
        // A process that was killed leaves `running`, and gives its lock free
        Some(RunState::Stopped | RunState::Running) => PointState::Stopped,
    };
    if state == PointState::Finished {
        failure = None;
    }
    Stand { state, status, failure }
}
