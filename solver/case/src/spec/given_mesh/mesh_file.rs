//! `MeshFile`: a domain that is given as a mesh of Gmsh, or that was made inside a surface.

use std::sync::Arc;

use alewife_mesh::spatial::Imported;
use alewife_mesh::{Mesh, SidePair, SideShape, Unpaired};
use serde::{Deserialize, Serialize};

use super::contents::{Contents, GivenMesh, NamedSide};
use super::region_mesh::{RegionFault, RegionMesh};
use crate::spec::extent::Extent;

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
    pub(crate) source: MeshSource,
    /// In space, what is around the bodies that are holes of it, where there are some.
    #[serde(skip)]
    #[cfg_attr(test, schemars(skip))]
    pub(crate) around_bodies: Option<Imported>,
}

pub(super) fn one() -> f64 {
    1.0
}

/// Where a mesh comes from.
#[derive(Debug, Clone, Default)]
pub(crate) enum MeshSource {
    /// It has not been read.
    #[default]
    Unread,
    /// A file.
    File(Arc<Contents>),
    /// The inside of a surface, which is meshed once that is asked for.
    Inside(Arc<RegionMesh>),
}

/// Files with the same content are the same wherever they are.
impl PartialEq for MeshFile {
    fn eq(&self, other: &Self) -> bool {
        (self.scale, &self.sides, &self.checksum) == (other.scale, &other.sides, &other.checksum)
    }
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
    let pair = |[original, copy]: &[String; 2]| {
        let [original, copy] = [mesh.boundary_named(original)?, mesh.boundary_named(copy)?];
        Some(SidePair { original, copy })
    };
    pairs.iter().filter_map(pair).collect()
}

impl MeshFile {
    /// The mesh inside a surface.
    pub(crate) fn inside(region: Arc<RegionMesh>) -> Self {
        Self {
            file: String::new(),
            scale: 1.0,
            sides: Vec::new(),
            checksum: None,
            source: MeshSource::Inside(region),
            around_bodies: None,
        }
    }

    fn contents(&self) -> Option<&Contents> {
        match &self.source {
            MeshSource::Unread => None,
            MeshSource::File(contents) => Some(contents),
            MeshSource::Inside(region) => region.contents().ok(),
        }
    }

    /// Why the inside of its surface has no mesh, if it has none.
    #[must_use]
    pub fn fault(&self) -> Option<RegionFault> {
        match &self.source {
            MeshSource::Inside(region) => region.contents().err(),
            MeshSource::Unread | MeshSource::File(_) => None,
        }
    }

    /// Pairs the nodes of sides, each pair by its names.
    pub(crate) fn pair(&mut self, sides: &[[String; 2]]) -> Result<(), UnpairedSides> {
        // A mesh that was just read is held by nobody else
        let MeshSource::File(contents) = &mut self.source else { return Ok(()) };
        let Some(own) = Arc::get_mut(contents) else { return Ok(()) };
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
        Ok(())
    }

    /// Along which coordinates its sides are periodic.
    #[must_use]
    pub fn periodic(&self) -> [bool; 3] {
        self.contents().map_or([false; 3], |contents| contents.periodic)
    }

    fn named_sides(&self) -> &[NamedSide] {
        self.contents().map_or(&[], |contents| contents.sides.as_slice())
    }

    /// What was made of the file that its author may not expect, a sentence each.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        self.contents().map_or(&[], |contents| contents.notes.as_slice())
    }

    /// Names of its sides.
    #[must_use]
    pub fn side_names(&self) -> Vec<&str> {
        match &self.source {
            MeshSource::Inside(region) => region.sides().iter().map(String::as_str).collect(),
            _ => self.named_sides().iter().map(|side| side.name.as_str()).collect(),
        }
    }

    /// What a side looks like; `None` where there is none of that name.
    #[must_use]
    pub fn side_shape(&self, name: &str) -> Option<&SideShape> {
        self.named_sides().iter().find(|side| side.name == name).map(|side| &side.shape)
    }

    /// The smallest box around it.
    #[must_use]
    pub fn extent(&self) -> Extent {
        let extent = self.contents().map(|contents| contents.extent);
        extent.unwrap_or_else(|| Extent::between(&[], &[]))
    }

    /// Its number of cells.
    #[must_use]
    pub fn n_cells(&self) -> usize {
        self.contents().map_or(0, |contents| contents.n_cells)
    }

    /// Its area, in space its volume (m2, m3).
    #[must_use]
    pub fn measure(&self) -> f64 {
        self.contents().map_or(0.0, |contents| contents.measure)
    }

    /// Its mesh in the plane; `None` in space.
    #[must_use]
    pub fn planar(&self) -> Option<&Mesh<2>> {
        match &self.contents()?.mesh {
            GivenMesh::Planar(mesh) => Some(mesh),
            GivenMesh::Spatial(_) => None,
        }
    }

    /// Its mesh in space; `None` in the plane.
    #[must_use]
    pub fn spatial(&self) -> Option<&Imported> {
        match &self.contents()?.mesh {
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
        self.contents()?.bytes.as_deref()
    }
}
