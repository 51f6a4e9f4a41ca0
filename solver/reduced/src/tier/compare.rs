//! References of a soft case beside what was computed.

use alewife_case::soft::spec::{ReferenceOf, SoftCase, SoftReference};
use serde_json::{Value, json};

/// A reference beside what was computed.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// The reference.
    pub reference: SoftReference,
    /// What was computed; nothing where there is no such quantity.
    pub computed: Option<f64>,
}

impl Compared {
    /// Whether the value is within its tolerance.
    #[must_use]
    pub fn is_within(&self) -> bool {
        let SoftReference { value, .. } = self.reference;
        self.computed.is_some_and(|computed| (computed - value).abs() <= self.reference.allowed())
    }

    /// In a line.
    #[must_use]
    pub fn line(&self) -> String {
        let SoftReference { quantity, value, kind, source, .. } = &self.reference;
        let computed = self.computed.map_or("no such quantity".to_owned(), |x| format!("{x:.6e}"));
        let verdict = if self.is_within() { "within" } else { "OUTSIDE" };
        let allowed = self.reference.allowed();
        let kind = kind.name();
        format!(
            "{verdict:<8} {quantity} = {computed}, {value:.6e} +- {allowed:.1e} ({kind}: {source})"
        )
    }

    /// As JSON.
    #[must_use]
    pub fn to_json(&self) -> Value {
        json!({
            "quantity": self.reference.quantity,
            "reference": self.reference.value,
            "allowed": self.reference.allowed(),
            "kind": self.reference.kind.name(),
            "source": self.reference.source,
            "computed": self.computed,
            "within": self.is_within(),
        })
    }
}

/// Compares what a command has computed with the references that are of it.
pub fn compare(
    case: &SoftCase,
    of: ReferenceOf,
    value: &dyn Fn(&str) -> Option<f64>,
) -> Vec<Compared> {
    let own = case.reference.iter().filter(|reference| reference.of == of);
    own.map(|reference| Compared {
        computed: value(&reference.quantity),
        reference: reference.clone(),
    })
    .collect()
}
