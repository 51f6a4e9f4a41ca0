//! `MeshFile`: a domain that is given as a mesh made by Gmsh, and what is known of its sides.

use std::sync::Arc;

use alewife_mesh::spatial::Imported;
use alewife_mesh::{Bounds, DomainMesh, Mesh, MshError, MshOptions, SideShape};
use serde::{Deserialize, Serialize};

use super::extent::Extent;

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
            mesh,
        }
    }
}

impl MeshFile {
    /// A mesh that was made inside a surface.
    pub(crate) fn of_region(contents: Arc<Contents>) -> Self {
        let contents = Some(contents);
        Self { file: String::new(), scale: 1.0, sides: Vec::new(), checksum: None, contents }
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

    /// The content of the file; `None` of a mesh that was made inside a surface.
    #[must_use]
    pub fn bytes(&self) -> Option<&[u8]> {
        self.contents.as_ref()?.bytes.as_deref()
    }
}
