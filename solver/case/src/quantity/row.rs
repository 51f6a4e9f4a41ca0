//! `Quantity`: a row of a table of quantities; `When`: in which cases one exists.

/// A row of a table of quantities.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Quantity<T> {
    /// Which one it is.
    pub id: T,
    /// Name after that of its owner, such as `force.x`.
    pub name: &'static str,
    /// Unit; that of planar cases in parentheses where it differs.
    pub unit: &'static str,
    /// When it exists.
    pub when: When,
    /// What it is.
    pub meaning: &'static str,
}

/// When a quantity exists.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum When {
    /// In all cases.
    Always,
    /// In planar and axisymmetric cases.
    Plane,
    /// In three dimensions.
    Spatial,
    /// There are `[scales]` and a density, so that coefficients can be formed.
    Scales,
    /// The same in three dimensions.
    SpatialScales,
    /// There is `[contact]`.
    Contact,
    /// The same in planar and axisymmetric cases.
    PlaneContact,
    /// The same in three dimensions.
    SpatialContact,
    /// The joint is a pivot.
    Pivot,
    /// The joint is an arm.
    Arm,
    /// The swimmer has more than one body.
    SeveralBodies,
    /// The same in planar and axisymmetric cases.
    PlaneSeveralBodies,
    /// The same in three dimensions.
    SpatialSeveralBodies,
    /// The swimmer has two bodies that are not on one pivot, and the mesh moves.
    MovingMembers,
    /// The swimmer has a period, and the run is unsteady.
    Cycles,
    /// The same in three dimensions.
    SpatialCycles,
    /// The swimmer has a period, the run is unsteady, and its resistance is known.
    TowedCycles,
    /// Its resistance is known, but it has no cycles.
    TowedWithoutCycles,
    /// All work on the fluid is that of bodies and waving sheets.
    IdleSides,
    /// The fluid is convected in time around bodies, and does not cross the sides.
    ClosedSides,
    /// There is `[flow]`.
    MeanFlow,
    /// The same in three dimensions.
    SpatialMeanFlow,
    /// The fluid is convected.
    Convection,
    /// The same, and the run is unsteady.
    UnsteadyConvection,
    /// The mesh moves.
    MovingMesh,
}

impl When {
    /// The same in words, for a table; empty for quantities of all cases.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Always => "",
            Self::Plane => "planar, axisymmetric",
            Self::Spatial => "spatial",
            Self::Scales => "`scales`",
            Self::SpatialScales => "`scales`, spatial",
            Self::Contact => "[`contact`](#contact)",
            Self::PlaneContact => "[`contact`](#contact), planar, axisymmetric",
            Self::SpatialContact => "[`contact`](#contact), spatial",
            Self::Pivot => "pivots (`bent`, `hinge`, `ball`)",
            Self::Arm => "`arm`, `slider`",
            Self::SeveralBodies => "several bodies",
            Self::PlaneSeveralBodies => "several bodies, planar, axisymmetric",
            Self::SpatialSeveralBodies => "several bodies, spatial",
            Self::MovingMembers => "two bodies that share no pivot, a moving mesh",
            Self::Cycles => "a period",
            Self::SpatialCycles => "a period, spatial",
            Self::TowedCycles => "a period and `resistance`",
            Self::TowedWithoutCycles => "`resistance`, no period",
            Self::IdleSides => "bodies or a waving sheet, and other sides that do no work",
            Self::ClosedSides => "`navier-stokes`, unsteady, bodies, sides that nothing crosses",
            Self::MeanFlow => "[`flow`](#flow)",
            Self::SpatialMeanFlow => "[`flow`](#flow), spatial",
            Self::Convection => "`navier-stokes`",
            Self::UnsteadyConvection => "`navier-stokes`, unsteady",
            Self::MovingMesh => "a moving mesh",
        }
    }

    pub(super) fn holds(self, known: &Circumstances) -> bool {
        match self {
            Self::Always => true,
            Self::Plane => !known.is_spatial,
            Self::Spatial => known.is_spatial,
            Self::Scales => known.has_coefficients,
            Self::SpatialScales => known.has_coefficients && known.is_spatial,
            Self::Contact => known.has_contact,
            Self::PlaneContact => known.has_contact && !known.is_spatial,
            Self::SpatialContact => known.has_contact && known.is_spatial,
            Self::Pivot => !known.is_arm,
            Self::Arm => known.is_arm,
            Self::SeveralBodies => known.has_several_bodies,
            Self::PlaneSeveralBodies => known.has_several_bodies && !known.is_spatial,
            Self::SpatialSeveralBodies => known.has_several_bodies && known.is_spatial,
            Self::MovingMembers => known.has_separate_bodies && known.mesh_moves,
            Self::Cycles => known.has_cycles,
            Self::SpatialCycles => known.has_cycles && known.is_spatial,
            Self::TowedCycles => known.has_cycles && known.has_resistance,
            Self::TowedWithoutCycles => !known.has_cycles && known.has_resistance,
            Self::IdleSides => known.balances_energy,
            Self::ClosedSides => known.balances_momentum,
            Self::MeanFlow => known.has_mean_flow,
            Self::SpatialMeanFlow => known.has_mean_flow && known.is_spatial,
            Self::Convection => known.has_convection,
            Self::UnsteadyConvection => known.has_convection && known.is_unsteady,
            Self::MovingMesh => known.mesh_moves,
        }
    }
}

/// What decides which quantities the case, a joint or a swimmer has.
#[derive(Debug, Clone, Default)]
pub(super) struct Circumstances {
    pub is_spatial: bool,
    pub has_coefficients: bool,
    pub has_contact: bool,
    pub is_arm: bool,
    pub has_several_bodies: bool,
    pub has_separate_bodies: bool,
    pub has_cycles: bool,
    pub has_resistance: bool,
    pub balances_energy: bool,
    pub balances_momentum: bool,
    pub has_mean_flow: bool,
    pub has_convection: bool,
    pub is_unsteady: bool,
    pub mesh_moves: bool,
}
