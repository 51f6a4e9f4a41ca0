//! The progress of a run on stderr: a bar on a terminal, a plain line now and then elsewhere.

use std::io;
use std::time::{Duration, Instant};

use indicatif::{HumanDuration, ProgressBar, ProgressStyle};

use super::terminal::{LINE_INTERVAL, TERMINAL};
use crate::case::{Model, TimeSettings, significant};
use crate::run::{LastState, Observer, RunError, Snapshot};

/// Parts of a full bar.
const FULL: u64 = 10_000;

/// Columns below which there is no space for a bar beside the numbers.
const NARROW: usize = 90;

/// Shows how far a run is.
#[derive(Debug)]
pub struct Progress {
    /// Shown on a terminal only.
    bar: Option<ProgressBar>,
    /// End of the run (s); nothing for a steady solution.
    end: Option<f64>,
    /// Time of the first row of this process (s), and when it was there: what comes later is steps.
    first: Option<(f64, Instant)>,
    /// Beginning of the names of the quantities of the first swimmer.
    swimmer: Option<String>,
    last_line: Option<Instant>,
}

impl Progress {
    /// Shows from now on that something happens.
    #[must_use]
    pub fn new(model: &Model) -> Self {
        let end = match &model.case.time {
            TimeSettings::Steady(_) => None,
            TimeSettings::Unsteady(settings) => Some(settings.end),
        };
        let bar = TERMINAL.is_terminal().then(|| {
            let (bar, template) = match end {
                // How many iterations a steady solution takes is not known before.
                None => (ProgressBar::new_spinner(), "{spinner} {elapsed}  {wide_msg}"),
                // What does not fit into the line is cut off
                Some(_) if TERMINAL.width() < NARROW => {
                    (ProgressBar::new(FULL), "{percent:>3}%  {wide_msg}")
                }
                Some(_) => (ProgressBar::new(FULL), "{bar:24} {percent:>3}%  {wide_msg}"),
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
        let swimmer = model.swimmers.first().map(|swimmer| format!("{}.velocity.", swimmer.name));
        Self { bar, end, first: None, swimmer, last_line: None }
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
        let mut line = format!("step {}  t {:.4}/{end}", snapshot.step, snapshot.time);
        line += &self.speed_and_gap(snapshot);
        if let Some((start, began)) = self.first
            && snapshot.time > start
            && !snapshot.is_last
        {
            let to_go = (end - snapshot.time) / (snapshot.time - start);
            let left = began.elapsed().mul_f64(to_go.clamp(0.0, 1e9));
            line += &format!("  {:#} left", HumanDuration(left));
        }
        if snapshot.time_step > 0.0 {
            line += &format!("  dt {}", significant(snapshot.time_step));
        }
        line + &format!("  iterations {iterations}")
    }

    /// How fast the first swimmer is, and the smallest gap, where there are such quantities.
    fn speed_and_gap<const D: usize>(&self, snapshot: &Snapshot<'_, D>) -> String {
        let named = || snapshot.names.iter().zip(snapshot.values);
        let mut text = String::new();
        if let Some(begin) = &self.swimmer {
            let is_component = |name: &str| {
                name.strip_prefix(begin.as_str())
                    .is_some_and(|axis| ["x", "y", "z"].contains(&axis))
            };
            let components = named().filter(|(name, _)| is_component(name)).map(|(_, value)| value);
            let speed = components.map(|component| component * component).sum::<f64>().sqrt();
            if named().any(|(name, _)| is_component(name)) && speed.is_finite() {
                text += &format!("  speed {}", significant(speed));
            }
        }
        let gap = named().find(|(name, _)| *name == "flow.minimum_gap").map(|(_, gap)| *gap);
        if let Some(gap) = gap.filter(|gap| gap.is_finite()) {
            text += &format!("  gap {}", significant(gap));
        }
        text
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
        self.first.get_or_insert((snapshot.time, Instant::now()));
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
