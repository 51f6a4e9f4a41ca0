//! `Evidence`: whether what is uncertain in a computed value and in its reference explains their difference.

use super::comparison::Comparison;

/// The part of a reference by which machines, threads and compilers may change a value.
const ROUNDING: f64 = 1e-9;

/// What a comparison shows, apart from its band.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Evidence {
    /// The difference is not above the uncertainties of both values together.
    Confirmed,
    /// It is above them: both agree to this, relative to the reference if the tolerance is.
    Consistent(f64),
}

impl Comparison {
    /// What the comparison shows; nothing for conditions, earlier values of this program and values
    /// that were not computed. An uncertainty that is not known counts as none.
    #[must_use]
    pub fn evidence(&self) -> Option<Evidence> {
        if !self.reference.expected.kind.is_evidence() {
            return None;
        }
        let difference = self.difference()?.abs();
        let numerical = self.numerical_share().unwrap_or_default();
        let own = self.reference_share().unwrap_or_default();
        // Written so that a difference that is not a number confirms nothing
        let scale = match self.reference.expected.relative {
            Some(_) => 1.0,
            None => self.reference.expected.value.abs(),
        };
        Some(if difference <= numerical + own + ROUNDING * scale {
            Evidence::Confirmed
        } else {
            Evidence::Consistent(difference)
        })
    }

    /// Its name in JSON.
    pub(super) fn evidence_name(&self) -> Option<&'static str> {
        self.evidence().map(|evidence| match evidence {
            Evidence::Confirmed => CONFIRMED,
            Evidence::Consistent(_) => "consistent",
        })
    }

    /// The same in words.
    pub(super) fn evidence_in_words(&self) -> String {
        match self.evidence() {
            None => "-".to_owned(),
            Some(Evidence::Confirmed) => CONFIRMED.to_owned(),
            Some(Evidence::Consistent(to)) => format!("{CONSISTENT}{}", self.share(to)),
        }
    }
}

const CONFIRMED: &str = "confirmed";
const CONSISTENT: &str = "consistent to ";

/// How many values are confirmed, and how many only consistent.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct EvidenceCount {
    pub confirmed: usize,
    pub consistent: usize,
}

impl EvidenceCount {
    /// Those of comparisons.
    pub fn of(comparisons: &[Comparison]) -> Self {
        comparisons.iter().fold(Self::default(), |sum, one| sum.with(&one.evidence_in_words()))
    }

    /// With that of a cell of a table.
    pub fn with(mut self, cell: &str) -> Self {
        self.confirmed += usize::from(cell == CONFIRMED);
        self.consistent += usize::from(cell.starts_with(CONSISTENT));
        self
    }

    /// In a sentence, if there are any.
    pub fn in_words(self) -> Option<String> {
        let all = self.confirmed + self.consistent;
        (all > 0).then(|| {
            format!(
                "of {all} with a reference that is evidence, {} confirmed and {} consistent to the \
                 difference shown",
                self.confirmed, self.consistent
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{Case, Reference, ReferenceKind, Uncertainty};
    use crate::validation::comparison::judge;

    fn row(factor: f64, change: impl Fn(&mut Comparison)) -> Comparison {
        let mut reference: Reference =
            Case::read("dfg-2d-1", &[]).unwrap().model.case.reference.remove(0);
        let expected = &mut reference.expected;
        (expected.relative, expected.absolute) = (Some(0.05), None);
        expected.kind = ReferenceKind::Literature;
        let computed = Ok(factor * reference.expected.value);
        let mut row = judge("c", &reference, computed, 1, 0.0);
        row.reference.expected.uncertainty = None;
        change(&mut row);
        row
    }

    #[test]
    fn a_value_is_confirmed_where_both_uncertainties_cover_the_difference() {
        let words = |factor: f64, numerical: f64, own: f64| {
            let change = |row: &mut Comparison| {
                let value = row.reference.expected.value;
                row.numerical = (numerical > 0.0).then_some(Ok(numerical * value));
                row.reference.expected.uncertainty =
                    (own > 0.0).then_some(Uncertainty::Percent(own));
            };
            row(factor, change).evidence_in_words()
        };
        assert_eq!(words(1.002, 0.0015, 0.1), "confirmed");
        assert_eq!(words(0.998, 0.0015, 0.1), "confirmed");
        assert_eq!(words(1.003, 0.0015, 0.1), "consistent to 0.30%");
        // What is not known covers nothing
        assert_eq!(words(1.002, 0.0, 0.1), "consistent to 0.20%");
        assert_eq!(words(1.002, 0.0, 0.0), "consistent to 0.20%");
        assert_eq!(words(1.0, 0.0, 0.0), "confirmed");
    }

    #[test]
    fn conditions_and_earlier_values_are_no_evidence() {
        for kind in ReferenceKind::ALL {
            let reported = row(1.0, |row| row.reference.expected.kind = kind).evidence();
            let is_evidence = !matches!(kind, ReferenceKind::Property | ReferenceKind::Regression);
            assert_eq!(reported.is_some(), is_evidence, "{kind:?}");
        }
        let failed = row(1.0, |row| row.computed = Err("it diverged".to_owned()));
        assert_eq!((failed.evidence(), failed.evidence_in_words()), (None, "-".to_owned()));
        let rows = [failed, row(1.0, |_| ()), row(1.1, |_| ())];
        let count = EvidenceCount::of(&rows);
        assert_eq!(count, EvidenceCount { confirmed: 1, consistent: 1 });
        assert!(count.in_words().unwrap().starts_with("of 2 with"));
        assert_eq!(EvidenceCount::default().in_words(), None);
    }
}
