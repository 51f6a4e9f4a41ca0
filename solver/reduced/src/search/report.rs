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
