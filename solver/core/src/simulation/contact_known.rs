//! `KnownContact`: what a pass knows of contact before its flow is solved.
//!
//! Where each solution takes iterations, the flow of a pass is solved with loads of contact that are nearly right, so
//! that only a small correction is left to be solved for: those of the law where bodies are expected, or those that
//! the pass before has led to.

use nalgebra::DMatrix;

use super::state::State;
use super::stepper::TimeStepper;
use crate::body::{Pose, Wrench};
use crate::contact::{ContactLoads, Gaps};
use crate::coupling::RigidBodyEquations;

/// Contact as far as it is known.
pub(super) struct KnownContact {
    /// Loads on all bodies.
    pub loads: ContactLoads,
    /// What the passes before have learnt.
    pub learnt: Option<Learnt>,
}

/// A mobility that has been learnt.
pub(super) struct Learnt {
    /// Of these bodies, ascending.
    pub bodies: Vec<usize>,
    pub mobility: DMatrix<f64>,
}

impl KnownContact {
    /// Before the first pass of a step, which is to be solved with bodies in these poses: the loads of the law there
    /// where bodies are apart.
    pub fn at_poses<const D: usize>(
        stepper: &TimeStepper<'_, D>,
        state: &State<D>,
        gaps: Option<&dyn Gaps>,
        poses: &[Pose],
    ) -> Self {
        let none = Self { loads: ContactLoads::none(poses.len()), learnt: None };
        let (Some(law), Some(gaps)) = (stepper.contact, gaps) else { return none };
        let loads = ContactLoads::new(gaps, law, &state.in_own_frame(stepper.problem, poses));
        let is_sound = |wrench: &Wrench| wrench.to_vector().iter().all(|part| part.is_finite());
        let are_apart = loads.contacts.iter().all(|contact| contact.pair.gap > 0.0);
        if are_apart && loads.wrenches.iter().all(is_sound) { Self { loads, ..none } } else { none }
    }

    /// No contact at all, and nothing learnt.
    pub fn none(n_bodies: usize) -> Self {
        Self { loads: ContactLoads::none(n_bodies), learnt: None }
    }

    /// Adds the loads to those from outside.
    pub fn load(&self, equations: &mut RigidBodyEquations) {
        for (equation, wrench) in equations.bodies.iter_mut().zip(&self.loads.wrenches) {
            equation.external += wrench.to_vector();
        }
    }
}
