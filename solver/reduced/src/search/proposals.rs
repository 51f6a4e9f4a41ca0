//! `Proposals`: points that a method proposes, each in a backtracking line search, in a journal.

use alewife_interrupt::check;

use super::{Bounded, Evaluated, Journal, SearchError};

/// How often the way to a proposal is halved before it is given up, where nothing else is said.
pub const HALVINGS: u8 = 4;

/// How long a search goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Effort {
    /// Evaluations at most, those on the way to proposals included.
    pub evaluations: usize,
    /// How often the way to a proposal is halved before it is given up.
    pub halvings: u8,
}

/// A motion that fails counts so many times what the start leaves.
const FAILED: f64 = 1e3;

/// What is made small without derivatives: infinite where there is no value.
pub type Objective<'a> = &'a mut dyn FnMut(&[f64]) -> f64;

/// A point that was proposed, and what became of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Proposal {
    /// The point, within its bounds.
    pub values: Vec<f64>,
    /// The objective there.
    pub objective: f64,
    /// The part of the way from the best point before at which it became better, if it did.
    pub accepted: Option<f64>,
    /// The best objective after it.
    pub best: f64,
}

/// Why no more points are tried.
#[derive(Debug, Clone, PartialEq)]
pub enum Halt {
    /// Evaluations are used up.
    UsedUp,
    /// The search cannot go on.
    Error(SearchError),
    /// What proposes has failed.
    Failed(String),
}

/// Points that are proposed within bounds. From the best point so far the whole way to each is tried, and then a half, a
/// quarter, ... of it; the first point that is better is taken (as in Swim2Real, Qiu et al. 2026, arXiv 2603.20827).
pub struct Proposals<'a> {
    bounded: &'a [Bounded],
    effort: Effort,
    evaluate: Objective<'a>,
    journal: Option<Journal>,
    known: Vec<Evaluated>,
    n_evaluations: usize,
    start: f64,
    best: Vec<f64>,
    objective: f64,
    all: Vec<Proposal>,
}

impl<'a> Proposals<'a> {
    /// From a start, with the evaluations that a search before has made, which are not made again.
    ///
    /// # Errors
    /// `SearchError` when bounds are wrong, the start has no value, or the journal is of another search.
    pub fn new(
        bounded: &'a [Bounded],
        effort: Effort,
        evaluate: Objective<'a>,
        journal: Option<Journal>,
        known: Vec<Evaluated>,
    ) -> Result<Self, SearchError> {
        for one in bounded {
            // Points are shares of what lies between the bounds
            Bounded { scale: Some(1.0), ..one.clone() }.check()?;
        }
        let best: Vec<f64> = bounded.iter().map(|one| one.start).collect();
        let (n_evaluations, all, infinite) = (0, Vec::new(), f64::INFINITY);
        let mut made = Self {
            bounded,
            effort: Effort { evaluations: effort.evaluations.max(1), ..effort },
            evaluate,
            journal,
            known,
            n_evaluations,
            start: infinite,
            best: best.clone(),
            objective: infinite,
            all,
        };
        match made.evaluated(&best) {
            Ok(value) if value.is_finite() => {
                (made.start, made.objective) = (value, value);
                Ok(made)
            }
            Ok(_) => Err(SearchError::Start("the motion fails".to_owned())),
            Err(Halt::Error(error)) => Err(error),
            Err(Halt::Failed(what)) => Err(SearchError::Start(what)),
            Err(Halt::UsedUp) => Err(SearchError::Start("nothing may be evaluated".to_owned())),
        }
    }

    /// Number of parameters.
    #[must_use]
    pub fn n_parameters(&self) -> usize {
        self.bounded.len()
    }

    /// Parameters with their bounds.
    #[must_use]
    pub fn bounded(&self) -> &[Bounded] {
        self.bounded
    }

    /// The best values so far.
    #[must_use]
    pub fn best(&self) -> &[f64] {
        &self.best
    }

