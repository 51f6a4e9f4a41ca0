//! The mean flow of a system: its pressure gradient, and how given mean velocities are met.

use alewife_mesh::Point;

use super::super::error::SolveError;
use super::super::problem::MeanFlowAt;
use super::super::rigid_equations::RigidBodyEquation;
use super::super::solution::Solution;
use super::super::system::{Configuration, FluidSystem};
use super::{MeanFlowReport, ResponseSystem, with_given_gradients};
use crate::body::{Mode, Wrench, in_space};
use crate::timing::Timing;

/// Difference of a mean velocity from the given one that is rounding.
const MEAN_VELOCITY: f64 = 1e-10;

impl<const D: usize> FluidSystem<D> {
    /// Load of the mean pressure gradient on a body, as that of gravity on the fluid it displaces.
    #[must_use]
    pub fn mean_load(&self, body: usize, solution: &Solution<D>) -> Wrench {
        let Some(cell) = &self.cell else { return Wrench::default() };
        let force = -in_space(&solution.pressure_gradient) * cell.body_volume(body);
        Wrench { force, ..Wrench::default() }
    }

    /// The mean flow of a solution, where one is given.
    #[must_use]
    pub fn mean_flow(
        &self,
        given: &MeanFlowAt<D>,
        solution: &Solution<D>,
    ) -> Option<MeanFlowReport> {
        let cell = self.cell.as_ref()?;
        let (velocity, pressure_gradient) =
            (cell.mean_velocity(solution), solution.pressure_gradient);
        let power = given.body_force.dot(&cell.fluid_integral(solution))
            - pressure_gradient.dot(&velocity) * cell.volume();
        let force = (given.body_force - pressure_gradient) * cell.fluid_volume();
        let [pressure_gradient, velocity, force] =
            [pressure_gradient, velocity, force].map(|v| in_space(&v));
        Some(MeanFlowReport { pressure_gradient, velocity, power, force })
    }

    /// A solution with the pressure gradients that are given, and those that balance the forces on fluid
    /// and bodies where a mean velocity is given and nothing else holds them.
    #[must_use]
    pub fn with_given_gradients(
        &self,
        at: &Configuration<'_, D>,
        solution: Solution<D>,
    ) -> Solution<D> {
        let Some(cell) = &self.cell else { return solution };
        let mut solution = with_given_gradients(solution, &at.mean_flow);
        let is_free = at.problem.free_translations();
        for axis in (0..D).filter(|&axis| is_free[axis] && at.mean_flow.velocity(axis).is_some()) {
            let along = |body: &RigidBodyEquation| body.external[Mode::along(axis)];
            let on_bodies: f64 = at.bodies.bodies.iter().map(along).sum();
            let on_fluid = at.mean_flow.body_force[axis] * cell.fluid_volume();
            solution.pressure_gradient[axis] = (on_bodies + on_fluid) / cell.volume();
        }
        solution
    }

    /// Largest force of the mean pressure gradient on a node (N; N/m planar).
    #[must_use]
    pub fn mean_force(&self, solution: &Solution<D>) -> f64 {
        let gradient = solution.pressure_gradient.amax();
        self.cell.as_ref().map_or(0.0, |cell| gradient * cell.largest_node())
    }

    /// Whether a solution has the mean velocities that are given.
    #[must_use]
    pub fn meets_mean_velocity(&self, at: &Configuration<'_, D>, solution: &Solution<D>) -> bool {
        let Some(cell) = &self.cell else { return true };
        let (mean, speed) = (cell.mean_velocity(solution), solution.top_speed());
        (0..D).all(|axis| {
            let velocity = at.mean_flow.velocity(axis);
            velocity.is_none_or(|velocity| {
                (mean[axis] - velocity).abs() <= MEAN_VELOCITY * velocity.abs().max(speed)
            })
        })
    }

    /// Gives the free unknowns the mean velocities that are given where something holds the fluid; the
    /// change of the pressure gradient that does.
    pub(in super::super) fn meet_mean_velocity(
        &mut self,
        at: &Configuration<'_, D>,
        free: &mut [f64],
        timing: &mut Timing,
    ) -> Result<Point<D>, SolveError> {
        let Some(cell) = &self.cell else { return Ok(Point::<D>::zeros()) };
        let held = at.problem.free_translations().map(|is_free| !is_free);
        let given = |axis: usize| at.mean_flow.velocity(axis).filter(|_| held[axis]);
        let axes: Vec<usize> = (0..D).filter(|&axis| given(axis).is_some()).collect();
        let (layout, modes) = (self.layout, self.modes);
        let system =
            ResponseSystem { cell, layout: &layout, modes, constraints: at.constraints, axes };
        self.response.update(&system, self.linear.as_mut(), timing)?;
        if self.response.is_empty() {
            return Ok(Point::<D>::zeros());
        }
        let raw = at.constraints.expand(free);
        let mean = cell.mean_velocity(&Solution::from_raw(&layout, modes, &raw));
        let excess = self.response.axes().iter().filter_map(|&axis| {
            given(axis).map(|velocity| (mean[axis] - velocity) * cell.volume())
        });
        self.response.take_off(&excess.collect::<Vec<f64>>(), free)
    }

    /// The mean velocity of fluid and bodies (m/s), where nothing holds them or one is given.
    pub(in super::super) fn mean_velocity(&self, solution: &Solution<D>) -> Point<D> {
        match (&self.cell, &self.nullspace) {
            (Some(cell), _) => cell.mean_velocity(solution),
            (None, Some(nullspace)) => nullspace.mean(solution),
            (None, None) => Point::<D>::zeros(),
        }
    }
}
