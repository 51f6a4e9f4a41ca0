//! The level a step leads to: the mesh where the bodies get to, rates, and the work of swimmers.

use super::configuration::StepConfiguration;
use super::context::StepContext;
use super::error::StepError;
use super::stepper::TimeStepper;
use super::workspace::Workspace;
use crate::body::{Pose, Twist};
use crate::contact::{ContactLoads, Gaps};
use crate::coupling::{PropulsionPower, Solution};
use crate::state::{NewLevel, PowerShare, PropulsionStep, State};

/// What the last iteration of a step has found.
pub(super) struct ConvergedStep<const D: usize> {
    /// Where the bodies get to.
    pub poses: Vec<Pose>,
    pub solution: Solution<D>,
    pub contact: ContactLoads,
}

impl<const D: usize> TimeStepper<'_, D> {
    /// Loads of contact with the smallest gap of bodies at these poses.
    pub(super) fn with_minimum_gap(
        &self,
        contact: ContactLoads,
        gaps: Option<&dyn Gaps>,
        state: &State<D>,
        poses: &[Pose],
    ) -> ContactLoads {
        let Some(gaps) = gaps else { return contact };
        let minimum_gap = gaps.minimum_gap(&state.in_own_frame(self.problem, poses));
        ContactLoads { minimum_gap, ..contact }
    }
}

impl<const D: usize> StepContext<'_, D> {
    /// The new level, with the mesh moved to where the bodies get to.
    ///
    /// # Errors
    /// When it degenerates there.
    pub fn new_level(
        &self,
        work: &mut Workspace<D>,
        configuration: &StepConfiguration<D>,
        end: ConvergedStep<D>,
        propulsion: &[PropulsionPower],
    ) -> Result<NewLevel<D>, StepError> {
        let Self { stepper, state, history, .. } = self;
        let ConvergedStep { poses, solution, contact } = end;
        let bdf = &history.step.bdf;
        let nodes =
            stepper.path.move_mesh(work, stepper.problem, state, &poses, &history.shapes)?;
        let rates = solution.velocity.iter().zip(&history.derivative);
        let twists = solution.twists.iter().zip(&configuration.bodies.bodies);
        Ok(NewLevel {
            time: history.step.time,
            step: bdf.step,
            rates: Some(rates.map(|(new, older)| new * bdf.next + older).collect()),
            accelerations: twists
                .map(|(twist, body)| {
                    Twist::from_vector(&(twist.to_vector() * bdf.next + body.history))
                })
                .collect(),
            nodes,
            poses,
            contact,
            propulsion: propulsion_steps(state, propulsion, bdf.is_second_order()),
            solution,
        })
    }
}

/// What the groups do in a step that ends with these powers: their integral by the trapezoidal rule.
fn propulsion_steps<const D: usize>(
    state: &State<D>,
    ends: &[PropulsionPower],
    is_second_order: bool,
) -> Vec<PropulsionStep> {
    let step = |(end, before): (&PropulsionPower, PropulsionPower)| {
        let share = |power: PropulsionPower, share: f64| PowerShare { power, share };
        // A first-order step comes after a jump: what was before it does not count
        let shares = if is_second_order {
            vec![share(before, 0.5), share(*end, 0.5)]
        } else {
            vec![share(*end, 1.0)]
        };
        PropulsionStep { shares, end: *end }
    };
    ends.iter().zip(state.propulsion.iter().map(|history| history.power())).map(step).collect()
}
