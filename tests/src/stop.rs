//! Runs that are stopped on the way.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use alewife_core::case::Model;
use alewife_core::simulation::{
    LastState, Observer, RunError, RunSummary, SavedState, Snapshot, StopRequest, simulate,
    simulate_from,
};

/// What a stopped run leaves.
#[derive(Debug, Clone, Default)]
pub struct Stopped {
    /// Its last state.
    pub state: Option<SavedState<2>>,
    /// Times of the steps that were reported (s).
    pub times: Vec<f64>,
}

/// Stops a run after some steps and keeps what it leaves.
struct Stopper {
    after: usize,
    /// How often the run may ask after these steps whether to stop before it is to.
    spared: usize,
    left: Arc<Mutex<Stopped>>,
}

impl Observer<2> for Stopper {
    fn on_step(&mut self, snapshot: &Snapshot<'_, 2>) -> std::io::Result<()> {
        self.left.lock().expect("nobody else holds it").times.push(snapshot.time);
        Ok(())
    }

    fn stop_request(&self) -> Option<StopRequest> {
        let (after, spared, left) = (self.after, self.spared, Arc::clone(&self.left));
        let asked = AtomicUsize::new(0);
        Some(Arc::new(move || {
            // The start is reported, too
            let is_due = left.lock().expect("nobody else holds it").times.len() > after;
            is_due && asked.fetch_add(1, Ordering::Relaxed) >= spared
        }))
    }

    fn on_failure(
        &mut self,
        _error: &RunError,
        remains: Option<&LastState<'_, 2>>,
    ) -> std::io::Result<()> {
        self.left.lock().expect("nobody else holds it").state =
            remains.and_then(|remains| remains.saved.cloned());
        Ok(())
    }
}

/// Stops a run after some steps, at the first question whether to stop but for some that are spared.
fn stop(model: &Model, after: usize, spared: usize) -> Stopped {
    let left = Arc::new(Mutex::new(Stopped::default()));
    let stopper = Stopper { after, spared, left: Arc::clone(&left) };
    let error = simulate(model, &mut [Box::new(stopper)]).expect_err("it is stopped");
    assert!(matches!(error, RunError::Stopped { .. }), "{error}");
    let stopped = left.lock().expect("the run is over").clone();
    assert!(stopped.state.is_some(), "there is a state");
    stopped
}

/// What a run leaves that is asked to stop after some steps, and goes on for as many more questions
/// whether to stop as it is `spared`.
///
/// # Panics
/// When the run fails before.
#[must_use]
pub fn stopped_within_a_step(model: &Model, after: usize, spared: usize) -> Stopped {
    stop(model, after, spared)
}

/// The state of a run after some steps, through the text it is written as.
///
/// # Panics
/// When the run fails before, or the text is not the state.
#[must_use]
pub fn stopped(model: &Model, after: usize) -> SavedState<2> {
    let saved = stop(model, after, 0).state.expect("there is a state");
    let text = serde_json::to_string(&saved).expect("it is written");
    let read: SavedState<2> = serde_json::from_str(&text).expect("it is read");
    assert!(read == saved, "not a bit is lost");
    read
}

/// Resumes from a state.
///
/// # Errors
/// Those of [`simulate_from`].
pub fn resumed(model: &Model, state: &SavedState<2>) -> Result<RunSummary, RunError> {
    simulate_from(model, Some(state), &mut [])
}
