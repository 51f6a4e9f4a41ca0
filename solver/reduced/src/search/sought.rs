//! `Sought`: what a search makes small, a function of parameters with its gradient.

use super::Evaluated;

/// What a search makes small: a function of parameters, with its gradient.
pub trait Sought {
    /// The objective at values of the parameters, and its derivatives by them.
    ///
    /// # Errors
    /// Why there is none, as for a body whose step fails.
    fn evaluate(&mut self, values: &[f64]) -> Result<Evaluated, String>;
}
