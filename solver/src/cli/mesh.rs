//! `mesh`: the mesh of a case as a file, and how good it is.

use std::path::PathBuf;

use alewife_mesh::{Encoding, Mesh, write_msh, write_vtu};
use alewife_reduced::tier::{Model, rest_mesh};

use super::exit::{Exit, Failure};
use super::read::read_case;
use super::style::say;
use crate::case::CaseFile;
use crate::case::soft::SoftFile;
use crate::observer::write_atomic;
use crate::run::{Dimension, Solve, build_mesh};
use crate::runner::with_key;

/// Where a mesh is written, and how.
#[derive(Debug)]
pub struct Target {
    /// The file; `<case>.vtu` here if absent.
    pub out: Option<PathBuf>,
    /// Whether a file of Gmsh has its numbers as text.
    pub as_text: bool,
}

/// Makes the mesh of a case, writes it as VTU, or as MSH where the name of the file ends so, and reports
/// its quality.
pub fn mesh(argument: &str, settings: &[String], target: Target) -> Result<Exit, Failure> {
    if let Some(file) = SoftFile::read_if_soft(argument, settings)? {
        let place = target.place(&file.directory_name())?;
        return match file.case.geometry.dimensions() {
            2 => write::<2>(&rest_mesh(&Model::new(&file)?), &place),
            _ => write::<3>(&rest_mesh(&Model::new(&file)?), &place),
        };
    }
    let file = read_case(argument, settings)?;
    let place = target.place(&file.directory_name())?;
    match file.case().geometry.dimensions() {
        2 => write::<2>(&of_flow_domain(&file)?, &place),
        _ => write::<3>(&of_flow_domain(&file)?, &place),
    }
}

/// Where a mesh is written.
struct Place {
    path: PathBuf,
    /// As a file of Gmsh, or else for ParaView.
    encoding: Option<Encoding>,
}

impl Target {
    /// Where the mesh of a case with this name is written.
    fn place(self, name: &str) -> Result<Place, Failure> {
        let path = self.out.unwrap_or_else(|| PathBuf::from(format!("{name}.vtu")));
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        let is_file = !std::fs::metadata(&path).is_ok_and(|found| !found.is_file());
        let ending = ending.as_deref();
        if let Some(ending) = ending.filter(|ending| is_file && !["vtu", "msh"].contains(ending)) {
            let reason = format!(
                "--out: no mesh is written as .{ending}; let the name end in .vtu (ParaView) or .msh (Gmsh)"
            );
            return Err(Failure::new(Exit::Usage, reason));
        }
        let encoding = match (ending == Some("msh"), self.as_text) {
            (false, false) => None,
            (true, false) => Some(Encoding::Binary),
            (true, true) => Some(Encoding::Text),
            (false, true) => {
                let reason = "--text is for files of Gmsh: let the name given to --out end in .msh";
                return Err(Failure::new(Exit::Usage, reason));
            }
        };
        Ok(Place { path, encoding })
    }
}

/// The mesh of the fluid.
fn of_flow_domain<const D: usize>(file: &CaseFile) -> Result<Mesh<D>, Failure>
where
    Dimension<D>: Solve<D>,
{
    build_mesh::<D>(&file.model).map_err(|error| with_key(file, error))
}

fn write<const D: usize>(mesh: &Mesh<D>, place: &Place) -> Result<Exit, Failure>
where
    Dimension<D>: Solve<D>,
{
    let Place { path, encoding } = place;
    let failed = |error: std::io::Error| {
        Failure::new(Exit::InputOutput, format!("cannot write {}: {error}", path.display()))
    };
    let mut bytes = Vec::new();
    match encoding {
        Some(encoding) => write_msh(&mut bytes, mesh, *encoding),
        None => write_vtu(&mut bytes, mesh, None, &[], &[]),
    }
    .map_err(failed)?;
    // A pipe or a device is written to, not replaced
    let is_special = std::fs::metadata(path).is_ok_and(|found| !found.is_file());
    if is_special { std::fs::write(path, &bytes) } else { write_atomic(path, &bytes) }
        .map_err(failed)?;
    say(Dimension::<D>::quality(mesh).to_string().trim_end());
    say(&format!("written to {}", path.display()));
    Ok(Exit::Done)
}
