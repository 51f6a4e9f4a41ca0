//! Signals that end a run before its next step, or a command on its way: Ctrl-C, SIGTERM, SIGHUP, SIGXCPU and SIGUSR1.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use alewife_interrupt::{Request, hearing};
use signal_hook::consts::{SIGABRT, SIGHUP, SIGINT, SIGTERM, SIGUSR1, SIGXCPU, SIGXFSZ};
use signal_hook::flag;

use super::failure::{Exit, Failure};
use crate::observer::print_line;
use crate::run::{Observer, Snapshot};
use crate::step::StopRequest;

/// How often it is looked whether a first signal has come.
const LOOK_EVERY: Duration = Duration::from_millis(100);
/// Signals within this time are one.
const TOGETHER: Duration = Duration::from_millis(500);
/// How long a command may take to end where it looks whether it is asked to.
const PATIENCE: Duration = Duration::from_millis(1200);

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

    /// What is asked whether a signal has come.
    pub fn request(&self) -> Request {
        let has_come = Arc::clone(&self.has_come);
        Arc::new(move || has_come.load(Ordering::Relaxed))
    }

    /// Ends the program some time after a signal where work is not done then, with what there is to say.
    fn end_late(&self, is_done: &Arc<AtomicBool>, message: String) {
        let (watch, is_done) = (self.clone(), Arc::clone(is_done));
        std::thread::spawn(move || {
            while !watch.has_come() {
                std::thread::sleep(LOOK_EVERY);
            }
            std::thread::sleep(PATIENCE);
            if !is_done.load(Ordering::Relaxed) {
                print_line(&message);
                std::process::exit(i32::from(Exit::Stopped as u8));
            }
        });
    }
}

/// Does the work of a command that a signal ends: where the work looks whether it is to end, and where it does not
/// look for long, with the program. Files of such work are written whole or line by line. `left` says what is left.
///
/// # Errors
/// Those of the work, and `Exit::Stopped` where a signal ended it.
pub fn ended_by_signal<R>(
    left: &str,
    work: impl FnOnce() -> Result<R, Failure>,
) -> Result<R, Failure> {
    let watch = SignalWatch::start()?;
    let message = format!("stopped by a signal; {left}");
    let is_done = Arc::new(AtomicBool::new(false));
    watch.end_late(&is_done, message.clone());
    let heard = hearing(watch.request(), work);
    is_done.store(true, Ordering::Relaxed);
    match heard.result {
        Err(_) if heard.was_ended => Err(Failure { exit: Exit::Stopped, message }),
        result => result,
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
        Some(self.request())
    }
}
