//! `WallLimit`: a run that is to end before its time on the clock is over, with a checkpoint.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant, SystemTime};

use super::exit::{Exit, Failure};
use crate::case::WallTime;
use crate::simulation::{Observer, Snapshot, StopRequest};

/// What writing the last state may take (s), beside twice the longest step so far.
const WRITING: f64 = 10.0;

/// Asks for the end of a run when one more step might not fit.
#[derive(Debug)]
pub struct WallLimit {
    end: Instant,
    last: Instant,
    /// Longest time between two steps so far (microseconds).
    longest: Arc<AtomicU64>,
}

impl WallLimit {
    /// The limit that is asked for, or else that of the batch job, if there is one.
    ///
    /// # Errors
    /// When what is asked for is no time.
    pub fn new(asked: Option<&str>) -> Result<Option<Self>, Failure> {
        let (now, end) = (Instant::now(), Self::end(asked)?);
        Ok(end.map(|end| Self { end, last: now, longest: Arc::new(AtomicU64::new(0)) }))
    }

    /// When the time that is asked for is over, or else that of the batch job, if there is one.
    ///
    /// # Errors
    /// When what is asked for is no time.
    pub fn end(asked: Option<&str>) -> Result<Option<Instant>, Failure> {
        let wrong = |reason| Failure::new(Exit::Usage, format!("--max-walltime: {reason}"));
        let asked: Option<WallTime> = asked.map(str::parse).transpose().map_err(wrong)?;
        let now = Instant::now();
        let left = asked.map(WallTime::duration).or_else(left_of_job);
        Ok(left.and_then(|left| now.checked_add(left)))
    }
}

/// What is left to a job of Slurm.
fn left_of_job() -> Option<Duration> {
    let end: u64 = std::env::var("SLURM_JOB_END_TIME").ok()?.parse().ok()?;
    let end = SystemTime::UNIX_EPOCH + Duration::from_secs(end);
    Some(end.duration_since(SystemTime::now()).unwrap_or_default())
}

/// Time to keep for one more step and the state after it.
fn margin(longest: &AtomicU64) -> Duration {
    let longest = Duration::from_micros(longest.load(Ordering::Relaxed));
    2 * longest + Duration::from_secs_f64(WRITING)
}

impl<const D: usize> Observer<D> for WallLimit {
    fn on_step(&mut self, _snapshot: &Snapshot<'_, D>) -> std::io::Result<()> {
        let micros = u64::try_from(self.last.elapsed().as_micros()).unwrap_or(u64::MAX);
        self.longest.fetch_max(micros, Ordering::Relaxed);
        self.last = Instant::now();
        Ok(())
    }

    fn stop_request(&self) -> Option<StopRequest> {
        let (end, longest) = (self.end, Arc::clone(&self.longest));
        Some(Arc::new(move || Instant::now() + margin(&longest) >= end))
    }
}
