//! `[[body]]`: outline, pose, density, motion and gait of one body.

pub(crate) mod axial_vector;
pub(crate) mod command;
pub(crate) mod gait;
pub(crate) mod given;
pub(crate) mod joint;
pub(crate) mod link;
pub(crate) mod motion;
pub(crate) mod orientation;
pub(crate) mod rod;
mod shape_names;
pub(crate) mod skin;
pub(crate) mod slip;
mod solid;
pub(crate) mod solid_shape;
pub(crate) mod spring;
pub(crate) mod squirmer;
pub(crate) mod stroke;
pub(crate) mod swimmer;

use serde::{Deserialize, Serialize};

use self::axial_vector::AxialVector;
use self::gait::{
    AnguilliformGait, CarangiformGait, FishShape, FlagellateShape, FlagellumGait, JointsGait,
    PulsatingGait, TubeShape,
};
use self::given::hole::HoleShape;
use self::given::midline::MidlineGait;
use self::given::polygon::PolygonShape;
use self::given::surface::SurfaceShape;
use self::motion::by_axis::Driven;
use self::motion::inertia::InertiaSpec;
use self::motion::{LoadFrame, Lock, Motion};
use self::orientation::Orientation;
use self::rod::{Activation, Attached, RodSpec};
use self::slip::SlipGait;
use self::spring::SpringSpec;
use self::squirmer::SquirmerGait;
use super::time_function::TimeFunction;
#[cfg(test)]
use crate::spec::number::{NonNegative, NonZero, PerDimension, Positive};

/// `shape`: one of these, in the body's own frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum ShapeSpec {
    /// Disc (planar).
    #[cfg_attr(test, schemars(extend("geometries" = ["planar"])))]
    Disc {
        /// Radius (m).
        #[cfg_attr(test, schemars(with = "Positive"))]
        radius: f64,
    },
    /// Ellipse (planar).
    #[cfg_attr(test, schemars(extend("geometries" = ["planar"])))]
    Ellipse {
        /// Semi-axes along the body's x and y (m).
        #[cfg_attr(test, schemars(with = "[Positive; 2]"))]
        semi_axes: [f64; 2],
    },
    /// Closed smooth spline (planar).
    #[cfg_attr(test, schemars(extend("geometries" = ["planar"])))]
    Spline {
        /// Points counter-clockwise in the body frame (m), the first not repeated.
        #[cfg_attr(test, schemars(length(min = 3)))]
        points: Vec<[f64; 2]>,
    },
    /// Polygon with sharp corners (planar).
    #[cfg_attr(test, schemars(extend("geometries" = ["planar"])))]
    Polygon(PolygonShape),
    /// Rectangle with sharp corners (planar).
    #[cfg_attr(test, schemars(extend("geometries" = ["planar"])))]
    Box {
        /// Lengths along the body's x and y (m).
        #[cfg_attr(test, schemars(with = "[Positive; 2]"))]
        size: [f64; 2],
    },
    /// What a given mesh leaves out inside the side of this name (planar, spatial).
    #[cfg_attr(test, schemars(extend("geometries" = ["planar", "spatial"])))]
    Side(HoleShape),
    /// Fish (planar, spatial).
    #[cfg_attr(test, schemars(extend("geometries" = ["planar", "spatial"])))]
    Fish(FishShape),
    /// Head with a tail (planar, spatial).
    #[cfg_attr(test, schemars(extend("geometries" = ["planar", "spatial"])))]
    Flagellate(FlagellateShape),
    /// Chain with a skin; made from the links of a swimmer only.
    #[serde(skip)]
    Tube(TubeShape),
    /// Sphere (axisymmetric, spatial).
    #[cfg_attr(test, schemars(extend("geometries" = ["axisymmetric", "spatial"])))]
    Sphere {
        /// Radius (m).
        #[cfg_attr(test, schemars(with = "Positive"))]
        radius: f64,
    },
    /// Ellipsoid of revolution about the body's x axis (axisymmetric, spatial).
    #[cfg_attr(test, schemars(extend("geometries" = ["axisymmetric", "spatial"])))]
    Spheroid {
        /// Semi-axes along and across the axis of revolution (m).
        #[cfg_attr(test, schemars(with = "[Positive; 2]"))]
        semi_axes: [f64; 2],
    },
    /// Ellipsoid (spatial).
    #[cfg_attr(test, schemars(extend("geometries" = ["spatial"])))]
    Ellipsoid {
        /// Semi-axes along the body's x, y and z (m).
        #[cfg_attr(test, schemars(with = "[Positive; 3]"))]
        semi_axes: [f64; 3],
    },
    /// Cylinder about the body's x axis with half spheres at its ends (spatial).
    #[cfg_attr(test, schemars(extend("geometries" = ["spatial"])))]
    Capsule {
        /// Length from end to end (m).
        #[cfg_attr(test, schemars(with = "Positive"))]
        length: f64,
        /// Radius (m).
        #[cfg_attr(test, schemars(with = "Positive"))]
        radius: f64,
    },
    /// Circular cylinder from side to side of a box (spatial).
    #[cfg_attr(test, schemars(extend("geometries" = ["spatial"])))]
    Cylinder {
        /// Radius (m).
        #[cfg_attr(test, schemars(with = "Positive"))]
        radius: f64,
        /// Coordinate along which it goes through the box.
        axis: CylinderAxis,
        /// Length of the box along it (m), which is not written.
        #[serde(skip)]
        length: f64,
    },
    /// Tube along a helix about the body's x axis (spatial).
    #[cfg_attr(test, schemars(extend("geometries" = ["spatial"])))]
    Helix(HelixShape),
    /// Tube along a smooth curve through points (spatial).
    #[cfg_attr(test, schemars(extend("geometries" = ["spatial"])))]
    Curve(CurveShape),
    /// Smooth profile turned about the body's x axis, which it crosses at right angles (axisymmetric, spatial).
    #[cfg_attr(test, schemars(extend("geometries" = ["axisymmetric", "spatial"])))]
    Revolved {
        /// Points (x, distance from the axis) of the profile (m), the first and the last on the axis.
        #[cfg_attr(test, schemars(length(min = 3)))]
        profile: Vec<[f64; 2]>,
    },
    /// Solid by the triangles of its surface (spatial).
    #[cfg_attr(test, schemars(extend("geometries" = ["spatial"])))]
    Surface(SurfaceShape),
    /// All points of several parts, such as a head and a flagellum (spatial).
    #[cfg_attr(test, schemars(extend("geometries" = ["spatial"])))]
    Union(#[cfg_attr(test, schemars(length(min = 1)))] Vec<PartSpec>),
}

