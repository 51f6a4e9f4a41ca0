//! The matrix of fluid and bodies, linearised at a solution.

use alewife_interrupt::check;

use super::super::error::SolveError;
use super::super::linear_system::{Coefficients, Discretised};
use super::super::mass_tolerance::mass_tolerance;
use super::super::solution::Solution;
use super::{Configuration, FluidSystem};
use crate::algebra::LinearError;
use crate::flow::{Convection, FlowTerms, ViscosityTerm, assemble};
use crate::timing::{Stage, Timing};

impl<const D: usize> FluidSystem<D> {
    /// Assembles the Jacobian at a solution and gives the solver what it needs of it.
    pub(super) fn linearise(
        &mut self,
        at: &Configuration<'_, D>,
        terms: &FlowTerms<'_, D>,
        solution: &Solution<D>,
        timing: &mut Timing,
    ) -> Result<(), SolveError> {
        timing.measure(Stage::Assembly, || {
            let (assembly, fields) = (&self.assembly, solution.fields());
            self.linear.assemble(&mut |scatter| {
                assemble(assembly, at.mesh, at.constraints, terms, &fields, scatter);
            });
            self.add_body_matrix(at, &solution.rates);
        });
        check().map_err(LinearError::from)?;
        if let Some(nullspace) = &self.nullspace {
            nullspace.check_balance(at.bodies, &at.mean_flow)?;
        }
        let local = match &terms.viscosity {
            ViscosityTerm::Local(local) => Some(local),
            ViscosityTerm::Constant(_) => None,
        };
        if local.is_some() {
            self.linear.forget_weights();
        }
        let coefficients = Coefficients {
            viscosity: terms.viscosity.constant().unwrap_or_default(),
            inertia: terms.density * terms.rate,
            has_convection: terms.convection != Convection::None,
        };
        let discretised = Discretised {
            mesh: at.mesh,
            layout: &self.layout,
            constraints: at.constraints,
            tables: self.assembly.tables(),
            local,
        };
        self.linear.prepare(coefficients, &|| discretised.weights(coefficients), timing);
        check().map_err(LinearError::from)?;
        self.linear.recall_with_weights()?;
        if self.linear.is_iterative() {
            self.linear.limit_mass(mass_tolerance(at.problem, at.mesh, &solution.velocity));
        }
        Ok(())
    }
}
