//! `SoftCase`: what the file of a soft case declares.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::search::{Calibration, Optimisation, Robot};
use super::solid::SoftSolid;
#[cfg(test)]
use crate::spec::number::{NonNegative, Positive};
use crate::{DataSpec, Geometry, ReferenceKind, Units};

/// An elastic body without a flow: what it is made of, how it is driven and loaded, what is known of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SoftCase {
    /// One line saying what is computed.
    pub title: String,
    /// A paragraph for `alewife show`: physics, source, what to expect.
    #[serde(default)]
    pub description: String,
    /// In the plane (plane strain), around the axis y = 0, or in space.
    pub geometry: Geometry,
    /// The consistent units of all numbers: a text, as `SI`, or labels.
    #[serde(default)]
    pub units: Units,
    /// The body: one.
    pub solid: Vec<SoftSolid>,
    /// Frames and steps.
    pub soft: SoftSettings,
    /// The fluid's loads, facet by facet; as in vacuum if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub loads: Option<Loads>,
    /// Points of the body that are followed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub marker: Vec<Marker>,
    /// Angles between them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub angle: Vec<AngleSpec>,
    /// A recorded motion.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub record: Option<RecordSpec>,
    /// Which numbers `alewife calibrate` finds from the record.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub calibration: Option<Calibration>,
    /// Which numbers `alewife optimise` finds, and for what.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub optimisation: Option<Optimisation>,
    /// What stands for the robot in `alewife loop`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub robot: Option<Robot>,
    /// Files that do not come with the case.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub data: Option<DataSpec>,
    /// What runs and searches are compared with.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub reference: Vec<SoftReference>,
    /// The same case with some keys set.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub variant: Vec<SoftVariant>,
}

impl SoftCase {
    /// Names of the columns of `series.csv` behind the time: places and velocities of markers, angles, energies and work.
    #[must_use]
    pub fn quantities(&self) -> Vec<String> {
        let axes = &["x", "y", "z"][..self.geometry.dimensions()];
        let of_marker = |marker: &Marker| {
            let name = &marker.name;
            let places = axes.iter().map(move |axis| format!("{name}.{axis}"));
            let velocities = axes.iter().map(move |axis| format!("{name}.velocity.{axis}"));
            places.chain(velocities).collect::<Vec<_>>()
        };
        let angles = self.angle.iter().map(|angle| format!("{}.angle", angle.name));
        let of_body = ["energy.kinetic", "energy.elastic", "work"];
        let sought = self.optimisation.iter().map(|_| "objective");
        let of_body = of_body.into_iter().chain(sought).map(str::to_owned);
        self.marker.iter().flat_map(of_marker).chain(angles).chain(of_body).collect()
    }
}

/// `[[variant]]`: the same case with some keys set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SoftVariant {
    /// Name; `alewife run CASE/NAME` runs it.
    pub name: String,
    /// Keys to set, written as on the command line: `"solid.0.material.young" = 2e4`.
    #[serde(default)]
    #[cfg_attr(test, schemars(with = "BTreeMap<String, serde_json::Value>"))]
    pub set: BTreeMap<String, toml::Value>,
    /// Its references, besides those of the case.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub reference: Vec<SoftReference>,
}

/// `[soft]`: how the body steps in time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SoftSettings {
    /// Time of a frame (s): what fibres are told is held over it.
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub frame: f64,
    /// Number of frames.
    pub frames: usize,
    /// Steps of a frame.
    #[serde(default = "one_step")]
    pub substeps: usize,
    /// How it steps.
    #[serde(default)]
    pub scheme: SoftScheme,
    /// Residual of a step, of its forces, at which Newton's iterations end.
    #[serde(default = "tolerance")]
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub tolerance: f64,
}

fn one_step() -> usize {
    1
}

fn tolerance() -> f64 {
    1e-8
}

/// How a soft body steps.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum SoftScheme {
    /// Implicit Euler: first order, damps what it does not resolve.
    #[default]
    Euler,
    /// Backward differences of second order.
    Bdf2,
}

/// `[loads]`: drag and thrust on facets that move into the fluid.
///
/// On a facet of area A and outer normal n with the velocity v at the angle of attack alpha the load is
/// -density/2 A (`drag`(alpha) |v| v + `thrust`(alpha) |v|^2 n).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Loads {
    /// Density of the fluid (kg/m3).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub density: f64,
    /// Coefficient of drag over alpha from 0 (along the facet) to pi/2 (along its normal).
    pub drag: LoadCurve,
    /// Coefficient of thrust over alpha from -pi/2 to pi/2, of which the upper half is used.
    pub thrust: LoadCurve,
}

/// A coefficient over an angle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum LoadCurve {
    /// Bezier's cubic by its four points, evenly apart in the angle.
    Bezier(Vec<f64>),
    /// Two or more values evenly apart in the angle, joined by straight lines.
    Table(Vec<f64>),
}

