//! Meshing that is asked to end, ends soon.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use alewife_interrupt::{Heard, check, hearing, is_requested};
use alewife_mesh::spatial::{self, Body, Domain};
use alewife_mesh::{MeshError, Point, Sizing};
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
