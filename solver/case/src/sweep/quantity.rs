//! `SweepQuantity`: a number a sweep collects of every point: a quantity, and its statistic.

use std::fmt;

use crate::source::Origin;
use crate::tree::{TomlNode, TreeError};
use crate::type_error::suggestion;
use crate::{Diagnostic, Model, Statistic, known_quantities};

/// Statistics that need nothing but a quantity.
const STATISTICS: [Statistic; 6] = [
    Statistic::Final,
    Statistic::Mean,
    Statistic::Max,
    Statistic::Min,
    Statistic::Rms,
    Statistic::Range,
];

/// A quantity of a run, and how its series becomes a number.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepQuantity {
    /// A column of `series.csv`.
    pub quantity: String,
    /// How it becomes a number.
    pub statistic: Statistic,
    origin: Option<Origin>,
}

impl SweepQuantity {
    /// Reads `squirmer.velocity.x`, or `mean squirmer.velocity.x`.
    ///
    /// # Errors
    /// What is wrong with the word in front, and what it may be.
    pub fn parse(text: &str) -> Result<Self, String> {
        let of = |quantity: &str, statistic| Self {
            quantity: quantity.to_owned(),
            statistic,
            origin: None,
        };
        match text.split_whitespace().collect::<Vec<_>>()[..] {
            [quantity] => Ok(of(quantity, Statistic::Final)),
            [word, quantity] => {
                let statistic = STATISTICS.into_iter().find(|one| one.name() == word);
                statistic.map(|statistic| of(quantity, statistic)).ok_or_else(|| {
                    let known = STATISTICS.map(Statistic::name);
                    format!("\"{word}\" is no statistic; {}", suggestion(word, &known))
                })
            }
            _ => Err(format!(
                "\"{text}\" is no quantity; write its name, such as \"squirmer.velocity.x\", or \"mean \
                 squirmer.velocity.x\""
            )),
        }
    }

    /// The quantity, with its statistic unless that is the final value.
    #[must_use]
    pub fn label(&self) -> String {
        match self.statistic {
            Statistic::Final => self.quantity.clone(),
            other => format!("{} ({})", self.quantity, other.name()),
        }
    }

    /// Why a run of a case has no such quantity; nothing if it has.
    pub(crate) fn mistake(&self, model: &Model) -> Option<Diagnostic> {
        let known = known_quantities(model);
        if known.contains(&self.quantity) {
            return None;
        }
        let message = format!("a run has no quantity `{}`", self.quantity);
        let help = suggestion(&self.quantity, &known);
        let mut diagnostic = Diagnostic::error("sweep.quantities", message, &help);
        diagnostic.location = self.origin.as_ref().map(Origin::location);
        Some(diagnostic)
    }
}

/// As it is written in a case.
impl fmt::Display for SweepQuantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.statistic {
            Statistic::Final => f.write_str(&self.quantity),
            other => write!(f, "{} {}", other.name(), self.quantity),
        }
    }
}

/// Reads `sweep.quantities`.
///
/// # Errors
/// When it is no list of quantities.
pub fn read(node: &TomlNode) -> Result<Vec<SweepQuantity>, TreeError> {
    let refused = |node: &TomlNode, message: String| TreeError {
        origin: node.origin.clone(),
        message,
        help: "write a list such as [\"squirmer.velocity.x\", \"mean squirmer.power\"]".to_owned(),
    };
    let items =
        node.array().ok_or_else(|| refused(node, "`sweep.quantities` is no list".to_owned()))?;
    let mut quantities = Vec::new();
    for item in items {
        let text = item.text().ok_or_else(|| refused(item, "this is no text".to_owned()))?;
        let quantity = SweepQuantity::parse(text).map_err(|reason| refused(item, reason))?;
        quantities.push(SweepQuantity { origin: Some(item.origin.clone()), ..quantity });
    }
    Ok(quantities)
}
