//! `Method`: what proposes points: at random, a simplex, a distribution that adapts, or somebody else.

use std::cell::RefCell;
use std::f64::consts::TAU;

use alewife_case::SplitMix64;
use alewife_interrupt::check;
use basin::{
    BoundedCmaEs, BoxBounds, ConstraintDescription, ConstraintSet, Constraints, CostFunction,
    DenseMatrix, Executor, NelderMead, PopulationProgress, SimplexProgress,
};

use super::proposals::{Halt, Proposals};
use super::{Ended, SearchError};

/// Share of what lies between the bounds that the first points are apart.
const SPREAD: f64 = 0.2;

/// Share of it below which a simplex or a distribution has converged.
const SMALL: f64 = 1e-6;

/// What proposes points.
pub enum Method<'a> {
    /// In any direction from the best point, as far as half of what lies between the bounds.
    Random {
        /// Seed of the numbers.
        seed: u64,
    },
    /// Nelder and Mead's simplex, projected to the bounds.
    NelderMead,
    /// The covariance matrix adaptation of Hansen and Ostermeier, with a penalty at the bounds.
    CmaEs {
        /// Seed of the numbers.
        seed: u64,
    },
    /// Somebody else, by what is known so far; why there is none.
    External(Ask<'a>),
}

/// Asks for the next point by all that is known.
pub type Ask<'a> = &'a mut dyn FnMut(&Proposals<'_>) -> Result<Vec<f64>, String>;

/// Has a method propose points until the evaluations are used up or it has converged.
///
/// # Errors
/// `SearchError` where the journal cannot be written, or is of another search. What fails to propose ends the search.
pub fn propose(proposals: &mut Proposals<'_>, method: Method<'_>) -> Result<Ended, SearchError> {
    let halted = match method {
        Method::Random { seed } => at_random(proposals, seed),
        Method::NelderMead => by_simplex(proposals),
        Method::CmaEs { seed } => by_distribution(proposals, seed),
        Method::External(ask) => by_others(proposals, ask),
    };
    match halted {
        None => Ok(Ended::Converged),
        Some(Halt::UsedUp) => Ok(Ended::Evaluations),
        Some(Halt::Failed(what)) => Ok(Ended::Failed(what)),
        Some(Halt::Error(error)) => Err(error),
    }
}

fn at_random(proposals: &mut Proposals<'_>, seed: u64) -> Option<Halt> {
    let mut random = SplitMix64(seed);
    loop {
        let mut normal = || {
            let radius = (-2.0 * (1.0 - random.uniform()).ln()).sqrt();
            radius * (TAU * random.uniform()).cos()
        };
        let direction: Vec<f64> = (0..proposals.n_parameters()).map(|_| normal()).collect();
        let size = direction.iter().map(|one| one * one).sum::<f64>().sqrt().max(f64::MIN_POSITIVE);
        let length = 0.5 * random.uniform() / size;
        let from = proposals.shares(proposals.best());
        let to: Vec<f64> = from.iter().zip(&direction).map(|(at, by)| at + length * by).collect();
        let values = proposals.values(&to);
        if let Err(halt) = proposals.propose(&values) {
            return Some(halt);
        }
    }
}

fn by_others(proposals: &mut Proposals<'_>, ask: Ask<'_>) -> Option<Halt> {
    while proposals.n_left() > 0 {
        let known = proposals.known_next().map(<[f64]>::to_vec);
        let values = match known.map_or_else(|| ask(proposals), Ok) {
            Ok(values) => values,
            Err(what) => {
                let stopped = check().err();
                return Some(stopped.map_or(Halt::Failed(what), |one| Halt::Error(one.into())));
            }
        };
        if let Err(halt) = proposals.propose(&values) {
            return Some(halt);
        }
    }
    Some(Halt::UsedUp)
}

/// Proposals as a method of a library sees them: a function of shares between the bounds.
struct Seen<'a, 'b> {
    proposals: &'a RefCell<&'a mut Proposals<'b>>,
    halt: &'a RefCell<Option<Halt>>,
    lower: Vec<f64>,
    upper: Vec<f64>,
}

impl Constraints for Seen<'_, '_> {
    type Set = ConstraintSet<BoxBounds<Vec<f64>>>;

    fn constraints(&self) -> <Self::Set as ConstraintDescription>::Borrowed<'_> {
        ConstraintSet::new().with_bounds(BoxBounds::new(Some(&self.lower), Some(&self.upper)))
    }
}

impl CostFunction for Seen<'_, '_> {
    type Param = Vec<f64>;
    type Output = f64;
    type Error = String;

    fn cost(&self, shares: &Vec<f64>) -> Result<f64, String> {
        let mut proposals = self.proposals.borrow_mut();
        let values = proposals.values(shares);
        proposals.propose(&values).map_err(|halt| {
            *self.halt.borrow_mut() = Some(halt);
            "no more points are tried".to_owned()
        })
    }
}

/// Why a method of a library ended, where it was not stopped.
fn ended<R, E: std::fmt::Display>(halt: Option<Halt>, result: Result<R, E>) -> Option<Halt> {
    halt.or_else(|| result.err().map(|error| Halt::Failed(error.to_string())))
}

fn by_simplex(proposals: &mut Proposals<'_>) -> Option<Halt> {
    let start = proposals.shares(proposals.best());
    // Away from the nearer bound, so that no corner is on another
    let corner = |k: usize| {
        let mut corner = start.clone();
        corner[k] += if corner[k] <= 0.5 { SPREAD } else { -SPREAD };
        corner
    };
    let mut corners = vec![start.clone()];
    corners.extend((0..start.len()).map(corner));
    let method = NelderMead::new()
        .with_absolute_simplex_size_tolerance(SMALL)
        .with_relative_simplex_size_tolerance(None)
        .with_absolute_simplex_cost_tolerance(None)
        .with_relative_simplex_cost_tolerance(SMALL)
        .projected();
    seen(proposals, |problem, most| {
        let state = SimplexProgress::from_simplex(corners);
        Executor::new(problem, method, state).max_iter(most).run().map(|_| ())
    })
}

fn by_distribution(proposals: &mut Proposals<'_>, seed: u64) -> Option<Halt> {
    let start = proposals.shares(proposals.best());
    let method = BoundedCmaEs::<Vec<f64>, DenseMatrix>::new(seed, SPREAD)
        .with_absolute_distribution_size_tolerance(SMALL);
    seen(proposals, |problem, most| {
        let state = PopulationProgress::from_point(start);
        Executor::new(problem, method, state).max_iter(most).run().map(|_| ())
    })
}

/// Lends proposals to a method of a library.
fn seen<E: std::fmt::Display>(
    proposals: &mut Proposals<'_>,
    run: impl FnOnce(Seen<'_, '_>, u64) -> Result<(), E>,
) -> Option<Halt> {
    let (n, most) = (proposals.n_parameters(), proposals.n_left() as u64);
    let halt = RefCell::new(None);
    let shared = RefCell::new(proposals);
    let problem =
        Seen { proposals: &shared, halt: &halt, lower: vec![0.0; n], upper: vec![1.0; n] };
    let result = run(problem, most);
    ended(halt.into_inner(), result)
}
