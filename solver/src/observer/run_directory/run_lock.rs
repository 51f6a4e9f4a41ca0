//! `RunLock`: one process for a directory; the system gives it free however the process ends.

use std::fs::{self, File, Metadata, TryLockError};
use std::io;
use std::os::unix::fs::{FileExt, MetadataExt, OpenOptionsExt};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use rustix::fs::OFlags;
use thiserror::Error;

use super::lock_reach::sees_other_hosts;
use crate::observer::system::{AtPath, process, remove_if_there};

/// The file that is locked.
pub const LOCK_FILE: &str = "lock";
/// Longest name of a holder that is reported (bytes).
const LONGEST: usize = 300;
/// How the name of a holder begins; a file that begins otherwise was written by somebody else.
const NAMED: &str = "process ";
/// How long a lock is tried for: who only looks whether it is held has it for an instant.
const GRACE: Duration = Duration::from_millis(300);
/// Time between two tries.
const AGAIN: Duration = Duration::from_millis(10);
/// Time between two signs of life of a holder.
const BEAT: Duration = Duration::from_secs(10);
/// A holder on another computer without a sign of life for so long has ended.
const SILENCE: Duration = Duration::from_secs(120);

/// Why a directory cannot be held.
#[derive(Debug, Error)]
pub enum LockError {
    /// Another process has it.
    #[error(
        "another run{} is writing to {path}; wait for it, or give another directory with --out",
        holder.as_ref().map(|holder| format!(" ({holder})")).unwrap_or_default()
    )]
    InUse {
        /// The directory.
        path: PathBuf,
        /// The other process, as far as it is known.
        holder: Option<String>,
    },
    /// What has the name of the lock is something else, which is left as it is.
    #[error(
        "{path} is no lock of alewife, but a link, a folder or a file of somebody else; move it away, or \
         give another directory with --out"
    )]
    NotALock {
        /// The file.
        path: PathBuf,
    },
    /// The file system refused.
    #[error(transparent)]
    Io(#[from] io::Error),
}

/// A directory, held by this process as long as a copy of the value lives.
///
/// The kernel has the lock, so that it ends with the process. The name of the holder in the file is for others to
/// read, and is taken away at the end; it is written again and again as a sign of life to computers that do not see
/// the lock.
#[derive(Debug, Clone)]
pub struct RunLock {
    _held: Arc<Held>,
}

/// The lock itself.
#[derive(Debug)]
struct Held {
    file: Arc<File>,
    directory: PathBuf,
    /// Ends the signs of life when it is dropped.
    life: Option<Life>,
}

#[derive(Debug)]
struct Life {
    end: Sender<()>,
    thread: JoinHandle<()>,
}

impl RunLock {
    /// Holds a directory.
    ///
    /// # Errors
    /// When another process has it, the file of the lock is something else, or the file system refuses.
    pub fn take(directory: &Path) -> Result<Self, LockError> {
        let path = directory.join(LOCK_FILE);
        let started = Instant::now();
        loop {
            let file = open(&path)?;
            let refusal = match file.try_lock() {
                Ok(()) => holder_elsewhere(&file, directory).map(Some),
                Err(TryLockError::WouldBlock) => Some(holder_of(&file)),
                // Some network file systems have no locks: signs of life have to do
                Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => {
                    holder_elsewhere(&file, directory).map(Some)
                }
                Err(TryLockError::Error(error)) => return Err(error).at(&path)?,
            };
            match refusal {
                // The process that had it may have removed it since it was opened here
                None if is_still_there(&file, &path) => return Ok(Self::begin(file, directory)),
                Some(holder) if started.elapsed() > GRACE => {
                    return Err(LockError::InUse { path: directory.to_owned(), holder });
                }
                _ => thread::sleep(AGAIN),
            }
        }
    }

    /// Holds a directory as soon as others give it free; nothing once it `must_give_up`.
    ///
    /// # Errors
    /// Those of [`RunLock::take`], another holder aside.
    pub fn wait(
        directory: &Path,
        must_give_up: impl Fn() -> bool,
    ) -> Result<Option<Self>, LockError> {
        loop {
            match Self::take(directory) {
                Err(LockError::InUse { .. }) if !must_give_up() => thread::sleep(AGAIN),
                Err(LockError::InUse { .. }) => return Ok(None),
                taken => return taken.map(Some),
            }
        }
    }

    fn begin(file: File, directory: &Path) -> Self {
        let file = Arc::new(file);
        // A full disk is found soon enough by files that matter
        let _ = file.set_len(0).and_then(|()| file.write_all_at(holder().as_bytes(), 0));
        let life = signs_of_life(&file);
        Self { _held: Arc::new(Held { file, directory: directory.to_owned(), life }) }
    }

