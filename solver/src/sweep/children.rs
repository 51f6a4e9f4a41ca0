//! Points as child processes, several at once.

use std::collections::{BTreeMap, VecDeque};
use std::io::{self, Read};
use std::os::unix::process::ExitStatusExt;
use std::process::{Child, Command, ExitStatus};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

use rustix::process::{Pid, Signal, kill_process};

use super::failure::PointFailure;

/// How often it is looked whether the sweep is to stop.
const LOOK_EVERY: Duration = Duration::from_millis(100);
/// How long a point that another process runs is left alone.
const LEFT_ALONE: Duration = Duration::from_millis(200);
/// Code of a run that stopped and continues.
const STOPPED: u8 = 75;
/// Code of a process whose point another one has.
const IN_USE: u8 = 77;
/// How often a point is begun again whose process was killed: by chance, or for want of memory.
const MOST_KILLED: usize = 3;
/// Bytes of what a child said that are kept, the last ones.
const KEPT: usize = 4000;

/// What is to be done about a point when its turn comes.
#[derive(Debug)]
pub enum Launch {
    /// Start this.
    Start(Box<Command>),
    /// Wait: another process runs it.
    Busy,
    /// Nothing: it is finished by now.
    IsDone,
    /// Nothing: another process has found that it fails.
    HasFailed(PointFailure),
    /// Nothing, and nothing any more: time is over.
    TimeIsOver,
}

/// How the process of a point ended.
#[derive(Debug)]
pub enum Ending {
    /// Its run came to its end.
    Finished,
    /// It stopped on its way.
    Stopped,
    /// It failed.
    Failed(PointFailure),
}

/// A point that is over, and how it ended.
#[derive(Debug)]
pub struct Ended {
    /// Its index.
    pub index: usize,
    /// How it ended.
    pub ending: Ending,
}

/// Points that wait, and processes that run.
struct Queue {
    waiting: VecDeque<usize>,
    running: BTreeMap<usize, u32>,
    /// How often the process of a point was killed.
    kills: BTreeMap<usize, usize>,
    is_closed: bool,
}

struct Shared(Mutex<Queue>);

impl Shared {
    fn lock(&self) -> MutexGuard<'_, Queue> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn next(&self) -> Option<usize> {
        let mut queue = self.lock();
        if queue.is_closed { None } else { queue.waiting.pop_front() }
    }

    /// Starts a process, unless the sweep is to stop.
    fn start(&self, index: usize, command: &mut Command) -> io::Result<Option<Child>> {
        let mut queue = self.lock();
        if queue.is_closed {
            return Ok(None);
        }
        let child = command.spawn()?;
        queue.running.insert(index, child.id());
        Ok(Some(child))
    }

    /// Puts a point behind the others.
    fn again(&self, index: usize) {
        self.lock().waiting.push_back(index);
    }

    /// Whether a point is to be begun again whose process was killed once more.
    fn survives_kill(&self, index: usize) -> bool {
        let mut queue = self.lock();
        let kills = queue.kills.entry(index).or_default();
        *kills += 1;
        *kills <= MOST_KILLED && !queue.is_closed
    }

    /// Starts nothing any more, and asks all that run to stop.
    fn stop(&self) {
        let mut queue = self.lock();
        queue.is_closed = true;
        for id in queue.running.values() {
            let process = i32::try_from(*id).ok().and_then(Pid::from_raw);
            if let Some(process) = process {
                // One that has just ended needs no signal
                let _ = kill_process(process, Signal::TERM);
            }
        }
    }
}

