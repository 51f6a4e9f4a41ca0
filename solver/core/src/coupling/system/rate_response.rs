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

use super::super::flexible_equation::FlexibleEquation;
use crate::algebra::{AffineConstraints, Term};
use crate::space::DofLayout;

/// Most iterations for the rates of coordinates.
const MOST_ITERATIONS: usize = 20;
/// Change of the rates over their size that ends them: the next one is of its square.
const CONVERGED: f64 = 1e-9;
/// The same where it does not fall any more: what G rounds to times a large stiffness. The next system starts from there.
const ROUNDING: f64 = 1e-5;
/// A part of the last change that is no progress any more.
const NO_PROGRESS: f64 = 0.5;

/// Derivatives of the equations of coordinates, and how their rates answer to forces.
#[derive(Debug, Default)]
pub(super) struct RateResponse {
    /// Derivatives in the matrix, body by body; empty where they are to be taken again.
    pub tangents: Vec<DMatrix<f64>>,
    /// With the last factors that these are in.
    pub factorised: Option<Factorised>,
    /// Whether the last rates were found to rounding only.
    pub is_rounding: bool,
}

/// What is known from factors.
#[derive(Debug)]
pub(super) struct Factorised {
    /// The block of the inverse in the unknowns that rates depend on.
    pub inverse: DMatrix<f64>,
    /// The derivatives that are in them, by these unknowns: where bodies turn on which others are fixed, the same
    /// derivatives are others by the unknowns of a later system.
    pub derivatives: DMatrix<f64>,
    /// How an enclosed fluid answers.
    pub enclosed: Option<EnclosedAnswers>,
}

/// How free unknowns answer to what an enclosed fluid does to bodies with coordinates.
#[derive(Debug)]
pub(super) struct EnclosedAnswers {
    /// To a source of one that is spread over the fluid.
    pub source: Vec<f64>,
    /// To a level of the pressure of one that is taken off; none where each answer takes iterations: the residual of the next
    /// system then has the level that this one has come to.
    pub level: Option<Vec<f64>>,
}

impl RateResponse {
    /// Takes the derivatives of these equations at rates of all coordinates, unless there are some already.
    pub(super) fn keep_tangents(&mut self, equations: &[FlexibleEquation], rates: &[f64]) {
        if self.tangents.len() != equations.len() {
            let tangents = equations.iter().map(|equation| equation.tangent(rates));
            *self = Self { tangents: tangents.collect(), ..Self::default() };
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

    /// How an enclosed fluid answers, if the factors are known that this was found with; to be kept again.
    pub(super) fn take_enclosed(&mut self) -> Option<EnclosedAnswers> {
        self.factorised.as_mut()?.enclosed.take()
    }

    /// Keeps how an enclosed fluid answers, as long as the factors.
    pub(super) fn keep_enclosed(&mut self, answers: EnclosedAnswers) {
        if let Some(factorised) = &mut self.factorised {
            factorised.enclosed = Some(answers);
        }
    }
}

/// What is beyond the linear equations.
pub(super) struct Beyond {
    /// Forces on the unknowns.
    pub forces: DVector<f64>,
    /// Whether they are as exact as rounding allows, and not more.
    pub is_rounding: bool,
}

/// The equations of the coordinates of all bodies in the unknowns y that they depend on.
pub(super) struct CoordinateEquations<'a> {
    equations: &'a [FlexibleEquation],
    /// The unknowns, ascending.
    pub unknowns: Vec<usize>,
    /// Each rate: weights of the unknowns by their positions, and what is given of it.
    rates: Vec<(Vec<(usize, f64)>, f64)>,
}

impl<'a> CoordinateEquations<'a> {
    /// Those of these bodies under constraints.
    pub fn new<const D: usize>(
        equations: &'a [FlexibleEquation],
        constraints: &AffineConstraints,
        layout: &DofLayout<D>,
    ) -> Self {
        let raw = (0..layout.n_coordinates).map(|coordinate| layout.rate(coordinate));
        let row = |raw: usize| (constraints.row(raw), constraints.value(raw));
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
        Self { equations, unknowns, rates }
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

    /// Derivatives by the unknowns, from those by all rates, body by body.
    pub fn reduced(&self, tangents: &[DMatrix<f64>]) -> DMatrix<f64> {
        let mut reduced = DMatrix::zeros(self.unknowns.len(), self.unknowns.len());
        for (equation, tangent) in self.equations.iter().zip(tangents) {
            let own = &self.rates[equation.first..equation.first + tangent.nrows()];
            for (column, (by, _)) in tangent.column_iter().zip(own) {
                for (value, (of, _)) in column.iter().zip(own).filter(|(value, _)| **value != 0.0) {
                    for (j, right) in by {
                        for (i, left) in of {
                            reduced[(*i, *j)] += left * value * right;
                        }
                    }
                }
            }
        }
        reduced
    }

    fn tangents(&self, y: &DVector<f64>) -> Vec<DMatrix<f64>> {
        let rates = self.rates(y);
        self.equations.iter().map(|equation| equation.tangent(&rates)).collect()
    }

    /// The forces e(y) at the solution of y = `linear` - G e(y); none where it is not found.
    pub fn beyond_linear(
        &self,
        [start, linear]: [&DVector<f64>; 2],
        factorised: &Factorised,
    ) -> Option<Beyond> {
        let Factorised { inverse, derivatives, .. } = factorised;
        let at_start = self.lack(start);
        let beyond = |y: &DVector<f64>| {
            let mut beyond = self.lack(y) - &at_start;
            for_each_entry(derivatives, |row, column, value| {
                beyond[row] -= value * (y[column] - start[column]);
            });
            beyond
        };
        let (mut y, mut last) = (linear.clone(), f64::INFINITY);
        for _ in 0..MOST_ITERATIONS {
            let off = &y - linear + inverse * beyond(&y);
            let changed = self.reduced(&self.tangents(&y)) - derivatives;
            let mut by_rates = DMatrix::identity(y.len(), y.len());
            for_each_entry(&changed, |row, column, value| {
                by_rates.column_mut(column).axpy(value, &inverse.column(row), 1.0);
            });
            let change = by_rates.lu().solve(&off)?;
            y -= &change;
            let relative = change.amax() / y.amax().max(f64::MIN_POSITIVE);
            if !relative.is_finite() {
                return None;
            }
            let is_rounding = relative <= ROUNDING && relative > NO_PROGRESS * last;
            if relative <= CONVERGED || is_rounding {
                return Some(Beyond { forces: beyond(&y), is_rounding });
            }
            last = relative;
        }
        None
    }
}

/// Calls with row, column and value of the entries that are not zero.
fn for_each_entry(matrix: &DMatrix<f64>, mut call: impl FnMut(usize, usize, f64)) {
    for (column, values) in matrix.column_iter().enumerate() {
        let entries = values.iter().enumerate().filter(|(_, value)| **value != 0.0);
        entries.for_each(|(row, value)| call(row, column, *value));
    }
}
