//! `[mesh]`: cell sizes.

use std::collections::BTreeMap;
#[cfg(test)]
use std::num::NonZeroUsize;

#[cfg(test)]
use crate::spec::number::{Fraction, PerDimension, Positive, UpToOne};
use serde::{Deserialize, Serialize};

/// `[mesh]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct MeshSettings {
    /// Largest edge length anywhere (m).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub size: f64,
    /// Edge length on body surfaces (m); `size` if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub surface: Option<f64>,
    /// Edge lengths on sides of the domain, by name (m).
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    #[cfg_attr(test, schemars(with = "BTreeMap<String, Positive>"))]
    pub sides: BTreeMap<String, f64>,
    /// Growth of the edge length per unit distance (1).
    #[serde(default = "default_growth")]
    #[cfg_attr(test, schemars(with = "UpToOne"))]
    pub growth: f64,
    /// Layers of cells wanted across the gap between two surfaces.
    #[serde(default = "default_gap_layers")]
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub gap_layers: f64,
    /// Cells of a mesh at most: a run that needs a new one with more ends. If absent, ten times those of the first mesh, or
    /// 50000 in the plane and 200000 in space where that is more.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<NonZeroUsize>"))]
    pub max_cells: Option<usize>,
    /// Rectangles, or boxes in space, with finer cells.
    #[serde(default, skip_serializing_if = "Vec::is_empty", rename = "box")]
    pub boxes: Vec<RefinementBox>,
    /// Whether cells follow curved boundaries (isoparametric P2) or stay straight.
    #[serde(default = "default_curved")]
    pub curved: bool,
    /// How the mesh follows bodies that move, and when it is replaced by a new one.
    #[serde(default, skip_serializing_if = "MovingMesh::is_default")]
    pub moving: MovingMesh,
    /// Factor on the sizes above and on `growth`, divisor of `gap_layers`: 0.5 is the same mesh
    /// twice as fine everywhere (1).
    #[serde(default = "default_scale")]
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub scale: f64,
}

/// Most layers of cells across a gap for which the domain is remeshed unless the case says so.
const ENOUGH_LAYERS: f64 = 2.0;

impl MeshSettings {
    /// Layers of cells across a gap in a new mesh.
    #[must_use]
    pub fn layers_when_new(&self) -> f64 {
        self.gap_layers / self.scale
    }

    /// Layers of cells across a gap below which the domain is remeshed: as given, or half of those in a new
    /// mesh, 2 at most.
    #[must_use]
    pub fn fewest_layers(&self) -> f64 {
        self.moving.layers.unwrap_or_else(|| ENOUGH_LAYERS.min(0.5 * self.layers_when_new()))
    }
}

/// `[mesh.moving]`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct MovingMesh {
    /// The equation the displacements of the cells solve.
    #[serde(default)]
    pub equation: MeshEquation,
    /// Quality of a cell, over its quality when new, below which the domain is remeshed (1).
    #[serde(default = "default_quality")]
    #[cfg_attr(test, schemars(with = "Fraction"))]
    pub quality: f64,
    /// Layers of cells across a gap below which the domain is remeshed; half of `gap_layers`, 2 at most, if
    /// absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub layers: Option<f64>,
}

impl MovingMesh {
    fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

impl Default for MovingMesh {
    fn default() -> Self {
        Self { equation: MeshEquation::default(), quality: default_quality(), layers: None }
    }
}

/// Equation of mesh motion.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum MeshEquation {
    /// Linear elasticity, stiff near the bodies: lets them go farthest.
    #[default]
    Elastic,
    /// Harmonic, stiff where cells are small (Masud and Hughes).
    Harmonic,
}

/// `[[mesh.box]]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct RefinementBox {
    /// Corner with the least coordinates (m), one number per dimension.
    #[cfg_attr(test, schemars(with = "PerDimension"))]
    pub min: Vec<f64>,
    /// Corner with the largest coordinates (m).
    #[cfg_attr(test, schemars(with = "PerDimension"))]
    pub max: Vec<f64>,
    /// Largest edge length inside (m).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub size: f64,
}

fn default_quality() -> f64 {
    0.4
}

fn default_growth() -> f64 {
    0.2
}

fn default_gap_layers() -> f64 {
    4.0
}

fn default_curved() -> bool {
    true
}

fn default_scale() -> f64 {
    1.0
}
