//! A request to end that is heard within long work: set for a thread, looked at in loops, by helpers of it too.

use std::cell::{Cell, RefCell};
use std::fmt;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use thiserror::Error;

/// Says whether work is to end.
pub type Request = Arc<dyn Fn() -> bool + Send + Sync>;

/// Looks from which the request itself is asked once: a look is to cost next to nothing.
const ASK_EVERY: u32 = 64;
/// How often the request is asked while work that cannot look itself goes on.
const WAIT: Duration = Duration::from_millis(20);

thread_local! {
    /// Who listens on this thread.
    static LISTENER: RefCell<Listener> = const { RefCell::new(Listener { asked: None }) };
    /// Looks so far.
    static LOOKS: Cell<u32> = const { Cell::new(0) };
}

/// Work was asked to end before it was done.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("it was asked to end")]
pub struct Stopped;

/// What work that hears a request came to.
#[derive(Debug)]
pub struct Heard<R> {
    /// What it handed back.
    pub result: R,
    /// Whether it was ended on the way.
    pub was_ended: bool,
}

/// Does work on this thread that ends early, where it looks, once a request is made: this one, or that of work which
/// this is a part of.
pub fn hearing<R>(request: Request, work: impl FnOnce() -> R) -> Heard<R> {
    let whole = Listener::here().asked;
    let asked = Asked { request, whole, is_made: AtomicBool::new(false) };
    let listener = Listener { asked: Some(Arc::new(asked)) };
    let _before = Before(LISTENER.replace(listener.clone()));
    let result = work();
    Heard { result, was_ended: listener.was_ended() }
}

/// Who listened before, who listens again however the work ends.
struct Before(Listener);

impl Drop for Before {
    fn drop(&mut self) {
        LISTENER.replace(std::mem::take(&mut self.0));
    }
}

/// A request, and whether it was found to be made.
struct Asked {
    request: Request,
    /// That of the work which this is a part of.
    whole: Option<Arc<Asked>>,
    is_made: AtomicBool,
}

/// Who looks whether work is to end; whoever helps with the work, on whichever thread, takes a clone along.
#[derive(Clone, Default)]
pub struct Listener {
    /// None where nobody asks.
    asked: Option<Arc<Asked>>,
}

impl fmt::Debug for Listener {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Listener").field("was_ended", &self.was_ended()).finish()
    }
}

impl Listener {
    /// The listener of this thread.
    #[must_use]
    pub fn here() -> Self {
        LISTENER.with_borrow(Self::clone)
    }

    /// Does work on this thread that the listener looks for: part of what goes on elsewhere.
    pub fn along<R>(&self, work: impl FnOnce() -> R) -> R {
        let _before = Before(LISTENER.replace(self.clone()));
        work()
    }

    /// Whether work is to end, in a loop of short rounds: then what it has so far may be left as it is.
    #[must_use]
    pub fn is_requested(&self) -> bool {
        let Some(asked) = &self.asked else { return false };
        if asked.is_made.load(Ordering::Relaxed) {
            return true;
        }
        let looks = LOOKS.get().wrapping_add(1);
        LOOKS.set(looks);
        looks.is_multiple_of(ASK_EVERY) && asked.ask()
    }

    /// The same before a long part of work: the request is asked at once.
    ///
    /// # Errors
    /// Where the work is to end.
    pub fn check(&self) -> Result<(), Stopped> {
        if self.asked.as_ref().is_some_and(|asked| asked.ask()) { Err(Stopped) } else { Ok(()) }
    }

    /// Whether a look has found that the work is to end, so that something may be left as it was.
    #[must_use]
    pub fn was_ended(&self) -> bool {
        self.asked.as_ref().is_some_and(|asked| asked.is_made.load(Ordering::Relaxed))
    }
}

impl Asked {
    fn ask(&self) -> bool {
        let is_made = self.is_made.load(Ordering::Relaxed)
            || (self.request)()
            || self.whole.as_ref().is_some_and(|whole| whole.ask());
        if is_made {
            self.is_made.store(true, Ordering::Relaxed);
        }
        is_made
    }
}

/// [`Listener::is_requested`] on this thread.
#[must_use]
pub fn is_requested() -> bool {
    LISTENER.with_borrow(Listener::is_requested)
}

/// [`Listener::check`] on this thread.
///
/// # Errors
/// Where work is to end.
pub fn check() -> Result<(), Stopped> {
    LISTENER.with_borrow(Listener::check)
}

