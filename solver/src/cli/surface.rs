//! `surface`: what a file of triangles encloses, whether it can be a body, and small repairs.

use std::path::{Path, PathBuf};

use alewife_mesh::spatial::{Repaired, Repairs, TriangleMesh, Triangulated};
use clap::{Args, ValueHint};

use super::exit::{Exit, Failure};
use super::style::say;
use crate::case::significant;
use crate::observer::write_atomic;

/// Largest file that is read (bytes).
const LARGEST_FILE: u64 = 1_000_000_000;

/// What `surface` is asked for.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  alewife surface fish.stl
  alewife surface fish.stl --repair whole.stl
  alewife surface fish.stl --smooth 180")]
pub struct Options {
    /// File of triangles: STL as text or binary, OBJ or PLY
    #[arg(value_hint = ValueHint::FilePath)]
    file: PathBuf,
    /// Weld vertices that are close to each other, drop triangles without area, turn all outwards, and write
    /// the result as binary STL
    #[arg(long, value_name = "OUT.stl", value_hint = ValueHint::FilePath)]
    repair: Option<PathBuf>,
    /// Largest angle at an edge that is taken as smooth (degrees), as `smooth` of a case
    #[arg(long, value_name = "DEGREES", default_value_t = 45.0)]
    smooth: f64,
}

/// Reports what a file of triangles is, and repairs it.
///
/// # Errors
/// Where it is no file of triangles, or encloses no solid: with the place of the fault.
pub fn surface(options: &Options) -> Result<Exit, Failure> {
    let mut mesh = read(&options.file)?;
    if let Some(out) = &options.repair {
        let is_stl = out.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("stl"));
        if !is_stl {
            let reason = "--repair: let the name of the file to be written end in .stl";
            return Err(Failure::new(Exit::Usage, reason));
        }
        let Repaired { mesh: mended, repairs } = mesh.repaired();
        let Repairs { welded, dropped, turned } = repairs;
        write_atomic(out, &mended.to_stl())?;
        say(&format!(
            "{}: {welded} vertices welded, {dropped} triangles dropped, {turned} turned",
            out.display()
        ));
        // What is left of it in single precision
        mesh = read(out)?;
    }
    report(&mesh);
    match Triangulated::new(&mesh, options.smooth, None) {
        Ok(solid) => {
            let moments = solid.moments();
            say(&format!(
                "as a body    one closed surface, smooth: volume {}, area {}, centroid {}",
                significant(moments.volume),
                significant(solid.area()),
                place(moments.centroid.as_slice())
            ));
            Ok(Exit::Done)
        }
        Err(fault) => {
            let file = options.repair.as_ref().unwrap_or(&options.file).display();
            let help = fault.remedy();
            Err(Failure::new(Exit::BadCase, format!("{file}: {fault}\n  help: {help}")))
        }
    }
}

fn read(path: &Path) -> Result<TriangleMesh, Failure> {
    let named =
        |error: std::io::Error| Failure::new(Exit::NoInput, format!("{}: {error}", path.display()));
    // Asked before it is opened: opening a pipe waits for somebody to write into it
    let found = std::fs::metadata(path).map_err(named)?;
    if !found.is_file() || found.len() > LARGEST_FILE {
        let reason = format!("{} is no file of up to 1 GB", path.display());
        return Err(Failure::new(Exit::NoInput, reason));
    }
    let bytes = std::fs::read(path).map_err(named)?;
    TriangleMesh::read(&bytes).map_err(|fault| {
        let (file, help) = (path.display(), fault.remedy());
        Failure::new(Exit::BadCase, format!("{file}: {fault}\n  help: {help}"))
    })
}

fn report(mesh: &TriangleMesh) {
    let (measures, moments, bounds) = (mesh.measures(), mesh.moments(), mesh.bounds());
    let [shortest, longest] = measures.edges.map(significant);
    let (angle, at) = measures.sharpest;
    let inertia = moments.inertia.row_iter();
    let rows: Vec<String> = inertia.map(|row| place(&[row[0], row[1], row[2]])).collect();
    let closed = if measures.n_open == 0 {
        "none open".to_owned()
    } else {
        format!("{} open", measures.n_open)
    };
    for line in [
        format!("triangles    {}, vertices {}", mesh.triangles.len(), mesh.vertices.len()),
        format!(
            "extent       {} to {}",
            place(bounds.min.as_slice()),
            place(bounds.max.as_slice())
        ),
        format!("edges        {shortest} to {longest}, {closed}; shells {}", measures.n_shells),
        format!("sharpest     {:.1} degrees at {}", angle.to_degrees(), place(at.as_slice())),
        format!("area         {}", significant(measures.area)),
        format!("volume       {}", significant(moments.volume)),
        format!("centroid     {}", place(moments.centroid.as_slice())),
        format!("inertia      {} about the centroid, at density 1", rows.join(" ")),
    ] {
        say(&line);
    }
}

/// Numbers in brackets.
fn place(numbers: &[f64]) -> String {
    let words: Vec<String> = numbers.iter().map(|number| significant(*number)).collect();
    format!("({})", words.join(", "))
}
