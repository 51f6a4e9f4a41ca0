//! The discrete adjoint: exact derivatives of an objective by all parameters of a motion, for the price of one more.

use alewife_interrupt::check;
use alewife_solid::material::Kinematics;
use alewife_solid::solid::{Difference, Factor, Potential, SolidError, StrainLevel};

use super::SoftError;
use super::body::SoftBody;
use super::curve::Curve;
use super::facets::FacetLaw;
use super::motion::{Plan, Trajectory};
use super::objective::Objective;

/// Derivatives of an objective.
#[derive(Debug, Clone, PartialEq)]
pub struct Gradient {
    /// By the Young's modulus (1/Pa) of each material.
    pub young: Vec<f64>,
    /// By the Poisson's ratio of each material.
    pub poisson: Vec<f64>,
    /// By the stiffness (1/Pa) of each set of fibres.
    pub fibre_stiffness: Vec<f64>,
    /// By the stretches each set of fibres is told, frame by frame.
    pub targets: Vec<Vec<f64>>,
    /// By the points of the curve of drag.
    pub drag: Vec<f64>,
    /// By the points of the curve of thrust.
    pub thrust: Vec<f64>,
    /// By the places of all nodes at rest (1/m); empty where it was not asked for.
    pub shape: Vec<f64>,
}

/// An objective with its derivatives, and the motion.
#[derive(Debug, Clone, PartialEq)]
pub struct WithGradient {
    /// The objective.
    pub value: f64,
    /// Its derivatives.
    pub gradient: Gradient,
    /// The motion.
    pub trajectory: Trajectory,
}

/// Derivatives of an objective by what it is made of directly.
#[derive(Debug, Clone, PartialEq)]
pub struct Seeds {
    /// By the places of all levels.
    pub places: Vec<Vec<f64>>,
    /// By the stretches each set of fibres is told, frame by frame.
    pub targets: Vec<Vec<f64>>,
    /// By the stiffness of each set of fibres.
    pub fibre_stiffness: Vec<f64>,
    /// By the places of all nodes at rest.
    pub rest: Vec<f64>,
}

/// The way back through a motion.
struct Backward<'a, const D: usize> {
    body: &'a SoftBody<D>,
    plan: &'a Plan,
    trajectory: &'a Trajectory,
    held: Vec<usize>,
    /// Derivatives of the rest of the objective by the places of each level.
    places: Vec<Vec<f64>>,
    /// And by its velocities.
    velocities: Vec<Vec<f64>>,
    factor: Option<Factor>,
    gradient: Gradient,
}

/// Adds a multiple of a list.
fn add(to: &mut [f64], factor: f64, from: &[f64]) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to += factor * from);
}

impl<const D: usize> SoftBody<D> {
    /// The objective of a motion.
    #[must_use]
    pub fn value(&self, trajectory: &Trajectory, objective: &dyn Objective) -> f64 {
        let rest = self.solid.at_rest();
        let mut aside = [vec![0.0; rest.len()], vec![0.0; rest.len()]];
        let [by_places, by_rest] = &mut aside;
        let levels = trajectory.levels.iter().enumerate();
        levels.map(|(n, level)| objective.at(n, level, &rest, by_places, by_rest)).sum()
    }

    /// Moves the body as planned, and goes back through all steps.
    ///
    /// # Errors
    /// Those of [`SoftBody::simulate`].
    pub fn with_gradient(
        &self,
        plan: &Plan,
        objective: &dyn Objective,
        with_shape: bool,
    ) -> Result<WithGradient, SoftError> {
        let trajectory = self.simulate(plan)?;
        let mut seeds = self.no_seeds(plan);
        let value = self.add_seeds(&trajectory, objective, 1.0, &mut seeds);
        let gradient = self.gradient(plan, &trajectory, seeds, with_shape)?;
        Ok(WithGradient { value, gradient, trajectory })
    }

