//! Fixed steps, halved where they must be.

use super::start::{Piece, pieces};
use super::{SMALLEST_PART, step_size_underflow};
use crate::case::{Scheme, Unsteady};
use crate::coupling::SurfaceLoads;
use crate::simulation::RunError;
use crate::simulation::advance::Attempt;
use crate::simulation::run::{Run, StepSummary};
use crate::simulation::stepper::StepReport;

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
    pub(in crate::simulation) fn fixed_steps(
        &mut self,
        settings: &Unsteady,
    ) -> Result<usize, RunError> {
        let n_steps = settings.n_steps();
        // A resumed run may be anywhere within a step, and may have made others of another size, after
        // whose number its own are counted
        let first = settings.n_steps_to(self.simulation.state.time);
        let numbers = self.simulation.state.step..;
        for (number, index) in numbers.zip(first..n_steps) {
            let started = self.simulation.state.time;
            let target = ((index + 1) as f64 * settings.step).min(settings.end);
            let mut tally = StepTally::default();
            for (done, piece) in pieces(settings, &self.simulation, target).into_iter().enumerate()
            {
                if done > 0 {
                    // What is not yet a step does not count as one
                    self.simulation.state.step = number;
                    self.check_signals(false)?;
                }
                self.fixed_piece(settings, number, piece, &mut tally)?;
            }
            // Counted, not summed, so that rounding does not pile up
            let is_last = index + 1 == n_steps;
            let state = &mut self.simulation.state;
            state.time = if is_last { settings.end } else { (index + 1) as f64 * settings.step };
            let summary = StepSummary {
                iterations: tally.iterations,
                time_step: state.time - started,
                is_last,
                crossing: None,
            };
            self.report(&tally.loads, summary)?;
            self.check_signals(is_last)?;
        }
        Ok(self.simulation.state.step)
    }

    /// Makes one piece of a step, in halves where it must be.
    fn fixed_piece(
        &mut self,
        settings: &Unsteady,
        number: usize,
        piece: Piece,
        tally: &mut StepTally,
    ) -> Result<(), RunError> {
        let smallest = settings.step * SMALLEST_PART;
        if piece.is_restart {
            // What was before does not count for what comes
            self.simulation.state.last_step = 0.0;
        }
        // The next one last
        let mut to_do = vec![piece.size];
        while let Some(size) = to_do.pop() {
            let before = self.simulation.state.last_step;
            let grows = before > 0.0 && size > LARGEST_GROWTH * before;
            if grows && settings.scheme == Scheme::Bdf2 {
                to_do.extend([0.5 * size; 2]);
                continue;
            }
            self.simulation.state.step = number;
            match self.simulation.try_step(size, f64::INFINITY)? {
                Attempt::Made(step) => tally.add(step),
                Attempt::Rejected(error) if size <= smallest => {
                    return Err(step_size_underflow(&self.simulation, size, &error));
                }
                Attempt::Rejected(_) => {
                    self.rejections += 1;
                    to_do.extend([0.5 * size; 2]);
                }
            }
            // A step in many pieces may take long. After the last one the step is reported first: a
            // resumed run begins behind it.
            if !to_do.is_empty() {
                self.simulation.state.step = number;
                self.check_signals(false)?;
            }
        }
        Ok(())
    }
}
