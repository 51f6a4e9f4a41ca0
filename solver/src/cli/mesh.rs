//! `mesh`: the mesh of a case as a file, and how good it is.

use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use alewife_mesh::write_vtu;

use super::engine;
use super::exit::{Exit, Failure};
use super::read::read_case;
use super::style::say;
use crate::case::Model;
use crate::simulation::{Dimension, Solve};

/// Makes the mesh of a case, writes it as VTU, and reports its quality.
pub fn mesh(argument: &str, settings: &[String], out: Option<PathBuf>) -> Result<Exit, Failure> {
    let file = read_case(argument, settings)?;
    let path =
        out.unwrap_or_else(|| PathBuf::from(format!("{}.vtu", file.full_name().replace('/', "-"))));
    match file.case().geometry.dimensions() {
        2 => write::<2>(&file.model, &path),
        _ => write::<3>(&file.model, &path),
    }
}

fn write<const D: usize>(model: &Model, path: &Path) -> Result<Exit, Failure>
where
    Dimension<D>: Solve<D>,
{
    let mesh = engine::build_mesh::<D>(model)?;
    let failed = |error: std::io::Error| {
        Failure::new(Exit::InputOutput, format!("cannot write {}: {error}", path.display()))
    };
    let writer = BufWriter::new(File::create(path).map_err(failed)?);
    write_vtu(writer, &mesh, None, &[], &[]).map_err(failed)?;
    say(Dimension::<D>::quality(&mesh).to_string().trim_end());
    say(&format!("written to {}", path.display()));
    Ok(Exit::Done)
}
