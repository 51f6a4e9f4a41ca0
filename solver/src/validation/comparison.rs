//! `Comparison`: a reference beside what was computed, and the verdict.

use serde_json::{Value, json};

use super::statistic::measured_value;
use crate::case::{Case, Reference};
use crate::run::{RunSummary, Series};

/// What a comparison came to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Within the tolerance.
    Within,
    /// Outside the tolerance, for the reason the reference gives.
    KnownOutside,
    /// Outside the tolerance.
    Outside,
    /// Within the tolerance, though the reference gives a reason why it is not.
    NoLongerOutside,
    /// There is nothing to compare.
    NotComputed,
}

impl Verdict {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::Within, Self::KnownOutside, Self::Outside, Self::NoLongerOutside, Self::NotComputed];

    /// Name in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Within => "within",
            Self::KnownOutside => "OUTSIDE, known",
            Self::Outside => "OUTSIDE",
            Self::NoLongerOutside => "NO LONGER OUTSIDE",
            Self::NotComputed => "NOT COMPUTED",
        }
    }

    /// Whether a validation with such a comparison fails.
    #[must_use]
    pub fn is_failure(self) -> bool {
        !matches!(self, Self::Within | Self::KnownOutside)
    }
}

/// A reference beside what was computed.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Name of the case, with its variant.
    pub case: String,
    /// Which quantity, with its statistic unless that is the final value.
    pub quantity: String,
    /// What was computed, or why it was not.
    pub computed: Result<f64, String>,
    /// The value, its kind and source, and how near we should be.
    pub reference: Reference,
    /// The verdict.
    pub verdict: Verdict,
    /// Unknowns of the linear system; 0 if it was not made.
    pub dofs: usize,
    /// CPU seconds of the run.
    pub cpu_seconds: f64,
    /// Discretisation error of the computed value, or why it is not known; nothing if nobody asked.
    pub numerical: Option<Result<f64, String>>,
}

/// Compares a run with all references of its case.
#[must_use]
pub fn compare(name: &str, case: &Case, outcome: &RunSummary) -> Vec<Comparison> {
    let cpu_seconds = outcome.timing.cpu.iter().sum();
    compare_series(name, case, &outcome.series, outcome.n_dofs, cpu_seconds)
}

/// Compares a series of quantities, of so many unknowns and seconds, with all references of its case.
#[must_use]
pub fn compare_series(
    name: &str,
    case: &Case,
    series: &Series,
    n_dofs: usize,
    cpu_seconds: f64,
) -> Vec<Comparison> {
    case.reference
        .iter()
        .map(|reference| {
            let computed = measured_value(series, case, &reference.statistic);
            let computed = computed.map_err(|error| error.to_string()).and_then(|value| {
                let value = value / reference.expected.per;
                let is_of_cycle = reference.statistic.quantity.contains(".cycle.");
                match value {
                    value if value.is_finite() => Ok(value),
                    _ if is_of_cycle => Err(format!(
                        "{} is not a number: no whole cycle had ended by then",
                        reference.statistic.quantity
                    )),
                    value => Err(format!("{} is {value}", reference.statistic.quantity)),
                }
            });
            judge(name, reference, computed, n_dofs, cpu_seconds)
        })
        .collect()
}

/// The references of a case that could not be run, and why.
#[must_use]
pub fn not_computed(name: &str, case: &Case, reason: &str) -> Vec<Comparison> {
    case.reference
        .iter()
        .map(|reference| judge(name, reference, Err(reason.to_owned()), 0, 0.0))
        .collect()
}

pub(super) fn judge(
    name: &str,
    reference: &Reference,
    computed: Result<f64, String>,
    dofs: usize,
    cpu_seconds: f64,
) -> Comparison {
    let verdict = match &computed {
        Err(_) => Verdict::NotComputed,
        // Written so that a value that is not a number is outside, too.
        Ok(value) if (value - reference.expected.value).abs() <= allowed(reference) => {
            if reference.expected.outside.is_some() {
                Verdict::NoLongerOutside
            } else {
                Verdict::Within
            }
        }
        Ok(value) if reference.expected.outside.is_some() && value.is_finite() => {
            Verdict::KnownOutside
        }
        Ok(_) => Verdict::Outside,
    };
    Comparison {
        case: name.to_owned(),
        quantity: reference.statistic.label(),
        computed,
        reference: reference.clone(),
        verdict,
        dofs,
        cpu_seconds,
        numerical: None,
    }
}

/// Largest accepted difference.
fn allowed(reference: &Reference) -> f64 {
    match (reference.expected.relative, reference.expected.absolute) {
        (Some(relative), _) => relative * reference.expected.value.abs(),
        (None, Some(absolute)) => absolute,
        (None, None) => 0.0,
    }
}

impl Comparison {
    /// Computed less reference, relative if the tolerance is.
    #[must_use]
    pub fn difference(&self) -> Option<f64> {
        let difference = self.computed.as_ref().ok()? - self.reference.expected.value;
        Some(match self.reference.expected.relative {
            Some(_) => difference / self.reference.expected.value.abs(),
            None => difference,
        })
    }

    /// The numerical uncertainty of the computed value, if it has one.
    #[must_use]
    pub fn numerical_uncertainty(&self) -> Option<f64> {
        self.numerical.as_ref()?.as_ref().ok().copied()
    }

    /// The same relative to the reference, if the tolerance is.
    #[must_use]
    pub fn numerical_share(&self) -> Option<f64> {
        let uncertainty = self.numerical_uncertainty()?;
        Some(match self.reference.expected.relative {
            Some(_) => uncertainty / self.reference.expected.value.abs(),
            None => uncertainty,
        })
    }

    /// The reference's own uncertainty, relative to it if the tolerance is.
    #[must_use]
    pub fn reference_share(&self) -> Option<f64> {
        let expected = &self.reference.expected;
        let own = expected.uncertainty?.of(expected.value);
        Some(match expected.relative {
            Some(_) => own / expected.value.abs(),
            None => own,
        })
    }

    /// The comparison as an object: numbers as numbers, `null` where there is none.
    #[must_use]
    pub fn to_json(&self) -> Value {
        json!({
            "case": self.case,
            "quantity": self.reference.statistic.quantity,
            "minus": self.reference.statistic.minus,
            "statistic": self.reference.statistic.kind.name(),
            "at": self.reference.statistic.at,
            "level": self.reference.statistic.level,
            "of": self.reference.statistic.of,
            "computed": self.computed.as_ref().ok(),
            "reference": self.reference.expected.value,
            "kind": self.reference.expected.kind.name(),
            "date": self.reference.expected.date,
            "uncertainty": self.reference_share(),
            "numerical_uncertainty": self.numerical_share(),
            "difference": self.difference(),
            "tolerance": self.reference.expected.relative.or(self.reference.expected.absolute),
            "is_relative": self.reference.expected.relative.is_some(),
            "source": self.reference.expected.source,
            "note": self.reference.expected.note,
            "verdict": self.verdict.name().to_lowercase(),
            "evidence": self.evidence_name(),
            "outside": self.reference.expected.outside,
            "cause": self.reference.expected.cause,
            "reason": self.computed.as_ref().err(),
            "dofs": self.dofs,
            "cpu_seconds": self.cpu_seconds,
        })
    }
}
