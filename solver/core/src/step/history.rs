//! `StepHistory`: the older levels of a step, with what follows from them.

use std::ops::Range;
use std::sync::Arc;

use alewife_mesh::Point;
use nalgebra::DVector;

use super::error::StepError;
use super::stepper::{Step, TimeStepper};
use crate::body::{Inertia, Pose, RigidVector, Twist, carried_velocity};
use crate::coupling::{
    AttachedCoordinate, BodyShapes, FlexibleEquation, PosesByVelocity, Problem, RigidBody,
    RigidBodyEquations, ShapeError, Solution, TurningBase,
};
use crate::state::State;
use crate::structure::Held;
use crate::time::Bdf;

/// Part of a step by which rates at its ends are evaluated inside it: those that jump there have two.
pub const INSIDE: f64 = 1e-9;

/// What a step knows before it is made.
pub struct StepHistory<const D: usize> {
    /// The step.
    pub step: Step,
    /// The bodies at the new time, those with coordinates as these are extrapolated.
    pub shapes: BodyShapes,
    /// The bodies just before the new time, where rates may jump at it.
    before_jump: Option<BodyShapes>,
    /// Older part of du/dt at the nodes (m/s2).
    pub derivative: Vec<Point<D>>,
    /// All unknowns extrapolated to the new time.
    pub extrapolated: Solution<D>,
    /// Velocity of the frame extrapolated to the new time (m/s).
    pub frame_velocity: Point<D>,
    /// The constant part of the update of poses: those of bodies without velocity at the new time.
    unmoved: Vec<Pose>,
    /// The constant part of the update of coordinates.
    unmoved_coordinates: Vec<f64>,
    /// Coordinates that are given at the new time.
    held: Vec<Held>,
    /// Older part of the rates of change of their rates.
    coordinate_derivative: Vec<f64>,
    /// The bodies at the present level and the one before; none of an instantaneous flow.
    older: Option<[OlderBodies; 2]>,
}

/// Bodies at an older level.
struct OlderBodies {
    inertia: Vec<Inertia>,
    poses: Vec<Pose>,
    twists: Vec<Twist>,
}

impl OlderBodies {
    fn new<const D: usize>(
        problem: &Problem<D>,
        time: f64,
        poses: &[Pose],
        twists: &[Twist],
    ) -> Result<Self, StepError> {
        let inertia =
            |body: &RigidBody| -> Result<Inertia, StepError> { Ok(body.inertia_at(time)?) };
        Ok(Self {
            inertia: problem.bodies.iter().map(inertia).collect::<Result<_, _>>()?,
            poses: poses.to_vec(),
            twists: twists.to_vec(),
        })
    }
}

impl<const D: usize> StepHistory<D> {
    /// That of a step from a state.
    ///
    /// # Errors
    /// When a gait gives its body no shape.
    pub fn new(
        stepper: &TimeStepper<'_, D>,
        state: &State<D>,
        step: Step,
    ) -> Result<Self, StepError> {
        let problem = stepper.problem;
        let Step { time, bdf, .. } = step;
        let levels = || state.now.velocity.iter().zip(&state.previous.velocity);
        let before_jump = problem
            .rate_discontinuities
            .is_some()
            .then(|| BodyShapes::at(&problem.bodies, time - INSIDE * bdf.step))
            .transpose()?;
        let extrapolated = extrapolate(state, &step);
        let held = problem.held_coordinates(time);
        let inertial = f64::from(u8::from(problem.has_inertia));
        let coordinates = integrate_coordinates(state, &step, &held, &extrapolated.rates);
        let rates = state.now.rates.iter().zip(&state.previous.rates);
        let older = |time: f64, poses: &[Pose], twists: &[Twist]| {
            OlderBodies::new(problem, time, poses, twists)
        };
        Ok(Self {
            // A guess may bend a body too far
            shapes: BodyShapes::with(&problem.bodies, time, &coordinates)
                .or_else(|_| BodyShapes::with(&problem.bodies, time, &state.shapes.now))?,
            before_jump,
            derivative: levels().map(|(now, before)| bdf.history(*now, *before)).collect(),
            extrapolated,
            frame_velocity: bdf.extrapolate(
                problem.frame_velocity(&state.now.twists),
                problem.frame_velocity(&state.previous.twists),
            ),
            unmoved: stepper.unmoved_poses(state, &step),
            unmoved_coordinates: unmoved_coordinates(state, &step, &held),
            held,
            coordinate_derivative: rates
                .map(|(now, before)| inertial * bdf.history(*now, *before))
                .collect(),
            older: Some([
                older(state.time, &state.poses, &state.now.twists)?,
                older(state.time_before(), &state.previous_poses, &state.previous.twists)?,
            ]),
            step,
        })
    }