    /// Whether a process has a directory: on this computer the lock says so, of another one signs of life, in the
    /// lock or in the newest of `files`.
    #[must_use]
    pub fn is_held(directory: &Path, files: &[&str]) -> bool {
        let path = directory.join(LOCK_FILE);
        let Ok(file) = File::options().read(true).custom_flags(flags()).open(&path) else {
            return false;
        };
        // Who gives it free takes the name away: nothing has to be locked to see that
        let Some(holder) = holder_of(&file) else { return false };
        match file.try_lock_shared() {
            Err(TryLockError::WouldBlock) => return true,
            Ok(()) if is_of_this_host(&holder) => return false,
            _ => {}
        }
        drop(file);
        let files = files.iter().map(|name| directory.join(name)).chain([path]);
        files.filter_map(|file| fs::metadata(file).ok()).any(|found| is_recent(&found))
    }
}

impl Drop for Held {
    /// Takes the name away, or the whole file where nothing was made that it belongs to.
    fn drop(&mut self) {
        if let Some(Life { end, thread }) = self.life.take() {
            drop(end);
            // It does nothing that could fail
            let _ = thread.join();
        }
        let _ = self.file.set_len(0);
        if !self.directory.join(super::marker::MARKER_FILE).exists() {
            let _ = remove_if_there(&self.directory.join(LOCK_FILE));
            // Which is refused where there are other files
            let _ = fs::remove_dir(&self.directory);
        }
    }
}

fn flags() -> i32 {
    // Neither the target of a link nor a pipe is ever opened
    i32::try_from((OFlags::NOFOLLOW | OFlags::NONBLOCK).bits()).unwrap_or_default()
}

/// The file of a lock, made if it is not there.
fn open(path: &Path) -> Result<File, LockError> {
    let not_a_lock = || LockError::NotALock { path: path.to_owned() };
    let mut options = File::options();
    options.create(true).truncate(false).read(true).write(true).custom_flags(flags());
    let file = match options.open(path) {
        Ok(file) => file,
        Err(_) if fs::symlink_metadata(path).is_ok_and(|found| !found.is_file()) => {
            return Err(not_a_lock());
        }
        Err(error) => return Err(error).at(path)?,
    };
    let found = file.metadata().at(path)?;
    // One look, as whoever holds it may just take the name away
    let text = text_of(&file);
    let is_ours = text.as_ref().is_some_and(|text| text.is_empty() || text.starts_with(NAMED));
    if !found.is_file() || found.nlink() > 1 || !is_ours {
        return Err(not_a_lock());
    }
    Ok(file)
}

/// Whether a file is the one of a name.
fn is_still_there(file: &File, path: &Path) -> bool {
    let same =
        |one: Metadata, other: Metadata| (one.dev(), one.ino()) == (other.dev(), other.ino());
    file.metadata().is_ok_and(|one| fs::symlink_metadata(path).is_ok_and(|other| same(one, other)))
}

/// The holder a file names.
fn holder_of(file: &File) -> Option<String> {
    text_of(file).map(|text| text.trim().to_owned()).filter(|text| text.starts_with(NAMED))
}

/// What a file says, the first bytes of it; nothing where it cannot be read.
fn text_of(file: &File) -> Option<String> {
    let mut bytes = vec![0; LONGEST];
    let n = file.read_at(&mut bytes, 0).ok()?;
    Some(String::from_utf8_lossy(&bytes[..n]).into_owned())
}

/// The holder of a lock that this process was given, where it may still run: on another computer, by a file system
/// that need not make its locks known to others.
fn holder_elsewhere(file: &File, directory: &Path) -> Option<String> {
    let holder = holder_of(file)?;
    let may_run = !is_of_this_host(&holder) && !sees_other_hosts(directory);
    (may_run && file.metadata().is_ok_and(|found| is_recent(&found))).then_some(holder)
}

fn is_of_this_host(holder: &str) -> bool {
    process::host_name().is_some_and(|host| holder.ends_with(&format!(" on {host}")))
}

/// Whether a file was written to a short time ago, or in the future of this clock.
fn is_recent(found: &Metadata) -> bool {
    found.modified().is_ok_and(|then| process::age(then).is_none_or(|age| age < SILENCE))
}

/// Writes the name of the holder again and again.
fn signs_of_life(file: &Arc<File>) -> Option<Life> {
    let (end, ends) = mpsc::channel();
    let file = Arc::clone(file);
    let beat = move || {
        while ends.recv_timeout(BEAT) == Err(RecvTimeoutError::Timeout) {
            let _ = file.write_all_at(holder().as_bytes(), 0);
        }
    };
    // Without it others see the lock alone
    let thread = thread::Builder::new().name("lock".to_owned()).spawn(beat).ok()?;
    Some(Life { end, thread })
}

