//! The energy of bodies in contact over a step, by which it is too long or not.

use std::ops::Range;

use nalgebra::{DMatrix, DVector, Vector3};

use crate::body::Twist;
use crate::contact::{BodyInStep, ContactEnergy, ContactLoads, ElasticMotion, Gaps, StepEnergy};
use crate::coupling::{RigidBody, RigidBodyEquation, Solution};
use crate::step::configuration::StepConfiguration;
use crate::step::context::StepContext;
use crate::step::placement::Placement;
use crate::step::stepper::TimeStepper;
use crate::structure::BaseMotion;
use crate::time::Bdf;

/// What a step leads to.
pub(in crate::step) struct StepEnd<'a, const D: usize> {
    /// Gaps there.
    pub gaps: Option<&'a dyn Gaps>,
    pub solution: &'a Solution<D>,
    /// Where bodies are.
    pub reached: &'a Placement,
    /// Loads of contact.
    pub loads: &'a ContactLoads,
}

impl<const D: usize> StepContext<'_, D> {
    /// What the step does to the energy of bodies in contact.
    pub(in crate::step) fn contact_energy(
        &self,
        configuration: &StepConfiguration<D>,
        end: &StepEnd<'_, D>,
    ) -> ContactEnergy {
        let Self { stepper: TimeStepper { problem, contact, .. }, state, history, .. } = self;
        let StepEnd { solution, reached, loads, .. } = *end;
        let (Some(law), Some(before), Some(after)) = (contact, self.gaps(), end.gaps) else {
            return ContactEnergy::default();
        };
        let minima = [state.contact.minimum_gap, loads.minimum_gap];
        if minima.into_iter().flatten().all(|minimum| minimum.gap >= law.range()) {
            return ContactEnergy::default();
        }
        let equations = &configuration.bodies.bodies;
        let elastic = self.elastic_motions(end);
        let body = |((body, equation), elastic): ((usize, &RigidBodyEquation), _)| BodyInStep {
            inertia: problem.free_inertia(body, &equation.inertia),
            twists: [state.now.twists[body], solution.twists[body]],
            accelerations: [
                state.accelerations[body],
                acceleration(&history.step.bdf, &solution.twists[body], equation),
            ],
            displacement: reached.poses[body].displacement_from(&state.poses[body]),
            is_alone: problem.is_alone(body),
            elastic,
        };
        let bodies: Vec<BodyInStep> = equations.iter().enumerate().zip(elastic).map(body).collect();
        let seen =
            [&state.poses[..], &reached.poses].map(|poses| state.in_own_frame(problem, poses));
        let [start, end] = &seen;
        let is_second_order = history.step.bdf.is_second_order();
        let (gaps, poses) = ([before, after], [&start[..], end]);
        StepEnergy { gaps, law, poses, bodies: &bodies, loads, is_second_order }.measure()
    }

    /// What bodies with coordinates do in the step, by body.
    fn elastic_motions(&self, end: &StepEnd<'_, D>) -> Vec<Option<ElasticMotion>> {
        let Self { stepper: TimeStepper { problem, .. }, state, history, .. } = self;
        let accelerations = history.accelerations_with(state, &end.solution.rates);
        let held: Vec<usize> = problem
            .held_coordinates(history.step.time)
            .iter()
            .map(|held| held.coordinate)
            .chain(problem.attached_coordinates().iter().map(|at| at.coordinate))
            .collect();
        let motion = |(body, own): (&RigidBody, Range<usize>)| {
            let flexible = body.flexible()?;
            let of = |all: &[f64]| DVector::from_column_slice(&all[own.clone()]);
            let after = of(&end.reached.coordinates);
            let mass = flexible.mass();
            let forces = &mass * of(&accelerations);
            let along = |axis: usize| {
                let velocity = Vector3::ith(axis, 1.0);
                let motion = BaseMotion { velocity, ..BaseMotion::default() };
                flexible.rigid_velocities(&after, &motion).map_or(0.0, |all| all.dot(&forces))
            };
            let momentum_rate = Vector3::from_fn(|axis, _| along(axis));
            let is_held = |at: usize| held.contains(&(own.start + at));
            Some(ElasticMotion {
                rates: [of(&state.now.rates), of(&end.solution.rates)],
                displacement: &after - of(&state.shapes.now),
                response: if problem.has_inertia { response(mass, is_held) } else { None },
                momentum_rate: body.pose.to_world(&momentum_rate),
            })
        };
        problem.bodies.iter().zip(problem.coordinates()).map(motion).collect()
    }
}

/// The inverse of a mass matrix, zero for coordinates that are held; none of a matrix that is singular.
fn response(mut mass: DMatrix<f64>, is_held: impl Fn(usize) -> bool) -> Option<DMatrix<f64>> {
    let held: Vec<usize> = (0..mass.nrows()).filter(|at| is_held(*at)).collect();
    for &at in &held {
        mass.row_mut(at).fill(0.0);
        mass.column_mut(at).fill(0.0);
        mass[(at, at)] = 1.0;
    }
    let mut inverse = mass.cholesky()?.inverse();
    for &at in &held {
        inverse[(at, at)] = 0.0;
    }
    Some(inverse)
}

/// The rate of the velocities of a body at the new time (m/s2, rad/s2).
pub(in crate::step) fn acceleration(
    bdf: &Bdf,
    twist: &Twist,
    equation: &RigidBodyEquation,
) -> Twist {
    Twist::from_vector(&(twist.to_vector() * bdf.next + equation.history))
}
