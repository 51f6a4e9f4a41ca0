//! `ExchangeError`: why a case is not written for another program, or the model of one not read.

use thiserror::Error;

use crate::reduced::ReducedError;

/// What keeps a model from being exchanged.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ExchangeError {
    /// The case has no reduced model.
    #[error(transparent)]
    Reduced(#[from] ReducedError),
    /// The case is one without inertia.
    #[error(
        "a case without inertia has no masses, which MJCF and URDF ask for; take fluid.model = \
         \"navier-stokes\""
    )]
    WithoutInertia,
}
