//! Cases in meshes of files.

use alewife_core::case::{Case, CaseFile, Model};
use alewife_core::run::{CaseMesh, Dimension, build_mesh};
use alewife_mesh::{Encoding, Mesh, write_msh};

/// What is read of a text with a mesh in a file as its domain, or why it is refused; `name` is not used at the same time.
///
/// # Errors
/// What reading refuses.
///
/// # Panics
/// When there is no room for files.
pub fn in_mesh<const D: usize>(name: &str, mesh: &Mesh<D>, text: &str) -> Result<CaseFile, String> {
    let mut bytes = Vec::new();
    write_msh(&mut bytes, mesh, Encoding::Binary).expect("memory takes everything");
    let folder = std::env::temp_dir().join(format!("alewife-{name}-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("there is room for files");
    std::fs::write(folder.join("a.msh"), &bytes).expect("it is written");
    let mesh = format!("domain.mesh.file={}", folder.join("a.msh").display());
    let file = Case::parse("t.toml", text, &[mesh]);
    std::fs::remove_dir_all(&folder).expect("it is ours");
    file.map_err(|error| error.to_string())
}

/// The case of a text in the mesh of another case.
///
/// # Panics
/// When that is not meshed, or the text is refused.
#[must_use]
pub fn in_mesh_of<const D: usize>(name: &str, own: &Model, text: &str) -> Model
where
    Dimension<D>: CaseMesh<D>,
{
    let mesh = build_mesh::<D>(own).expect("it is meshed");
    in_mesh(name, &mesh, text).unwrap_or_else(|error| panic!("{error}")).model
}
