//! `RateResponse`: how rates of coordinates answer to forces, and what their equations ask for beyond the linear ones.
//!
//! Where convection is extrapolated, only the equations of coordinates are not linear. With their derivatives K in the
//! matrix A, a step of Newton's method leads the unknowns y they depend on to y_l. The block G of the inverse of A in these
//! unknowns says how they answer to forces, so that with all of the forces f they are the solution of
//!
//!   y = y_l - G e(y),   e(y) = f(y) - f(y_0) - K (y - y_0),
//!
//! which are few: found by Newton's method without another system of the fluid, but for one substitution that adds the flow
//! of e. K and G are kept for further systems of a step, in which the mesh moves little and the factors stay.

use nalgebra::{DMatrix, DVector};

use super::super::error::SolveError;
use super::super::flexible_equation::FlexibleEquation;
use super::{Configuration, FluidSystem};
use crate::algebra::Term;
use crate::space::DofLayout;
use crate::timing::Timing;

/// Most iterations for the rates of coordinates.
const MOST_ITERATIONS: usize = 12;
/// Change of the rates over their size that ends them: the next one is of its square.
const CONVERGED: f64 = 1e-9;

/// Derivatives of the equations of coordinates, and how their rates answer to forces.
#[derive(Debug, Default)]
pub(super) struct RateResponse {
    /// Derivatives in the matrix, body by body; empty where they are to be taken again.
    tangents: Vec<DMatrix<f64>>,
    /// With the last factors that these are in.
    factorised: Option<Factorised>,
}

/// What is known from factors.
#[derive(Debug)]
struct Factorised {
    /// The block of the inverse in the unknowns that rates depend on.
    inverse: DMatrix<f64>,
    /// The flow that a source makes which is spread over an enclosed fluid.
    source: Option<Vec<f64>>,
}

impl RateResponse {
    /// Takes the derivatives of these equations at rates of all coordinates, unless there are some already.
    pub(super) fn keep_tangents(&mut self, equations: &[FlexibleEquation], rates: &[f64]) {
        if self.tangents.len() != equations.len() {
            let tangents = equations.iter().map(|equation| equation.tangent(rates));
            *self = Self { tangents: tangents.collect(), factorised: None };
        }
    }

    /// The derivatives, body by body.
    pub(super) fn tangents(&self) -> &[DMatrix<f64>] {
        &self.tangents
    }

    /// Whether factors are known that the derivatives are in.
    pub(super) fn is_kept(&self) -> bool {
        self.factorised.is_some()
    }

    /// The flow of a source, if the factors are known that it was found with.
    pub(super) fn source(&self) -> Option<&[f64]> {
        self.factorised.as_ref()?.source.as_deref()
    }
}

/// The equations of the coordinates of all bodies in the unknowns y that they depend on.
struct CoordinateEquations<'a> {
    equations: &'a [FlexibleEquation],
    /// The unknowns, ascending.
    unknowns: Vec<usize>,
    /// Each rate: weights of the unknowns by their positions, and what is given of it.
    rates: Vec<(Vec<(usize, f64)>, f64)>,
}

impl<'a> CoordinateEquations<'a> {
    fn new<const D: usize>(at: &Configuration<'a, D>, layout: &DofLayout<D>) -> Self {
        let raw = (0..layout.n_coordinates).map(|coordinate| layout.rate(coordinate));
        let row = |raw: usize| (at.constraints.row(raw), at.constraints.value(raw));
        let rows: Vec<(&[Term<u32>], f64)> = raw.map(row).collect();
        let mut unknowns: Vec<usize> = rows
            .iter()
            .flat_map(|(terms, _)| terms.iter().map(|term| term.unknown as usize))
            .collect();
        unknowns.sort_unstable();
        unknowns.dedup();
        let position = |term: &Term<u32>| {
            let at = unknowns.binary_search(&(term.unknown as usize)).ok()?;
            Some((at, term.weight))
        };
        let rates = rows
            .into_iter()
            .map(|(terms, given)| (terms.iter().filter_map(position).collect(), given))
            .collect();
        Self { equations: &at.bodies.flexible, unknowns, rates }
    }

    fn rates(&self, y: &DVector<f64>) -> Vec<f64> {
        let rate = |(weights, given): &(Vec<(usize, f64)>, f64)| {
            weights.iter().fold(*given, |sum, (at, weight)| sum + weight * y[*at])
        };
        self.rates.iter().map(rate).collect()
    }

