//! `*.state`: a state on the disk, with a checksum by which damage is found.
//!
//! A header of 32 bytes, then the state in the format of postcard, compressed by Zstandard:
//!
//! | Bytes | What |
//! |---|---|
//! | 16 | `alewife state`, padded with zeros |
//! | 4 | version, little-endian |
//! | 4 | CRC-32 (ISO 3309) of what follows the header |
//! | 8 | its length, little-endian |

use std::io;
use std::path::Path;

use crate::observer::system::{AtPath, write_atomic};
use crate::run::{STATE_VERSION, SavedState};

/// How such a file begins.
const MAGIC: [u8; 16] = *b"alewife state\0\0\0";
/// Length of the header (bytes).
const HEADER: usize = 32;
/// Compression of Zstandard: its fastest. Numbers compress by a tenth at any level, indices by two thirds.
const LEVEL: i32 = 1;
/// Length beyond which a state is taken for damaged before memory is asked for it (bytes).
const MOST_BYTES: usize = 1 << 40;

/// Writes a state to a file that is seen whole or not at all; its size (bytes).
///
/// # Errors
/// When the file system refuses.
pub fn write_state<const D: usize>(path: &Path, state: &SavedState<D>) -> io::Result<usize> {
    let bytes = content(state)?;
    write_atomic(path, &bytes)?;
    Ok(bytes.len())
}

/// The size of a file with a state (bytes).
///
/// # Errors
/// When it cannot be encoded.
pub fn state_size<const D: usize>(state: &SavedState<D>) -> io::Result<usize> {
    Ok(content(state)?.len())
}

/// All bytes of a file with a state.
fn content<const D: usize>(state: &SavedState<D>) -> io::Result<Vec<u8>> {
    let numbers = postcard::to_stdvec(state).map_err(io::Error::other)?;
    let content = zstd::bulk::compress(&numbers, LEVEL)?;
    let mut bytes = Vec::with_capacity(HEADER + content.len());
    bytes.extend(MAGIC);
    bytes.extend(STATE_VERSION.to_le_bytes());
    bytes.extend(crc32fast::hash(&content).to_le_bytes());
    bytes.extend((content.len() as u64).to_le_bytes());
    bytes.extend(content);
    Ok(bytes)
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
    let damaged = |reason: &str| io::Error::new(io::ErrorKind::InvalidData, reason.to_owned());
    let (header, content) = bytes
        .split_at_checked(HEADER)
        .filter(|(header, _)| header.starts_with(&MAGIC))
        .ok_or_else(|| damaged("this is no state of a run"))?;
    let number = |from: usize| u32::from_le_bytes([0, 1, 2, 3].map(|byte| header[from + byte]));
    let (version, checksum) = (number(16), number(20));
    let length = u64::from(number(24)) | u64::from(number(28)) << 32;
    if version != STATE_VERSION {
        return Err(damaged(&of_another_version(version)));
    }
    if length != content.len() as u64 || crc32fast::hash(content) != checksum {
        return Err(damaged("its checksum is not that of its content: it is damaged"));
    }
    let size = zstd::zstd_safe::get_frame_content_size(content).ok().flatten();
    let size = size.and_then(|size| usize::try_from(size).ok()).filter(|&size| size < MOST_BYTES);
    let size = size.ok_or_else(|| damaged("it does not say its length: it is damaged"))?;
    let numbers = zstd::bulk::decompress(content, size)?;
    postcard::from_bytes(&numbers).map_err(|error| damaged(&format!("this is no state: {error}")))
}

/// Which program reads a state of a version that this one does not read.
fn of_another_version(version: u32) -> String {
    let this = env!("CARGO_PKG_VERSION");
    let which = if version > STATE_VERSION {
        format!("a newer alewife than this one, {this}, wrote it and reads it")
    } else {
        format!("an older alewife than this one, {this}, wrote it and reads it")
    };
    format!(
        "this is a state of version {version}, and version {STATE_VERSION} is read here: {which}; \
         `provenance.json` of its run has the one that did (`alewife`, `git`)"
    )
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;
    use std::rc::Rc;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, Ordering};

    use super::*;
    use crate::case::Model;
    use crate::run::{LastState, Observer, RunError, Snapshot, simulate};
    use crate::step::StopRequest;

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
        let path = place.path().join("last.state");
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
