//! `Excess`: by what it shows that a flow has blown up.

use std::fmt::{self, Display, Formatter};

/// What is larger than what drives fluid and bodies can have made it, and how many times.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Excess {
    /// Kinetic and elastic energy, over that at the start and the work done since.
    Energy(f64),
    /// Root mean square of the velocity of the fluid, over the speed that what drives it gives.
    MeanSpeed(f64),
    /// Largest speed of the fluid, over the same, in cells that do not resolve it.
    LargestSpeed(f64),
    /// Speed of a body, over the same.
    BodySpeed(f64),
}

impl Excess {
    /// How many times as large.
    #[must_use]
    pub fn times(&self) -> f64 {
        let (Self::Energy(times)
        | Self::MeanSpeed(times)
        | Self::LargestSpeed(times)
        | Self::BodySpeed(times)) = self;
        *times
    }
}

impl Display for Excess {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        let times = Times(self.times());
        match self {
            Self::Energy(_) => write!(
                formatter,
                "fluid and bodies have {times} the energy of the start and of the work done on them since"
            ),
            Self::MeanSpeed(_) => {
                write!(formatter, "on average it is {times} as fast as what drives it can make it")
            }
            Self::LargestSpeed(_) => {
                write!(formatter, "it is up to {times} as fast as what drives it can make it")
            }
            Self::BodySpeed(_) => {
                write!(formatter, "a body is {times} as fast as what drives it can make it")
            }
        }
    }
}

/// A factor, as it is read.
struct Times(f64);

impl Display for Times {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        let Self(times) = self;
        if *times < 1e4 {
            write!(formatter, "{times:.0} times")
        } else {
            write!(formatter, "{times:.1e} times")
        }
    }
}
