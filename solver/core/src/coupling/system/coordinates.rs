//! Systems of fluid and bodies with coordinates: what the equations of these ask for beyond the linear ones.

use nalgebra::{DMatrix, DVector};

use super::super::error::SolveError;
use super::super::flexible_equation::FlexibleEquation;
use super::rate_response::{CoordinateEquations, Factorised, RateResponse};
use super::{Configuration, FluidSystem};
use crate::timing::Timing;

impl<const D: usize> FluidSystem<D> {
    /// Whether factors are kept with the derivatives of the equations of coordinates.
    #[must_use]
    pub fn keeps_factors(&self) -> bool {
        self.rate_response.is_kept()
    }

    /// Whether rates of coordinates were found to the rounding of a large change only: a further system leads on from there.
    #[must_use]
    pub fn has_rounded_rates(&self) -> bool {
        self.rate_response.is_rounding
    }

    /// Has the next system take the derivatives of the equations of coordinates again.
    pub fn renew_tangents(&mut self) {
        self.rate_response = RateResponse::default();
    }

    /// The forces of coordinates beyond the derivatives of them that are in the matrix, from these rates of all coordinates on.
    #[must_use]
    pub fn forces_beyond(&self, equations: &[FlexibleEquation], rates: &[f64]) -> ForcesBeyond {
        ForcesBeyond {
            equations: equations.to_vec(),
            tangents: self.rate_response.tangents().to_vec(),
            from: rates.to_vec(),
        }
    }

    /// Gives free unknowns, after the change by a linear system, what the equations of coordinates ask for beyond that.
    pub(super) fn follow_coordinates(
        &mut self,
        at: &Configuration<'_, D>,
        by_system: &[f64],
        free: &mut [f64],
        timing: &mut Timing,
    ) {
        let equations = CoordinateEquations::new(&at.bodies.flexible, at.constraints, &self.layout);
        let unknowns = &equations.unknowns;
        let Some(factorised) = &self.rate_response.factorised else { return };
        let own = |all: &[f64]| {
            DVector::from_iterator(unknowns.len(), unknowns.iter().map(|at| all[*at]))
        };
        let linear = own(free);
        let start = &linear - own(by_system);
        let beyond = equations.beyond_linear([&start, &linear], factorised);
        self.rate_response.is_rounding = beyond.as_ref().is_some_and(|found| found.is_rounding);
        let Some(beyond) = beyond else { return };
        let mut change = vec![0.0; free.len()];
        for (unknown, force) in unknowns.iter().zip(beyond.forces.iter()) {
            change[*unknown] = -force;
        }
        if self.linear.substitute(&mut change, timing) {
            free.iter_mut().zip(&change).for_each(|(value, change)| *value += change);
        }
    }

    /// Takes note of how rates of coordinates answer to forces where the matrix has factors.
    ///
    /// # Errors
    /// When the matrix is singular.
    pub(super) fn keep_response(
        &mut self,
        at: &Configuration<'_, D>,
        timing: &mut Timing,
    ) -> Result<(), SolveError> {
        let has_coordinates = !at.bodies.flexible.is_empty() && self.nullspace.is_none();
        if !has_coordinates || !self.linear.is_factorised() {
            return Ok(());
        }
        let equations = CoordinateEquations::new(&at.bodies.flexible, at.constraints, &self.layout);
        let unknowns = &equations.unknowns;
        if unknowns.is_empty() {
            return Ok(());
        }
        let derivatives = equations.reduced(self.rate_response.tangents());
        let inverse = self.linear.inverse_of(unknowns, timing)?;
        let inverse = DMatrix::from_column_slice(unknowns.len(), unknowns.len(), &inverse);
        let enclosed = self.substituted_answers(at.constraints, timing);
        self.rate_response.factorised = Some(Factorised { inverse, derivatives, enclosed });
        Ok(())
    }
}

/// What the equations of coordinates have beyond their linear part in a matrix, as functions of the rates of all coordinates.
#[derive(Debug, Clone)]
pub struct ForcesBeyond {
    equations: Vec<FlexibleEquation>,
    /// Their derivatives in the matrix, body by body.
    tangents: Vec<DMatrix<f64>>,
    /// The rates at which they are in balance.
    from: Vec<f64>,
}

impl ForcesBeyond {
    /// The forces at these rates, against them.
    #[must_use]
    pub fn forces(&self, rates: &[f64]) -> DVector<f64> {
        let mut forces = DVector::zeros(rates.len());
        for (equation, tangent) in self.equations.iter().zip(&self.tangents) {
            let own = equation.first..equation.first + tangent.nrows();
            let change = own.clone().map(|at| rates[at] - self.from[at]);
            let linear = tangent * DVector::from_vec(change.collect());
            let lack = equation.residual(rates) - equation.residual(&self.from) - linear;
            forces.rows_mut(own.start, own.len()).copy_from(&lack);
        }
        forces
    }

    /// Their derivatives by the rates.
    #[must_use]
    pub fn tangent(&self, rates: &[f64]) -> DMatrix<f64> {
        let mut all = DMatrix::zeros(rates.len(), rates.len());
        for (equation, tangent) in self.equations.iter().zip(&self.tangents) {
            let (first, n) = (equation.first, tangent.nrows());
            all.view_mut((first, first), (n, n)).copy_from(&(equation.tangent(rates) - tangent));
        }
        all
    }
}