    /// That of an instantaneous flow of bodies at poses in a step of a number, without inertia: bodies have their
    /// shapes at a time (s), and rates of gaits and boundary values are those at another one.
    ///
    /// # Errors
    /// When a gait gives its body no shape.
    pub fn instantaneous(
        problem: &Problem<D>,
        number: usize,
        poses: &[Pose],
        time: f64,
        rates_at: f64,
    ) -> Result<Self, StepError> {
        Ok(Self {
            // Without density its coefficients multiply nothing
            step: Step { number, time, bdf: Bdf::first_order(1.0) },
            shapes: BodyShapes::at(&problem.bodies, time)?,
            before_jump: Some(BodyShapes::at(&problem.bodies, rates_at)?),
            derivative: Vec::new(),
            extrapolated: Solution {
                velocity: Vec::new(),
                pressure: Vec::new(),
                twists: Vec::new(),
                rates: Vec::new(),
                pressure_gradient: Point::<D>::zeros(),
            },
            frame_velocity: Point::<D>::zeros(),
            unmoved: poses.to_vec(),
            unmoved_coordinates: Vec::new(),
            held: Vec::new(),
            coordinate_derivative: Vec::new(),
            older: None,
        })
    }

    /// The bodies at the time at which boundary values and rates of gaits are taken.
    pub fn boundary_shapes(&self) -> &BodyShapes {
        self.before_jump.as_ref().unwrap_or(&self.shapes)
    }

    /// The bodies with coordinates at that time, from those at the new time.
    ///
    /// # Errors
    /// When they give a body no shape.
    pub fn boundary_shapes_with(
        &self,
        problem: &Problem<D>,
        coordinates: &[f64],
        at_new_time: &BodyShapes,
    ) -> Result<BodyShapes, ShapeError> {
        match &self.before_jump {
            Some(shapes) => shapes.with_coordinates(&problem.bodies, coordinates),
            None => Ok(at_new_time.clone()),
        }
    }

    /// Newton's and Euler's equations with bodies at these poses at the new time.
    pub fn body_equations(&self, problem: &Problem<D>, poses: &[Pose]) -> RigidBodyEquations {
        let Step { time, bdf, .. } = self.step;
        let mut equations = RigidBodyEquations::without_loads(problem.bodies.len());
        let Some(older) = &self.older else {
            let time = self.boundary_shapes().time();
            equations.add_loads(problem, time, PosesByVelocity::staying(&self.unmoved));
            return equations;
        };
        equations.rate = bdf.next;
        for (body, equation) in equations.bodies.iter_mut().enumerate() {
            let inertia = problem.bodies[body].inertia_with(self.shapes.deformed(body));
            equation.inertia = inertia.matrix(&poses[body]);
            let [now, before] = older.each_ref().map(|older| -> RigidVector {
                let then = older.inertia[body].matrix(&older.poses[body]);
                let velocity = older.twists[body].to_vector();
                carried_velocity(&then, &equation.inertia, &velocity, problem.modes())
            });
            equation.history = bdf.history(now, before);
        }
        equations.flexible = self.flexible_equations(problem, poses);
        let unmoved = &self.unmoved;
        let reached = PosesByVelocity { unmoved, expected: poses, coefficient: 1.0 / bdf.next };
        equations.add_loads(problem, time, reached);
        equations
    }
}

impl<const D: usize> StepHistory<D> {
    /// The equations of the coordinates of bodies at the new time.
    fn flexible_equations(&self, problem: &Problem<D>, poses: &[Pose]) -> Vec<FlexibleEquation> {
        let Step { time, bdf, .. } = self.step;
        let unmoved = self.unmoved_with(problem, poses);
        let bodies = problem.bodies.iter().zip(problem.coordinates());
        let equation = |(body, own): (&RigidBody, Range<usize>)| {
            Some(FlexibleEquation {
                first: own.start,
                body: Arc::clone(body.flexible()?),
                rate: if problem.has_inertia { bdf.next } else { 0.0 },
                history: DVector::from_column_slice(&self.coordinate_derivative[own.clone()]),
                unmoved: DVector::from_column_slice(&unmoved[own]),
                coefficient: 1.0 / bdf.next,
                relaxation: 0.0,
                is_unloaded: false,
                base: turning_base(body, poses),
                time,
            })
        };
        bodies.filter_map(equation).collect()
    }

