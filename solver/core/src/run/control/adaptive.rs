//! Steps as long as their error, the cells and the gaps allow.

use super::corners::next_corner;
use super::start::start_pieces;
use super::{NEAR, Piece, SMALLEST_PART, step_size_factor, step_size_underflow};
use crate::case::{Adaptive, Scheme, Unsteady};
use crate::run::RunError;
use crate::run::run::{Run, StepSummary};
use crate::run::simulation::{Attempt, Simulation};
use crate::step::{StepError, StepReport};

/// Part of the time to the end that is rounding.
const AT_END: f64 = 1e-9;

/// Largest growth of a step over the one before.
const LARGEST_GROWTH: f64 = 1.5;

/// Bounds of the steps (s).
#[derive(Clone, Copy)]
struct Bounds {
    smallest: f64,
    largest: f64,
}

/// A step that has been made.
struct Made {
    report: StepReport,
    size: f64,
    /// Whether a longer one was rejected before.
    is_shortened: bool,
}

/// Whether a piece is the step across a jump, which is made whatever its error.
fn leads_across(piece: Piece, bounds: Bounds) -> bool {
    piece.is_restart && piece.size <= bounds.smallest
}

impl<const D: usize> Run<'_, D> {
    /// Makes all steps up to a time (s), at which one ends.
    pub(in crate::run) fn adaptive_steps(
        &mut self,
        settings: &Unsteady,
        adaptive: &Adaptive,
        until: f64,
    ) -> Result<(), RunError> {
        let until = until.min(settings.end);
        let bounds = Bounds {
            smallest: adaptive.smallest.unwrap_or(settings.step * 1e-6),
            largest: adaptive.largest.unwrap_or(settings.end / 10.0),
        };
        let Simulation { state, control, .. } = &self.simulation;
        if state.last_step == 0.0 && control.proposed_step.is_none() {
            self.begin_in_pieces(settings, settings.step.min(settings.end));
            self.simulation.look_ahead(settings);
        }
        while until - self.simulation.state.time > AT_END * settings.end {
            let proposed = self.simulation.control.proposed_step.unwrap_or(settings.step);
            self.restart_at_discontinuity(settings, proposed);
            let piece = self.simulation.control.pieces.last().copied();
            let is_start = piece.is_some() && settings.scheme == Scheme::Bdf2;
            if piece.is_some_and(|piece| piece.is_restart) {
                self.simulation.state.restart();
            }
            let is_across = piece.is_some_and(|piece| leads_across(piece, bounds));
            let wanted = piece.map_or(proposed, |piece| piece.size).min(bounds.largest);
            let size = if is_across {
                wanted.min(until - self.simulation.state.time)
            } else {
                self.cut_to_fit(until, proposed, self.cut_at_rest(settings, wanted))
            };
            // Pieces of the first step are smaller than any that is asked for
            let floor = bounds.smallest;
            let floor = if is_start { floor.min(SMALLEST_PART * size) } else { floor };
            let gap = self.simulation.state.contact.minimum_gap.map(|minimum| minimum.gap);
            let tolerance = if is_across { f64::INFINITY } else { adaptive.tolerance };
            let Some(made) = self.adaptive_step(tolerance, size, floor)? else {
                self.plan_to_go_across(settings, bounds);
                continue;
            };
            let error = (made.report.error / adaptive.tolerance).max(made.report.contact_error);
            let factor = if is_start { 2.0 } else { step_size_factor(error, LARGEST_GROWTH) };
            let crossing = self.simulation.cell_crossing();
            let longest = adaptive.cfl / crossing.rate;
            let proposed = self.propose(adaptive, made.size, factor, gap).min(longest);
            let Simulation { state, control, .. } = &mut self.simulation;
            // Only now: within a step the run may be stopped, and then tries again what was rejected
            control.pieces.pop();
            if made.is_shortened && !is_across {
                control.pieces.clear();
            }
            control.proposed_step = Some(proposed.clamp(bounds.smallest, bounds.largest));
            let is_last = settings.end - state.time <= AT_END * settings.end;
            if until - state.time <= AT_END * settings.end {
                state.round_time(until);
            }
            let is_last = is_last || self.is_over(settings)?;
            let Made { report, size, .. } = made;
            let (iterations, crossing) = (report.iterations, Some(crossing));
            let summary = StepSummary { iterations, time_step: size, is_last, crossing };
            self.report(&report.loads, summary)?;
            if is_last {
                break;
            }
            self.check_signals(is_last)?;
        }
        Ok(())
    }

    /// Makes the next steps the pieces of one of this size (s).
    fn begin_in_pieces(&mut self, settings: &Unsteady, size: f64) {
        let pieces = start_pieces(settings.scheme, true, size).into_iter().rev();
        let pieces = pieces.map(|size| Piece { size, is_restart: false });
        self.simulation.control.pieces = pieces.collect();
    }

    /// Where rates jump, what was before does not count for what comes.
    fn restart_at_discontinuity(&mut self, settings: &Unsteady, proposed: f64) {
        let left = settings.end - self.simulation.state.time;
        let has_begun = self.simulation.state.step > 0;
        if has_begun && self.simulation.is_at_discontinuity(NEAR * proposed.min(left)) {
            self.begin_in_pieces(settings, settings.step.min(proposed));
            self.simulation.state.restart();
        }
    }

    /// A step that ends where fluid and bodies at rest begin to move: it would know of nothing within it.
    fn cut_at_rest(&self, settings: &Unsteady, size: f64) -> f64 {
        let end = self.simulation.end_of_rest(settings, size);
        end.map_or(size, |end| end - self.simulation.state.time)
    }

    /// Makes the next step the shortest one, across what jumps within it, and those that follow the pieces of a first step:
    /// neither knows what was before it.
    fn plan_to_go_across(&mut self, settings: &Unsteady, bounds: Bounds) {
        let Simulation { state, .. } = &self.simulation;
        let (step, time, within) = (state.step + 1, state.time, bounds.smallest);
        tracing::info!(step, time, within, "something jumps: steps begin anew behind it");
        self.begin_in_pieces(settings, settings.step.min(bounds.largest));
        let pieces = &mut self.simulation.control.pieces;
        if let Some(behind) = pieces.last_mut() {
            behind.is_restart = true;
        }
        pieces.push(Piece { size: bounds.smallest, is_restart: true });
    }

    /// A step that ends at a time (s), and where rates jump and tables have corners; the last two before share what is left.
    fn cut_to_fit(&self, until: f64, proposed: f64, size: f64) -> f64 {
        let time = self.simulation.state.time;
        let mut left = until - time;
        let near = NEAR * proposed.min(left);
        let jumps = self.simulation.problem.rate_discontinuities.as_ref();
        let jump = jumps.and_then(|jumps| jumps(time + near, until).first().copied());
        let corner = next_corner(&self.model, [time + near, until]);
        let next = jump.into_iter().chain(corner).reduce(f64::min);
        left = next.map_or(left, |next| next - time);
        if left >= 2.0 * size {
            size
        } else if left <= size * (1.0 + AT_END) {
            left
        } else {
            0.5 * left
        }
    }

    /// Makes a step, shorter where it must be; none where its error does not fall with its size, as that of earlier steps did.
    fn adaptive_step(
        &mut self,
        tolerance: f64,
        mut size: f64,
        floor: f64,
    ) -> Result<Option<Made>, RunError> {
        let mut is_shortened = false;
        // Pieces that are left are those of a start, of which no step has had its error estimated yet: what jumps
        // again so soon does not do so at single times
        let may_go_across = self.simulation.control.pieces.is_empty();
        loop {
            match self.simulation.try_step(size, tolerance)? {
                Attempt::Made(report) => return Ok(Some(Made { report, size, is_shortened })),
                Attempt::Rejected(StepError::LocalErrorTooLarge { .. })
                    if size <= floor && may_go_across =>
                {
                    return Ok(None);
                }
                Attempt::Rejected(error) if size <= floor => {
                    return Err(step_size_underflow(self, size, &error));
                }
                Attempt::Rejected(StepError::LocalErrorTooLarge { error, .. }) => {
                    size *= step_size_factor(error / tolerance, LARGEST_GROWTH).min(0.7);
                }
                Attempt::Rejected(_) => size *= 0.5,
            }
            size = size.max(floor);
            is_shortened = true;
            self.check_signals(false)?;
        }
    }

    /// The next step after one of this size: by its error and the rate at which the smallest gap closes.
    fn propose(&self, adaptive: &Adaptive, size: f64, factor: f64, gap: Option<f64>) -> f64 {
        let proposed = size * factor;
        match (gap, self.simulation.state.contact.minimum_gap) {
            (Some(before), Some(now)) => {
                let rate = (now.gap - before).abs() / size;
                proposed.min(adaptive.gap * now.gap / rate)
            }
            _ => proposed,
        }
    }
}
