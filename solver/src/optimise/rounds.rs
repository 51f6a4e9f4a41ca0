//! `FlowSearch`: a search of a flow in rounds, each on the mesh of the case at the best of the round before.
//!
//! Within a round the mesh follows the bodies, so that the objective is a smooth function of the numbers. It is that of
//! the mesh of the start, though: a round that has led away from it is followed by another one.

use std::path::Path;

use alewife_interrupt::check_whole;
use alewife_reduced::search::{
    Bounded, Ended, Evaluated, Found, Progress, Search, SearchError, Slope, certainties, search,
    slopes,
};

use super::constraints::Multipliers;
use super::error::OptimiseError;
use super::numbers::Numbers;
use super::objective::Objective;
use super::optimum::Optimum;
use super::sought::OnOneMesh;
use super::tier::{Tier, tier_of};
use crate::case::{CaseError, CaseFile, Diagnostic, FlowOptimisation, Severity, check_starts};
use crate::gradient::Derivatives;

/// Rounds at most, and those of a search that holds something: each of them corrects a multiplier.
const MOST_ROUNDS: usize = 10;
const MOST_ROUNDS_WITH_HELD: usize = 20;

/// Way of a round, in scales or logarithms of the numbers, after which the mesh is as good as one of the best.
const NEAR: f64 = 0.01;

/// The rise of the objective, of its value, up to which numbers are told to be as good.
const RISE: f64 = 0.01;

/// A search of a flow.
#[derive(Debug)]
pub struct FlowSearch {
    file: CaseFile,
    spec: FlowOptimisation,
    numbers: Numbers,
    objective: Objective,
    tier: Box<dyn Tier>,
}

/// How far a search is.
#[derive(Debug, Clone, PartialEq)]
pub struct RoundProgress {
    /// The round, from 1.
    pub round: usize,
    /// How far the search is.
    pub progress: Progress,
}

/// What rounds have found.
struct Rounds<'a> {
    /// All evaluations.
    all: Vec<Evaluated>,
    /// What the last round has found.
    last: Found,
    /// Quantities where the first round began.
    at_start: Vec<Derivatives>,
    /// The objective where the first round began, as it is made small.
    objective_at_start: f64,
    /// The mesh of the last round.
    sought: OnOneMesh<'a>,
    /// Number of rounds.
    n: usize,
}

impl FlowSearch {
    /// That of a case.
    ///
    /// # Errors
    /// [`OptimiseError::Case`]: it has none, starts beyond its bounds, or is wrong at them.
    pub fn new(file: &CaseFile) -> Result<Self, OptimiseError> {
        let Some(spec) = file.case().optimisation.clone() else {
            let missing = Diagnostic {
                severity: Severity::Error,
                key: String::new(),
                message: "the case has no [optimisation]".to_owned(),
                help: "add [optimisation] with an objective and the numbers that are sought"
                    .to_owned(),
                location: None,
            };
            return Err(CaseError::Wrong(vec![missing]).into());
        };
        let mut outside = check_starts(file);
        outside.retain(|one| one.key.starts_with("optimisation."));
        if !outside.is_empty() {
            return Err(CaseError::Wrong(outside).into());
        }
        let tier = tier_of(file);
        tier.check(file)?;
        let numbers = Numbers::new(file);
        numbers.check_bounds()?;
        let held = Multipliers::quantities(&spec.constraint);
        let objective = Objective::new(&spec.objective, &file.case().define, &held);
        Ok(Self { file: file.clone(), spec, numbers, objective, tier })
    }

    /// Seeks, with a journal of each round in a directory: what stands there of this search is not computed again, and so
    /// it goes on with the same bits.
    ///
    /// # Errors
    /// [`OptimiseError`]: there is no flow at the start, or a journal is of another search or cannot be written.
    pub fn seek(
        &self,
        directory: &Path,
        told: &mut dyn FnMut(&RoundProgress),
    ) -> Result<Optimum, OptimiseError> {
        let bounded = self.numbers.bounded();
        let Rounds { all, last, at_start, objective_at_start, mut sought, n } =
            self.rounds(directory, &bounded, told)?;
        let rise = RISE * last.best.objective.abs();
        let certainties = certainties(&bounded, &last.best, rise, &mut sought);
        check_whole().map_err(SearchError::from)?;
        let quantities = sought.quantities(&last.best.values)?;
        let values = |of: &[Derivatives]| of.iter().map(|one| one.value).collect();
        let best = sought.objective(&last.best.values).map_err(SearchError::Start)?;
        let with_held = slopes(&bounded, &last.best, -1.0);
        let own = slopes(&bounded, &best, -1.0).into_iter().zip(with_held);
        let is_held = !self.spec.constraint.is_empty();
        let slope = |(own, with_held)| Slope { own, with_held: is_held.then_some(with_held) };
        Ok(Optimum {
            objective: -best.objective,
            objective_at_start: -objective_at_start,
            held: sought.held(&last.best.values)?,
            file: self.numbers.case(&last.best.values)?,
            searched: fingerprint(&self.file),
            found: Found { all, ..last },
            n_rounds: n,
            bounded,
            certainties,
            slopes: own.map(slope).collect(),
            names: self.objective.quantities.clone(),
            quantities: values(&quantities),
            quantities_at_start: values(&at_start),
            references: self.spec.reference.clone(),
        })
    }

