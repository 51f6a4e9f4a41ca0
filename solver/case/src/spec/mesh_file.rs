//! `MeshFile` and `RegionSpec`: domains that are given as a mesh of Gmsh, or as a closed surface.

use std::collections::BTreeMap;
use std::sync::Arc;

use alewife_mesh::spatial::Imported;
use alewife_mesh::{
    BoundaryId, Bounds, DomainMesh, Mesh, MshError, MshOptions, SidePair, SideShape, Unpaired,
};
use serde::{Deserialize, Serialize};

use super::extent::Extent;
#[cfg(test)]
use crate::spec::number::{Degrees, Positive};

/// `domain.mesh`: a mesh in a file.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct MeshFile {
    /// Path of a file of Gmsh (MSH 2.2, 4.0 or 4.1), relative to the file in which it is written.
    pub file: String,
    /// Factor that makes its lengths those of the case (1).
    #[serde(default = "one")]
    pub scale: f64,
    /// Names of the physical groups that are sides, where parts of the boundary are in several (all groups).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sides: Vec<String>,
    /// Checksum of the file, as runs write it: a file with another one is refused.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub checksum: Option<String>,
    /// What the file holds.
    #[serde(skip)]
    #[cfg_attr(test, schemars(skip))]
    pub(crate) contents: Option<Arc<Contents>>,
    /// In space, what is around the bodies that are holes of it, where there are some.
    #[serde(skip)]
    #[cfg_attr(test, schemars(skip))]
    pub(crate) around_bodies: Option<Imported>,
}

fn one() -> f64 {
    1.0
}

/// Files with the same content are the same wherever they are.
impl PartialEq for MeshFile {
    fn eq(&self, other: &Self) -> bool {
        (self.scale, &self.sides, &self.checksum) == (other.scale, &other.sides, &other.checksum)
    }
}

/// What a file holds.
#[derive(Debug)]
pub(crate) struct Contents {
    /// Content of the file; `None` of a mesh that was made.
    bytes: Option<Vec<u8>>,
    mesh: GivenMesh,
    sides: Vec<NamedSide>,
    extent: Extent,
    n_cells: usize,
    measure: f64,
    notes: Vec<String>,
    /// Along which coordinates sides are periodic.
    periodic: [bool; 3],
}

/// Why sides are no periodic pairs.
pub(crate) struct UnpairedSides {
    /// The side of the node without a partner.
    pub side: Option<String>,
    /// What is wrong.
    pub reason: Unpaired,
}

/// Where pairs of sides are among those of a mesh.
fn numbered<const D: usize>(mesh: &Mesh<D>, pairs: &[[String; 2]]) -> Vec<SidePair> {
    let number = |name: &String| {
        let place = mesh.boundaries.iter().position(|boundary| boundary.name == *name);
        place.map(BoundaryId::new)
    };
    let pair = |[original, copy]: &[String; 2]| {
        Some(SidePair { original: number(original)?, copy: number(copy)? })
    };
    pairs.iter().filter_map(pair).collect()
}

/// A mesh of the dimension of the case.
#[derive(Debug)]
enum GivenMesh {
    Planar(Mesh<2>),
    Spatial(Imported),
}

#[derive(Debug)]
struct NamedSide {
    name: String,
    shape: SideShape,
}

impl Contents {
    /// Reads the content of a file as a mesh of this many dimensions.
    pub(crate) fn read(
        bytes: Vec<u8>,
        options: &MshOptions,
        dimensions: usize,
    ) -> Result<Self, MshError> {
        if dimensions == 2 {
            let read = DomainMesh::<2>::read(&bytes, options)?;
            Ok(Self::of(Some(bytes), &read, GivenMesh::Planar(read.mesh.clone())))
        } else {
            let read = DomainMesh::<3>::read(&bytes, options)?;
            let imported = Imported::new(read.mesh.clone());
            Ok(Self::of(Some(bytes), &read, GivenMesh::Spatial(imported)))
        }
    }

    /// A mesh that was made inside a surface.
    pub(crate) fn of_region(mesh: Mesh<3>) -> Self {
        let imported = Imported::new(mesh.clone());
        Self::of(None, &DomainMesh::of(mesh), GivenMesh::Spatial(imported))
    }

    fn of<const D: usize>(bytes: Option<Vec<u8>>, from: &DomainMesh<D>, mesh: GivenMesh) -> Self {
        let sides = from.mesh.boundaries.iter().zip(&from.sides);
        let sides =
            sides.map(|(boundary, shape)| NamedSide { name: boundary.name.clone(), shape: *shape });
        let bounds = Bounds::around(&from.mesh.nodes);
        Self {
            bytes,
            sides: sides.collect(),
            extent: Extent::between(bounds.min.as_slice(), bounds.max.as_slice()),
            n_cells: from.mesh.n_cells(),
            measure: from.measure,
            notes: from.notes.clone(),
            periodic: [false; 3],
            mesh,
        }
    }
}

