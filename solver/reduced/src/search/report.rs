//! What is said of a search that has ended: its numbers, how well they are determined, why it ended.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::{Bounded, Certainty, Ended, Evaluated, Found};

/// How well each number of a search is determined, or why that is not known.
pub type Certainties = Result<Vec<Certainty>, String>;

/// Change of an objective (in units of it) by a change of a parameter of its scale, or of its logarithm by 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slope {
    /// Of the objective itself.
    pub own: f64,
    /// The same where what is held stays as it is, as far as the multipliers of the search say; none where nothing is held.
    pub with_held: Option<f64>,
}

/// The slopes of an objective by each parameter, with another sign where it was made large.
#[must_use]
pub fn slopes(bounded: &[Bounded], at: &Evaluated, sign: f64) -> Vec<f64> {
    let numbers = bounded.iter().zip(&at.values).zip(&at.slopes);
    numbers.map(|((one, value), slope)| sign * slope * one.slope(*value)).collect()
}

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

/// A line for each number that was found, with its start, bounds and certainty, or its slope at a bound.
#[must_use]
pub fn number_lines(
    bounded: &[Bounded],
    found: &Found,
    certainties: &Certainties,
    slopes: &[Slope],
) -> String {
    let mut text = String::new();
    let width = bounded.iter().map(|one| one.name.len()).max().unwrap_or(0);
    for (index, one) in bounded.iter().enumerate() {
        let value = found.best.values[index];
        let known = certainties.as_ref().ok();
        let known = known.map(|all| certainty(one, value, &all[index], slopes[index]));
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
fn certainty(of: &Bounded, value: f64, one: &Certainty, slope: Slope) -> String {
    let word = if one.is_determined { "" } else { "UNDETERMINED: " };
    match (one.reach, of.scale) {
        (None, _) => {
            let held = slope.with_held.map(|slope| format!(", {slope:.2e} with what is held"));
            format!("at its bound, slope {:.2e}{}", slope.own, held.unwrap_or_default())
        }
        (Some(reach), _) if reach.is_infinite() => format!("{word}along a valley"),
        (Some(reach), None) => format!("{word}within a factor of {:.3}", reach.exp()),
        (Some(reach), Some(scale)) => format!("{word}within {:.2e} of {value:.3e}", reach * scale),
    }
}

/// The numbers that were found, as JSON.
#[must_use]
pub fn numbers_to_json(
    bounded: &[Bounded],
    found: &Found,
    certainties: &Certainties,
    slopes: &[Slope],
) -> Value {
    let number = |(index, one): (usize, &Bounded)| {
        let known = certainties.as_ref().ok().map(|all| all[index]);
        let mut number = json!({
            "name": one.name,
            "value": found.best.values[index],
            "start": one.start,
            "bounds": [one.lower, one.upper],
            "scale": one.scale,
            "slope": slopes[index].own,
            "reach": known.and_then(|known| known.reach).filter(|reach| reach.is_finite()),
            "determined": known.map(|known| known.is_determined),
        });
        if let Some(slope) = slopes[index].with_held {
            number["slope_with_constraints"] = json!(slope);
        }
        number
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
        let one = [one];
        let slope = |with_held| [Slope { own: -3.0, with_held }];
        let lines = number_lines(&one, &idle, &Err("none".to_owned()), &slope(None));
        assert!(lines.contains("nothing depends"), "{lines}");
        // At a bound of 2 a slope of 0.5 of what is made small is one of 1 less by a logarithm of what is made large
        let at = at(2.0, -7.0, 0.5);
        assert_eq!(slopes(&one, &at, -1.0), [-1.0]);
        let known = Ok(vec![Certainty { reach: None, is_determined: true }]);
        let lines = number_lines(&one, &moved, &known, &slope(Some(0.25)));
        let wanted = "at its bound, slope -3.00e0, 2.50e-1 with what is held";
        assert!(lines.contains(wanted), "{lines}");
        let told = numbers_to_json(&one, &moved, &known, &slope(Some(0.25)));
        assert_eq!([&told[0]["slope"], &told[0]["slope_with_constraints"]], [-3.0, 0.25]);
    }
}
