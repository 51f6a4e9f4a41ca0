//! `SweepQuantity`: a number a sweep collects of every point: a quantity, and its statistic.

use std::fmt;

use crate::quantity::is_of_a_side;
use crate::text::source::Origin;
use crate::text::tree::{TomlNode, TreeError};
use crate::text::type_error::suggestion;
use crate::{Diagnostic, Model, Statistic, StatisticKind, known_quantities};

/// Statistics that need nothing but a quantity.
const STATISTICS: [StatisticKind; 6] = [
    StatisticKind::Final,
    StatisticKind::Mean,
    StatisticKind::Max,
    StatisticKind::Min,
    StatisticKind::Rms,
    StatisticKind::Range,
];

/// A quantity of a run, and how its series becomes a number.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepQuantity {
    /// The number.
    pub statistic: Statistic,
    origin: Option<Origin>,
}

impl SweepQuantity {
    /// Reads `squirmer.velocity.x`, or `mean squirmer.velocity.x`.
    ///
    /// # Errors
    /// What is wrong with the word in front, and what it may be.
    pub fn parse(text: &str) -> Result<Self, String> {
        let of = |quantity: &str, kind| {
            let quantity = quantity.to_owned();
            let statistic = Statistic { quantity, kind, ..Statistic::default() };
            Self { statistic, origin: None }
        };
        match text.split_whitespace().collect::<Vec<_>>()[..] {
            [quantity] => Ok(of(quantity, StatisticKind::Final)),
            [word, quantity] => {
                let kind = STATISTICS.into_iter().find(|one| one.name() == word);
                kind.map(|kind| of(quantity, kind)).ok_or_else(|| {
                    let known = STATISTICS.map(StatisticKind::name);
                    format!("\"{word}\" is no statistic; {}", suggestion(word, &known))
                })
            }
            _ => Err(format!(
                "\"{text}\" is no quantity; write its name, such as \"squirmer.velocity.x\", or \"mean \
                 squirmer.velocity.x\""
            )),
        }
    }

    /// Why a run of a case has no such quantity; nothing if it has.
    pub(crate) fn mistake(&self, model: &Model) -> Option<Diagnostic> {
        let known = known_quantities(model);
        let mut found = self.mistake_among(&known)?;
        if is_of_a_side(model, &self.statistic.quantity) {
            "quantities of sides need output.sides = true".clone_into(&mut found.help);
        }
        Some(found)
    }

    /// The same where a run has these quantities.
    pub(crate) fn mistake_among(&self, known: &[String]) -> Option<Diagnostic> {
        if known.contains(&self.statistic.quantity) {
            return None;
        }
        let message = format!("a run has no quantity `{}`", self.statistic.quantity);
        let help = suggestion(&self.statistic.quantity, known);
        let mut diagnostic = Diagnostic::error("sweep.quantities", message, &help);
        diagnostic.location = self.origin.as_ref().map(Origin::location);
        Some(diagnostic)
    }
}

/// As it is written in a case.
impl fmt::Display for SweepQuantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.statistic.kind {
            StatisticKind::Final => f.write_str(&self.statistic.quantity),
            other => write!(f, "{} {}", other.name(), self.statistic.quantity),
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