/// A coordinate along which a cylinder goes through a box.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum CylinderAxis {
    /// From left to right.
    X,
    /// From bottom to top.
    Y,
    /// From back to front.
    Z,
}

impl CylinderAxis {
    /// 0 for x, 1 for y, 2 for z.
    #[must_use]
    pub fn index(self) -> usize {
        match self {
            Self::X => 0,
            Self::Y => 1,
            Self::Z => 2,
        }
    }
}

/// `helix`: a tube along a helix about the body's x axis, from x = 0 towards +x, with round ends.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct HelixShape {
    /// Distance of the midline from the axis (m); it starts in the half plane y > 0.
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub radius: f64,
    /// Length along the axis of one turn (m).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub pitch: f64,
    /// Number of turns: right-handed if positive, left-handed if negative.
    #[cfg_attr(test, schemars(with = "NonZero"))]
    pub turns: f64,
    /// Radius of the tube (m).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub tube_radius: f64,
}

/// `curve`: a tube with round ends along the natural cubic spline through points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct CurveShape {
    /// Points of the midline in the body frame (m), two or more.
    #[cfg_attr(test, schemars(length(min = 2)))]
    pub points: Vec<[f64; 3]>,
    /// Radius of the tube (m).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub tube_radius: f64,
}

/// A part of a `union`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct PartSpec {
    /// What it is.
    pub shape: ShapeSpec,
    /// Where its origin is in the frame of the body (m).
    #[serde(default)]
    pub center: [f64; 3],
    /// How it is turned from the frame of the body; not at all if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub orientation: Option<Orientation>,
}

/// How a swimmer's surface moves by itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum GaitSpec {
    /// Tangential slip of a spherical or circular squirmer.
    Squirmer(SquirmerGait),
    /// Slip along the surface of any smooth shape, by expressions.
    Slip(SlipGait),
    /// A wave of curvature along a fish.
    Carangiform(CarangiformGait),
    /// A wave of displacements along a fish.
    Anguilliform(AnguilliformGait),
    /// A wave along the tail of a flagellate.
    Flagellum(FlagellumGait),
    /// A midline of one's own, of a fish or a flagellate.
    Midline(Box<MidlineGait>),
    /// Area or volume of a round body as a function of time.
    Pulsating(PulsatingGait),
    /// Angles of the pivots of a chain with a skin; made from the joints of a swimmer only.
    #[serde(skip)]
    Joints(JointsGait),
}