/// Says before results are used whether a look has found that the work is to end: then some of it may have been left
/// as it was.
///
/// # Errors
/// Where it was ended.
pub fn check_whole() -> Result<(), Stopped> {
    if LISTENER.with_borrow(Listener::was_ended) { Err(Stopped) } else { Ok(()) }
}

/// Does long work of a library that cannot look. Where it is to end, it is left to a thread of its own, which ends
/// with the process or when it is done; what it takes is its own.
///
/// # Errors
/// Where it is to end.
pub fn left_alone<R: Send + 'static>(
    work: impl FnOnce() -> R + Send + 'static,
) -> Result<R, Stopped> {
    let listener = Listener::here();
    if listener.asked.is_none() {
        return Ok(work());
    }
    listener.check()?;
    let work = Arc::new(Mutex::new(Some(work)));
    let (done, wait) = sync_channel(1);
    let taken = Arc::clone(&work);
    let helper = thread::Builder::new().spawn(move || {
        let work = taken.lock().unwrap_or_else(PoisonError::into_inner).take();
        // Nobody waits any more where the work was to end
        let _ = done.send(work.map(|work| work()));
    });
    let Ok(helper) = helper else {
        // No thread is to be had
        let work = work.lock().unwrap_or_else(PoisonError::into_inner).take();
        return work.map(|work| work()).ok_or(Stopped);
    };
    loop {
        match wait.recv_timeout(WAIT) {
            Ok(result) => return result.ok_or(Stopped),
            Err(RecvTimeoutError::Timeout) => listener.check()?,
            Err(RecvTimeoutError::Disconnected) => match helper.join() {
                Err(panic) => resume_unwind(panic),
                Ok(()) => return Err(Stopped),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicUsize;
    use std::time::Instant;

    use super::*;

    /// A request that is made from the `n`-th question on.
    fn made_at(n: usize) -> Request {
        let asked = AtomicUsize::new(0);
        Arc::new(move || asked.fetch_add(1, Ordering::Relaxed) + 1 >= n)
    }

    #[test]
    fn a_request_is_found_on_the_threads_that_help() {
        let heard = hearing(made_at(2), || {
            assert_eq!(check(), Ok(()));
            let listener = Listener::here();
            let helper = thread::spawn(move || listener.check());
            assert_eq!(helper.join().expect("no panic"), Err(Stopped));
            // It stays made
            is_requested()
        });
        assert!(heard.result && heard.was_ended);
    }

    #[test]
    fn what_was_asked_of_one_work_is_no_matter_of_the_next() {
        let outer = hearing(made_at(usize::MAX), || {
            let inner = hearing(made_at(1), check);
            assert!(inner.was_ended && inner.result == Err(Stopped));
            check()
        });
        assert!(!outer.was_ended && outer.result == Ok(()));
        assert!(check().is_ok() && !is_requested());
    }

    #[test]
    fn what_goes_on_elsewhere_is_part_of_the_work() {
        let heard = hearing(made_at(1), || {
            let listener = Listener::here();
            let elsewhere = thread::spawn(move || (check_whole(), listener.along(check), check()));
            assert_eq!(elsewhere.join().expect("no panic"), (Ok(()), Err(Stopped), Ok(())));
            check_whole()
        });
        assert!(heard.was_ended && heard.result == Err(Stopped));
        assert_eq!(check_whole(), Ok(()));
    }

    #[test]
    fn a_part_ends_with_the_whole() {
        let outer = hearing(made_at(2), || {
            let inner = hearing(made_at(usize::MAX), || [check(), check()]);
            assert!(inner.was_ended);
            inner.result
        });
        assert!(outer.was_ended);
        assert_eq!(outer.result, [Ok(()), Err(Stopped)]);
    }

    #[test]
    fn looks_in_short_rounds_ask_now_and_then() {
        let heard = hearing(made_at(3), || (0..1000).take_while(|_| !is_requested()).count());
        let least = 2 * ASK_EVERY as usize;
        assert!((least..least + ASK_EVERY as usize).contains(&heard.result), "{}", heard.result);
    }

    #[test]
    fn a_library_that_cannot_look_is_left_alone() {
        let started = Instant::now();
        let heard = hearing(made_at(3), || {
            left_alone(|| {
                thread::sleep(Duration::from_secs(20));
                1
            })
        });
        assert!(heard.was_ended && heard.result == Err(Stopped));
        assert!(started.elapsed() < Duration::from_secs(10), "{:?}", started.elapsed());
        let done = hearing(made_at(usize::MAX), || left_alone(|| 7));
        assert!(!done.was_ended && done.result == Ok(7));
        assert_eq!(left_alone(|| 7), Ok(7));
    }
}