    /// One round after the other, until one of them stays where it began.
    fn rounds(
        &self,
        directory: &Path,
        bounded: &[Bounded],
        told: &mut dyn FnMut(&RoundProgress),
    ) -> Result<Rounds<'_>, OptimiseError> {
        let most = self.spec.search.evaluations;
        let mut bounded = bounded.to_vec();
        let mut all: Vec<Evaluated> = Vec::new();
        let mut at_start = Vec::new();
        let mut objective_at_start = f64::NAN;
        let mut way_before = f64::INFINITY;
        let held = &self.spec.constraint;
        let mut multipliers = Multipliers::new(held, 1.0);
        let most_rounds = if held.is_empty() { MOST_ROUNDS } else { MOST_ROUNDS_WITH_HELD };
        for round in 1..=most_rounds {
            let start: Vec<f64> = bounded.iter().map(|one| one.start).collect();
            let mut sought =
                OnOneMesh::new(&self.numbers, &self.objective, &multipliers, &start, &*self.tier);
            if round == 1 {
                // Why there is no flow is told as it is elsewhere, before there is a journal
                at_start = sought.quantities(&start)?;
                objective_at_start =
                    sought.objective(&start).map_err(SearchError::Start)?.objective;
                multipliers = Multipliers::new(held, objective_at_start.abs());
                sought.hold(&multipliers);
            }
            let used = all.len();
            let mut tell = |progress: &Progress| {
                let n_evaluations = used + progress.n_evaluations;
                let progress = Progress { n_evaluations, most, ..progress.clone() };
                told(&RoundProgress { round, progress });
            };
            let last = self.round(directory, round, &bounded, used, &mut sought, &mut tell)?;
            all.extend(last.all.iter().cloned());
            let way = way(&bounded, &start, &last.best.values);
            // Ways that do not fall are from what one mesh differs by from another
            let is_near = !self.tier.has_mesh()
                || way < NEAR
                || (last.ended == Ended::Converged && way > 0.5 * way_before);
            let is_left = all.len() < most && round < most_rounds;
            // A method that fails where no flow has failed has met what its mesh is too coarse for
            let may_go_on = last.ended != Ended::Evaluations && sought.failure.is_none();
            let held = sought.held(&last.best.values)?;
            let is_done = is_near && multipliers.are_settled(&held);
            if is_done || !is_left || !may_go_on {
                let n = round;
                return Ok(Rounds { all, last, at_start, objective_at_start, sought, n });
            }
            multipliers.correct(&held);
            way_before = way;
            for (one, value) in bounded.iter_mut().zip(&last.best.values) {
                one.start = *value;
            }
        }
        // The last round has returned
        Err(SearchError::Start("there was no round".to_owned()).into())
    }

    /// A round.
    fn round(
        &self,
        directory: &Path,
        round: usize,
        bounded: &[Bounded],
        used: usize,
        sought: &mut OnOneMesh<'_>,
        tell: &mut dyn FnMut(&Progress),
    ) -> Result<Found, SearchError> {
        let settings = Search {
            max_evaluations: self.spec.search.evaluations.saturating_sub(used),
            decrease: self.spec.search.decrease,
            slope: self.spec.search.slope,
            known: Vec::new(),
        };
        let journal = directory.join(format!("round-{round}.journal")).display().to_string();
        search(bounded, &settings, [&journal, &self.name(round)], sought, tell)
    }

    /// Which search a journal is of.
    fn name(&self, round: usize) -> String {
        let of = fingerprint(&self.file);
        format!(
            "alewife optimisation of {of}, round {round}, version {}",
            env!("CARGO_PKG_VERSION")
        )
    }
}

/// A number that tells the case of a search with its mesh from others.
fn fingerprint(file: &CaseFile) -> String {
    let mut bytes = file.case().to_toml().unwrap_or_default().into_bytes();
    let mesh = file.case().given_mesh().and_then(|mesh| mesh.bytes());
    bytes.extend_from_slice(mesh.unwrap_or_default());
    format!("crc32:{:08x}-{}", crc32fast::hash(&bytes), bytes.len())
}

/// The largest way of a number, in its scale or its logarithm.
fn way(bounded: &[Bounded], from: &[f64], to: &[f64]) -> f64 {
    let ways = bounded.iter().zip(from).zip(to).map(|((one, from), to)| {
        one.scale.map_or_else(|| (to / from).ln(), |scale| (to - from) / scale).abs()
    });
    ways.fold(0.0, f64::max)
}
