//! `[[solid]]`: shape, material, fibres and what holds a soft body.

use serde::{Deserialize, Serialize};

use super::stretch::Stretch;
use crate::ShapeSpec;
#[cfg(test)]
use crate::spec::number::{NonNegative, Positive};

/// An elastic body. One of `shape`, `outline`, `grid` and `mesh` says where it is at rest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SoftSolid {
    /// Its name.
    pub name: String,
    /// A shape of the plane: disc, ellipse, spline, fish, flagellate or tube; in space a surface; with its origin at 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shape: Option<ShapeSpec>,
    /// A polygon, in space a plate of its form.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outline: Option<OutlineSpec>,
    /// A rectangle or a box of equal cells.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub grid: Option<GridSpec>,
    /// A mesh of Gmsh.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mesh: Option<SolidMeshFile>,
    /// Size of the cells (m) of a `shape` or an `outline`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub size: Option<f64>,
    /// Degree of the shape functions.
    #[serde(default)]
    pub order: SolidOrder,
    /// What it is made of.
    pub material: MaterialSpec,
    /// Parts of other materials, such as stiff ones; the last that holds a cell counts.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub part: Vec<MaterialPart>,
    /// Parts that move as rigid bodies; they may not touch each other, nor be held.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rigid: Vec<RigidSpec>,
    /// Active fibres.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub fibre: Vec<FibreSpec>,
    /// Where it is held.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub hold: Vec<HoldSpec>,
}

/// `outline`: a polygon.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct OutlineSpec {
    /// Its corners in order (m), three or more; the last is joined to the first.
    #[cfg_attr(test, schemars(length(min = 3)))]
    pub points: Vec<[f64; 2]>,
    /// In space: where the plate begins and ends along z (m).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub z: Option<[f64; 2]>,
    /// In space: layers of cells along z.
    #[serde(default = "one_layer")]
    pub layers: usize,
}

fn one_layer() -> usize {
    1
}

/// `grid`: a rectangle or a box of equal cells, each divided into simplices.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct GridSpec {
    /// Lower corner (m).
    pub from: Vec<f64>,
    /// Upper corner (m).
    pub to: Vec<f64>,
    /// Cells along each axis.
    pub cells: Vec<usize>,
}

/// `mesh`: a mesh of Gmsh, MSH 4.1.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SolidMeshFile {
    /// Path of the file, relative to the file in which it is written.
    pub file: String,
    /// Factor that makes its lengths those of the case.
    #[serde(default = "one")]
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub scale: f64,
}

fn one() -> f64 {
    1.0
}

/// Degree of the shape functions of a solid.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum SolidOrder {
    /// One strain a cell: too stiff in bending and near nu = 0.5.
    Linear,
    /// Good to nu = 0.49 by places alone, and at 0.5 with linear pressures.
    #[default]
    Quadratic,
}

/// An elastic material.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct MaterialSpec {
    /// Its elastic energy.
    #[serde(default)]
    pub law: LawName,
    /// Young's modulus (Pa).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub young: f64,
    /// Poisson's ratio, above -1 and at most 0.5: 0.5 keeps the volume, by pressures, in quadratic cells.
    pub poisson: f64,
    /// Density at rest (kg/m3).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub density: f64,
    /// Viscosity of Kelvin and Voigt's damping (Pa s).
    #[serde(default)]
    #[cfg_attr(test, schemars(with = "NonNegative"))]
    pub viscosity: f64,
}

impl MaterialSpec {
    /// Whether its volume cannot change.
    #[must_use]
    pub fn is_incompressible(&self) -> bool {
        self.poisson == 0.5
    }
}

/// An elastic energy.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum LawName {
    /// Neo-Hookean.
    #[default]
    NeoHookean,
    /// Saint-Venant and Kirchhoff's: for benchmarks and small strains.
    SaintVenantKirchhoff,
    /// Corotated, with (J - 1)^2 for the volume.
    Corotated,
    /// Corotated, with the distance from stretches of unit volume: a third of Hooke's lambda.
    CorotatedVolume,
}

/// `part`: cells of another material.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct MaterialPart {
    /// Which cells: those whose centre lies there.
    pub region: Region,
    /// What they are made of.
    pub material: MaterialSpec,
}

/// `rigid`: cells that move as a rigid body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct RigidSpec {
    /// Which cells: those whose centre lies there.
    pub region: Region,
    /// Density at rest (kg/m3).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub density: f64,
}

/// A box: what lies in it, its faces included, is meant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Region {
    /// Lower corner (m); -inf for none.
    pub from: Vec<f64>,
    /// Upper corner (m); inf for none.
    pub to: Vec<f64>,
}

impl Region {
    /// Whether a point lies in it.
    #[must_use]
    pub fn holds(&self, point: &[f64]) -> bool {
        let mut sides = point.iter().zip(self.from.iter().zip(&self.to));
        sides.all(|(x, (from, to))| from <= x && x <= to)
    }
}

/// `fibre`: active fibres with the energy `stiffness`/2 (|F m| - a)^2 a volume, along m and told the stretch a.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct FibreSpec {
    /// Their name.
    pub name: String,
    /// Which cells they run through: those whose centre lies there.
    pub region: Region,
    /// Their direction at rest.
    pub direction: Vec<f64>,
    /// Stiffness (Pa).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub stiffness: f64,
    /// The stretch they are told, 1 at rest.
    pub stretch: Stretch,
}

/// `hold`: nodes that do not move along some axes: clamped along all, on a rail along all but one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct HoldSpec {
    /// Which nodes: those that lie there.
    pub region: Region,
    /// Along which axes: all of them if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axes: Option<Vec<AxisName>>,
}

/// An axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum AxisName {
    /// The first.
    X,
    /// The second.
    Y,
    /// The third.
    Z,
}

impl AxisName {
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
