//! `RegionSpec`: a domain that is given as a closed surface of triangles.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::mesh_file::{MeshFile, one};
#[cfg(test)]
use crate::spec::number::{Degrees, Positive};

/// `domain.surface`: the inside of a closed surface, from an STL, OBJ or PLY file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct RegionSpec {
    /// Path of the file, relative to the file in which it is written.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// The triangles of the file, as runs write them in its place.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub data: Option<String>,
    /// The solids of an STL file as text, or the groups of an OBJ file, as runs write them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub solids: Vec<NamedSolid>,
    /// Factor that makes its lengths those of the case (1).
    #[serde(default = "one")]
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub scale: f64,
    /// Largest angle by which a smooth wall turns at an edge of triangles (degrees); sharper edges stay sharp.
    #[serde(default = "smooth")]
    #[cfg_attr(test, schemars(with = "Degrees"))]
    pub smooth: f64,
    /// Sides by their names; triangles of none of them are on the side of the name of their solid, or on `wall`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub sides: BTreeMap<String, SidePart>,
    /// Its mesh, once it is read.
    #[serde(skip)]
    #[cfg_attr(test, schemars(skip))]
    pub(crate) filled: Option<MeshFile>,
}

fn smooth() -> f64 {
    30.0
}

/// Triangles of a file that have one name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct NamedSolid {
    /// Their name.
    pub name: String,
    /// How many there are.
    pub triangles: usize,
}

/// The part of a surface that is a side.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum SidePart {
    /// The triangles in a plane.
    Plane {
        /// A point of the plane (m).
        point: [f64; 3],
        /// A direction across it.
        normal: [f64; 3],
    },
    /// The triangles of a solid of an STL file as text, or of a group of an OBJ file.
    Solid(String),
}

impl RegionSpec {
    /// Its mesh; `None` where it has not been read.
    #[must_use]
    pub fn mesh(&self) -> Option<&MeshFile> {
        self.filled.as_ref()
    }
}
