//! `RodError`: why there is no rod of given properties.

use std::fmt;

/// Why there is no rod of given properties.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RodError {
    /// A length or a number of elements that makes no rod.
    Size {
        /// Length (m).
        length: f64,
        /// Number of elements.
        elements: usize,
    },
    /// A property that is not finite, negative, or zero where it has to be positive.
    Property {
        /// Its name.
        name: &'static str,
        /// Distance along the rod (m).
        along: f64,
        /// The value there.
        value: f64,
    },
}

impl fmt::Display for RodError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Size { length, elements } => {
                write!(f, "a rod of length {length} and {elements} elements: both must be positive")
            }
            Self::Property { name, along, value } => {
                write!(f, "{name} of a rod is {value} at {along} along it: it must be positive")
            }
        }
    }
}

impl std::error::Error for RodError {}
