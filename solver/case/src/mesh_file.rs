//! `MeshFile`: a domain that is given as a mesh made by Gmsh, and what is known of its sides.

use std::path::Path;
use std::sync::Arc;

use alewife_mesh::spatial::Imported;
use alewife_mesh::{
    BoundaryId, Bounds, Mesh, MshError, SideShape, read_planar_msh, read_spatial_msh,
};
use serde::{Deserialize, Serialize};

use super::region::Extent;
use super::source::Origin;
use super::tree::{TomlNode, TreeError};
use super::{Case, DomainSpec, library};

/// Largest file that is read (bytes).
const LARGEST_FILE: u64 = 4_000_000_000;

/// `domain.mesh`: a mesh in a file.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct MeshFile {
    /// Path of a file of Gmsh, MSH 4.1, relative to the file in which it is written.
    pub file: String,
    /// Factor that makes its lengths those of the case (1).
    #[serde(default = "one")]
    pub scale: f64,
    /// Checksum of the file, as runs write it: a file with another one is refused.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub checksum: Option<String>,
    /// What the file holds.
    #[serde(skip)]
    #[cfg_attr(test, schemars(skip))]
    pub(super) contents: Option<Arc<Contents>>,
}

fn one() -> f64 {
    1.0
}

/// Files with the same content are the same wherever they are.
impl PartialEq for MeshFile {
    fn eq(&self, other: &Self) -> bool {
        (self.scale, &self.checksum) == (other.scale, &other.checksum)
    }
}

/// What a file holds.
#[derive(Debug)]
pub(super) struct Contents {
    bytes: Vec<u8>,
    mesh: GivenMesh,
    sides: Vec<NamedSide>,
    extent: Extent,
    n_cells: usize,
    measure: f64,
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
    fn read(bytes: Vec<u8>, scale: f64, dimensions: usize) -> Result<Self, MshError> {
        if dimensions == 2 {
            let mesh = read_planar_msh(&bytes, scale)?;
            Ok(Self::of(bytes, &mesh, GivenMesh::Planar(mesh.clone())))
        } else {
            let imported = Imported::new(read_spatial_msh(&bytes, scale)?);
            Ok(Self::of(bytes, imported.mesh(), GivenMesh::Spatial(imported.clone())))
        }
    }

    fn of<const D: usize>(bytes: Vec<u8>, from: &Mesh<D>, mesh: GivenMesh) -> Self {
        let sides = from.boundaries.iter().enumerate().map(|(index, boundary)| NamedSide {
            name: boundary.name.clone(),
            shape: from.side_shape(BoundaryId::new(index)),
        });
        let bounds = Bounds::around(&from.nodes);
        Self {
            bytes,
            sides: sides.collect(),
            extent: Extent::between(bounds.min.as_slice(), bounds.max.as_slice()),
            n_cells: from.n_cells(),
            measure: from.measure(),
            mesh,
        }
    }
}

impl MeshFile {
    fn sides(&self) -> &[NamedSide] {
        self.contents.as_ref().map_or(&[], |contents| contents.sides.as_slice())
    }

    /// Names of its sides.
    #[must_use]
    pub fn side_names(&self) -> Vec<&str> {
        self.sides().iter().map(|side| side.name.as_str()).collect()
    }

    /// What a side looks like; `None` where there is none of that name.
    #[must_use]
    pub fn side_shape(&self, name: &str) -> Option<&SideShape> {
        self.sides().iter().find(|side| side.name == name).map(|side| &side.shape)
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

    /// The content of the file.
    #[must_use]
    pub fn bytes(&self) -> Option<&[u8]> {
        self.contents.as_ref().map(|contents| contents.bytes.as_slice())
    }
}

impl Case {
    /// The mesh the domain is given by; `None` of other domains.
    #[must_use]
    pub fn given_mesh(&self) -> Option<&MeshFile> {
        match &self.domain {
            DomainSpec::Mesh(file) => Some(file),
            _ => None,
        }
    }
}

/// Reads the file that a case names as its domain, if it does.
///
/// # Errors
/// When it cannot be read, or is no mesh of the dimension of the case.
pub fn read_into(case: &mut Case, root: &TomlNode) -> Result<(), TreeError> {
    let dimensions = case.geometry.dimensions();
    let DomainSpec::Mesh(spec) = &mut case.domain else { return Ok(()) };
    let origin = root.find("domain.mesh.file").node.origin.clone();
    let refused = |message: String, help: &str| TreeError {
        origin: origin.clone(),
        message,
        help: help.to_owned(),
    };
    if !(spec.scale.is_finite() && spec.scale > 0.0) {
        let origin = root.find("domain.mesh.scale").node.origin.clone();
        let message = format!("`domain.mesh.scale` is {}", spec.scale);
        return Err(TreeError { origin, message, help: "write a number above 0".to_owned() });
    }
    let bytes = bytes_of(&spec.file, &origin)
        .map_err(|Unreadable { message, help }| refused(message, &help))?;
    let found = checksum(&bytes);
    if let Some(wanted) = spec.checksum.as_ref().filter(|wanted| **wanted != found) {
        return Err(refused(
            format!("{} has the checksum {found}, not {wanted}", spec.file),
            "it has changed since the case was run: restore it, or take domain.mesh.checksum out",
        ));
    }
    let contents = Contents::read(bytes, spec.scale, dimensions).map_err(|error| {
        let help = error.accepted.clone();
        let place = match error.place {
            alewife_mesh::Place::Line(line) => format!(", line {line}"),
            alewife_mesh::Place::Byte(byte) => format!(", byte {byte}"),
            alewife_mesh::Place::Mesh => String::new(),
        };
        refused(format!("{}{place}: {}", spec.file, error.found), &help)
    })?;
    spec.checksum = Some(found);
    spec.contents = Some(Arc::new(contents));
    Ok(())
}

/// The checksum of a file: CRC-32 as in `provenance.json`, and the length.
fn checksum(bytes: &[u8]) -> String {
    format!("crc32:{:08x}-{}", crc32fast::hash(bytes), bytes.len())
}

/// Why a file cannot be read, and what would help.
struct Unreadable {
    message: String,
    help: String,
}

/// The content of a file named at some place.
fn bytes_of(file: &str, origin: &Origin) -> Result<Vec<u8>, Unreadable> {
    let unreadable = |message: String, help: &str| Unreadable { message, help: help.to_owned() };
    let Some(directory) = &origin.source.directory else {
        return library::file_beside(&origin.source.name, file).map(<[u8]>::to_vec).ok_or_else(
            || {
                unreadable(
                    format!("`{file}` cannot be reached from here"),
                    "a shipped case is given with its mesh: write `extends` with its name, or \
                     `alewife mesh CASE --out FILE.msh`",
                )
            },
        );
    };
    let path = directory.join(Path::new(file));
    let failed = |error: std::io::Error| {
        unreadable(
            format!("{}: {error}", path.display()),
            "give the path of a file of Gmsh, relative to the file in which it is written",
        )
    };
    // Asked before it is opened: opening a pipe waits for somebody to write into it
    let found = std::fs::metadata(&path).map_err(failed)?;
    if !found.is_file() {
        let message = format!("{} is no file", path.display());
        return Err(unreadable(message, "give the path of a file of Gmsh"));
    }
    if found.len() > LARGEST_FILE {
        let message = format!("{} has {:.1} GB", path.display(), found.len() as f64 / 1e9);
        return Err(unreadable(message, "meshes up to 4 GB are read"));
    }
    std::fs::read(&path).map_err(failed)
}
