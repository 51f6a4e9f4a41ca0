//! Control of the step size: fixed steps, steps by their error, first steps, trials of other sizes.

mod adaptive;
mod fixed;
mod start;
mod trial;

use super::advance::Simulation;
use super::error::{RunError, StepError};

/// Part of a step by which a discontinuity may be off and still be at its end.
const NEAR: f64 = 1e-7;

/// The smallest step over the given one, of fixed steps that are halved where they must be.
const SMALLEST_PART: f64 = 1.0 / 1024.0;

/// No smaller step helps.
fn step_size_underflow<const D: usize>(
    simulation: &Simulation<D>,
    smallest: f64,
    error: &StepError,
) -> RunError {
    let Simulation { problem, state, moving_mesh, .. } = simulation;
    let (step, time) = (state.step + 1, state.time);
    let nearest = moving_mesh.as_ref().zip(state.contact.minimum_gap).map(|(moving, minimum)| {
        let gaps = moving.gaps();
        let names = [gaps.body_name(minimum.body), gaps.partner_name(minimum.partner)];
        format!("; nearest are `{}` and `{}`, {:.3e} apart", names[0], names[1], minimum.gap)
    });
    let hint = match (&nearest, &simulation.law) {
        (Some(_), None) if problem.gives_way() => {
            "; [contact] keeps bodies apart from each other and from walls"
        }
        _ => "",
    };
    let reason = format!("{error}{}{hint}", nearest.unwrap_or_default());
    RunError::StepSizeUnderflow { step, time, smallest, reason }
}
