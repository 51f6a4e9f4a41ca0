//! The net flux of bodies with coordinates in an enclosed fluid.
//!
//! Surfaces that are interpolated carry a small net flux, which the continuity equation gets back as a source that is spread
//! over the fluid. Where the motion of surfaces is given, so is the source; the rates of coordinates change it, by one number
//! more that is unknown.

use super::super::error::SolveError;
use super::super::solution::Solution;
use super::{Configuration, FluidSystem};
use crate::flow::FlowTerms;
use crate::timing::Timing;

impl<const D: usize> FluidSystem<D> {
    /// Gives free unknowns, after a step of Newton's method from a solution, the net flux that their source is of.
    ///
    /// # Errors
    /// When the matrix is singular.
    pub(super) fn balance_net_flux(
        &mut self,
        at: &Configuration<'_, D>,
        terms: &FlowTerms<'_, D>,
        solution: &Solution<D>,
        free: &mut [f64],
        timing: &mut Timing,
    ) -> Result<(), SolveError> {
        if !at.problem.is_enclosed() || self.layout.n_coordinates == 0 {
            return Ok(());
        }
        let mut answer = at.constraints.restrict(&self.unit_source());
        self.linear.solve(&mut answer, None, timing)?;
        let flux = |free: &[f64]| {
            let raw = at.constraints.expand(free);
            let flow = Solution::from_raw(&self.layout, self.modes, &raw);
            self.net_flux(at, terms, &flow)
        };
        let given = self.net_flux(at, terms, solution);
        let found = flux(free);
        let more: Vec<f64> = free.iter().zip(&answer).map(|(free, part)| free + part).collect();
        let by_source = flux(&more) - found;
        let part = (found - given) / (1.0 - by_source);
        free.iter_mut().zip(&answer).for_each(|(free, answer)| *free += part * answer);
        Ok(())
    }

    /// The sum of the continuity equations at a solution (m3/s; m2/s planar).
    fn net_flux(
        &self,
        at: &Configuration<'_, D>,
        terms: &FlowTerms<'_, D>,
        solution: &Solution<D>,
    ) -> f64 {
        self.fluid_residual(at, terms, solution)[self.layout.pressures()].iter().sum()
    }

    /// A source of one, spread over the fluid as a net flux is, in the rows of the raw residual.
    fn unit_source(&self) -> Vec<f64> {
        let mut raw = vec![0.0; self.layout.n_raw()];
        let pressures = self.layout.pressures();
        raw[pressures.start] = 1.0;
        self.pressure.make_compatible(&mut raw[pressures.clone()]);
        raw[pressures.clone()].iter_mut().for_each(|value| *value = -*value);
        raw[pressures.start] += 1.0;
        raw
    }
}
