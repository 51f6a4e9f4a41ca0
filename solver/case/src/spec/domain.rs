//! `[domain]` and `[boundary]`: the region, its sides, and what holds on them.

use serde::{Deserialize, Serialize};

use super::formula::Formula;
use super::profile::ProfileSpec;
use super::time_function::{TimeFunction, is_zero};
#[cfg(test)]
use crate::spec::number::{FormulaPerDimension, NonZero, PerDimension, Positive, UpToOne};
use crate::{MeshFile, RegionSpec};

/// Dimension and symmetry of the problem.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Geometry {
    /// Two dimensions; loads are per unit length.
    Planar,
    /// Half plane y >= 0 turned about the x axis; loads are those of the whole body.
    Axisymmetric,
    /// Three dimensions.
    Spatial,
}

impl Geometry {
    /// Numbers a point or a velocity has; axisymmetric problems are solved in their half plane.
    #[must_use]
    pub fn dimensions(self) -> usize {
        match self {
            Self::Planar | Self::Axisymmetric => 2,
            Self::Spatial => 3,
        }
    }

    /// Name in the case file.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Planar => "planar",
            Self::Axisymmetric => "axisymmetric",
            Self::Spatial => "spatial",
        }
    }
}

/// `[domain]`: one of these.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum DomainSpec {
    /// Rectangle with sides `left`, `right`, `bottom`, `top` (planar); in space also `back`, `front`,
    /// where z is least and largest.
    #[cfg_attr(test, schemars(extend("geometries" = ["planar", "spatial"])))]
    Box {
        /// Corner with the least coordinates (m), one number per dimension.
        #[cfg_attr(test, schemars(with = "PerDimension"))]
        min: Vec<f64>,
        /// Corner with the largest coordinates (m).
        #[cfg_attr(test, schemars(with = "PerDimension"))]
        max: Vec<f64>,
    },
    /// Rectangle with its lower left corner at the origin; sides as those of a box (planar).
    #[cfg_attr(test, schemars(extend("geometries" = ["planar"])))]
    Channel {
        /// Extent along x (m).
        #[cfg_attr(test, schemars(with = "Positive"))]
        length: f64,
        /// Extent along y (m).
        #[cfg_attr(test, schemars(with = "Positive"))]
        height: f64,
    },
    /// Disc with the side `wall` (planar).
    #[cfg_attr(test, schemars(extend("geometries" = ["planar"])))]
    Disc {
        /// Centre (m).
        #[serde(default)]
        center: [f64; 2],
        /// Radius (m).
        #[cfg_attr(test, schemars(with = "Positive"))]
        radius: f64,
    },
    /// A ball cut by its meridian plane, with the sides `wall` and `axis` (axisymmetric).
    #[cfg_attr(test, schemars(extend("geometries" = ["axisymmetric"])))]
    HalfDisc {
        /// Centre on the axis (m).
        #[serde(default)]
        center: f64,
        /// Radius (m).
        #[cfg_attr(test, schemars(with = "Positive"))]
        radius: f64,
    },
    /// A cylinder about the x axis with the sides `left`, `right` and `wall` (spatial), or cut by its
    /// meridian plane, with the side `axis`, too (axisymmetric).
    #[cfg_attr(test, schemars(extend("geometries" = ["axisymmetric", "spatial"])))]
    Cylinder {
        /// Both ends on the axis (m).
        x: [f64; 2],
        /// Radius (m).
        #[cfg_attr(test, schemars(with = "Positive"))]
        radius: f64,
    },
    /// A ball with the side `wall` (spatial).
    #[cfg_attr(test, schemars(extend("geometries" = ["spatial"])))]
    Sphere {
        /// Centre (m).
        #[serde(default)]
        center: [f64; 3],
        /// Radius (m).
        #[cfg_attr(test, schemars(with = "Positive"))]
        radius: f64,
    },
    /// The region of a mesh made by Gmsh, with its physical names as sides (planar, spatial).
    #[cfg_attr(test, schemars(extend("geometries" = ["planar", "spatial"])))]
    Mesh(MeshFile),
    /// The inside of a closed surface from an STL, OBJ or PLY file, with named sides (spatial).
    #[cfg_attr(test, schemars(extend("geometries" = ["spatial"])))]
    Surface(RegionSpec),
}

