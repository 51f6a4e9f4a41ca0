//! Adjoint flows: the transposed system at a solution.
//!
//! A quantity J of the raw unknowns x = P y + g has the adjoint lambda with (P^T R' P)^T lambda = P^T J'. What a
//! parameter then changes of J is what it changes of J - lambda . P^T R with y kept.

use super::super::error::SolveError;
use super::super::problem::Problem;
use super::super::solution::Solution;
use super::{Configuration, FluidSystem};
use crate::algebra::AffineConstraints;
use crate::flow::{Convection, FlowTerms, transposed_product};
use crate::timing::Timing;

impl<const D: usize> FluidSystem<D> {
    /// The adjoints, by free unknowns, of quantities with these derivatives by the raw unknowns at a solution. Solved for by
    /// factors of its matrix, or where systems are solved by iterations and it is symmetric by iterations.
    ///
    /// # Errors
    /// When the matrix is singular, or its factors are too large.
    pub fn adjoints(
        &mut self,
        at: &Configuration<'_, D>,
        terms: &FlowTerms<'_, D>,
        solution: &Solution<D>,
        derivatives: &[Vec<f64>],
        timing: &mut Timing,
    ) -> Result<Vec<Vec<f64>>, SolveError> {
        self.renew_tangents();
        self.linearise(at, terms, solution, timing)?;
        // That is a limit for flows
        self.linear.limit_mass(f64::INFINITY);
        let right_hand_side = |derivative: &Vec<f64>| {
            let mut raw = derivative.clone();
            if at.problem.is_enclosed() {
                self.pressure.before_centering(&mut raw[self.layout.pressures()]);
            }
            at.constraints.restrict(&raw)
        };
        let mut adjoints: Vec<Vec<f64>> = derivatives.iter().map(right_hand_side).collect();
        let is_symmetric =
            terms.convection == Convection::None && at.problem.open_sides().is_empty();
        let solved = self.linear.solve_transposed(&mut adjoints, is_symmetric, timing);
        solved.map_err(|error| self.explain(at, error))?;
        Ok(adjoints)
    }

    /// The derivative by the raw unknowns of the product of the fluid's raw residual with weights.
    #[must_use]
    pub fn derivative_of_residual(
        &self,
        at: &Configuration<'_, D>,
        terms: &FlowTerms<'_, D>,
        solution: &Solution<D>,
        weights: &[f64],
    ) -> Vec<f64> {
        transposed_product(&self.assembly, at.mesh, terms, &solution.fields(), weights)
    }

    /// The free unknowns of a solution, at the level of the pressure that the constraints give it.
    #[must_use]
    pub fn free_unknowns(
        &self,
        problem: &Problem<D>,
        constraints: &AffineConstraints,
        solution: &Solution<D>,
    ) -> Vec<f64> {
        let mut raw = solution.to_raw(self.modes);
        if problem.is_enclosed() {
            let pressures = self.layout.pressures();
            let level = pressures.clone().find(|&index| {
                constraints.unknown(index).is_none() && constraints.row(index).is_empty()
            });
            if let Some(level) = level {
                let off = raw[level] - constraints.value(level);
                raw[pressures].iter_mut().for_each(|pressure| *pressure -= off);
            }
        }
        constraints.pick(&raw)
    }

    /// The solution with these free unknowns, the pressure of an enclosed flow with zero mean.
    #[must_use]
    pub fn solution_of(
        &self,
        problem: &Problem<D>,
        constraints: &AffineConstraints,
        free: &[f64],
    ) -> Solution<D> {
        let raw = constraints.expand(free);
        let mut solution = Solution::from_raw(&self.layout, self.modes, &raw);
        self.center_pressure(problem, &mut solution);
        solution
    }
}