    /// The objective there.
    #[must_use]
    pub fn objective(&self) -> f64 {
        self.objective
    }

    /// All proposals so far.
    #[must_use]
    pub fn all(&self) -> &[Proposal] {
        &self.all
    }

    /// Evaluations so far.
    #[must_use]
    pub fn n_evaluations(&self) -> usize {
        self.n_evaluations
    }

    /// Evaluations that may still be made.
    #[must_use]
    pub fn n_left(&self) -> usize {
        self.effort.evaluations.saturating_sub(self.n_evaluations)
    }

    /// Shares of what lies between the bounds, of some values.
    #[must_use]
    pub fn shares(&self, values: &[f64]) -> Vec<f64> {
        let share = |(one, value): (&Bounded, &f64)| {
            let width = one.upper - one.lower;
            if width > 0.0 { (value - one.lower) / width } else { 0.0 }
        };
        self.bounded.iter().zip(values).map(share).collect()
    }

    /// Values of such shares, within the bounds.
    #[must_use]
    pub fn values(&self, shares: &[f64]) -> Vec<f64> {
        let value = |(one, share): (&Bounded, &f64)| {
            (one.lower + share * (one.upper - one.lower)).clamp(one.lower, one.upper)
        };
        self.bounded.iter().zip(shares).map(value).collect()
    }

    /// What a search before has proposed next, where it was stopped later than here.
    #[must_use]
    pub fn known_next(&self) -> Option<&[f64]> {
        self.known.get(self.n_evaluations).map(|one| one.values.as_slice())
    }

    /// The objective at some values, from the journal where it is known.
    fn evaluated(&mut self, values: &[f64]) -> Result<f64, Halt> {
        if self.n_evaluations >= self.effort.evaluations {
            return Err(Halt::UsedUp);
        }
        if let Some(known) = self.known.get(self.n_evaluations) {
            if known.values != values {
                let what = "the journal has other points than this search proposes";
                return Err(Halt::Error(SearchError::OtherSearch(what.to_owned())));
            }
            let objective = known.objective;
            self.n_evaluations += 1;
            return Ok(objective);
        }
        let objective = (self.evaluate)(values);
        // A motion that was asked to end has none, and is made again
        check().map_err(|stopped| Halt::Error(stopped.into()))?;
        let objective = if objective.is_finite() { objective } else { f64::INFINITY };
        let (values, slopes) = (values.to_vec(), vec![0.0; values.len()]);
        if let Some(journal) = &mut self.journal {
            journal.add(&Evaluated { values, objective, slopes }).map_err(Halt::Error)?;
        }
        self.n_evaluations += 1;
        Ok(objective)
    }

    /// Tries a proposal, which is clipped to the bounds; the objective at it, finite where there is none.
    ///
    /// # Errors
    /// Why no more points are tried.
    pub fn propose(&mut self, values: &[f64]) -> Result<f64, Halt> {
        let clip = |(value, one): (&f64, &Bounded)| value.clamp(one.lower, one.upper);
        let values: Vec<f64> = values.iter().zip(self.bounded).map(clip).collect();
        let from = self.best.clone();
        let objective = self.evaluated(&values)?;
        let mut accepted = None;
        let most = if values == from { 0 } else { self.effort.halvings };
        for halving in 0..=most {
            let part = 0.5_f64.powi(i32::from(halving));
            let point: Vec<f64> = if halving == 0 {
                values.clone()
            } else {
                from.iter().zip(&values).map(|(from, to)| from + part * (to - from)).collect()
            };
            let there = if halving == 0 { objective } else { self.evaluated(&point)? };
            if there < self.objective {
                (self.best, self.objective, accepted) = (point, there, Some(part));
                break;
            }
        }
        let best = self.objective;
        self.all.push(Proposal { values, objective, accepted, best });
        Ok(if objective.is_finite() { objective } else { FAILED * self.start })
    }
}