impl LoadCurve {
    /// Its points or values.
    #[must_use]
    pub fn points(&self) -> &[f64] {
        match self {
            Self::Bezier(points) | Self::Table(points) => points,
        }
    }

    pub(super) fn points_mut(&mut self) -> &mut Vec<f64> {
        match self {
            Self::Bezier(points) | Self::Table(points) => points,
        }
    }
}

/// `[[marker]]`: a point of the body that is followed: the node nearest to where it is at rest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Marker {
    /// Its name, in names of quantities.
    pub name: String,
    /// Where it is at rest (m).
    pub at: Vec<f64>,
    /// Its weight in comparisons with a record.
    #[serde(default = "one")]
    #[cfg_attr(test, schemars(with = "NonNegative"))]
    pub weight: f64,
    /// Columns of the record with its coordinates.
    #[serde(default, skip_serializing_if = "MarkerColumns::is_empty")]
    pub columns: MarkerColumns,
}

fn one() -> f64 {
    1.0
}

/// Columns of a record with the coordinates of a marker; a minus sign before a name turns the sign of its values.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct MarkerColumns {
    /// Column of x.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub x: Option<String>,
    /// Column of y.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub y: Option<String>,
    /// Column of z.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub z: Option<String>,
}

impl MarkerColumns {
    /// Whether none is named.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.each().iter().all(Option::is_none)
    }

    /// Those of x, y and z.
    #[must_use]
    pub fn each(&self) -> [Option<&str>; 3] {
        [self.x.as_deref(), self.y.as_deref(), self.z.as_deref()]
    }
}

/// `[[angle]]`: how the body is bent at a marker, in the plane: from the line to it to the line from it, anticlockwise.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct AngleSpec {
    /// Its name, in names of quantities.
    pub name: String,
    /// Names of the marker before, of the marker, and of the one after it.
    pub markers: [String; 3],
    /// Its column in the record; what is compared are changes from the first frame.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub column: Option<String>,
    /// What a squared radian counts beside a square metre of markers (m2/rad2).
    #[serde(default = "one")]
    #[cfg_attr(test, schemars(with = "NonNegative"))]
    pub weight: f64,
}

/// Unit of the angles of a record.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum AngleUnit {
    /// Radian.
    #[default]
    Rad,
    /// Degree.
    Deg,
}

impl AngleUnit {
    /// One of it (rad).
    #[must_use]
    pub fn radians(self) -> f64 {
        match self {
            Self::Rad => 1.0,
            Self::Deg => 1f64.to_radians(),
        }
    }
}

/// `[record]`: a table of comma-separated values with one row a frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct RecordSpec {
    /// Path of the file, relative to the file in which it is written. Its first row names the columns, the first
    /// of which is the time.
    pub file: String,
    /// Unit of the time (s): 1e-3 for milliseconds.
    #[serde(default = "one")]
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub time_unit: f64,
    /// Unit of lengths (m): 1e-3 for millimetres.
    #[serde(default = "one")]
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub length_unit: f64,
    /// Unit of angles.
    #[serde(default)]
    pub angle_unit: AngleUnit,
    /// A column whose first change is where the motion begins: rows before, and those without a number in it, are
    /// left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub begins_with: Option<String>,
    /// What becomes of values that are not numbers.
    #[serde(default)]
    pub gaps: RecordGaps,
}

/// What becomes of values of a record that are not numbers.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum RecordGaps {
    /// A gap is a mistake.
    #[default]
    Refused,
    /// What would be compared with a gap is left out.
    Kept,
}

/// `[[reference]]`: a value with which a run or a search is compared.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SoftReference {
    /// Which command computes it.
    #[serde(default)]
    pub of: ReferenceOf,
    /// The quantity: a column of series.csv at the end of a run, `loss` or the name of a parameter of a
    /// calibration, `objective`, `travel`, `work` or the name of a parameter of an optimisation.
    pub quantity: String,
    /// Its value.
    pub value: f64,
    /// Largest accepted difference, of the value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<NonNegative>"))]
    pub relative: Option<f64>,
    /// Largest accepted difference.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<NonNegative>"))]
    pub absolute: Option<f64>,
    /// What kind of evidence it is.
    pub kind: ReferenceKind,
    /// Where it is from.
    pub source: String,
}

/// The command that computes a value.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum ReferenceOf {
    /// `alewife run`.
    #[default]
    Run,
    /// `alewife calibrate`.
    Calibration,
    /// `alewife optimise`.
    Optimisation,
}

impl SoftReference {
    /// The largest difference that is accepted.
    #[must_use]
    pub fn allowed(&self) -> f64 {
        self.absolute.unwrap_or_else(|| self.relative.unwrap_or(0.0) * self.value.abs())
    }
}
