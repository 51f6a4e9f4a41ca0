//! What is said of a search that has ended: its numbers, how well they are determined, why it ended.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::{Bounded, Certainty, Ended, Found};

/// How well each number of a search is determined, or why that is not known.
pub type Certainties = Result<Vec<Certainty>, String>;

impl Ended {
    /// In words.
    #[must_use]
    pub fn text(&self) -> String {
        match self {
            Self::Converged => "it converged".to_owned(),
            Self::Evaluations => "its evaluations are used up: the best so far".to_owned(),
            Self::Failed(why) => format!("it failed ({why}): the best so far"),
        }
    }

    /// As a word, of a failure with its reason.
    #[must_use]
    pub fn word(&self) -> String {
        match self {
            Self::Converged => "converged".to_owned(),
            Self::Evaluations => "evaluations".to_owned(),
            Self::Failed(why) => format!("failed: {why}"),
        }
    }
}

impl Found {
    /// Whether the objective depends on any number, as far as its derivatives say.
    #[must_use]
    pub fn has_effect(&self) -> bool {
        self.all.iter().any(|one| one.slopes.iter().any(|slope| *slope != 0.0))
    }

    /// What is to be said of a search that has found nothing.
    #[must_use]
    pub fn remark(&self) -> Option<&'static str> {
        let start = self.all.first()?;
        if !self.has_effect() {
            Some("nothing depends on any of the numbers: it is where it started")
        } else if self.best.values == start.values {
            Some("no number moved: nothing that was tried is better than the start")
        } else {
            None
        }
    }
}

/// A line for each number that was found, with its start, bounds and certainty.
#[must_use]
pub fn number_lines(bounded: &[Bounded], found: &Found, certainties: &Certainties) -> String {
    let mut text = String::new();
    let width = bounded.iter().map(|one| one.name.len()).max().unwrap_or(0);
    for (index, one) in bounded.iter().enumerate() {
        let value = found.best.values[index];
        let known = certainties.as_ref().ok().map(|all| certainty(one, value, &all[index]));
        let _ = writeln!(
            text,
            "  {:<width$}  {value:.6e}  from {:.4e}, bounds {:.4e} {:.4e}  {}",
            one.name,
            one.start,
            one.lower,
            one.upper,
            known.unwrap_or_default()
        );
    }
    if let Some(remark) = found.remark() {
        let _ = writeln!(text, "{remark}");
    }
    if let Err(why) = certainties {
        let _ = writeln!(text, "how well they are determined is not known: {why}");
    }
    text
}

/// What is known of a number, in words.
fn certainty(of: &Bounded, value: f64, one: &Certainty) -> String {
    let word = if one.is_determined { "" } else { "UNDETERMINED: " };
    match (one.reach, of.scale) {
        (None, _) => format!("at its bound, slope {:.2e}", one.slope),
        (Some(reach), _) if reach.is_infinite() => format!("{word}along a valley"),
        (Some(reach), None) => format!("{word}within a factor of {:.3}", reach.exp()),
        (Some(reach), Some(scale)) => format!("{word}within {:.2e} of {value:.3e}", reach * scale),
    }
}

/// The numbers that were found, as JSON.
#[must_use]
pub fn numbers_to_json(bounded: &[Bounded], found: &Found, certainties: &Certainties) -> Value {
    let number = |(index, one): (usize, &Bounded)| {
        let known = certainties.as_ref().ok().map(|all| all[index]);
        json!({
            "name": one.name,
            "value": found.best.values[index],
            "start": one.start,
            "bounds": [one.lower, one.upper],
            "scale": one.scale,
            "slope": known.map(|known| known.slope),
            "reach": known.and_then(|known| known.reach).filter(|reach| reach.is_finite()),
            "determined": known.map(|known| known.is_determined),
        })
    };
    bounded.iter().enumerate().map(number).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::search::Evaluated;

    #[test]
    fn a_search_that_finds_nothing_says_so() {
        let at = |value: f64, objective: f64, slope: f64| Evaluated {
            values: vec![value],
            objective,
            slopes: vec![slope],
        };
        let found = |all: Vec<Evaluated>, best: usize| Found {
            best: all[best].clone(),
            all,
            ended: Ended::Converged,
        };
        let moved = found(vec![at(1.0, 2.0, -1.0), at(2.0, 1.0, 0.0)], 1);
        assert!(moved.has_effect() && moved.remark().is_none());
        let stays = found(vec![at(1.0, 2.0, -1.0), at(2.0, 3.0, 0.5)], 0);
        assert!(stays.has_effect() && stays.remark().is_some_and(|one| one.contains("no number")));
        let idle = found(vec![at(1.0, 2.0, 0.0)], 0);
        assert!(!idle.has_effect() && idle.remark().is_some_and(|one| one.contains("depends")));
        let one = Bounded { name: "k".to_owned(), start: 1.0, lower: 0.5, upper: 2.0, scale: None };
        let lines = number_lines(&[one], &idle, &Err("none".to_owned()));
        assert!(lines.contains("nothing depends"), "{lines}");
    }
}
