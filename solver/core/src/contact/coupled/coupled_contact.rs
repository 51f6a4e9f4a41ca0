//! `CoupledContact`: what contact knows of one iteration for the poses of a step.

use nalgebra::{DMatrix, DVector};

use super::body_rows::BodyRows;
use super::drag_mobility::BodyDynamics;
use super::loaded_flow::LoadedFlow;
use crate::body::{BodyLoad, LoadedBody, Pose, Twist, Wrench};
use crate::contact::{ContactError, ContactLoads, ContactSolution, ContactStep, Gaps, Law};

/// Bodies that could be in contact within this times their displacement are candidates.
const CONTACT_MARGIN: f64 = 2.0;

/// Contact in the flow of one configuration. Poses are of all bodies, as seen in its mesh.
pub struct CoupledContact<'a> {
    /// Surfaces of bodies and walls.
    pub gaps: &'a dyn Gaps,
    /// The law.
    pub law: &'a Law,
    /// Poses before the step, in which bodies are expected to be apart.
    pub start: Vec<Pose>,
    /// Poses for which the flow is solved.
    pub predicted: Vec<Pose>,
    /// Velocities that lead there (m/s, rad/s).
    pub predicted_velocities: Vec<Twist>,
    /// Inertia and resistance of the bodies themselves.
    pub dynamics: BodyDynamics,
}

impl CoupledContact<'_> {
    /// The rows of some bodies.
    pub(super) fn rows<'b>(&self, bodies: &'b [usize]) -> BodyRows<'b> {
        BodyRows { bodies, modes: self.gaps.modes() }
    }

    /// The bodies that may get within the range of something on their way from the start to poses, and those with loads;
    /// ascending.
    pub(super) fn candidate_bodies(&self, reached: &[Pose], loads: &ContactLoads) -> Vec<usize> {
        let range = self.law.range();
        let mut bodies = self.gaps.candidate_bodies(&self.start, reached, CONTACT_MARGIN, range);
        let wrenches = loads.wrenches.iter().enumerate();
        bodies.extend(wrenches.filter(|(_, load)| is_load(load)).map(|(body, _)| body));
        bodies.sort_unstable();
        bodies.dedup();
        bodies
    }

    /// Bodies as a mobility is asked for them.
    pub(super) fn loaded(&self, bodies: &[usize]) -> Vec<LoadedBody> {
        loaded_bodies(self.gaps, self.law, bodies)
    }

    /// Loads on some bodies, by row.
    pub(super) fn loads(&self, bodies: &[usize], loads: &ContactLoads) -> DVector<f64> {
        self.rows(bodies).of(|body| loads.wrenches[body].to_vector())
    }

    /// The forces of contact for bodies with these velocities, in which loads have been applied already, by a mobility
    /// of the bodies that may be in contact.
    ///
    /// # Errors
    /// When they are not found.
    pub(super) fn solve(
        &self,
        bodies: &[usize],
        twists: &[Twist],
        applied: &ContactLoads,
        mobility: &DMatrix<f64>,
    ) -> Result<ContactSolution, ContactError> {
        let rows = self.rows(bodies);
        let pushed = mobility * self.loads(bodies, applied);
        self.solve_without_loads(bodies, &(rows.of_twists(twists) - pushed), mobility)
    }

    /// The forces of contact for bodies with these velocities without contact, by row.
    ///
    /// # Errors
    /// When they are not found.
    pub(super) fn solve_without_loads(
        &self,
        bodies: &[usize],
        free_velocities: &DVector<f64>,
        mobility: &DMatrix<f64>,
    ) -> Result<ContactSolution, ContactError> {
        let rows = self.rows(bodies);
        let predicted_velocities: Vec<Twist> =
            bodies.iter().map(|&body| self.predicted_velocities[body]).collect();
        let step = ContactStep {
            gaps: self.gaps,
            law: self.law,
            modes: rows.modes,
            bodies,
            free_velocities: &rows.twists(free_velocities),
            mobility,
            predicted: &self.predicted,
            predicted_velocities: &predicted_velocities,
            coefficient: 1.0 / self.dynamics.rate,
            start: &self.start,
        };
        step.solve()
    }

    /// Replaces loads in a flow by others.
    ///
    /// # Errors
    /// When the linear system cannot be solved.
    pub(super) fn replace<E: From<ContactError>>(
        &self,
        flow: &mut dyn LoadedFlow<Error = E>,
        applied: &mut ContactLoads,
        next: ContactLoads,
        tolerance: Option<f64>,
    ) -> Result<(), E> {
        let changes = changed_loads(applied, &next);
        *applied = next;
        flow.add_loads(&changes, tolerance)
    }
}

/// Bodies as a mobility is asked for them: without friction contact does not turn those that are round.
pub(super) fn loaded_bodies(gaps: &dyn Gaps, law: &Law, bodies: &[usize]) -> Vec<LoadedBody> {
    let turns = |body: usize| law.turns_round_bodies() || !gaps.is_round(body);
    let loaded = |&body: &usize| LoadedBody { body, turns: turns(body) };
    bodies.iter().map(loaded).collect()
}

/// What is to be added to some loads of contact to get others.
pub(super) fn changed_loads(from: &ContactLoads, to: &ContactLoads) -> Vec<BodyLoad> {
    let pairs = from.wrenches.iter().zip(&to.wrenches).enumerate();
    let changes =
        pairs.map(|(body, (old, new))| BodyLoad { body, load: new.to_vector() - old.to_vector() });
    changes.filter(|on_body| on_body.load.iter().any(|part| *part != 0.0)).collect()
}

fn is_load(wrench: &Wrench) -> bool {
    wrench.to_vector().iter().any(|part| *part != 0.0)
}
