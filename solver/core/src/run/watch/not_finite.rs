//! `NotFinite`: an expression of a case that has no finite value where or when a flow is sought.

/// An expression at a place where it has no finite value.
#[derive(Debug, Clone, PartialEq)]
pub struct NotFinite {
    /// Its key.
    pub key: String,
    /// As it is written.
    pub written: String,
    /// What it is there: no number, or infinite.
    pub value: f64,
    /// Where (m).
    pub near: Vec<f64>,
    /// Whether that is in the frame of a body.
    pub is_of_body: bool,
    /// When (s).
    pub time: f64,
}
