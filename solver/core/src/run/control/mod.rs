//! Control of the step size: fixed steps, steps by their error, first steps.

mod adaptive;
mod ahead;
mod corners;
mod fixed;
mod planned;
mod start;

pub(super) use self::planned::n_pieces;
pub(super) use self::start::first_piece;
use super::error::RunError;
use super::run::Run;
use super::simulation::Simulation;
use super::step_control::Piece;
use crate::case::{BentByLoad, bent_by_loads, significant};
use crate::step::StepError;

/// Part of a step by which a discontinuity may be off and still be at its end.
const NEAR: f64 = 1e-7;

/// The smallest step over the given one, of fixed steps that are halved where they must be.
const SMALLEST_PART: f64 = 1.0 / 1024.0;

/// The smallest step over the given one where bodies are in contact, which may be over in any time.
const SMALLEST_PART_IN_CONTACT: f64 = 1e-8;

/// Part of the domain that no body goes in the smallest step when all is in one system of units.
const FAR: f64 = 1e-3;

/// Why an error does not fall with the step.
const JUMPS: &str = "; an error that does not fall with the step is that of something which jumps again and again: look for \
                     if, sign, floor and tables with steep rows in the velocities, slip and loads of the case; fixed steps, by \
                     time.unsteady.step, do not look at their error";

/// Factor of the next step after a step with this error over the tolerance, `most` at most; the error goes
/// with the third power of the step.
fn step_size_factor(error: f64, most: f64) -> f64 {
    if error > 0.0 { (0.85 * error.powf(-1.0 / 3.0)).clamp(0.3, most) } else { most }
}

/// No smaller step helps.
fn step_size_underflow<const D: usize>(
    run: &Run<'_, D>,
    smallest: f64,
    error: &StepError,
) -> RunError {
    let Simulation { problem, state, moving_mesh, law, .. } = &run.simulation;
    let (step, time, reason) = (state.step + 1, state.time, error.to_string());
    if let Some(trouble) = run.pace.trouble() {
        let advice = format!("; {trouble}; the last flow is in failure/");
        return RunError::StepSizeUnderflow { step, time, smallest, reason, advice };
    }
    // Steps of any size fail where a load bends a rod too sharply, whatever is near
    let mut bent = run.model.bodies.iter().flat_map(|body| {
        let all = bent_by_loads(run.model.case.geometry, body)
            .into_iter()
            .filter(BentByLoad::is_too_sharp);
        all.map(|one| (&body.name, one))
    });
    if let Some((name, BentByLoad { end, by, curvature, half_width })) = bent.next() {
        let (end, radius) = (end.name(), significant(1.0 / curvature));
        let half_width = significant(half_width);
        let advice = format!(
            "; the {by} at the {end} of `{name}` bends it to a radius of curvature of {radius}, and half of its thickness \
             is {half_width}: load it less, or make it stiffer or thinner; the last state is in failure/"
        );
        return RunError::StepSizeUnderflow { step, time, smallest, reason, advice };
    }
    // How far the fastest body would go in the smallest step (m)
    let leap =
        smallest * state.now.twists.iter().map(|twist| twist.linear.norm()).fold(0.0, f64::max);
    // A wall that a body is driven into is nearer than the smallest step, too, in the end
    let extent = run.simulation.extent();
    let is_too_large = matches!(error, StepError::LocalErrorTooLarge { .. });
    let nearest = moving_mesh.as_ref().zip(state.contact.minimum_gap);
    // Bodies disturb each other's steps where they are no farther apart than large
    let nearest = nearest.filter(|(moving, minimum)| {
        !is_too_large || minimum.gap < moving.gaps().reach(minimum.body)
    });
    let nearest = nearest.map(|(moving, minimum)| {
        let gaps = moving.gaps();
        let names = [gaps.body_name(minimum.body), gaps.partner_name(minimum.partner)];
        let hint = match law {
            None if leap > minimum.gap.max(FAR * extent) => {
                ": bodies would pass each other or a wall in a single step, however short: are loads, viscosity \
                 and time in one system of units?"
            }
            None if problem.gives_way() => {
                ": [contact] keeps bodies apart from each other and from walls"
            }
            _ => "",
        };
        let gap = minimum.gap;
        format!("; nearest are `{}` and `{}`, {gap:.3e} apart{hint}", names[0], names[1])
    });
    let jumps = if is_too_large { JUMPS } else { "" };
    let advice = nearest.unwrap_or_default()
        + jumps
        + "; the last state is in failure/: look at its flow there, and resume from it with --resume";
    RunError::StepSizeUnderflow { step, time, smallest, reason, advice }
}
