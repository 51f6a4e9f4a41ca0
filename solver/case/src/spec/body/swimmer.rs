//! `[[swimmer]]`: bodies and joints made by kind, one or many at a time, and what they do together.

use serde::{Deserialize, Serialize};

use super::joint::{Hinge, JointKind};
use super::link::Link;
use super::orientation::Orientation;
use super::stroke::Stroke;
use super::{GaitSpec, Motion, ShapeSpec};
#[cfg(test)]
use crate::spec::number::{CountPerDimension, Direction, NonNegative, PerDimension, Positive};
#[cfg(test)]
use std::num::NonZeroUsize;

/// `[[swimmer]]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SwimmerSpec {
    /// Name; its bodies are called NAME-1, NAME-2, ..., copies NAME-1, NAME-2 and their bodies
    /// NAME-1-1, NAME-1-2, ....
    pub name: String,
    /// What it is made of.
    pub kind: SwimmerKind,
    /// Position (m) of the root body, to which all others are joined; the origin if absent.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(test, schemars(with = "PerDimension"))]
    pub center: Vec<f64>,
    /// Rotation of the root body in space; none if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(extend("geometries" = ["spatial"])))]
    pub orientation: Option<Orientation>,
    /// Rotation of the root body, counter-clockwise (rad).
    #[serde(default, deserialize_with = "crate::text::angle::deserialize")]
    #[cfg_attr(test, schemars(with = "crate::text::angle::Angle"))]
    #[cfg_attr(test, schemars(extend("geometries" = ["planar", "axisymmetric"])))]
    pub angle: f64,
    /// Density (kg/m3); that of the fluid if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<NonNegative>"))]
    pub density: Option<f64>,
    /// How the root body moves.
    #[serde(default = "free")]
    pub motion: Motion,
    /// Magnetic moment of the root body in its frame (A m2; A m planar), one number per dimension.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub magnetic_moment: Vec<f64>,
    /// Cell size on its surfaces (m); that of `[mesh]` if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub size: Option<f64>,
    /// Copies of it in other positions; itself alone if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub copies: Option<Copies>,
    /// Time of one cycle (s); that of its strokes or gait if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub period: Option<f64>,
    /// Force per velocity that drags it when towed (N s/m; N s/m2 planar), for Lighthill's
    /// efficiency.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub resistance: Option<f64>,
}

/// `kind`: one of these.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum SwimmerKind {
    /// One body with a gait, or without one.
    Body {
        /// Outline.
        shape: ShapeSpec,
        /// Surface motion.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        gait: Option<GaitSpec>,
    },
    /// Spheres (axisymmetric) or discs (planar) in a line along x, on arms whose lengths are given;
    /// all are joined to the middle one.
    LinkedSpheres {
        /// Radii (m), from left to right.
        #[cfg_attr(test, schemars(with = "Vec<Positive>", length(min = 2)))]
        radii: Vec<f64>,
        /// Distances of the centres of neighbours (m), from left to right.
        arms: Vec<Stroke>,
        /// Gait of each, such as one that changes its radius; none if absent.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        gaits: Vec<GaitSpec>,
    },
    /// Discs on arms from a disc in the middle (planar), or spheres (spatial).
    #[cfg_attr(test, schemars(extend("geometries" = ["planar", "spatial"])))]
    Star {
        /// Radius in the middle (m).
        #[cfg_attr(test, schemars(with = "Positive"))]
        radius: f64,
        /// Radii at the ends of the arms (m).
        #[cfg_attr(test, schemars(with = "Vec<Positive>", length(min = 1)))]
        radii: Vec<f64>,
        /// Distances of their centres from the middle (m).
        arms: Vec<Stroke>,
        /// Directions of the arms, from x, counter-clockwise (rad); evenly around if absent.
        #[serde(
            default,
            skip_serializing_if = "Vec::is_empty",
            deserialize_with = "crate::text::angle::deserialize"
        )]
        #[cfg_attr(test, schemars(with = "Vec<crate::text::angle::Angle>"))]
        directions: Vec<f64>,
        /// In three dimensions, directions of the arms in the frame of the middle one, of any length.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        #[cfg_attr(test, schemars(with = "Vec<Direction>", extend("geometries" = ["spatial"])))]
        along: Vec<[f64; 3]>,
    },
    /// Slender links one after the other, with pivots between them (planar, spatial); the first one is
    /// in front, towards +x, and all are joined to the middle one. In three dimensions they bend about the
    /// z axis of the middle one unless `axis` of a hinge says otherwise.
    #[cfg_attr(test, schemars(extend("geometries" = ["planar", "spatial"])))]
    Chain {
        /// Links from the front: semi-axes of an ellipse, in three dimensions of a spheroid (m), along
        /// the chain and across, or `{ shape, density, magnetic_moment }`.
        links: Vec<Link>,
        /// Distance of the ends of neighbours along the chain, the pivot in its middle, on the x axes
        /// of both (m).
        #[cfg_attr(test, schemars(with = "Positive"))]
        gap: f64,
        /// Pivots: `bent = { angle }` or `hinge = { ... }`, from the front; the angle is that of the
        /// link farther from the middle less that of the nearer one.
        joints: Vec<Pivot>,
        /// Makes one body of all links, which bends by the given angles; separate links if absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[cfg_attr(test, schemars(extend("geometries" = ["planar"])))]
        skin: Option<Skin>,
    },
    /// Bodies of `[[body]]` that are reported as one.
    Bodies(Vec<String>),
}

/// `skin`: one smooth tube about the midline of all links.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Skin {
    /// Length of midline over which it bends at each pivot (m); half the shortest distance between
    /// neighbouring pivots, or of an end from its pivot, if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub rounding: Option<f64>,
}

/// A pivot between the links of a chain.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Pivot {
    /// Bent by a given angle (rad).
    Bent {
        /// Angle (rad).
        #[serde(deserialize_with = "crate::text::angle::deserialize")]
        angle: Stroke,
    },
    /// Free, with stiffness, damping and torque.
    Hinge(Hinge),
}

impl From<Pivot> for JointKind {
    fn from(pivot: Pivot) -> Self {
        match pivot {
            Pivot::Bent { angle } => Self::Bent { angle, axis: None },
            Pivot::Hinge(hinge) => Self::Hinge(hinge),
        }
    }
}

/// Where copies of a swimmer go.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Copies {
    /// In rows and columns, the first at `center`.
    Lattice {
        /// Numbers along each axis.
        #[cfg_attr(test, schemars(with = "CountPerDimension"))]
        counts: Vec<usize>,
        /// Distances along each axis (m).
        #[cfg_attr(test, schemars(with = "PerDimension"))]
        spacing: Vec<f64>,
    },
    /// At random, at least a gap apart from each other, from the bodies before and from walls, by the
    /// circles or spheres that hold them.
    Random {
        /// How many.
        #[cfg_attr(test, schemars(with = "NonZeroUsize"))]
        count: usize,
        /// The same seed gives the same positions on every machine.
        seed: u64,
        /// Smallest gap (m).
        #[cfg_attr(test, schemars(with = "NonNegative"))]
        gap: f64,
        /// Lowest and highest corner of where the centres go (m); the whole domain if absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[cfg_attr(test, schemars(with = "Option<[PerDimension; 2]>"))]
        within: Option<[Vec<f64>; 2]>,
        /// Whether each is turned at random; else all as `angle` or `orientation`.
        #[serde(default)]
        turned: bool,
    },
}

fn free() -> Motion {
    Motion::Free
}
