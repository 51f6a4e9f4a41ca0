//! Runs that are stopped on the way.

use std::sync::{Arc, Mutex};

use alewife_core::case::Model;
use alewife_core::simulation::{LastState, Observer, RunError, SavedState, Snapshot, simulate};

/// Stops a run after some steps and keeps the state it leaves.
struct Stopper {
    after: usize,
    steps: usize,
    left: Arc<Mutex<Option<SavedState<2>>>>,
}

impl Observer<2> for Stopper {
    fn on_step(&mut self, snapshot: &Snapshot<'_, 2>) -> std::io::Result<()> {
        self.steps = snapshot.step;
        Ok(())
    }

    fn wants_stop(&self) -> bool {
        self.steps >= self.after
    }

    fn on_failure(
        &mut self,
        _error: &RunError,
        remains: Option<&LastState<'_, 2>>,
    ) -> std::io::Result<()> {
        *self.left.lock().expect("nobody else holds it") =
            remains.and_then(|remains| remains.saved.cloned());
        Ok(())
    }
}

/// The state of a run after some steps, through the text it is written as.
///
/// # Panics
/// When the run fails before, or the text is not the state.
#[must_use]
pub fn stopped(model: &Model, after: usize) -> SavedState<2> {
    let left = Arc::new(Mutex::new(None));
    let stopper = Stopper { after, steps: 0, left: Arc::clone(&left) };
    let error = simulate(model, &mut [Box::new(stopper)]).expect_err("it is stopped");
    assert!(matches!(error, RunError::Stopped { .. }), "{error}");
    let saved = left.lock().expect("the run is over").take().expect("there is a state");
    let text = serde_json::to_string(&saved).expect("it is written");
    let read: SavedState<2> = serde_json::from_str(&text).expect("it is read");
    assert!(read == saved, "not a bit is lost");
    read
}
