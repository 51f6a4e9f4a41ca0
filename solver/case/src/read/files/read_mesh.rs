//! The mesh file that a case names as its domain, found and read.

use std::path::Path;
use std::sync::Arc;

use alewife_mesh::{MshOptions, Place};

use crate::read::library::{self, Beside};
use crate::spec::given_mesh::contents::Contents;
use crate::spec::given_mesh::mesh_file::MeshSource;
use crate::text::source::Origin;
use crate::text::tree::{TomlNode, TreeError};
use crate::{Case, DomainSpec};

/// Largest file that is read (bytes).
const LARGEST_FILE: u64 = 4_000_000_000;

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
    if let Some(format) = other_format(&spec.file, &bytes) {
        let path = Path::new(&spec.file);
        let whole = origin.source.directory.as_ref().map_or(path.to_owned(), |at| at.join(path));
        let (from, to) = (whole.display().to_string(), whole.with_extension("msh"));
        return Err(refused(
            format!("{} is a file of {format}, and no mesh of Gmsh", spec.file),
            &format!(
                "make one of it with `alewife-post convert {from} {}`, and write file = \"{}\"",
                to.display(),
                path.with_extension("msh").display()
            ),
        ));
    }
    let found = checksum(&bytes);
    if let Some(wanted) = spec.checksum.as_ref().filter(|wanted| **wanted != found) {
        return Err(refused(
            format!("{} has the checksum {found}, not {wanted}", spec.file),
            "it has changed since the case was run: restore it, or take domain.mesh.checksum out",
        ));
    }
    let options = MshOptions { scale: spec.scale, sides: spec.sides.clone() };
    let contents = Contents::read(bytes, &options, dimensions).map_err(|error| {
        let help = error.accepted.clone();
        let place = match error.place {
            Place::Line(line) => format!(", line {line}"),
            Place::Byte(byte) => format!(", byte {byte}"),
            Place::Mesh => String::new(),
        };
        refused(format!("{}{place}: {}", spec.file, error.found), &help)
    })?;
    spec.checksum = Some(found);
    spec.source = MeshSource::File(Arc::new(contents));
    Ok(())
}

/// The format of a file that is none of Gmsh, if it is known.
fn other_format(file: &str, bytes: &[u8]) -> Option<&'static str> {
    const FORMATS: [(&str, &str); 14] = [
        ("med", "Salome (MED)"),
        ("vtu", "VTK"),
        ("vtk", "VTK"),
        ("xdmf", "XDMF"),
        ("xmf", "XDMF"),
        ("inp", "Abaqus"),
        ("bdf", "Nastran"),
        ("nas", "Nastran"),
        ("unv", "I-deas"),
        ("su2", "SU2"),
        ("mesh", "Medit"),
        ("exo", "Exodus"),
        ("e", "Exodus"),
        ("h5m", "MOAB"),
    ];
    if bytes.starts_with(b"$MeshFormat") {
        return None;
    }
    let ending = Path::new(file).extension()?.to_string_lossy().to_lowercase();
    FORMATS.iter().find(|(known, _)| *known == ending).map(|(_, format)| *format)
}

/// The checksum of a file: CRC-32 as in `provenance.json`, and the length.
fn checksum(bytes: &[u8]) -> String {
    format!("crc32:{:08x}-{}", crc32fast::hash(bytes), bytes.len())
}

/// Why a file cannot be read, and what would help.
pub(crate) struct Unreadable {
    /// What is wrong.
    pub message: String,
    /// What would help.
    pub help: String,
}

/// The content of a file named at some place.
pub(crate) fn bytes_of(file: &str, origin: &Origin) -> Result<Vec<u8>, Unreadable> {
    let unreadable = |message: String, help: &str| Unreadable { message, help: help.to_owned() };
    let path = match library::beside(&origin.source, file) {
        Some(Beside::Shipped(bytes)) => return Ok(bytes.to_vec()),
        Some(Beside::OnDisk(path)) => path,
        None => {
            return Err(unreadable(
                format!("`{file}` cannot be reached from here"),
                "a shipped case is given with its mesh: write `extends` with its name, or \
                 `alewife mesh CASE --out FILE.msh`",
            ));
        }
    };
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
