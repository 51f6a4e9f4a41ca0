//! Fixed steps, halved where they must be.

use super::start::pieces;
use super::{NEAR, Piece, SMALLEST_PART, step_size_underflow};
use crate::case::{Scheme, Unsteady};
use crate::coupling::SurfaceLoads;
use crate::run::RunError;
use crate::run::run::{Run, StepSummary};
use crate::run::simulation::{Attempt, Simulation};
use crate::step::StepReport;

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
    /// Makes all steps; their number, with those before the run resumed.
    pub(in crate::run) fn fixed_steps(&mut self, settings: &Unsteady) -> Result<usize, RunError> {
        let n_steps = settings.n_steps();
        // A resumed run may be anywhere within a step, and may have made others of another size, after
        // whose number its own are counted
        let first = settings.n_steps_to(self.simulation.state.time);
        for index in first..n_steps {
            let started = self.simulation.state.time;
            let target = ((index + 1) as f64 * settings.step).min(settings.end);
            let tally = self.fixed_step(settings, target)?;
            // Counted, not summed, so that rounding does not pile up
            let is_last = index + 1 == n_steps;
            let state = &mut self.simulation.state;
            let time = if is_last { settings.end } else { (index + 1) as f64 * settings.step };
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
        Ok(self.simulation.state.step)
    }

    /// Makes a step to a time (s) in its pieces, or the rest of it, in halves where it must be.
    fn fixed_step(&mut self, settings: &Unsteady, target: f64) -> Result<StepTally, RunError> {
        let smallest = settings.step * SMALLEST_PART;
        let mut tally = StepTally::default();
        let mut to_do = self.pieces_to(settings, target);
        while let Some(piece) = to_do.pop() {
            if piece.is_restart {
                // What was before does not count for what comes
                self.simulation.state.restart();
            }
            let (size, before) = (piece.size, self.simulation.state.last_step);
            let grows = before > 0.0 && size > LARGEST_GROWTH * before;
            if grows && settings.scheme == Scheme::Bdf2 {
                to_do.extend(halves(piece));
                continue;
            }
            match self.simulation.try_step(size, f64::INFINITY)? {
                Attempt::Made(step) => {
                    tally.add(step);
                    // A run that resumes makes these, and tries again what was rejected before
                    self.simulation.control.pieces.clone_from(&to_do);
                    if !to_do.is_empty() {
                        self.simulation.state.continue_step();
                    }
                }
                Attempt::Rejected(error) if size <= smallest => {
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

/// The halves of a piece, the first one last.
fn halves(piece: Piece) -> [Piece; 2] {
    let size = 0.5 * piece.size;
    [Piece { size, is_restart: false }, Piece { size, ..piece }]
}
