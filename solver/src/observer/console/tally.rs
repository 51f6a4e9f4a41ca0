//! `Tally`: how many of many runs are done, on stderr: a bar on a terminal, else a line now and then.

use std::time::{Duration, Instant};

use indicatif::{HumanDuration, ProgressBar, ProgressStyle};

use super::terminal::{LINE_INTERVAL, TERMINAL};

/// Shows how many runs are done.
#[derive(Debug)]
pub struct Tally {
    /// Shown on a terminal only.
    bar: Option<ProgressBar>,
    is_quiet: bool,
    total: usize,
    /// How many run at once.
    jobs: usize,
    started: Instant,
    last_line: Instant,
}

impl Tally {
    /// Shows that none of so many runs is done, `jobs` of which run at once.
    #[must_use]
    pub fn new(total: usize, jobs: usize, is_quiet: bool) -> Self {
        let has_bar = !is_quiet && TERMINAL.is_terminal();
        let bar = has_bar.then(|| {
            let style = ProgressStyle::with_template("{bar:24}  {msg}")
                .unwrap_or_else(|_| ProgressStyle::default_bar());
            let bar = TERMINAL.show(ProgressBar::new(total as u64).with_style(style));
            bar.enable_steady_tick(Duration::from_millis(200));
            bar
        });
        let now = Instant::now();
        let mut tally = Self { bar, is_quiet, total, jobs, started: now, last_line: now };
        tally.show(0, 0);
        tally
    }

    /// Shows how many are done, failed ones included, and how many of these failed.
    pub fn show(&mut self, done: usize, failed: usize) {
        if self.bar.is_none() && (self.is_quiet || self.last_line.elapsed() < LINE_INTERVAL) {
            return;
        }
        let line = self.line_of(done, failed);
        if let Some(bar) = &self.bar {
            bar.set_position(done as u64);
            bar.set_message(line);
        } else {
            self.last_line = Instant::now();
            TERMINAL.line(&line);
        }
    }

    fn line_of(&self, done: usize, failed: usize) -> String {
        let failed = if failed > 0 { format!(", {failed} failed") } else { String::new() };
        let left = self.total.saturating_sub(done);
        let running = left.min(self.jobs);
        let mut line = format!("{done} of {} done{failed}, {running} running", self.total);
        if done > 0 && left > 0 {
            let left = self.started.elapsed().mul_f64(left as f64 / done as f64);
            line += &format!(", {:#} left", HumanDuration(left));
        }
        line
    }

    /// Writes a line above it.
    pub fn line(&self, text: &str) {
        if !self.is_quiet {
            TERMINAL.line(text);
        }
    }
}

impl Drop for Tally {
    fn drop(&mut self) {
        if let Some(bar) = self.bar.take() {
            TERMINAL.drop_notes();
            bar.finish_and_clear();
        }
    }
}