/// `[[body]]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Name, used in outputs, references and as the name of its boundary.
    pub name: String,
    /// Outline.
    pub shape: ShapeSpec,
    /// Position of the shape's origin (m), one number per dimension.
    #[cfg_attr(test, schemars(with = "PerDimension"))]
    pub center: Vec<f64>,
    /// Rotation of the body frame, counter-clockwise (rad; planar).
    #[serde(default, deserialize_with = "crate::text::angle::deserialize")]
    #[cfg_attr(test, schemars(with = "crate::text::angle::Angle"))]
    #[cfg_attr(test, schemars(extend("geometries" = ["planar", "axisymmetric"])))]
    pub angle: f64,
    /// Rotation of the body frame in space; none if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(extend("geometries" = ["spatial"])))]
    pub orientation: Option<Orientation>,
    /// Density (kg/m3); that of the fluid if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<NonNegative>"))]
    pub density: Option<f64>,
    /// Mass (kg; kg/m planar), in place of the density times what the shape encloses.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<NonNegative>"))]
    pub mass: Option<f64>,
    /// Moment of inertia about the centre of mass (kg m2; kg m planar): a number in planar cases, in space those
    /// about x, y and z of the body, [xx, yy, zz], or the whole tensor; that of its mass spread evenly if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(extend("geometries" = ["planar", "spatial"])))]
    pub inertia: Option<InertiaSpec>,
    /// Centre of mass in the frame of the body (m), one number per dimension; that of its shape if absent.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(test, schemars(with = "PerDimension"))]
    pub center_of_mass: Vec<f64>,
    /// How it moves as a whole.
    pub motion: Motion,
    /// Motions a free body may not make.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub locked: Vec<Lock>,
    /// Those of the motions that are locked whose rate is given; made from `motion` only.
    #[serde(skip)]
    pub driven: Vec<Driven>,
    /// Velocity of a free body at time zero (m/s), one number per dimension; unsteady runs with inertia.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(test, schemars(with = "PerDimension"))]
    pub velocity: Vec<f64>,
    /// Angular velocity of a free body at time zero (rad/s): counter-clockwise in planar cases, [x, y, z] in
    /// space.
    #[serde(default, skip_serializing_if = "AxialVector::is_zero")]
    pub angular_velocity: AxialVector,
    /// Surface motion of a swimmer.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gait: Option<GaitSpec>,
    /// External force (N; N/m in planar cases), one number per dimension.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(test, schemars(with = "PerDimension"))]
    pub force: Vec<f64>,
    /// External torque (N m; N planar): counter-clockwise in planar cases, [x, y, z] in space.
    #[serde(default, skip_serializing_if = "AxialVector::is_zero")]
    pub torque: AxialVector,
    /// Factor in time for the external force and torque.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load_factor: Option<TimeFunction>,
    /// Axes along which the external force and torque are given.
    #[serde(default, skip_serializing_if = "LoadFrame::is_laboratory")]
    pub load_frame: LoadFrame,
    /// Spring and damper that tie it to a point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spring: Option<SpringSpec>,
    /// Magnetic moment in the frame of the body (A m2; A m planar), one number per dimension, which the
    /// field of `[field]` turns.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub magnetic_moment: Vec<f64>,
    /// Makes it bend as an elastic rod; a slender body only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(extend("geometries" = ["planar", "spatial"])))]
    pub rod: Option<RodSpec>,
    /// What holds the head of a rod; it is free if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(extend("geometries" = ["planar", "spatial"])))]
    pub attached: Option<Attached>,
    /// Muscles or motors within a rod.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(extend("geometries" = ["planar", "spatial"])))]
    pub activation: Option<Activation>,
    /// Cell size on its surface (m); that of `[mesh]` if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub size: Option<f64>,
}

impl GaitSpec {
    /// The time after which it begins again (s), if it does.
    #[must_use]
    pub fn period(&self) -> Option<f64> {
        match self {
            Self::Squirmer(_) | Self::Slip(_) => None,
            Self::Carangiform(gait) => Some(gait.period),
            Self::Anguilliform(gait) => Some(gait.period),
            Self::Flagellum(gait) => Some(gait.period),
            Self::Midline(gait) => Some(gait.period),
            Self::Pulsating(gait) => gait.period,
            Self::Joints(gait) => gait.period(),
        }
    }
}