    /// Coordinates from which the rates at the new time lead there, with bodies expected at poses to which some are fixed.
    fn unmoved_with(&self, problem: &Problem<D>, poses: &[Pose]) -> Vec<f64> {
        let mut unmoved = self.unmoved_coordinates.clone();
        let rate = self.step.bdf.next;
        for AttachedCoordinate { coordinate, own, to, given } in problem.attached_coordinates() {
            let (seen_from, pose) = (&problem.bodies[own].pose, &poses[to]);
            // The velocity that leads to the pose, as it is integrated: in space turns do not commute
            let from = self.older.as_ref().map_or(&self.unmoved[to], |[now, _]| &now.poses[to]);
            let led = pose.displacement_from(from) - self.unmoved[to].displacement_from(from);
            let way = given.rate(seen_from, pose, &Twist::from_vector(&(led * rate))) / rate;
            unmoved[coordinate] = given.value(seen_from, pose) - way;
        }
        unmoved
    }

    /// Coordinates at the new time with these rates there.
    pub fn coordinates_with(&self, state: &State<D>, rates: &[f64]) -> Vec<f64> {
        integrate_coordinates(state, &self.step, &self.held, rates)
    }

    /// Rates of change of these rates of coordinates at the new time.
    pub fn accelerations_with(&self, state: &State<D>, rates: &[f64]) -> Vec<f64> {
        let levels = state.now.rates.iter().zip(&state.previous.rates);
        let rate =
            |(new, (now, before)): (&f64, (&f64, &f64))| self.step.bdf.rate(*new, *now, *before);
        rates.iter().zip(levels).map(rate).collect()
    }
}

/// The end of a body that is clamped to another one, with that at its pose.
fn turning_base(body: &RigidBody, poses: &[Pose]) -> Option<TurningBase> {
    let attachment = body.attachment.as_ref()?;
    TurningBase::new(&attachment.coordinates, &body.pose, &poses[attachment.to])
}

/// Coordinates of all bodies at the new time with these rates there, and those that are given.
fn integrate_coordinates<const D: usize>(
    state: &State<D>,
    step: &Step,
    held: &[Held],
    rates: &[f64],
) -> Vec<f64> {
    let levels = state.shapes.now.iter().zip(&state.shapes.before);
    let integrated =
        levels.zip(rates).map(|((now, before), rate)| step.bdf.integrate(*rate, *now, *before));
    let mut coordinates: Vec<f64> = integrated.collect();
    held.iter().for_each(|held| coordinates[held.coordinate] = held.value);
    coordinates
}

/// Coordinates from which the rates at the new time lead there.
fn unmoved_coordinates<const D: usize>(state: &State<D>, step: &Step, held: &[Held]) -> Vec<f64> {
    let at_rest = vec![0.0; state.shapes.now.len()];
    let mut unmoved = integrate_coordinates(state, step, held, &at_rest);
    for Held { coordinate, value, rate } in held {
        unmoved[*coordinate] = value - rate / step.bdf.next;
    }
    unmoved
}

/// All unknowns extrapolated to the new time: nearer to the new level than the present one, so that
/// less is left for an iterative solve.
fn extrapolate<const D: usize>(state: &State<D>, step: &Step) -> Solution<D> {
    let (now, previous, bdf) = (&state.now, &state.previous, &step.bdf);
    let velocities = now.velocity.iter().zip(&previous.velocity);
    let pressures = now.pressure.iter().zip(&previous.pressure);
    let twists = now.twists.iter().zip(&previous.twists);
    let rates = now.rates.iter().zip(&previous.rates);
    Solution {
        velocity: velocities.map(|(now, before)| bdf.extrapolate(*now, *before)).collect(),
        pressure: pressures.map(|(now, before)| bdf.extrapolate(*now, *before)).collect(),
        twists: twists
            .map(|(now, before)| {
                Twist::from_vector(&bdf.extrapolate(now.to_vector(), before.to_vector()))
            })
            .collect(),
        rates: rates.map(|(now, before)| bdf.extrapolate(*now, *before)).collect(),
        pressure_gradient: bdf.extrapolate(now.pressure_gradient, previous.pressure_gradient),
    }
}
