//! The residual of fluid and bodies, raw and on the free unknowns.

use alewife_mesh::Point;
use nalgebra::DVector;

use super::super::solution::Solution;
use super::{Configuration, FluidSystem};
use crate::coupling::flexible_equation::FlexibleEquation;
use crate::flow::{FlowTerms, residual};

impl<const D: usize> FluidSystem<D> {
    /// The raw residual of the fluid's equations at a solution.
    #[must_use]
    pub fn fluid_residual(
        &self,
        at: &Configuration<'_, D>,
        terms: &FlowTerms<'_, D>,
        solution: &Solution<D>,
    ) -> Vec<f64> {
        let mut raw = residual(&self.assembly, at.mesh, terms, &solution.fields());
        if let Some(cell) = &self.cell {
            let force = solution.pressure_gradient - at.mean_flow.body_force;
            cell.add(&self.layout, self.modes, [&force, &Point::<D>::zeros()], &mut raw);
        }
        self.subtract_given_loads(at, &mut raw);
        raw
    }

    /// P^T R: the residual of fluid and bodies on the free unknowns, from that of the fluid.
    #[must_use]
    pub fn reduced_residual(
        &self,
        at: &Configuration<'_, D>,
        solution: &Solution<D>,
        fluid: &[f64],
    ) -> Vec<f64> {
        let mut raw = fluid.to_vec();
        if at.problem.is_enclosed() {
            self.pressure.make_compatible(&mut raw[self.layout.pressures()]);
            self.take_off_level(solution, &mut raw);
        }
        let row = |body: usize, position: usize| self.layout.rigid(body, position);
        at.bodies.add_residual(&solution.twists, self.modes, row, &mut raw);
        for equation in &at.bodies.flexible {
            for (own, lack) in equation.residual(&solution.rates).iter().enumerate() {
                raw[self.layout.rate(equation.first + own)] += lack;
            }
        }
        if let Some(cell) = &self.cell {
            let force = solution.pressure_gradient;
            cell.add(&self.layout, self.modes, [&Point::<D>::zeros(), &force], &mut raw);
        }
        at.constraints.restrict(&raw)
    }

    /// The rounding in the equations of coordinates at a solution, body by body.
    #[must_use]
    pub fn roundings(
        &self,
        at: &Configuration<'_, D>,
        solution: &Solution<D>,
    ) -> Vec<DVector<f64>> {
        let of_body = |equation: &FlexibleEquation| equation.rounding(&solution.rates);
        at.bodies.flexible.iter().map(of_body).collect()
    }

    /// The largest size of a reduced residual; what coordinates have in it counts beyond its rounding.
    #[must_use]
    pub fn largest_lack(
        &self,
        at: &Configuration<'_, D>,
        reduced: &[f64],
        roundings: &[DVector<f64>],
    ) -> f64 {
        let mut sizes: Vec<f64> = reduced.iter().map(|value| value.abs()).collect();
        for (equation, roundings) in at.bodies.flexible.iter().zip(roundings) {
            for (own, rounding) in roundings.iter().enumerate() {
                for term in at.constraints.row(self.layout.rate(equation.first + own)) {
                    let size = &mut sizes[term.unknown as usize];
                    *size = (*size - term.weight.abs() * rounding).max(0.0);
                }
            }
        }
        sizes.into_iter().fold(0.0, f64::max)
    }
}
