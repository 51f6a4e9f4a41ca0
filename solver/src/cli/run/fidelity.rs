//! `Fidelity`: which of the models of a swimmer a command takes, the full solver or one without a flow.

use clap::ValueEnum;

/// Models of a swimmer, the dearest first.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum Fidelity {
    /// The full solver: flow on a mesh that follows the bodies
    #[default]
    Ale,
    /// An elastic body without a flow, under loads facet by facet
    Soft,
    /// A tree of rigid links without a flow, under loads by laws
    Reduced,
}

impl Fidelity {
    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ale => "ale",
            Self::Soft => "soft",
            Self::Reduced => "reduced",
        }
    }
}
