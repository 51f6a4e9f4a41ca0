//! The cycle that is made ahead of a run of swimmers without inertia: it ends when it is asked to, and
//! where it tells nothing.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use alewife_core::run::{Observer, RunError, Snapshot, simulate};
use alewife_core::step::{FlowError, StopRequest};
use tests::cases::case;

/// Two links that a motor turns, which is too strong for the steps if its torque is.
fn links(torque: f64) -> String {
    format!(
        r#"
        title = "two links and a motor"
        geometry = "planar"
        fluid = {{ model = "stokes", viscosity = 1.0 }}
        domain.box = {{ min = [-3.0, -3.0], max = [3.0, 3.0] }}
        boundary = {{ left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }}
        mesh = {{ size = 2.0, surface = 0.2, growth = 0.6, gap_layers = 1, moving.layers = 1 }}
        time.unsteady = {{ step = 0.1, end = 1.0 }}
        [[swimmer]]
        name = "swimmer"
        [swimmer.kind.chain]
        links = [[0.4, 0.1], [0.4, 0.1]]
        gap = 0.2
        joints = [{{ hinge = {{ stiffness = 1.0, torque.sine = {{ amplitude = {torque:?}, period = 1.0 }} }} }}]
        "#
    )
}

/// Asks a run to stop at a question, and counts questions and rows.
struct Asker {
    /// The question from which on it is to stop.
    stops_at: usize,
    /// Whether the first row stops it, too.
    stops_at_row: bool,
    asked: Arc<AtomicUsize>,
    rows: Arc<AtomicUsize>,
}

impl Observer<2> for Asker {
    fn on_step(&mut self, _snapshot: &Snapshot<'_, 2>) -> io::Result<()> {
        self.rows.fetch_add(1, Ordering::Relaxed);
        Ok(())
    }

    fn stop_request(&self) -> Option<StopRequest> {
        let (stops_at, at_row) = (self.stops_at, self.stops_at_row);
        let (asked, rows) = (Arc::clone(&self.asked), Arc::clone(&self.rows));
        Some(Arc::new(move || {
            let has_row = rows.load(Ordering::Relaxed) > 0;
            if has_row && at_row {
                return true;
            }
            asked.fetch_add(1, Ordering::Relaxed) + 1 >= stops_at
        }))
    }
}

/// Questions until a run with a motor is stopped, and the rows it has then.
fn asked_until_stopped(torque: f64, stops_at: usize, stops_at_row: bool) -> [usize; 2] {
    let counts = [Arc::new(AtomicUsize::new(0)), Arc::new(AtomicUsize::new(0))];
    let [asked, rows] = counts.clone();
    let asker = Asker { stops_at, stops_at_row, asked, rows };
    let error = simulate(&case(&links(torque)), &mut [Box::new(asker)]).expect_err("it is stopped");
    assert!(matches!(error, RunError::Flow(FlowError::Stopped { .. })), "{error}");
    counts.map(|count| count.load(Ordering::Relaxed))
}

#[test]
fn a_run_is_stopped_in_the_cycle_it_makes_ahead() {
    let [whole, _] = asked_until_stopped(1.0, usize::MAX, true);
    let [asked, rows] = asked_until_stopped(1.0, whole / 2, false);
    assert!(whole > 20 && rows <= 1, "after {asked} of {whole} questions: {rows} rows");
    assert!(asked < whole / 2 + 5, "no other cycle is tried: {asked}");
}

#[test]
fn a_cycle_with_steps_that_are_too_long_is_given_up() {
    let [gentle, _] = asked_until_stopped(1.0, usize::MAX, true);
    let [strong, rows] = asked_until_stopped(1000.0, usize::MAX, true);
    assert!(gentle > 5, "{gentle}: the cycle is made");
    assert_eq!(rows, 1);
    // Two cycles, of which the first step is tried a few times, with twelve passes each; all pieces down
    // to a thousandth are some thousands
    assert!(strong < 200, "{strong} of {gentle}");
}