/// Runs points as processes, `jobs` of them at once, until all are over or `must_stop` says so; ends
/// are reported as they come. `launch` says what to do with a point when its turn comes.
pub fn run_children(
    points: Vec<usize>,
    jobs: usize,
    launch: &(dyn Fn(usize) -> Launch + Sync),
    must_stop: &dyn Fn() -> bool,
    on_end: &mut dyn FnMut(Ended),
) {
    let (running, kills) = (BTreeMap::new(), BTreeMap::new());
    let queue = Queue { waiting: points.into(), running, kills, is_closed: false };
    let shared = Shared(Mutex::new(queue));
    thread::scope(|scope| {
        let (sender, events) = mpsc::channel();
        for _ in 0..jobs {
            let (sender, shared) = (sender.clone(), &shared);
            scope.spawn(move || work(shared, launch, &sender));
        }
        drop(sender);
        let mut is_stopping = false;
        loop {
            match events.recv_timeout(LOOK_EVERY) {
                Ok(ended) => on_end(ended),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => break,
            }
            if !is_stopping && must_stop() {
                is_stopping = true;
                shared.stop();
            }
        }
    });
}

/// Takes one point after the other.
fn work(shared: &Shared, launch: &(dyn Fn(usize) -> Launch + Sync), sender: &Sender<Ended>) {
    // Nobody listens any more only when the sweep is over
    let report = |index, ending| drop(sender.send(Ended { index, ending }));
    while let Some(index) = shared.next() {
        match launch(index) {
            Launch::IsDone => report(index, Ending::Finished),
            Launch::HasFailed(failure) => report(index, Ending::Failed(failure)),
            Launch::Busy => {
                shared.again(index);
                thread::sleep(LEFT_ALONE);
            }
            Launch::TimeIsOver => shared.lock().is_closed = true,
            Launch::Start(mut command) => match shared.start(index, &mut command) {
                Ok(None) => {}
                Ok(Some(child)) => match wait(shared, index, child) {
                    ChildEnd::Of(ending) => report(index, ending),
                    ChildEnd::InUse => {
                        shared.again(index);
                        thread::sleep(LEFT_ALONE);
                    }
                    // It continues from its latest checkpoint
                    ChildEnd::Killed(_) if shared.survives_kill(index) => shared.again(index),
                    ChildEnd::Killed(failure) => report(index, Ending::Failed(failure)),
                },
                Err(error) => {
                    let reason = format!("its process could not be started: {error}");
                    let failure = PointFailure::new(None, reason);
                    report(index, Ending::Failed(failure));
                }
            },
        }
    }
}

/// How a process ended, of a point or not.
enum ChildEnd {
    /// So its point ended.
    Of(Ending),
    /// Another process has the point.
    InUse,
    /// It was killed.
    Killed(PointFailure),
}

/// Waits for a process, and says how it ended.
fn wait(shared: &Shared, index: usize, mut child: Child) -> ChildEnd {
    let mut said = Vec::new();
    if let Some(stderr) = &mut child.stderr {
        // What could be read says enough
        let _ = stderr.read_to_end(&mut said);
    }
    // Its number is free for another process once it is waited for
    shared.lock().running.remove(&index);
    match child.wait() {
        Ok(status) => ending(status, &said),
        Err(error) => {
            let failure = PointFailure::new(None, error.to_string());
            ChildEnd::Of(Ending::Failed(failure))
        }
    }
}

fn ending(status: ExitStatus, said: &[u8]) -> ChildEnd {
    let said = String::from_utf8_lossy(&said[said.len().saturating_sub(KEPT)..]).trim().to_owned();
    let exit = status.code().and_then(|code| u8::try_from(code).ok());
    let signal = status.signal().map(Signal::from_named_raw);
    match (exit, signal) {
        (Some(0), _) => ChildEnd::Of(Ending::Finished),
        (Some(IN_USE), _) => ChildEnd::InUse,
        // Before it listens to signals, one ends it
        (Some(STOPPED), _) | (_, Some(Some(Signal::TERM | Signal::INT | Signal::HUP))) => {
            ChildEnd::Of(Ending::Stopped)
        }
        (_, Some(Some(Signal::KILL))) => {
            let reason = "signal 9 killed its process, by hand or for want of memory".to_owned();
            ChildEnd::Killed(PointFailure::new(None, reason))
        }
        (_, Some(_)) => {
            let signal = status.signal().unwrap_or_default();
            let reason = format!("signal {signal} killed its process");
            ChildEnd::Of(Ending::Failed(PointFailure::new(None, reason)))
        }
        _ => ChildEnd::Of(Ending::Failed(PointFailure::new(exit, said))),
    }
}
