//! The energy of bodies in contact over a step, by which it is too long or not.

use crate::body::{Pose, Twist};
use crate::contact::{BodyInStep, ContactEnergy, ContactLoads, StepEnergy};
use crate::coupling::RigidBodyEquation;
use crate::step::configuration::StepConfiguration;
use crate::step::context::StepContext;
use crate::step::stepper::TimeStepper;
use crate::time::Bdf;

impl<const D: usize> StepContext<'_, D> {
    /// What the step does to the energy of bodies in contact.
    pub(in crate::step) fn contact_energy(
        &self,
        configuration: &StepConfiguration<D>,
        twists: &[Twist],
        reached: &[Pose],
        loads: &ContactLoads,
    ) -> ContactEnergy {
        let Self { stepper: TimeStepper { problem, contact, .. }, state, history, .. } = self;
        let (Some(law), Some(gaps)) = (contact, self.gaps()) else {
            return ContactEnergy::default();
        };
        let minima = [state.contact.minimum_gap, loads.minimum_gap];
        if minima.into_iter().flatten().all(|minimum| minimum.gap >= law.range()) {
            return ContactEnergy::default();
        }
        let equations = &configuration.bodies.bodies;
        let body = |(body, equation): (usize, &RigidBodyEquation)| BodyInStep {
            inertia: problem.free_inertia(body, &equation.inertia),
            twists: [state.now.twists[body], twists[body]],
            accelerations: [
                state.accelerations[body],
                acceleration(&history.step.bdf, &twists[body], equation),
            ],
            displacement: reached[body].displacement_from(&state.poses[body]),
            is_alone: problem.is_alone(body),
        };
        let bodies: Vec<BodyInStep> = equations.iter().enumerate().map(body).collect();
        let seen = [&state.poses[..], reached].map(|poses| state.in_own_frame(problem, poses));
        let [start, end] = &seen;
        let is_second_order = history.step.bdf.is_second_order();
        StepEnergy { gaps, law, poses: [start, end], bodies: &bodies, loads, is_second_order }
            .measure()
    }
}

/// The rate of the velocities of a body at the new time (m/s2, rad/s2).
pub(in crate::step) fn acceleration(
    bdf: &Bdf,
    twist: &Twist,
    equation: &RigidBodyEquation,
) -> Twist {
    Twist::from_vector(&(twist.to_vector() * bdf.next + equation.history))
}
