//! `DerivedNumber`: a number that follows from a case.

/// A number that follows from a case.
#[derive(Debug, Clone, PartialEq)]
pub struct DerivedNumber {
    /// What it is called.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// What it is made of.
    pub formula: String,
}
