//! Fixed steps, halved where they must be.

use super::start::pieces;
use super::{
    NEAR, Piece, SMALLEST_PART, SMALLEST_PART_IN_CONTACT, step_size_factor, step_size_underflow,
};
use crate::case::{Scheme, Unsteady};
use crate::coupling::SurfaceLoads;
use crate::run::RunError;
use crate::run::run::{Run, StepSummary};
use crate::run::simulation::{Attempt, Simulation};
use crate::step::{StepError, StepReport};

/// Growth of a step over the one before beyond which BDF2 would not be stable.
const LARGEST_GROWTH: f64 = 2.1;

/// What the pieces of a step amount to.
#[derive(Default)]
struct StepTally {
    loads: SurfaceLoads,
    iterations: usize,
}

impl StepTally {
    fn add(&mut self, step: StepReport) {
        self.loads = step.loads;
        self.iterations += step.iterations;
    }
}

impl<const D: usize> Run<'_, D> {
    /// Makes all steps up to a time (s), which ends a step where it is within one.
    pub(in crate::run) fn fixed_steps(
        &mut self,
        settings: &Unsteady,
        until: f64,
    ) -> Result<(), RunError> {
        let n_steps = settings.n_steps();
        // A resumed run may be anywhere within a step, and may have made others of another size, after
        // whose number its own are counted
        let first = settings.n_steps_to(self.simulation.state.time);
        let near = NEAR * settings.step;
        for index in first..n_steps {
            let started = self.simulation.state.time;
            if started >= until - near {
                break;
            }
            let target = ((index + 1) as f64 * settings.step).min(settings.end);
            let is_cut = until < target - near;
            let target = if is_cut { until } else { target };
            let tally = self.fixed_step(settings, target)?;
            // Counted, not summed, so that rounding does not pile up
            let is_last = index + 1 == n_steps && !is_cut;
            let state = &mut self.simulation.state;
            let time = match (is_cut, is_last) {
                (true, _) => until,
                (false, true) => settings.end,
                (false, false) => (index + 1) as f64 * settings.step,
            };
            state.round_time(time);
            let is_last = is_last || self.is_over(settings)?;
            let state = &self.simulation.state;
            let summary = StepSummary {
                iterations: tally.iterations,
                time_step: state.time - started,
                is_last,
                crossing: None,
            };
            self.report(&tally.loads, summary)?;
            if is_last {
                break;
            }
            self.check_signals(false)?;
        }
        Ok(())
    }

    /// Makes a step to a time (s) in its pieces, or the rest of it, in halves where it must be.
    fn fixed_step(&mut self, settings: &Unsteady, target: f64) -> Result<StepTally, RunError> {
        let mut tally = StepTally::default();
        let mut to_do = self.pieces_to(settings, target);
        while let Some(piece) = to_do.pop() {
            if piece.is_restart {
                // What was before does not count for what comes
                self.simulation.state.restart();
            }
            let size = piece.size;
            if size > self.longest_piece(settings) {
                to_do.extend(halves(piece));
                continue;
            }
            match self.simulation.try_step(size, f64::INFINITY)? {
                Attempt::Made(step) => {
                    self.simulation.control.contact_step = (step.contact_error > 0.0)
                        .then(|| size * step_size_factor(step.contact_error, LARGEST_GROWTH));
                    tally.add(step);
                    // A run that resumes makes these, and tries again what was rejected before
                    self.simulation.control.pieces.clone_from(&to_do);
                    if !to_do.is_empty() {
                        self.simulation.state.continue_step();
                        self.note_piece(&tally.loads);
                    }
                }
                Attempt::Rejected(error) if size <= settings.step * smallest_part(&error) => {
                    return Err(step_size_underflow(self, size, &error));
                }
                Attempt::Rejected(_) => to_do.extend(halves(piece)),
            }
            // A step in many pieces may take long. After the last one the step is reported first: a
            // resumed run begins behind it.
            if !to_do.is_empty() {
                self.check_signals(false)?;
            }
        }
        Ok(tally)
    }

    /// The longest piece that may follow what has been made (s).
    fn longest_piece(&self, settings: &Unsteady) -> f64 {
        let Simulation { state, control, .. } = &self.simulation;
        let contact = control.contact_step.unwrap_or(f64::INFINITY);
        contact.min(longest_piece(settings, state.last_step))
    }

    /// The pieces of a step to a time (s), the next one last: what a run that resumes has left of them.
    fn pieces_to(&self, settings: &Unsteady, target: f64) -> Vec<Piece> {
        let Simulation { state, control, .. } = &self.simulation;
        let end = state.time + control.pieces.iter().map(|piece| piece.size).sum::<f64>();
        if !control.pieces.is_empty() && (end - target).abs() < NEAR * settings.step {
            control.pieces.clone()
        } else {
            pieces(settings, &self.simulation, target)
        }
    }
}

/// The longest piece that may follow one of a size (s), or none where that is zero.
pub(super) fn longest_piece(settings: &Unsteady, last: f64) -> f64 {
    let is_bound = settings.scheme == Scheme::Bdf2 && last > 0.0;
    if is_bound { LARGEST_GROWTH * last } else { f64::INFINITY }
}

/// The smallest part of a step that is tried after an error.
fn smallest_part(error: &StepError) -> f64 {
    match error {
        StepError::ContactNotResolved { .. } => SMALLEST_PART_IN_CONTACT,
        _ => SMALLEST_PART,
    }
}

/// The halves of a piece, the first one last.
pub(super) fn halves(piece: Piece) -> [Piece; 2] {
    let size = 0.5 * piece.size;
    [Piece { size, is_restart: false }, Piece { size, ..piece }]
}
