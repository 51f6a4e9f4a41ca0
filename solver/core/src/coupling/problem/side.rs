//! `Side`: what holds on a boundary of the fluid that is not a body.

use alewife_mesh::Point;

/// A velocity as a function of position and time (m, s, m/s).
pub type VelocityProfile<const D: usize> = Box<dyn Fn(&Point<D>, f64) -> Point<D> + Send + Sync>;

/// A pressure as a function of position and time (m, s, Pa).
pub type PressureProfile<const D: usize> = Box<dyn Fn(&Point<D>, f64) -> f64 + Send + Sync>;

/// What holds on a boundary that is not a body.
pub enum Side<const D: usize> {
    /// Given velocity. Where two such sides meet, a wall's value counts.
    Velocity {
        /// The velocity.
        profile: VelocityProfile<D>,
        /// Whether the side is a wall rather than an inflow.
        is_wall: bool,
    },
    /// mu du/dn - p n = 0.
    DoNothing,
    /// sigma n = 0.
    TractionFree,
    /// mu du/dn - p n = -p_0 n with a given pressure p_0.
    Pressure {
        /// The pressure.
        profile: PressureProfile<D>,
        /// Part beta of the momentum of fluid that enters which is taken (1): rho beta min(u . n, 0) u is added to the
        /// traction.
        backflow: f64,
    },
    /// sigma n as given (Pa).
    Traction {
        /// The traction.
        profile: VelocityProfile<D>,
        /// As that beside a pressure.
        backflow: f64,
    },
    /// No velocity along this coordinate, no traction along the others.
    Symmetry {
        /// 0 for x, 1 for y, 2 for z.
        normal_axis: usize,
    },
    /// One of a periodic pair; the mesh knows the partner nodes.
    Periodic,
}

impl<const D: usize> Side<D> {
    /// Whether the traction is given, so that the side fixes the level of the pressure.
    #[must_use]
    pub fn is_open(&self) -> bool {
        matches!(
            self,
            Self::DoNothing | Self::TractionFree | Self::Pressure { .. } | Self::Traction { .. }
        )
    }

    /// The given traction on the fluid (Pa) at a place (m) with a unit normal out of it at a time (s), beside that of a
    /// developed flow; none of sides without one.
    #[must_use]
    pub fn given_traction(
        &self,
        place: &Point<D>,
        normal: &Point<D>,
        time: f64,
    ) -> Option<Point<D>> {
        match self {
            Self::Pressure { profile, .. } => Some(normal * -profile(place, time)),
            Self::Traction { profile, .. } => Some(profile(place, time)),
            _ => None,
        }
    }

    /// Part of the momentum of fluid that enters which the side takes (1).
    #[must_use]
    pub fn backflow(&self) -> f64 {
        match self {
            Self::Pressure { backflow, .. } | Self::Traction { backflow, .. } => *backflow,
            _ => 0.0,
        }
    }

    /// Whether the traction is that of a developed flow, beside a pressure.
    #[must_use]
    pub fn is_developed(&self) -> bool {
        matches!(self, Self::DoNothing | Self::Pressure { .. })
    }

    /// Whether fluid and bodies may move along a coordinate as a whole without being held here.
    #[must_use]
    pub fn lets_slide(&self, axis: usize) -> bool {
        match self {
            Self::Periodic => true,
            Self::Symmetry { normal_axis } => *normal_axis != axis,
            Self::Velocity { .. }
            | Self::DoNothing
            | Self::TractionFree
            | Self::Pressure { .. }
            | Self::Traction { .. } => false,
        }
    }
}
