//! `SolveError`: why a system of fluid and bodies could not be solved.

use thiserror::Error;

use crate::algebra::LinearError;

/// Why a system could not be solved.
#[derive(Debug, Error)]
pub enum SolveError {
    /// The equations do not determine some of the unknowns.
    #[error(
        "the equations do not determine {unknowns}; left without an unknown is the equation of \
         {equations}{advice}"
    )]
    Undetermined {
        /// Which unknowns, in words.
        unknowns: String,
        /// Which equations have no unknown left, in words.
        equations: String,
        /// What may help, or nothing.
        advice: &'static str,
    },
    /// Forces have a sum where nothing holds fluid and bodies.
    #[error(
        "the forces on the bodies sum up to {sum:.3e} along {axis}, where nothing holds fluid and \
         bodies; balance them, or hold a body or a side"
    )]
    Unbalanced {
        /// Which coordinate.
        axis: &'static str,
        /// The sum (N).
        sum: f64,
    },
    /// A mean velocity is given, and no pressure gradient brings it about.
    #[error("the mean velocity does not depend on the pressure gradient: nothing resists the flow")]
    NoResistance,
    /// No accurate solution.
    #[error(transparent)]
    Linear(#[from] LinearError),
    /// A value of the solution is not a number.
    #[error("the solution is not finite near {}", coordinates(.near))]
    NotFinite {
        /// Position of the node (m).
        near: Vec<f64>,
    },
}

/// A position in words.
#[must_use]
pub fn coordinates(position: &[f64]) -> String {
    let numbers: Vec<String> = position.iter().map(|x| format!("{x:.4e}")).collect();
    format!("({})", numbers.join(", "))
}
