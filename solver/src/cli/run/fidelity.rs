//! `Fidelity`: which of the models of a swimmer a command takes, the full solver or one without a flow.

use clap::ValueEnum;

use crate::case::soft::OnlyModel;

/// Models of a swimmer, the dearest first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Fidelity {
    /// The full solver: flow on a mesh that follows the bodies
    Ale,
    /// An elastic body without a flow, under loads facet by facet
    Soft,
    /// A tree of rigid links without a flow, under loads by laws
    Reduced,
}

impl Fidelity {
    /// The full solver, or the one model that a case without a flow has. What is wrong with a case says who runs it.
    pub fn of(case: &str, settings: &[String]) -> Self {
        match OnlyModel::of(case, settings) {
            Some(OnlyModel::Soft) => Self::Soft,
            Some(OnlyModel::Reduced) => Self::Reduced,
            None => Self::Ale,
        }
    }

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ale => "ale",
            Self::Soft => "soft",
            Self::Reduced => "reduced",
        }
    }
}
