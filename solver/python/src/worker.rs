//! `Worker`: a session in threads of its own, which does one job after the other.
//!
//! A session stays where it was opened, since not all of it may go from thread to thread. Who asks for a job waits
//! without the lock of the interpreter, so that other threads of Python go on, and hears interrupts.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use alewife::run::{RunError, SavedState, Session};
use alewife::runner::{Failure, SessionPlan, session};
use alewife_interrupt::hearing;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::SessionError;

/// How often an interrupt is looked for.
const LOOK: Duration = Duration::from_millis(50);

/// Stack of a thread (bytes): what a main thread has.
const STACK: usize = 8 << 20;

/// A session in the plane or in space.
pub enum AnySession {
    /// Planar or axisymmetric.
    Plane(Session<2>),
    /// In three dimensions.
    Space(Session<3>),
}

/// A state in the plane or in space.
pub enum AnyState {
    /// Planar or axisymmetric.
    Plane(SavedState<2>),
    /// In three dimensions.
    Space(SavedState<3>),
}

/// Does the same with a session of either dimension.
#[macro_export]
macro_rules! either {
    ($any:expr, $session:ident => $work:expr) => {
        match $any {
            $crate::worker::AnySession::Plane($session) => $work,
            $crate::worker::AnySession::Space($session) => $work,
        }
    };
}

type Job<T> = Box<dyn FnOnce(&mut Option<T>) + Send>;

/// A session, or something else that stays where it was opened, in threads of its own.
pub struct Worker<T> {
    jobs: Mutex<Sender<Job<T>>>,
    /// Whether it is to stop at its next step.
    stop: Arc<AtomicBool>,
    threads: usize,
    _pool: ThreadPool,
}

/// The error of Python that a failure is.
pub fn failed(failure: &Failure) -> PyErr {
    SessionError::new_err((failure.message.clone(), failure.exit as i32))
}

impl Worker<AnySession> {
    /// Opens a session in this many threads.
    pub fn open(py: Python<'_>, plan: SessionPlan) -> PyResult<Self> {
        let worker = Self::start(plan.threads)?;
        let stop = Arc::clone(&worker.stop);
        worker.work(py, move |own| {
            // An interrupt is heard while it is meshed, too
            let opened = hearing(Stopped::by(&stop), || {
                Ok::<_, Failure>(match plan.file.case().geometry.dimensions() {
                    2 => AnySession::Plane(session::<2>(&plan)?),
                    _ => AnySession::Space(session::<3>(&plan)?),
                })
            });
            *own = Some(opened.result?.stopped_by(&stop));
            Ok(())
        })?;
        Ok(worker)
    }

    /// A session at the state of this one.
    pub fn fork(&self, py: Python<'_>) -> PyResult<Self> {
        let (give, take) = channel();
        self.with(py, move |session| {
            let model = either!(&*session, one => one.model().clone());
            let _ = give.send((model, AnyState::of(session)?));
            Ok(())
        })?;
        let (model, state) = take.recv().map_err(|_| ended())?;
        let worker = Self::start(self.threads)?;
        let stop = Arc::clone(&worker.stop);
        worker.work(py, move |own| {
            let session = match &state {
                AnyState::Plane(state) => {
                    AnySession::Plane(Session::resume(&model, state, Vec::new())?)
                }
                AnyState::Space(state) => {
                    AnySession::Space(Session::resume(&model, state, Vec::new())?)
                }
            };
            *own = Some(session.stopped_by(&stop));
            Ok(())
        })?;
        Ok(worker)
    }
}

impl<T: 'static> Worker<T> {
    /// What asks it to stop at its next step.
    pub fn stop(&self) -> &Arc<AtomicBool> {
        &self.stop
    }

    /// One that has nothing yet, in this many threads.
    pub fn start(threads: usize) -> PyResult<Self> {
        let pool = ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK).build();
        let pool = pool.map_err(|error| SessionError::new_err((error.to_string(), 70)))?;
        let (jobs, to_do): (Sender<Job<T>>, Receiver<Job<T>>) = channel();
        // What is done in parallel begins on one of its threads
        pool.spawn(move || {
            let mut session = None;
            for job in to_do {
                job(&mut session);
            }
        });
        let stop = Arc::new(AtomicBool::new(false));
        Ok(Self { jobs: Mutex::new(jobs), stop, threads, _pool: pool })
    }

    /// Does a job with the session.
    pub fn with<R: Send + 'static>(
        &self,
        py: Python<'_>,
        job: impl FnOnce(&mut T) -> Result<R, RunError> + Send + 'static,
    ) -> PyResult<R> {
        self.with_it(py, |own| job(own).map_err(Failure::from))
    }

    /// Does a job that fails in another way with it.
    pub fn with_it<R: Send + 'static>(
        &self,
        py: Python<'_>,
        job: impl FnOnce(&mut T) -> Result<R, Failure> + Send + 'static,
    ) -> PyResult<R> {
        self.work(py, |own| match own {
            Some(session) => job(session),
            None => Err(RunError::Session("this session is closed".to_owned()).into()),
        })
    }

    /// Does a job with the session, if it is open.
    pub fn work<R: Send + 'static>(
        &self,
        py: Python<'_>,
        job: impl FnOnce(&mut Option<T>) -> Result<R, Failure> + Send + 'static,
    ) -> PyResult<R> {
        self.stop.store(false, Ordering::Relaxed);
        let (give, take) = channel();
        let job: Job<T> = Box::new(move |own| {
            // A bug must not end the interpreter
            if let Ok(result) = catch_unwind(AssertUnwindSafe(|| job(own))) {
                let _ = give.send(result);
            } else {
                *own = None;
            }
        });
        let jobs = self.jobs.lock().unwrap_or_else(PoisonError::into_inner).clone();
        jobs.send(job).map_err(|_| ended())?;
        let mut interrupt = None;
        let take = Mutex::new(take);
        loop {
            let waited = py
                .detach(|| take.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(LOOK));
            match (waited, &interrupt) {
                (Err(RecvTimeoutError::Disconnected), _) => return Err(ended()),
                (Err(RecvTimeoutError::Timeout), _) => {
                    if let Err(error) = py.check_signals() {
                        self.stop.store(true, Ordering::Relaxed);
                        interrupt = Some(error);
                    }
                }
                (Ok(_), Some(_)) => break,
                (Ok(result), None) => return result.map_err(|failure| failed(&failure)),
            }
        }
        Err(interrupt.unwrap_or_else(ended))
    }
}

/// What asks for a stop at the next step.
pub struct Stopped;

impl Stopped {
    /// A request by a flag.
    pub fn by(stop: &Arc<AtomicBool>) -> Arc<dyn Fn() -> bool + Send + Sync> {
        let stop = Arc::clone(stop);
        Arc::new(move || stop.load(Ordering::Relaxed))
    }
}

fn ended() -> PyErr {
    SessionError::new_err(("this session has ended by a bug in the program", 70))
}

impl AnySession {
    fn stopped_by(mut self, stop: &Arc<AtomicBool>) -> Self {
        either!(&mut self, session => session.stop_when(Stopped::by(stop)));
        self
    }
}

impl AnyState {
    /// That of a session.
    pub fn of(session: &AnySession) -> Result<Self, RunError> {
        Ok(match session {
            AnySession::Plane(session) => Self::Plane(session.save()?),
            AnySession::Space(session) => Self::Space(session.save()?),
        })
    }
}
