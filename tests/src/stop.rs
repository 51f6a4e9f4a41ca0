//! Runs that are stopped on the way.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use alewife_core::case::Model;
use alewife_core::run::{
    Dimension, LastState, Observer, RunError, RunSummary, SavedState, Snapshot, Solve,
    simulate_from,
};
use alewife_core::step::{FlowError, StopRequest};

/// What a stopped run leaves.
#[derive(Debug, Clone)]
pub struct Stopped<const D: usize> {
    /// Its last state.
    pub state: Option<SavedState<D>>,
    /// Times of the steps that were reported (s).
    pub times: Vec<f64>,
}

/// Stops a run after some steps and keeps what it leaves.
struct Stopper<const D: usize> {
    after: usize,
    /// How often the run may ask after these steps whether to stop before it is to.
    spared: usize,
    left: Arc<Mutex<Stopped<D>>>,
}

impl<const D: usize> Observer<D> for Stopper<D> {
    fn on_step(&mut self, snapshot: &Snapshot<'_, D>) -> std::io::Result<()> {
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
        remains: Option<&LastState<'_, D>>,
    ) -> std::io::Result<()> {
        self.left.lock().expect("nobody else holds it").state =
            remains.and_then(|remains| remains.saved.cloned());
        Ok(())
    }
}

/// Stops a run after some steps, at the first question whether to stop but for some that are spared.
fn stop<const D: usize>(
    model: &Model,
    from: Option<&SavedState<D>>,
    after: usize,
    spared: usize,
) -> Stopped<D>
where
    Dimension<D>: Solve<D>,
{
    let left = Arc::new(Mutex::new(Stopped { state: None, times: Vec::new() }));
    let stopper = Stopper { after, spared, left: Arc::clone(&left) };
    let error = simulate_from(model, from, &mut [Box::new(stopper)]).expect_err("it is stopped");
    assert!(matches!(error, RunError::Flow(FlowError::Stopped { .. })), "{error}");
    let stopped = left.lock().expect("the run is over").clone();
    assert!(stopped.state.is_some(), "there is a state");
    stopped
}

/// What a run leaves that is asked to stop after some steps, and continues for as many more questions
/// whether to stop as it is `spared`.
///
/// # Panics
/// When the run fails before.
#[must_use]
pub fn stopped_within_a_step<const D: usize>(
    model: &Model,
    after: usize,
    spared: usize,
) -> Stopped<D>
where
    Dimension<D>: Solve<D>,
{
    stop(model, None, after, spared)
}

/// The state of a run after some steps, through the text it is written as.
///
/// # Panics
/// When the run fails before, or the text is not the state.
#[must_use]
pub fn stopped<const D: usize>(model: &Model, after: usize) -> SavedState<D>
where
    Dimension<D>: Solve<D>,
{
    let saved = stop(model, None, after, 0).state.expect("there is a state");
    let text = serde_json::to_string(&saved).expect("it is written");
    let read: SavedState<D> = serde_json::from_str(&text).expect("it is read");
    assert!(read == saved, "not a bit is lost");
    read
}

/// The state of a run that resumed from another state, once it has made so many steps in all.
///
/// # Panics
/// When the run fails before, or is beyond them.
#[must_use]
pub fn stopped_again<const D: usize>(
    model: &Model,
    from: &SavedState<D>,
    after: usize,
) -> SavedState<D>
where
    Dimension<D>: Solve<D>,
{
    // The step it resumes from is not reported again
    let more = after.checked_sub(from.step() + 1).expect("a later step");
    stop(model, Some(from), more, 0).state.expect("there is a state")
}

/// Resumes from a state.
///
/// # Errors
/// Those of [`simulate_from`].
pub fn resumed<const D: usize>(model: &Model, state: &SavedState<D>) -> Result<RunSummary, RunError>
where
    Dimension<D>: Solve<D>,
{
    simulate_from(model, Some(state), &mut [])
}