    /// Derivatives of what depends on nothing.
    #[must_use]
    pub fn no_seeds(&self, plan: &Plan) -> Seeds {
        let n = self.solid.n_components();
        Seeds {
            places: vec![vec![0.0; n]; plan.n_steps() + 1],
            targets: vec![vec![0.0; self.solid.spec().fibres.len()]; plan.targets.len()],
            fibre_stiffness: vec![0.0; self.solid.spec().fibres.len()],
            rest: vec![0.0; n],
        }
    }

    /// The objective of a motion; a multiple of its derivatives is added to those there are.
    pub fn add_seeds(
        &self,
        trajectory: &Trajectory,
        objective: &dyn Objective,
        factor: f64,
        seeds: &mut Seeds,
    ) -> f64 {
        let rest = self.solid.at_rest();
        let mut value = 0.0;
        let mut by_rest = vec![0.0; rest.len()];
        for (number, level) in trajectory.levels.iter().enumerate() {
            let mut by_places = vec![0.0; rest.len()];
            value += objective.at(number, level, &rest, &mut by_places, &mut by_rest);
            add(&mut seeds.places[number], factor, &by_places);
        }
        add(&mut seeds.rest, factor, &by_rest);
        value
    }

    /// The derivatives of an objective by all parameters, from those by what it is made of: goes back through all
    /// steps of a motion.
    ///
    /// # Errors
    /// [`SoftError::Step`] where a step has no derivative, and [`SoftError::Stopped`].
    pub fn gradient(
        &self,
        plan: &Plan,
        trajectory: &Trajectory,
        seeds: Seeds,
        with_shape: bool,
    ) -> Result<Gradient, SoftError> {
        let n_steps = plan.n_steps();
        let Seeds { places, targets, fibre_stiffness, rest } = seeds;
        let mut back = Backward {
            body: self,
            plan,
            trajectory,
            held: self.solid.held(),
            velocities: vec![vec![0.0; rest.len()]; n_steps + 1],
            places,
            factor: None,
            gradient: Gradient { targets, fibre_stiffness, ..self.no_gradient(with_shape) },
        };
        for step in (0..n_steps).rev() {
            check()?;
            let failed = |error| SoftError::Step { step: step + 1, n_steps, error };
            back.step(step).map_err(failed)?;
        }
        Ok(back.finish(&rest))
    }

    fn no_gradient(&self, with_shape: bool) -> Gradient {
        let spec = self.solid.spec();
        let n_points = |curve: fn(&FacetLaw) -> &Curve| {
            self.law.as_ref().map_or(0, |law| curve(law).points().len())
        };
        Gradient {
            young: vec![0.0; spec.materials.len()],
            poisson: vec![0.0; spec.materials.len()],
            fibre_stiffness: Vec::new(),
            targets: Vec::new(),
            drag: vec![0.0; n_points(|law| &law.drag)],
            thrust: vec![0.0; n_points(|law| &law.thrust)],
            shape: vec![0.0; if with_shape { self.solid.n_components() } else { 0 }],
        }
    }
}

