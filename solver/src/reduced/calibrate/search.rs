//! A search by proposals: coefficients that make what is left small, without derivatives.

use std::path::{Path, PathBuf};

use alewife_reduced::search::{
    Bounded, Effort, Ended, External, HALVINGS, Journal, Method, Opened, Proposals, propose,
};
use alewife_reduced::tree::{Fit, Residuals, fit};

use super::error::CalibrateError;
use super::sought::Sought;
use crate::case::{ProposalSpec, Proposer};

/// The journal of a search, in its directory.
pub const JOURNAL: &str = "search.journal";

/// Where a search is, and who is told of it.
pub struct Desk<'a> {
    /// Where the journal is written; nowhere if absent.
    pub directory: Option<PathBuf>,
    /// Where the program of a proposer is run.
    pub case_directory: PathBuf,
    /// Which search it is, for the journal.
    pub name: String,
    /// Called after each motion, with a line.
    pub told: &'a mut dyn FnMut(&str),
}

/// What became of the proposals of a search.
#[derive(Debug, Clone, PartialEq)]
pub struct Tally {
    /// What proposed.
    pub proposer: Proposer,
    /// Motions, those on the way to proposals included.
    pub n_evaluations: usize,
    /// Points that were proposed.
    pub n_proposals: usize,
    /// Those on the way to which a better point was found.
    pub n_accepted: usize,
    /// Those that were better themselves.
    pub n_at_once: usize,
    /// Why it ended.
    pub ended: Ended,
}

impl Tally {
    /// Shares of proposals that were accepted, and that were so as they were proposed, without the line search.
    #[must_use]
    pub fn shares(&self) -> [f64; 2] {
        [self.n_accepted, self.n_at_once].map(|n| n as f64 / self.n_proposals.max(1) as f64)
    }

    /// In a line.
    #[must_use]
    pub fn text(&self) -> String {
        let Self { proposer, n_evaluations, n_proposals, n_accepted, n_at_once, ended } = self;
        let [with, without] = self.shares().map(|share| 100.0 * share);
        format!(
            "{}: {n_evaluations} motions, {n_proposals} proposals, {n_accepted} of them accepted ({with:.0} %), \
             {n_at_once} as proposed ({without:.0} %); {}",
            proposer.name(),
            ended.text()
        )
    }
}

/// What a search has found.
pub struct Searched {
    pub fit: Fit,
    pub tally: Tally,
}

/// Makes residuals small by proposals.
///
/// # Errors
/// `CalibrateError` when the start fails, the journal is of another search or cannot be written, or a program does not
/// answer as it should.
pub fn searched(
    residuals: &impl Residuals,
    sought: &Sought,
    spec: &ProposalSpec,
    desk: &mut Desk<'_>,
) -> Result<Searched, CalibrateError> {
    let bounded = |(nth, name): (usize, &String)| Bounded {
        name: name.clone(),
        start: sought.start[nth],
        lower: sought.bounds[nth].lower,
        upper: sought.bounds[nth].upper,
        scale: Some(1.0),
    };
    let bounded: Vec<Bounded> = sought.names.iter().enumerate().map(bounded).collect();
    let opened = desk.directory.as_ref().map(|one| Journal::open(&one.join(JOURNAL), &desk.name));
    let (journal, known) = match opened.transpose()? {
        Some(Opened { journal, known }) => (Some(journal), known),
        None => (None, Vec::new()),
    };
    let (most, told) = (spec.evaluations, &mut desk.told);
    let effort = Effort { evaluations: most, halvings: spec.halvings.unwrap_or(HALVINGS) };
    let (mut n, mut best) = (known.len(), f64::INFINITY);
    let mut evaluate = |values: &[f64]| {
        let square = |left: Vec<f64>| 0.5 * left.iter().map(|one| one * one).sum::<f64>();
        let objective = residuals.values(values).map_or(f64::INFINITY, square);
        n += 1;
        best = best.min(objective);
        let left = (2.0 * objective).sqrt();
        told(&format!("[{n}/{most}] left {left:.6e}, best of these {:.6e}", (2.0 * best).sqrt()));
        objective
    };
    let mut proposals = Proposals::new(&bounded, effort, &mut evaluate, journal, known)?;
    let start_cost = proposals.objective();
    let seed = spec.seed.unwrap_or_default();
    let program =
        External { command: spec.command.clone(), directory: desk.case_directory.clone() };
    let mut ask = |proposals: &Proposals<'_>| program.ask(proposals);
    let method = match spec.proposer {
        Proposer::Random => Method::Random { seed },
        Proposer::NelderMead => Method::NelderMead,
        Proposer::CmaEs => Method::CmaEs { seed },
        Proposer::External => Method::External(&mut ask),
    };
    let ended = propose(&mut proposals, method)?;
    if let (Ended::Failed(what), Proposer::External) = (&ended, spec.proposer) {
        return Err(CalibrateError::Program(what.clone()));
    }
    let count = |is_it: fn(f64) -> bool| {
        proposals.all().iter().filter(|one| one.accepted.is_some_and(is_it)).count()
    };
    let tally = Tally {
        proposer: spec.proposer,
        n_evaluations: proposals.n_evaluations(),
        n_proposals: proposals.all().len(),
        n_accepted: count(|_| true),
        n_at_once: count(|part| part >= 1.0),
        ended,
    };
    let there = fit(residuals, proposals.best(), &sought.bounds, 0)?;
    Ok(Searched { fit: Fit { start_cost, steps: tally.n_proposals, ..there }, tally })
}

/// The directory of a case file.
pub fn directory_of(file: &str) -> PathBuf {
    let directory = Path::new(file).parent().filter(|one| !one.as_os_str().is_empty());
    directory.map_or_else(|| PathBuf::from("."), Path::to_path_buf)
}
