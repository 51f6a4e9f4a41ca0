//! `search`: a search with a journal, and its progress.

use std::path::Path;
use std::time::{Duration, Instant};

use alewife_interrupt::check_whole;

use super::{Bounded, Evaluated, Found, Journal, Opened, Search, SearchError, Sought, minimise};

/// How far a search is.
#[derive(Debug, Clone, PartialEq)]
pub struct Progress {
    /// Evaluations so far, those of an earlier process included.
    pub n_evaluations: usize,
    /// Evaluations at most.
    pub most: usize,
    /// The last evaluation.
    pub last: Evaluated,
    /// The smallest objective so far.
    pub best: f64,
    /// Mean time of an evaluation in this process.
    pub each: Duration,
}

impl Progress {
    /// Time that all evaluations which may still come would take: an upper bound.
    #[must_use]
    pub fn remaining(&self) -> Duration {
        let n = self.most.saturating_sub(self.n_evaluations);
        self.each.saturating_mul(u32::try_from(n).unwrap_or(u32::MAX))
    }
}

/// Makes an objective small, with all evaluations in a journal: what stands there is not evaluated again, and so
/// a search that was stopped or killed goes on with the same bits. `name` says which search it is, `told` is called after
/// each evaluation.
///
/// # Errors
/// Those of [`minimise`] and [`Journal::open`], and [`SearchError::Stopped`].
pub fn search(
    parameters: &[Bounded],
    settings: &Search,
    [journal, name]: [&str; 2],
    sought: &mut dyn Sought,
    told: &mut dyn FnMut(&Progress),
) -> Result<Found, SearchError> {
    for parameter in parameters {
        parameter.check()?;
    }
    let Opened { mut journal, known } = Journal::open(Path::new(journal), name)?;
    let mut best = known.iter().map(|found| found.objective).fold(f64::INFINITY, f64::min);
    let mut n_evaluations = known.len();
    let (begun, n_known) = (Instant::now(), known.len());
    let settings = Search { known, ..settings.clone() };
    let found = minimise(parameters, &settings, |values| {
        let last = sought.evaluate(values).and_then(|found| with_value(parameters, found));
        // Where it starts, `SearchError::Start` says so
        let last = last.map_err(|said| match n_evaluations {
            0 => said,
            _ => format!("at {}: {said}", place(parameters, values)),
        })?;
        // One of which a part was left as it was is none
        check_whole().map_err(|stopped| stopped.to_string())?;
        journal.add(&last).map_err(|error| error.to_string())?;
        n_evaluations += 1;
        best = best.min(last.objective);
        let n_here = u32::try_from(n_evaluations - n_known).unwrap_or(u32::MAX);
        told(&Progress {
            n_evaluations,
            most: settings.max_evaluations,
            last: last.clone(),
            best,
            each: begun.elapsed() / n_here,
        });
        Ok::<_, String>(last)
    });
    check_whole()?;
    found
}

/// Values of the parameters, by their names.
fn place(parameters: &[Bounded], values: &[f64]) -> String {
    let each = parameters.iter().zip(values).map(|(one, value)| format!("{} = {value}", one.name));
    each.collect::<Vec<_>>().join(", ")
}

/// An evaluation all numbers of which are finite.
fn with_value(parameters: &[Bounded], found: Evaluated) -> Result<Evaluated, String> {
    if !found.objective.is_finite() {
        return Err(format!("the objective has no value, it is {}", found.objective));
    }
    let wrong = parameters.iter().zip(&found.slopes).find(|(_, slope)| !slope.is_finite());
    match wrong {
        Some((one, slope)) => {
            Err(format!("the slope of the objective by {} has no value, it is {slope}", one.name))
        }
        None => Ok(found),
    }
}