    /// What they lack to balance the loads of the fluid.
    fn lack(&self, y: &DVector<f64>) -> DVector<f64> {
        let rates = self.rates(y);
        let mut lack = DVector::zeros(y.len());
        for equation in self.equations {
            for (own, value) in equation.residual(&rates).iter().enumerate() {
                for (at, weight) in &self.rates[equation.first + own].0 {
                    lack[*at] += weight * value;
                }
            }
        }
        lack
    }

    /// Derivatives by the unknowns that are not zero, from those by all rates, body by body.
    fn reduced(&self, tangents: &[DMatrix<f64>]) -> Vec<(usize, usize, f64)> {
        let mut entries = Vec::new();
        for (equation, tangent) in self.equations.iter().zip(tangents) {
            let own = &self.rates[equation.first..equation.first + tangent.nrows()];
            for (column, (by, _)) in tangent.column_iter().zip(own) {
                for (value, (of, _)) in column.iter().zip(own).filter(|(value, _)| **value != 0.0) {
                    for (j, right) in by {
                        entries.extend(of.iter().map(|(i, left)| (*i, *j, left * value * right)));
                    }
                }
            }
        }
        entries
    }

    fn tangents(&self, y: &DVector<f64>) -> Vec<DMatrix<f64>> {
        let rates = self.rates(y);
        self.equations.iter().map(|equation| equation.tangent(&rates)).collect()
    }

    /// The forces e(y) at the solution of y = `linear` - G e(y); none where it is not found.
    fn beyond_linear(
        &self,
        [start, linear]: [&DVector<f64>; 2],
        kept: &[DMatrix<f64>],
        inverse: &DMatrix<f64>,
    ) -> Option<DVector<f64>> {
        let at_start = self.lack(start);
        let derivatives = self.reduced(kept);
        let beyond = |y: &DVector<f64>| {
            let mut beyond = self.lack(y) - &at_start;
            for (i, j, value) in &derivatives {
                beyond[*i] -= value * (y[*j] - start[*j]);
            }
            beyond
        };
        let mut y = linear.clone();
        for _ in 0..MOST_ITERATIONS {
            let off = &y - linear + inverse * beyond(&y);
            let mut changed = self.tangents(&y);
            changed.iter_mut().zip(kept).for_each(|(tangent, kept)| *tangent -= kept);
            let mut by_rates = DMatrix::identity(y.len(), y.len());
            for (i, j, value) in self.reduced(&changed) {
                by_rates.column_mut(j).axpy(value, &inverse.column(i), 1.0);
            }
            let change = by_rates.lu().solve(&off)?;
            y -= &change;
            let relative = change.amax() / y.amax().max(f64::MIN_POSITIVE);
            if !relative.is_finite() {
                return None;
            }
            if relative <= CONVERGED {
                return Some(beyond(&y));
            }
        }
        None
    }
}

impl<const D: usize> FluidSystem<D> {
    /// Whether factors are kept with the derivatives of the equations of coordinates.
    #[must_use]
    pub fn keeps_factors(&self) -> bool {
        self.rate_response.is_kept()
    }

    /// Has the next system take the derivatives of the equations of coordinates again.
    pub fn renew_tangents(&mut self) {
        self.rate_response = RateResponse::default();
    }

    /// Gives free unknowns, after the change by a linear system, what the equations of coordinates ask for beyond that.
    pub(super) fn follow_coordinates(
        &mut self,
        at: &Configuration<'_, D>,
        by_system: &[f64],
        free: &mut [f64],
        timing: &mut Timing,
    ) {
        let equations = CoordinateEquations::new(at, &self.layout);
        let unknowns = &equations.unknowns;
        let RateResponse { tangents, factorised } = &self.rate_response;
        let Some(Factorised { inverse, .. }) = factorised else { return };
        let own = |all: &[f64]| {
            DVector::from_iterator(unknowns.len(), unknowns.iter().map(|at| all[*at]))
        };
        let linear = own(free);
        let start = &linear - own(by_system);
        let Some(beyond) = equations.beyond_linear([&start, &linear], tangents, inverse) else {
            return;
        };
        let mut change = vec![0.0; free.len()];
        for (unknown, force) in unknowns.iter().zip(beyond.iter()) {
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
        let unknowns = CoordinateEquations::new(at, &self.layout).unknowns;
        if unknowns.is_empty() {
            return Ok(());
        }
        let inverse = self.linear.inverse_of(&unknowns, timing)?;
        let inverse = DMatrix::from_column_slice(unknowns.len(), unknowns.len(), &inverse);
        let source = at.problem.is_enclosed().then(|| {
            let mut answer = at.constraints.restrict(&self.unit_source());
            self.linear.substitute(&mut answer, timing);
            answer
        });
        self.rate_response.factorised = Some(Factorised { inverse, source });
        Ok(())
    }
}