/// How this process is known to others.
fn holder() -> String {
    let host = process::host_name().map_or(String::new(), |host| format!(" on {host}"));
    format!("{NAMED}{}{host}\n", std::process::id())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn put(directory: &Path, text: &str) -> PathBuf {
        let path = directory.join(LOCK_FILE);
        fs::write(&path, text).unwrap();
        path
    }

    #[test]
    fn the_second_is_told_who_is_first_and_a_name_that_was_left_does_not_matter() {
        let place = tempfile::tempdir().unwrap();
        fs::write(place.path().join(super::super::marker::MARKER_FILE), "").unwrap();
        put(place.path(), &format!("process 1 on {}\n", process::host_name().unwrap_or_default()));
        assert!(!RunLock::is_held(place.path(), &[]), "nobody locks it");
        let first = RunLock::take(place.path()).unwrap();
        let reported = RunLock::take(place.path()).unwrap_err().to_string();
        assert!(RunLock::is_held(place.path(), &[]));
        let first_is = format!("process {}", std::process::id());
        assert!(reported.contains(&first_is), "{reported}");
        let copy = first.clone();
        drop(first);
        assert!(RunLock::is_held(place.path(), &[]), "a copy holds it as well");
        drop(copy);
        assert!(!RunLock::is_held(place.path(), &[]));
        RunLock::take(place.path()).unwrap();
    }

    #[test]
    fn a_process_of_another_computer_is_alive_while_it_gives_signs_of_life() {
        let place = tempfile::tempdir().unwrap();
        let path = put(place.path(), "process 1 on a computer that is switched off\n");
        assert!(RunLock::is_held(place.path(), &[]), "it may run there");
        let long_ago = fs::metadata(&path).unwrap().modified().unwrap() - 2 * SILENCE;
        File::options().write(true).open(&path).unwrap().set_modified(long_ago).unwrap();
        assert!(!RunLock::is_held(place.path(), &["status.json"]));
        fs::write(place.path().join("status.json"), "").unwrap();
        assert!(RunLock::is_held(place.path(), &["status.json"]), "it writes still");
    }

    #[test]
    fn what_is_no_lock_is_left_as_it_is() {
        let place = tempfile::tempdir().unwrap();
        let (mine, path) = (place.path().join("mine"), place.path().join(LOCK_FILE));
        let refused = || {
            let refused = RunLock::take(place.path());
            assert!(matches!(refused, Err(LockError::NotALock { .. })), "{refused:?}");
            assert!(!RunLock::is_held(place.path(), &[]));
        };
        for text in ["my thesis", ""] {
            fs::write(&mine, text).unwrap();
            std::os::unix::fs::symlink(&mine, &path).unwrap();
            refused();
            fs::remove_file(&path).unwrap();
            fs::hard_link(&mine, &path).unwrap();
            refused();
            fs::remove_file(&path).unwrap();
            assert_eq!(fs::read_to_string(&mine).unwrap(), text);
        }
        std::os::unix::fs::symlink(place.path().join("absent"), &path).unwrap();
        refused();
        assert!(!place.path().join("absent").exists());
        fs::remove_file(&path).unwrap();
        fs::create_dir(&path).unwrap();
        refused();
        fs::remove_dir(&path).unwrap();
        put(place.path(), "of somebody");
        refused();
    }

    #[test]
    fn who_takes_a_lock_that_is_just_given_free_finds_a_lock() {
        let place = tempfile::tempdir().unwrap();
        fs::write(place.path().join(super::super::marker::MARKER_FILE), "").unwrap();
        let visit = || {
            for _ in 0..100 {
                assert!(RunLock::wait(place.path(), || false).unwrap().is_some());
            }
        };
        thread::scope(|scope| (0..4).for_each(|_| drop(scope.spawn(visit))));
    }

    #[test]
    fn one_of_many_has_it_at_a_time_and_none_is_left_out() {
        let place = tempfile::tempdir().unwrap();
        let directory = place.path().join("new");
        let inside = std::sync::atomic::AtomicUsize::new(0);
        let visit = || {
            for _ in 0..20 {
                let lock = loop {
                    fs::create_dir_all(&directory).unwrap();
                    // The directory goes with the lock, as there is no run in it
                    match RunLock::wait(&directory, || false) {
                        Ok(lock) => break lock,
                        Err(LockError::Io(error)) => {
                            assert_eq!(error.kind(), io::ErrorKind::NotFound);
                        }
                        Err(error) => panic!("{error}"),
                    }
                };
                use std::sync::atomic::Ordering::SeqCst;
                assert_eq!(inside.fetch_add(1, SeqCst), 0);
                assert!(RunLock::is_held(&directory, &[]));
                inside.fetch_sub(1, SeqCst);
                drop(lock);
            }
        };
        thread::scope(|scope| (0..4).for_each(|_| drop(scope.spawn(visit))));
        assert!(!directory.exists());
    }
}
