//! `CoupledContact`: what contact knows of one iteration for the poses of a step.

use nalgebra::{DMatrix, DVector};

use super::body_rows::BodyRows;
use super::drag_mobility::BodyDynamics;
use super::loaded_flow::LoadedFlow;
use crate::body::{BodyLoad, LoadedBody, Pose, Twist, Wrench};
use crate::contact::{
    ContactError, ContactLoads, ContactSolution, ContactStep, ElasticBodies, ElasticStep, Gaps, Law,
};

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
    /// Bodies with coordinates, if there are any; `gaps` is of their coordinates before the step.
    pub elastic: Option<ElasticContact<'a>>,
}

/// Bodies with coordinates in the flow of one configuration.
#[derive(Debug)]
pub struct ElasticContact<'a> {
    /// The bodies.
    pub bodies: Box<dyn ElasticBodies + 'a>,
    /// Coordinates without velocity.
    pub unmoved: Vec<f64>,
    /// Coordinates before the step.
    pub start: Vec<f64>,
}

impl ElasticContact<'_> {
    /// Bodies that take part in a contact wherever it is: those with coordinates, which have many velocities, and those that
    /// they are attached to.
    fn all(&self) -> impl Iterator<Item = usize> {
        let ranges = self.bodies.ranges().iter().enumerate();
        let own = ranges.filter(|(_, range)| !range.is_empty()).map(|(body, _)| body);
        own.chain(self.bodies.bases().iter().copied())
    }
}

impl CoupledContact<'_> {
    /// The rows of some bodies.
    pub(super) fn rows<'b>(&self, bodies: &'b [usize]) -> BodyRows<'b> {
        BodyRows { bodies, modes: self.gaps.modes() }
    }

    /// The bodies that may get within the range of something on their way from the start to poses, and those with loads;
    /// ascending.
    pub(super) fn candidate_bodies(&self, reached: &[Pose], loads: &ContactLoads) -> Vec<usize> {
        let bounds = self.gaps.displacement_bounds(&self.start, reached);
        self.candidates_within(&bounds, loads)
    }

    /// The bodies that may be in contact in a flow, as it is without.
    pub(super) fn candidates_in<E: From<ContactError>>(
        &self,
        flow: &dyn LoadedFlow<Error = E>,
    ) -> Vec<usize> {
        let none = ContactLoads::none(self.gaps.n_bodies());
        let Some(elastic) = &self.elastic else {
            let bounds = self.gaps.displacement_bounds(&self.start, &flow.reached());
            return self.candidates_within(&bounds, &none);
        };
        let mut bodies = self.candidates_within(&self.ways_in(elastic, flow), &none);
        if !bodies.is_empty() {
            bodies.extend(elastic.all());
            bodies.sort_unstable();
            bodies.dedup();
        }
        bodies
    }

    /// How far bodies get at most in a flow (m).
    fn ways_in<E: From<ContactError>>(
        &self,
        elastic: &ElasticContact<'_>,
        flow: &dyn LoadedFlow<Error = E>,
    ) -> Vec<f64> {
        let mut ways = self.gaps.displacement_bounds(&self.start, &flow.reached());
        let reached = flow.reached_coordinates();
        let own = elastic.bodies.displacement_bounds(&elastic.start, &reached);
        for ((way, own), range) in ways.iter_mut().zip(own).zip(elastic.bodies.ranges()) {
            *way = if range.is_empty() { *way } else { own };
        }
        ways
    }

    /// Whether all bodies get to where nothing is in the range of anything, in a flow without contact, and cannot have gone
    /// through each other.
    pub(super) fn is_free_in<E: From<ContactError>>(
        &self,
        elastic: &ElasticContact<'_>,
        flow: &dyn LoadedFlow<Error = E>,
    ) -> bool {
        let (mut poses, mut coordinates) = (flow.reached(), flow.reached_coordinates());
        let Some(gaps) = elastic.bodies.place(&mut poses, &mut coordinates) else { return false };
        gaps.pairs(&poses, self.law.range()).is_empty()
            && self.gaps.max_part_of(&self.start, &self.ways_in(elastic, flow)) >= 1.0
    }

    /// Those that may, where bodies move no farther than these lengths (m).
    fn candidates_within(&self, bounds: &[f64], loads: &ContactLoads) -> Vec<usize> {
        let range = self.law.range();
        let mut bodies = self.gaps.candidates_within(&self.start, bounds, CONTACT_MARGIN, range);
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
            elastic: None,
        };
        step.solve()
    }

    /// The forces of contact of all that may be in contact in a flow without, by the mobility of bodies and coordinates.
    ///
    /// # Errors
    /// When they are not found.
    pub(super) fn solve_with_coordinates<E: From<ContactError>>(
        &self,
        elastic: &ElasticContact<'_>,
        bodies: &[usize],
        flow: &dyn LoadedFlow<Error = E>,
        mobility: &DMatrix<f64>,
    ) -> Result<ContactSolution, ContactError> {
        let of_bodies = |twists: &[Twist]| bodies.iter().map(|&body| twists[body]).collect();
        let [free, predicted]: [Vec<Twist>; 2] =
            [flow.twists(), &self.predicted_velocities[..]].map(of_bodies);
        let forces = flow.inner_forces();
        let step = ContactStep {
            gaps: self.gaps,
            law: self.law,
            modes: self.gaps.modes(),
            bodies,
            free_velocities: &free,
            mobility,
            predicted: &self.predicted,
            predicted_velocities: &predicted,
            coefficient: 1.0 / self.dynamics.rate,
            start: &self.start,
            elastic: Some(ElasticStep {
                bodies: elastic.bodies.as_ref(),
                forces: forces.as_ref(),
                unmoved: &elastic.unmoved,
                start: &elastic.start,
                free_rates: flow.rates(),
            }),
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
        flow.add_loads(&changes, &[], tolerance)
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
