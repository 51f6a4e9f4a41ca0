//! `state.json`: a state on the disk, with a checksum by which damage is found.

use std::io;
use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;

use super::atomic::{AtPath, write_atomic};
use crate::simulation::SavedState;

/// The content of the file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Content<'a> {
    /// Checksum of the text of `state` (CRC-32 of ISO 3309).
    crc32: u32,
    #[serde(borrow)]
    state: &'a RawValue,
}

/// Writes a state to a file that is seen whole or not at all.
///
/// # Errors
/// When the file system refuses.
pub(super) fn write_state<const D: usize>(path: &Path, state: &SavedState<D>) -> io::Result<()> {
    let state = serde_json::value::to_raw_value(state)?;
    let crc32 = crc32fast::hash(state.get().as_bytes());
    write_atomic(path, &serde_json::to_vec(&Content { crc32, state: &state })?)
}

/// Reads the state in a file.
///
/// # Errors
/// When there is no such file, it holds no state, or not the one that was written.
pub fn read_state<const D: usize>(path: &Path) -> io::Result<SavedState<D>> {
    let bytes = std::fs::read(path).at(path)?;
    read_content(&bytes).at(path)
}

fn read_content<const D: usize>(bytes: &[u8]) -> io::Result<SavedState<D>> {
    let damaged = |reason: String| io::Error::new(io::ErrorKind::InvalidData, reason);
    let not_a_state = |error| damaged(format!("this is no state of a run: {error}"));
    let content: Content<'_> = serde_json::from_slice(bytes).map_err(not_a_state)?;
    if crc32fast::hash(content.state.get().as_bytes()) != content.crc32 {
        return Err(damaged("its checksum is not that of its content: it is damaged".to_owned()));
    }
    serde_json::from_str(content.state.get()).map_err(not_a_state)
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;
    use std::rc::Rc;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, Ordering};

    use super::*;
    use crate::case::Model;
    use crate::simulation::{LastState, Observer, RunError, Snapshot, StopRequest, simulate};

    /// Stops a run at once and keeps its state.
    #[derive(Default)]
    struct Stop {
        has_begun: Arc<AtomicBool>,
        state: Rc<RefCell<Option<SavedState<2>>>>,
    }

    impl Observer<2> for Stop {
        fn on_step(&mut self, _snapshot: &Snapshot<'_, 2>) -> io::Result<()> {
            self.has_begun.store(true, Ordering::Relaxed);
            Ok(())
        }

        fn stop_request(&self) -> Option<StopRequest> {
            let has_begun = Arc::clone(&self.has_begun);
            Some(Arc::new(move || has_begun.load(Ordering::Relaxed)))
        }

        fn on_failure(
            &mut self,
            _error: &RunError,
            last: Option<&LastState<'_, 2>>,
        ) -> io::Result<()> {
            *self.state.borrow_mut() = last.and_then(|last| last.saved.cloned());
            Ok(())
        }
    }

    #[test]
    fn of_a_thousand_damaged_states_none_is_read() {
        let settings = ["mesh.scale=3", "time.unsteady.end=1.0"].map(str::to_owned);
        let model: Model = crate::case::Case::read("sphere-free-fall", &settings).unwrap().model;
        let stop = Stop::default();
        let left = Rc::clone(&stop.state);
        simulate(&model, &mut [Box::new(stop)]).unwrap_err();
        let state = left.take().unwrap();
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("state.json");
        write_state(&path, &state).unwrap();
        assert!(read_state(&path).unwrap() == state, "not a bit is lost");

        let whole = std::fs::read(&path).unwrap();
        // A linear congruential generator (Knuth, MMIX): the same damage in each run
        let mut random = 1_u64;
        let mut below = |n: usize| {
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            ((random >> 33) as usize) % n
        };
        for case in 0..1000 {
            let mut bytes = whole.clone();
            match case % 10 {
                0 => bytes.truncate(below(whole.len())),
                1 => bytes[below(whole.len())..].fill(0),
                // The head of the file as often as all the rest
                2..=4 => bytes[below(40)] ^= 1 << below(8),
                _ => bytes[below(whole.len())] ^= 1 << below(8),
            }
            let read = read_content::<2>(&bytes);
            assert!(bytes == whole || read.is_err(), "damage {case} is not seen");
        }
    }
}
