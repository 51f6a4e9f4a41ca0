//! A request to end that is heard within meshing: set for the work of a thread, looked at in its loops.

use std::cell::{Cell, RefCell};
use std::sync::Arc;

use crate::MeshError;

/// Says whether work is to end.
pub type Request = Arc<dyn Fn() -> bool + Send + Sync>;

/// Looks from which the request itself is asked once: a look is to cost next to nothing.
const ASK_EVERY: u32 = 64;

thread_local! {
    /// The request that is set.
    static REQUEST: RefCell<Option<Request>> = const { RefCell::new(None) };
    /// Whether it was found to be made.
    static IS_MADE: Cell<bool> = const { Cell::new(false) };
    /// Looks so far.
    static LOOKS: Cell<u32> = const { Cell::new(0) };
}

/// What work that hears a request came to.
#[derive(Debug)]
pub struct Heard<R> {
    /// What it handed back.
    pub result: R,
    /// Whether meshing was ended on the way.
    pub was_ended: bool,
}

/// Does work on this thread in which meshing ends with [`MeshError::Stopped`] once a request is made.
pub fn hearing<R>(request: Request, work: impl FnOnce() -> R) -> Heard<R> {
    let _before =
        Before { request: REQUEST.replace(Some(request)), is_made: IS_MADE.replace(false) };
    let result = work();
    Heard { result, was_ended: IS_MADE.get() }
}

/// What was set before, which is set again however the work ends.
struct Before {
    request: Option<Request>,
    is_made: bool,
}

impl Drop for Before {
    fn drop(&mut self) {
        REQUEST.replace(self.request.take());
        IS_MADE.set(self.is_made);
    }
}

/// Whether work is to end; where it is, a mesh may be left as it is.
pub(crate) fn is_requested() -> bool {
    if IS_MADE.get() {
        return true;
    }
    let looks = LOOKS.get().wrapping_add(1);
    LOOKS.set(looks);
    looks.is_multiple_of(ASK_EVERY) && ask()
}

/// An error where work is to end.
pub(crate) fn check() -> Result<(), MeshError> {
    if ask() { Err(MeshError::Stopped) } else { Ok(()) }
}

fn ask() -> bool {
    let is_made =
        IS_MADE.get() || REQUEST.with_borrow(|set| set.as_ref().is_some_and(|request| request()));
    IS_MADE.set(is_made);
    is_made
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::time::{Duration, Instant};

    use super::*;
    use crate::spatial::{self, Body, Domain};
    use crate::{Point, Sizing};
    use nalgebra::Isometry3;

    /// Meshes a hundred thousand cells, which takes seconds, until the request has been asked so often.
    fn mesh_until(n_asked: usize) -> Heard<Result<(), MeshError>> {
        let asked = AtomicUsize::new(0);
        let request = move || asked.fetch_add(1, Ordering::Relaxed) >= n_asked;
        let domain = Domain::Ball { center: Point::<3>::zeros(), radius: 10.0 };
        let sphere = spatial::Shape::Sphere { radius: 1.0 };
        let body = Body::new("a", sphere, Isometry3::identity());
        let sizing = Sizing::graded(0.1, 0.2, 1.0);
        hearing(Arc::new(request), || spatial::generate(&domain, &[body], &sizing).map(drop))
    }

    #[test]
    fn meshing_ends_soon_wherever_it_is() {
        for n_asked in [0, 1, 20, 300] {
            let started = Instant::now();
            let heard = mesh_until(n_asked);
            assert!(heard.was_ended && heard.result == Err(MeshError::Stopped), "{n_asked}");
            assert!(started.elapsed() < Duration::from_secs(10), "{:?}", started.elapsed());
        }
        // What was asked of one thread's work is no matter of the next
        assert!(check().is_ok() && !is_requested());
    }
}
