//! A process that this one works for, and ends with: of a sweep, or a Python that runs a case.

use rustix::process::{Pid, getppid, test_kill_process};

use super::exit::{Exit, Failure};

/// Names the process for which another program is run.
pub const VARIABLE: &str = "ALEWIFE_PARENT";

/// Has this process asked to stop when the one in the environment dies.
///
/// # Errors
/// When it is gone already, or the system refuses.
pub fn follow_named() -> Result<(), Failure> {
    let named = std::env::var(VARIABLE).ok();
    stop_with(named.and_then(|id| id.parse().ok()))
}

/// Has this process asked to stop when the one that started it dies.
///
/// # Errors
/// When it is gone already, or the system refuses.
pub fn stop_with(parent: Option<u32>) -> Result<(), Failure> {
    let Some(parent) = parent else { return Ok(()) };
    #[cfg(target_os = "linux")]
    rustix::process::set_parent_process_death_signal(Some(rustix::process::Signal::TERM))
        .map_err(std::io::Error::from)?;
    let parent = i32::try_from(parent).ok().and_then(Pid::from_raw);
    // A script may stand between both
    let is_there = |parent: Pid| getppid() == Some(parent) || test_kill_process(parent).is_ok();
    if parent.is_some_and(is_there) {
        return Ok(());
    }
    Err(Failure::new(Exit::Stopped, "the process that this one worked for is gone"))
}
