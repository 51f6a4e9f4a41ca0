//! `WallLimit`: a run that is to end before its time on the clock is over, with a checkpoint.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant, SystemTime};

use crate::case::WallTime;
use crate::observer::WriteTimes;
use crate::run::{Observer, Snapshot};
use crate::step::StopRequest;

/// Steps of which the longest is expected once more: every few of them end with a remeshing.
const RECENT: usize = 20;
/// Time kept for a step, in steps of that length: the next one may be longer.
const STEPS: f64 = 1.5;
/// Time kept for the last state, in the longest time one took: the disk may be busier.
const WRITES: u32 = 2;
/// Time kept beside it, for the other files and the end of the process.
const CLOSING: Duration = Duration::from_secs(2);
/// Time kept for all of that as long as no state was written.
const UNKNOWN: Duration = Duration::from_secs(10);

/// Asks for the end of a run when one more step might not fit.
#[derive(Debug)]
pub struct WallLimit {
    end: Instant,
    pace: Arc<Mutex<Pace>>,
    writes: WriteTimes,
    has_asked: Arc<AtomicBool>,
}

/// The latest steps of a run.
#[derive(Debug)]
struct Pace {
    latest: VecDeque<Duration>,
    /// When the last one ended.
    last: Instant,
}

impl Pace {
    /// One more step ends.
    fn step(&mut self, now: Instant) {
        self.latest.truncate(RECENT - 1);
        self.latest.push_front(now.saturating_duration_since(self.last));
        self.last = now;
    }

    /// The longest of the latest steps, the one under way included.
    fn longest(&self, now: Instant) -> Duration {
        let under_way = now.saturating_duration_since(self.last);
        self.latest.iter().copied().max().unwrap_or_default().max(under_way)
    }
}

/// Time to keep for one more step and the state after it.
fn margin(step: Duration, write: Option<Duration>) -> Duration {
    let ending =
        write.map_or(UNKNOWN, |write| write.saturating_mul(WRITES).saturating_add(CLOSING));
    step.mul_f64(STEPS).saturating_add(ending)
}

impl WallLimit {
    /// The limit that is asked for, or else that of the batch job, if there is one.
    #[must_use]
    pub fn new(asked: Option<WallTime>) -> Option<Self> {
        let pace = Pace { latest: VecDeque::new(), last: Instant::now() };
        let pace = Arc::new(Mutex::new(pace));
        let (writes, has_asked) = (WriteTimes::default(), Arc::default());
        Self::end(asked).map(|end| Self { end, pace, writes, has_asked })
    }

    /// Whether it has asked for the end of its run, for who looks afterwards.
    #[must_use]
    pub fn has_asked(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.has_asked)
    }

    /// When the time that is asked for is over, or else that of the batch job, if there is one.
    #[must_use]
    pub fn end(asked: Option<WallTime>) -> Option<Instant> {
        let end_of_job =
            || std::env::var("SLURM_JOB_END_TIME").ok().and_then(|end| end.parse::<u64>().ok());
        let left = asked.map(WallTime::duration);
        let left = left.or_else(|| end_of_job().map(|end| left_until(end, SystemTime::now())));
        // From here on the clock on the wall may be set as anybody likes
        let now = Instant::now();
        left.and_then(|left| now.checked_add(left))
    }

    /// The same, which learns from what states take to write.
    #[must_use]
    pub fn learning_from(self, writes: &WriteTimes) -> Self {
        Self { writes: writes.clone(), ..self }
    }
}

/// What is left until a time in seconds since 1970; nothing after it.
fn left_until(end: u64, now: SystemTime) -> Duration {
    let end = SystemTime::UNIX_EPOCH.checked_add(Duration::from_secs(end));
    end.and_then(|end| end.duration_since(now).ok()).unwrap_or_default()
}

fn lock(pace: &Mutex<Pace>) -> MutexGuard<'_, Pace> {
    pace.lock().unwrap_or_else(PoisonError::into_inner)
}

impl<const D: usize> Observer<D> for WallLimit {
    fn on_step(&mut self, _snapshot: &Snapshot<'_, D>) -> std::io::Result<()> {
        lock(&self.pace).step(Instant::now());
        Ok(())
    }

    fn stop_request(&self) -> Option<StopRequest> {
        let (end, pace, writes) = (self.end, Arc::clone(&self.pace), self.writes.clone());
        let has_asked = self.has_asked();
        Some(Arc::new(move || {
            let now = Instant::now();
            let longest = lock(&pace).longest(now);
            let is_over = end.saturating_duration_since(now) <= margin(longest, writes.longest());
            has_asked.fetch_or(is_over, Ordering::Relaxed);
            is_over
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn seconds(seconds: u64) -> Duration {
        Duration::from_secs(seconds)
    }

    #[test]
    fn the_margin_is_learnt_from_steps_and_states() {
        assert_eq!(margin(seconds(4), None), seconds(6 + 10));
        assert_eq!(margin(seconds(4), Some(Duration::ZERO)), seconds(6 + 2));
        assert_eq!(margin(seconds(4), Some(seconds(30))), seconds(6 + 60 + 2));
        assert!(margin(seconds(4), Some(Duration::MAX)) > seconds(1 << 40));
    }

    #[test]
    fn a_long_step_is_expected_again_for_twenty_steps() {
        let start = Instant::now();
        let mut pace = Pace { latest: VecDeque::new(), last: start };
        let mut now = start + seconds(50);
        pace.step(now);
        for others in 1..=RECENT {
            now += seconds(3);
            pace.step(now);
            let expected = if others < RECENT { 50 } else { 3 };
            assert_eq!(pace.longest(now), seconds(expected), "after {others} others");
        }
        // One under way that takes longer than all before
        assert_eq!(pace.longest(now + seconds(7)), seconds(7));
        assert_eq!(pace.latest.len(), RECENT);
    }

    /// A limit is a time from now on by a clock that only goes forwards, whatever the one on the wall shows.
    #[test]
    fn the_end_of_a_job_is_read_once_and_never_before_now() {
        let at = |time: u64| SystemTime::UNIX_EPOCH + seconds(time);
        assert_eq!(left_until(1000, at(400)), seconds(600));
        assert_eq!(left_until(1000, at(1400)), Duration::ZERO);
        let now = Instant::now();
        let mut pace = Pace { latest: VecDeque::new(), last: now + seconds(60) };
        pace.step(now);
        assert_eq!(pace.longest(now), Duration::ZERO, "no time is negative");
    }
}
