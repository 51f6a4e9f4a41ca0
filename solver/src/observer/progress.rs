//! The progress of a run on stderr: a bar on a terminal, a plain line now and then elsewhere.

use std::io;
use std::time::{Duration, Instant};

use indicatif::{HumanDuration, ProgressBar, ProgressStyle};

use super::terminal::{LINE_INTERVAL, TERMINAL};
use crate::case::{Case, TimeSettings};
use crate::simulation::{LastState, Observer, RunError, Snapshot};

/// Parts of a full bar.
const FULL: u64 = 10_000;

/// Shows how far a run is.
#[derive(Debug)]
pub struct Progress {
    /// Shown on a terminal only.
    bar: Option<ProgressBar>,
    /// End of the run (s); nothing for a steady solution.
    end: Option<f64>,
    /// Time at which this process began (s), once known.
    start: Option<f64>,
    started: Instant,
    last_line: Option<Instant>,
}

impl Progress {
    /// Shows from now on that something happens.
    #[must_use]
    pub fn new(case: &Case) -> Self {
        let end = match &case.time {
            TimeSettings::Steady(_) => None,
            TimeSettings::Unsteady(settings) => Some(settings.end),
        };
        let bar = TERMINAL.is_terminal().then(|| {
            let (bar, template) = match end {
                // How many iterations a steady solution takes is not known before.
                None => (ProgressBar::new_spinner(), "{spinner} {elapsed}  {msg}"),
                Some(_) => (ProgressBar::new(FULL), "{bar:24} {percent:>3}%  {msg}"),
            };
            let style = ProgressStyle::with_template(template)
                .unwrap_or_else(|_| ProgressStyle::default_bar());
            let bar = TERMINAL.show(bar.with_style(style));
            bar.enable_steady_tick(Duration::from_millis(200));
            bar
        });
        if bar.is_none() {
            TERMINAL.show_lines();
        }
        Self { bar, end, start: None, started: Instant::now(), last_line: None }
    }

    /// One line on the step, with the time left at the pace so far.
    fn line<const D: usize>(&self, snapshot: &Snapshot<'_, D>) -> String {
        let iterations = snapshot.iterations;
        let Some(end) = self.end else {
            return format!(
                "steady solution: {} unknowns, {iterations} iterations",
                snapshot.n_dofs
            );
        };
        let mut line = format!(
            "step {}  t {:.4}/{end}  dt {:.3e}  iterations {iterations}",
            snapshot.step, snapshot.time, snapshot.time_step
        );
        // A run that resumed has not made what was before
        let start = self.start.unwrap_or(0.0);
        let done = (snapshot.time - start) / (end - start);
        if snapshot.step > 0 && done > 0.0 && !snapshot.is_last {
            let left = self.started.elapsed().mul_f64(((1.0 - done) / done).clamp(0.0, 1e9));
            line += &format!("  {:#} left", HumanDuration(left));
        }
        line
    }

    fn stop(&mut self) {
        TERMINAL.drop_notes();
        if let Some(bar) = self.bar.take() {
            bar.finish_and_clear();
        }
    }
}

impl<const D: usize> Observer<D> for Progress {
    fn on_step(&mut self, snapshot: &Snapshot<'_, D>) -> io::Result<()> {
        self.start.get_or_insert(snapshot.time - snapshot.time_step);
        if let Some(bar) = &self.bar {
            if let Some(end) = self.end {
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "saturates"
                )]
                bar.set_position((snapshot.time / end * FULL as f64) as u64);
            }
            bar.set_message(self.line(snapshot));
        } else if snapshot.is_last
            || self.last_line.is_none_or(|last| last.elapsed() >= LINE_INTERVAL)
        {
            TERMINAL.line(&self.line(snapshot));
            self.last_line = Some(Instant::now());
        }
        if snapshot.is_last {
            let line = self.line(snapshot);
            let had_bar = self.bar.is_some();
            self.stop();
            if had_bar {
                TERMINAL.line(&line);
            }
        }
        Ok(())
    }

    fn on_failure(
        &mut self,
        _error: &RunError,
        _last: Option<&LastState<'_, D>>,
    ) -> io::Result<()> {
        self.stop();
        Ok(())
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.stop();
    }
}
