//! `WriteTimes`: how long the states of a run take to write, for what has to leave time for one more.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// The longest time a state took, shared by those who write and those who plan.
#[derive(Debug, Clone, Default)]
pub struct WriteTimes {
    /// Microseconds; zero as long as none is known.
    longest: Arc<AtomicU64>,
}

impl WriteTimes {
    /// Beginning with what the earlier parts of a run took (s).
    #[must_use]
    pub fn after(earlier: Option<f64>) -> Self {
        let times = Self::default();
        if let Some(Ok(time)) = earlier.map(Duration::try_from_secs_f64) {
            times.record(time);
        }
        times
    }

    /// One state took so long.
    pub fn record(&self, time: Duration) {
        let micros = u64::try_from(time.as_micros()).unwrap_or(u64::MAX);
        self.longest.fetch_max(micros.max(1), Ordering::Relaxed);
    }

    /// The longest so far.
    #[must_use]
    pub fn longest(&self) -> Option<Duration> {
        let micros = self.longest.load(Ordering::Relaxed);
        (micros > 0).then(|| Duration::from_micros(micros))
    }
}