impl<const D: usize> Backward<'_, D> {
    /// Goes back from the level after a step to those before it: with the residual r of the step and z = K^-1 b,
    /// where b are the derivatives by the places reached, those by all that r depends on are -z . dr.
    fn step(&mut self, step: usize) -> Result<(), SolidError> {
        let Self { body, plan, .. } = *self;
        let (levels, solid) = (&self.trajectory.levels, &body.solid);
        let motion = Trajectory::motion(levels, step);
        let targets = &plan.targets[plan.frame_of(step)];
        // Loads are dead: derivatives ask for them only where their torque changes with what a rigid part turns
        let loads = if solid.spec().rigid.is_empty() {
            vec![0.0; motion.places.len()]
        } else {
            body.loads(&motion.places, &motion.velocities)
        };
        let potential =
            solid.potential_of_step(&motion, plan.scheme, plan.step(), targets, &loads)?;
        let reached = &levels[step + 1].places;
        let difference = Difference::new(plan.scheme, plan.step(), motion.before.is_some());
        let [a0, a1, a2] = difference.factors;
        let mut by_velocity = std::mem::take(&mut self.velocities[step + 1]);
        for component in &self.held {
            by_velocity[*component] = 0.0;
        }
        let mut right = self.places[step + 1].clone();
        add(&mut right, a0, &by_velocity);
        let known = solid.kinematics(reached);
        let z = solid.solve_at(&potential, reached, &known, &right, &mut self.factor)?;
        self.add_parameters(step, &potential, &known, &z)?;
        let slopes = body.load_slopes(&motion.places, &motion.velocities, &z);
        add(&mut self.places[step], 1.0, &slopes.places);
        add(&mut self.velocities[step], 1.0, &slopes.velocities);
        add(&mut self.gradient.drag, 1.0, &slopes.drag);
        add(&mut self.gradient.thrust, 1.0, &slopes.thrust);
        // Where the nodes would coast to: -(a_1 x_n + a_2 x_(n-1))/a_0 - (a_1 v_n + a_2 v_(n-1))/a_0^2
        let mut coasted = solid.times_mass(&z);
        for component in &self.held {
            coasted[*component] = 0.0;
        }
        for (before, factor) in [a1, a2].into_iter().enumerate().filter(|(_, a)| *a != 0.0) {
            add(&mut self.places[step - before], -factor * a0, &coasted);
            add(&mut self.velocities[step - before], -factor, &coasted);
            add(&mut self.places[step - before], factor, &by_velocity);
        }
        Ok(())
    }

    /// Adds what moduli, fibres and the shape contribute in a step, and what its damping has of levels before.
    fn add_parameters(
        &mut self,
        step: usize,
        potential: &Potential<'_, D>,
        known: &[Kinematics],
        z: &[f64],
    ) -> Result<(), SolidError> {
        let (levels, solid) = (&self.trajectory.levels, &self.body.solid);
        let has_before = step > 0;
        let difference = Difference::new(self.plan.scheme, self.plan.step(), has_before);
        let [a0, a1, a2] = difference.factors;
        let strains: Vec<StrainLevel<'_>> = [a1, a2]
            .into_iter()
            .enumerate()
            .filter(|(_, a)| *a != 0.0)
            .map(|(k, a)| StrainLevel { factor: -a / a0, places: &levels[step - k].places })
            .collect();
        let reached = &levels[step + 1].places;
        let with_shape = !self.gradient.shape.is_empty();
        let found =
            solid.sensitivity(potential, reached, known, z, with_shape.then_some(&strains[..]))?;
        let gradient = &mut self.gradient;
        add(&mut gradient.young, -1.0, &found.young);
        add(&mut gradient.poisson, -1.0, &found.poisson);
        add(&mut gradient.fibre_stiffness, -1.0, &found.fibre_stiffness);
        add(&mut gradient.targets[self.plan.frame_of(step)], -1.0, &found.targets);
        add(&mut gradient.shape, -1.0, &found.shape);
        if with_shape {
            for component in &self.held {
                gradient.shape[*component] -= found.places[*component];
            }
        }
        let damped = solid.damping_by_levels(potential, reached, z, &strains)?;
        for (before, forces) in damped.iter().enumerate() {
            add(&mut self.places[step - before], -1.0, forces);
        }
        Ok(())
    }

    /// The gradient, with what the start and what is held contribute to that by the shape: the body starts as it
    /// is at rest, and what is held stays there.
    fn finish(mut self, by_rest: &[f64]) -> Gradient {
        if self.gradient.shape.is_empty() {
            return self.gradient;
        }
        for places in &self.places[1..] {
            for component in &self.held {
                self.gradient.shape[*component] += places[*component];
            }
        }
        add(&mut self.gradient.shape, 1.0, &self.places[0]);
        add(&mut self.gradient.shape, 1.0, by_rest);
        self.gradient.shape.truncate(self.body.solid.n_places());
        self.gradient
    }
}
