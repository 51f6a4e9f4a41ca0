//! `minimise`: bounded L-BFGS over named parameters, which can be taken up again with the same bits.

use std::cell::RefCell;
use std::collections::HashMap;
use std::fmt::Display;

use basin::{
    BoxBounds, ConstraintDescription, ConstraintSet, Constraints, CostFunction, Executor,
    FirstOrderState, Gradient, Lbfgsb, NumericalFailure, Stall, Termination,
};

use super::{Bounded, SearchError};

/// Pairs of steps and slopes that the method keeps.
const MEMORY: usize = 10;

/// An objective at values of the parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Evaluated {
    /// Values of the parameters.
    pub values: Vec<f64>,
    /// The objective.
    pub objective: f64,
    /// Its derivatives by the parameters.
    pub slopes: Vec<f64>,
}

/// How a search goes on and ends.
#[derive(Debug, Clone, PartialEq)]
pub struct Search {
    /// Evaluations at most, those known included.
    pub max_evaluations: usize,
    /// Relative decrease of the objective in an iteration that ends the search.
    pub decrease: f64,
    /// Slope, of the objective at the start, below which no parameter would change it.
    pub slope: f64,
    /// What an earlier search that was stopped has evaluated, in order: it is not evaluated again, and so the
    /// search goes on with the same bits.
    pub known: Vec<Evaluated>,
}

impl Default for Search {
    fn default() -> Self {
        Self { max_evaluations: 100, decrease: 1e-6, slope: 1e-6, known: Vec::new() }
    }
}

/// Why a search ended.
#[derive(Debug, Clone, PartialEq)]
pub enum Ended {
    /// It converged.
    Converged,
    /// Its evaluations are used up.
    Evaluations,
    /// An evaluation, or the method, failed: the best point so far is what there is.
    Failed(String),
}

/// What a search found.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// The best of all evaluations.
    pub best: Evaluated,
    /// All evaluations, in order.
    pub all: Vec<Evaluated>,
    /// Why it ended.
    pub ended: Ended,
}

/// Why an evaluation was not made.
#[derive(Debug, Clone, PartialEq)]
enum Stop {
    UsedUp,
    Failed(String),
}

/// The objective as the method sees it, scaled by its value at the start.
struct Scaled<'a, E> {
    parameters: &'a [Bounded],
    lower: Vec<f64>,
    upper: Vec<f64>,
    max_evaluations: usize,
    state: &'a RefCell<State<E>>,
}

struct State<E> {
    evaluate: E,
    known: HashMap<Vec<u64>, Evaluated>,
    all: Vec<Evaluated>,
    stop: Option<Stop>,
}

impl<E: FnMut(&[f64]) -> Result<Evaluated, String>> Scaled<'_, E> {
    /// The objective at searched numbers.
    fn at(&self, searched: &[f64]) -> Result<Evaluated, String> {
        let values: Vec<f64> =
            self.parameters.iter().zip(searched).map(|(p, s)| p.value(*s)).collect();
        let key: Vec<u64> = values.iter().map(|value| value.to_bits()).collect();
        let mut state = self.state.borrow_mut();
        let is_met = state.all.iter().any(|found| found.values == values);
        if let Some(found) = state.known.get(&key).cloned() {
            if !is_met {
                state.all.push(found.clone());
            }
            return Ok(found);
        }
        if state.all.len() >= self.max_evaluations {
            state.stop = Some(Stop::UsedUp);
            return Err("no evaluation is left".to_owned());
        }
        match (state.evaluate)(&values) {
            Ok(found) => {
                state.known.insert(key, found.clone());
                state.all.push(found.clone());
                Ok(found)
            }
            Err(said) => {
                state.stop = Some(Stop::Failed(said.clone()));
                Err(said)
            }
        }
    }

    /// The size the objective is divided by.
    fn size(&self) -> f64 {
        let state = self.state.borrow();
        let Some(first) = state.all.first() else { return 1.0 };
        let slopes = self.parameters.iter().zip(&first.values).zip(&first.slopes);
        let slopes = slopes.map(|((one, value), slope)| (slope * one.slope(*value)).abs());
        // A start at zero, as of a body that does not move yet, has the size of what numbers change
        let size =
            if first.objective == 0.0 { slopes.fold(0.0, f64::max) } else { first.objective.abs() };
        if size > 0.0 { size } else { 1.0 }
    }
}