impl MeshFile {
    /// A mesh that was made inside a surface.
    pub(crate) fn of_region(contents: Arc<Contents>) -> Self {
        let contents = Some(contents);
        Self {
            file: String::new(),
            scale: 1.0,
            sides: Vec::new(),
            checksum: None,
            contents,
            around_bodies: None,
        }
    }

    /// Pairs the nodes of sides, each pair by its names.
    pub(crate) fn pair(&mut self, sides: &[[String; 2]]) -> Result<(), UnpairedSides> {
        let Some(mut contents) = self.contents.take() else { return Ok(()) };
        // A mesh that was just read is held by nobody else
        let Some(own) = Arc::get_mut(&mut contents) else {
            self.contents = Some(contents);
            return Ok(());
        };
        let failed = |names: Vec<String>| {
            move |reason: Unpaired| {
                let side = match &reason {
                    Unpaired::Node { side, .. } => names.get(side.index()).cloned(),
                    Unpaired::Oblique { .. } => None,
                };
                UnpairedSides { side, reason }
            }
        };
        let names = own.sides.iter().map(|side| side.name.clone()).collect();
        let mut across = |along: &[f64]| {
            for (axis, part) in along.iter().enumerate() {
                own.periodic[axis] |= *part != 0.0;
            }
        };
        match &mut own.mesh {
            GivenMesh::Planar(mesh) => {
                let paired = mesh.paired(&numbered(mesh, sides)).map_err(failed(names))?;
                paired.translations.iter().for_each(|along| across(along.as_slice()));
                *mesh = paired.mesh;
            }
            GivenMesh::Spatial(imported) => {
                let mesh = imported.mesh();
                let paired = mesh.paired(&numbered(mesh, sides)).map_err(failed(names))?;
                paired.translations.iter().for_each(|along| across(along.as_slice()));
                *imported = Imported::new(paired.mesh);
            }
        }
        self.contents = Some(contents);
        Ok(())
    }

    /// Along which coordinates its sides are periodic.
    #[must_use]
    pub fn periodic(&self) -> [bool; 3] {
        self.contents.as_ref().map_or([false; 3], |contents| contents.periodic)
    }

    fn named_sides(&self) -> &[NamedSide] {
        self.contents.as_ref().map_or(&[], |contents| contents.sides.as_slice())
    }

    /// What was made of the file that its author may not expect, a sentence each.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        self.contents.as_ref().map_or(&[], |contents| contents.notes.as_slice())
    }

    /// Names of its sides.
    #[must_use]
    pub fn side_names(&self) -> Vec<&str> {
        self.named_sides().iter().map(|side| side.name.as_str()).collect()
    }

    /// What a side looks like; `None` where there is none of that name.
    #[must_use]
    pub fn side_shape(&self, name: &str) -> Option<&SideShape> {
        self.named_sides().iter().find(|side| side.name == name).map(|side| &side.shape)
    }

    /// The smallest box around it.
    #[must_use]
    pub fn extent(&self) -> Extent {
        let extent = self.contents.as_ref().map(|contents| contents.extent);
        extent.unwrap_or_else(|| Extent::between(&[], &[]))
    }

    /// Its number of cells.
    #[must_use]
    pub fn n_cells(&self) -> usize {
        self.contents.as_ref().map_or(0, |contents| contents.n_cells)
    }

    /// Its area, in space its volume (m2, m3).
    #[must_use]
    pub fn measure(&self) -> f64 {
        self.contents.as_ref().map_or(0.0, |contents| contents.measure)
    }

    /// Its mesh in the plane; `None` in space.
    #[must_use]
    pub fn planar(&self) -> Option<&Mesh<2>> {
        match &self.contents.as_ref()?.mesh {
            GivenMesh::Planar(mesh) => Some(mesh),
            GivenMesh::Spatial(_) => None,
        }
    }

    /// Its mesh in space; `None` in the plane.
    #[must_use]
    pub fn spatial(&self) -> Option<&Imported> {
        match &self.contents.as_ref()?.mesh {
            GivenMesh::Planar(_) => None,
            GivenMesh::Spatial(imported) => Some(imported),
        }
    }

    /// The same with the sides that no body is inside of: all where no body is a hole of it.
    #[must_use]
    pub fn around_bodies(&self) -> Option<&Imported> {
        self.around_bodies.as_ref().or_else(|| self.spatial())
    }

    /// The content of the file; `None` of a mesh that was made inside a surface.
    #[must_use]
    pub fn bytes(&self) -> Option<&[u8]> {
        self.contents.as_ref()?.bytes.as_deref()
    }
}

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