/// What holds on a side of the domain.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum BoundaryCondition {
    /// Zero velocity.
    NoSlip,
    /// Open: mu du/dn - p n = 0, which lets a developed flow leave undisturbed.
    DoNothing,
    /// Open: zero traction, sigma n = 0.
    TractionFree,
    /// Mirror plane: no normal velocity, no tangential traction. Also a frictionless wall.
    Symmetry,
    /// The axis of an axisymmetric domain (taken for granted there, may be left out).
    Axis,
    /// Open, with a pressure outside: mu du/dn - p n = -value n, of which `do-nothing` is that of 0.
    Pressure {
        /// Pressure (Pa), a number or an expression.
        value: Formula,
        /// Factor in time.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        factor: Option<TimeFunction>,
        /// Part beta of the momentum of fluid that enters here which the side takes (1): the traction rho beta min(u . n, 0) u
        /// beside its own. At 0.5 fluid enters without kinetic energy, and the pressure is the total one there.
        #[serde(default, skip_serializing_if = "is_zero")]
        #[cfg_attr(test, schemars(with = "UpToOne"))]
        backflow: f64,
    },
    /// Open, with a given traction sigma n, of which `traction-free` is that of 0.
    Traction {
        /// Traction on the fluid (Pa), one number or expression per dimension.
        #[cfg_attr(test, schemars(with = "FormulaPerDimension"))]
        value: Vec<Formula>,
        /// Factor in time.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        factor: Option<TimeFunction>,
        /// Part beta of the momentum of fluid that enters here which the side takes (1): the traction rho beta min(u . n, 0) u
        /// beside its own. At 0.5 fluid enters without kinetic energy, and the pressure is the total one there.
        #[serde(default, skip_serializing_if = "is_zero")]
        #[cfg_attr(test, schemars(with = "UpToOne"))]
        backflow: f64,
    },
    /// A given velocity on the side.
    Velocity {
        /// Velocity (m/s), one number or expression per dimension.
        #[cfg_attr(test, schemars(with = "FormulaPerDimension"))]
        value: Vec<Formula>,
        /// Factor in time.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        factor: Option<TimeFunction>,
    },
    /// A velocity by numbers at places of the side, from a file.
    Profile(ProfileSpec),
    /// Parabolic velocity along x, zero at both ends of the side (on a cylinder: largest on the axis;
    /// on a box in space: a parabola along y times one along z). On a flat side of `domain.mesh`: normal to
    /// it, into the domain, as `developed`.
    Parabolic {
        /// Largest velocity (m/s), negative towards -x, or out of a `domain.mesh`.
        peak: f64,
        /// Factor in time.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        factor: Option<TimeFunction>,
    },
    /// The developed flow through a flat side of any shape, normal to it into the domain: zero where it meets walls, not
    /// where it meets planes of symmetry.
    Developed {
        /// Volume that enters in a unit of time (m3/s; m2/s planar); or `peak`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        flux: Option<f64>,
        /// Largest velocity (m/s); or `flux`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        peak: Option<f64>,
        /// Factor in time.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        factor: Option<TimeFunction>,
    },
    /// Velocity of a simple shear: u = rate (y - origin) along x.
    Shear {
        /// Shear rate (1/s).
        rate: f64,
        /// Height of zero velocity (m).
        #[serde(default)]
        origin: f64,
        /// Factor in time.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        factor: Option<TimeFunction>,
    },
    /// A sheet that waves as y = amplitude sin(2 pi (x / wavelength - t / period)), and the mesh
    /// with it (planar, `bottom` only, unsteady runs).
    WavingSheet {
        /// Amplitude (m).
        #[cfg_attr(test, schemars(with = "Positive"))]
        amplitude: f64,
        /// Wavelength (m); divides the length of the side.
        #[cfg_attr(test, schemars(with = "Positive"))]
        wavelength: f64,
        /// Period (s); positive ones send the wave towards +x, negative ones towards -x.
        #[cfg_attr(test, schemars(with = "NonZero"))]
        period: f64,
        /// Whether its material moves up and down only; otherwise it keeps its length.
        #[serde(default)]
        extensible: bool,
    },
    /// One of a periodic pair: the side opposite, by name.
    Periodic(String),
}

impl BoundaryCondition {
    /// Whether fluid enters and leaves freely.
    #[must_use]
    pub fn is_open(&self) -> bool {
        matches!(
            self,
            Self::DoNothing | Self::TractionFree | Self::Pressure { .. } | Self::Traction { .. }
        )
    }
}