impl<E> Constraints for Scaled<'_, E> {
    type Set = ConstraintSet<BoxBounds<Vec<f64>>>;

    fn constraints(&self) -> <Self::Set as ConstraintDescription>::Borrowed<'_> {
        ConstraintSet::new().with_bounds(BoxBounds::new(Some(&self.lower), Some(&self.upper)))
    }
}

impl<E: FnMut(&[f64]) -> Result<Evaluated, String>> CostFunction for Scaled<'_, E> {
    type Param = Vec<f64>;
    type Output = f64;
    type Error = String;

    fn cost(&self, searched: &Vec<f64>) -> Result<f64, String> {
        let found = self.at(searched)?;
        Ok(found.objective / self.size())
    }
}

impl<E: FnMut(&[f64]) -> Result<Evaluated, String>> Gradient for Scaled<'_, E> {
    type Gradient = Vec<f64>;

    fn gradient(&self, searched: &Vec<f64>) -> Result<Vec<f64>, String> {
        let found = self.at(searched)?;
        let size = self.size();
        let slopes = self.parameters.iter().zip(&found.values).zip(&found.slopes);
        Ok(slopes.map(|((parameter, value), s)| s * parameter.slope(*value) / size).collect())
    }
}

/// Makes an objective small within bounds. `evaluate` gives the objective and its derivatives by the parameters;
/// it is called once for each set of values, and can report and store them.
///
/// # Errors
/// [`SearchError::Bounds`], and [`SearchError::Start`] where the start cannot be evaluated. Later failures end the
/// search at its best.
pub fn minimise<E: Display>(
    parameters: &[Bounded],
    search: &Search,
    mut evaluate: impl FnMut(&[f64]) -> Result<Evaluated, E>,
) -> Result<Found, SearchError> {
    let evaluate = |values: &[f64]| evaluate(values).map_err(|error| error.to_string());
    for parameter in parameters {
        parameter.check()?;
    }
    let key = |found: &Evaluated| found.values.iter().map(|value| value.to_bits()).collect();
    let bound = |of: fn(&Bounded) -> f64| parameters.iter().map(|p| p.searched(of(p))).collect();
    let state = RefCell::new(State {
        evaluate,
        known: search.known.iter().map(|found| (key(found), found.clone())).collect(),
        all: Vec::new(),
        stop: None,
    });
    let problem = Scaled {
        parameters,
        lower: bound(|p| p.lower),
        upper: bound(|p| p.upper),
        max_evaluations: search.max_evaluations.max(1),
        state: &state,
    };
    let start: Vec<f64> = bound(|p| p.start);
    if let Err(said) = problem.at(&start) {
        let stop = state.borrow_mut().stop.take();
        return Err(match stop {
            Some(Stop::Failed(error)) => SearchError::Start(error),
            _ => SearchError::Start(said),
        });
    }
    let method = Lbfgsb::new()
        .with_m_capacity(MEMORY)
        .with_absolute_projected_gradient_tolerance(search.slope)
        .with_relative_cost_reduction_tolerance(search.decrease);
    let result = Executor::new(problem, method, FirstOrderState::new(start))
        .max_iter(search.max_evaluations as u64)
        .run();
    let ended = match (state.borrow_mut().stop.take(), result) {
        (Some(Stop::UsedUp), _) => Ended::Evaluations,
        (Some(Stop::Failed(said)), _) => Ended::Failed(said),
        (None, Err(error)) => Ended::Failed(error.to_string()),
        (None, Ok(result)) => match result.report.termination {
            Termination::Converged(_) => Ended::Converged,
            // Of iterations, each of which takes an evaluation
            Termination::Limit(_) => Ended::Evaluations,
            other => Ended::Failed(in_words(&other)),
        },
    };
    let all = state.into_inner().all;
    let best = all.iter().min_by(|a, b| a.objective.total_cmp(&b.objective)).cloned();
    let best = best.ok_or_else(|| SearchError::Start("nothing was evaluated".to_owned()))?;
    Ok(Found { best, all, ended })
}

/// Why the method stopped without having converged.
fn in_words(end: &Termination) -> String {
    match end {
        Termination::Stalled(Stall::Numerical { message, .. })
        | Termination::Failed(NumericalFailure::Solver { message, .. }) => message.clone(),
        Termination::Failed(NumericalFailure::Inner { report }) => in_words(&report.termination),
        _ => "the method stopped before it had converged".to_owned(),
    }
}
