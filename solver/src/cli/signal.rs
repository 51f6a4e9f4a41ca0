//! Signals that end a run after its present step: Ctrl-C, SIGTERM and SIGUSR1.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use signal_hook::consts::{SIGINT, SIGTERM, SIGUSR1};
use signal_hook::flag;

use crate::simulation::{Observer, Snapshot};

/// Asks for the end of a run once a signal has come.
#[derive(Debug)]
pub struct SignalWatch {
    has_come: Arc<AtomicBool>,
}

impl SignalWatch {
    /// Watches from now on. A second Ctrl-C or SIGTERM ends the program at once.
    ///
    /// # Errors
    /// When the system refuses.
    pub fn start() -> io::Result<Self> {
        let has_come = Arc::new(AtomicBool::new(false));
        for signal in [SIGINT, SIGTERM] {
            // In this order: the first signal finds the flag down and only raises it.
            flag::register_conditional_shutdown(signal, 128 + signal, Arc::clone(&has_come))?;
            flag::register(signal, Arc::clone(&has_come))?;
        }
        flag::register(SIGUSR1, Arc::clone(&has_come))?;
        Ok(Self { has_come })
    }
}

impl Observer<2> for SignalWatch {
    fn on_step(&mut self, _snapshot: &Snapshot<'_, 2>) -> io::Result<()> {
        Ok(())
    }

    fn wants_stop(&self) -> bool {
        self.has_come.load(Ordering::Relaxed)
    }
}
