//! `FormulaError`: what is not understood in an expression, and where.

use std::fmt;

/// What is not understood in an expression.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FormulaError {
    /// Character of the text, from 1.
    pub column: usize,
    /// What is there.
    pub found: String,
    /// What would be accepted.
    pub accepted: String,
}

impl fmt::Display for FormulaError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "at character {}: {}; {}", self.column, self.found, self.accepted)
    }
}

impl std::error::Error for FormulaError {}
