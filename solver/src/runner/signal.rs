//! Signals that end a run before its next step: Ctrl-C, SIGTERM, SIGHUP, SIGXCPU and SIGUSR1.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use signal_hook::consts::{SIGABRT, SIGHUP, SIGINT, SIGTERM, SIGUSR1, SIGXCPU, SIGXFSZ};
use signal_hook::flag;

use super::failure::Exit;
use crate::run::{Observer, Snapshot};
use crate::step::StopRequest;

/// How often it is looked whether a first signal has come.
const LOOK_EVERY: Duration = Duration::from_millis(100);
/// Signals within this time are one.
const TOGETHER: Duration = Duration::from_millis(500);

/// Asks for the end of a run once a signal has come.
#[derive(Debug, Clone)]
pub struct SignalWatch {
    has_come: Arc<AtomicBool>,
}

impl SignalWatch {
    /// Watches from now on. A second Ctrl-C, SIGTERM or SIGHUP ends the program at once, unless it comes
    /// together with the first: some programs signal a process and then its whole group.
    ///
    /// # Errors
    /// When the system refuses.
    pub fn start() -> io::Result<Self> {
        let (has_come, is_past) =
            (Arc::new(AtomicBool::new(false)), Arc::new(AtomicBool::new(false)));
        for signal in [SIGINT, SIGTERM, SIGHUP] {
            flag::register_conditional_shutdown(signal, 128 + signal, Arc::clone(&is_past))?;
            flag::register(signal, Arc::clone(&has_come))?;
        }
        for signal in [SIGUSR1, SIGXCPU] {
            flag::register(signal, Arc::clone(&has_come))?;
        }
        let first = Arc::clone(&has_come);
        std::thread::spawn(move || {
            while !first.load(Ordering::Relaxed) {
                std::thread::sleep(LOOK_EVERY);
            }
            std::thread::sleep(TOGETHER);
            is_past.store(true, Ordering::Relaxed);
        });
        Ok(Self { has_come })
    }

    /// Whether a signal has come.
    pub fn has_come(&self) -> bool {
        self.has_come.load(Ordering::Relaxed)
    }
}

/// Makes a file that grows beyond what the system allows an error of that file: the signal that comes
/// with it would end the program.
///
/// # Errors
/// When the system refuses.
pub fn outlive_file_size_limit() -> io::Result<()> {
    flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false))).map(drop)
}

/// Gives the end for want of memory a code of its own: there nothing can be handed back, and the process is aborted.
///
/// # Errors
/// When the system refuses.
pub fn end_aborted_with(exit: Exit) -> io::Result<()> {
    let is_set = Arc::new(AtomicBool::new(true));
    flag::register_conditional_shutdown(SIGABRT, i32::from(exit as u8), is_set).map(drop)
}

impl<const D: usize> Observer<D> for SignalWatch {
    fn on_step(&mut self, _snapshot: &Snapshot<'_, D>) -> io::Result<()> {
        Ok(())
    }

    fn stop_request(&self) -> Option<StopRequest> {
        let has_come = Arc::clone(&self.has_come);
        Some(Arc::new(move || has_come.load(Ordering::Relaxed)))
    }
}
