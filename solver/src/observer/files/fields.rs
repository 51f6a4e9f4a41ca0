//! `fields/*.vtu` and `fields.pvd`: velocity, pressure and vorticity on the mesh, for ParaView.
//!
//! All three are given at the P2 nodes of quadratic triangles or tetrahedra.

use std::fmt::Write as _;
use std::fs;
use std::io;
use std::path::PathBuf;

use alewife_mesh::{Array, Mesh, Point, write_vtu_as};

use super::state_file::write_state;
use crate::body::in_space;
use crate::case::{Case, Precision};
use crate::observer::run_directory::{
    FAILURE_FLOW, FAILURE_FOLDER, FAILURE_STATE, Frame, History, RunDirectory,
};
use crate::observer::schedule::Schedule;
use crate::observer::system::{AtPath, remove_if_there, write_atomic};
use crate::run::{Dimension, LastState, Observer, RunError, Snapshot, Solve};
use crate::scalar::ScalarField;
use crate::step::FlowError;
use crate::timing::Timing;

/// The flow of a run that was stopped, which is removed once the run has continued.
const STOPPED: &str = "fields/stopped.vtu";
/// The list of all frames.
const LIST: &str = "fields.pvd";

/// The files written so far.
#[derive(Debug)]
pub struct FieldFiles {
    directory: PathBuf,
    /// The comment that names it.
    origin: String,
    schedule: Schedule,
    precision: alewife_mesh::Precision,
    /// Names of the scalars.
    scalars: Vec<String>,
    frames: Vec<Frame>,
    /// Whether there is a flow at which the run was stopped before.
    has_stopped: bool,
}

impl FieldFiles {
    /// Field files in `directory`, after those of a run that resumes there; none are written before
    /// the first step that is due.
    #[must_use]
    pub fn new(directory: &RunDirectory, case: &Case, history: Option<&History>) -> Self {
        Self {
            directory: directory.path().to_owned(),
            origin: origin_comment(directory),
            schedule: Schedule::new(case.output.fields, history.map(|history| history.time)),
            precision: precision_of(case.output.precision),
            scalars: case.scalar.iter().map(|scalar| scalar.name.clone()).collect(),
            frames: history.map(|history| history.frames.clone()).unwrap_or_default(),
            has_stopped: directory.path().join(STOPPED).is_file(),
        }
    }

    /// A folder of the run, made if it is not there.
    fn create_folder(&self, name: &str) -> io::Result<PathBuf> {
        let folder = self.directory.join(name);
        fs::create_dir_all(&folder).at(&folder)?;
        Ok(folder)
    }

    /// The content of one field file.
    fn frame<const D: usize>(
        &self,
        time: f64,
        mesh: &Mesh<D>,
        velocity: &[Point<D>],
        pressure: &[f64],
        scalars: &[ScalarField],
    ) -> io::Result<Vec<u8>>
    where
        Dimension<D>: Solve<D>,
    {
        let named = self.scalars.iter().zip(scalars);
        let scalars: Vec<Array<'_>> =
            named.map(|(name, field)| Array::new(name, 1, &field.now)).collect();
        let bytes = content(self.precision, time, mesh, velocity, pressure, &scalars)?;
        Ok(with_origin(bytes, &self.origin))
    }

    /// Writes the list. It names a file only once it is there, and is itself replaced as a whole: a list without
    /// its last line cannot be read at all.
    fn write_list(&mut self) -> io::Result<()> {
        write_atomic(&self.directory.join(LIST), self.collection().as_bytes())?;
        if std::mem::take(&mut self.has_stopped) {
            remove_if_there(&self.directory.join(STOPPED))?;
        }
        Ok(())
    }

    /// The list of all frames.
    fn collection(&self) -> String {
        collection(&self.origin, &self.frames)
    }
}

/// A list of files, as ParaView wants it, with a comment that names its origin.
pub(super) fn collection(origin: &str, frames: &[Frame]) -> String {
    let mut text = String::from("<?xml version=\"1.0\"?>\n");
    text += origin;
    text +=
        "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n";
    for Frame { time, file } in frames {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "<DataSet timestep=\"{time:?}\" part=\"0\" file=\"{file}\"/>");
    }
    text + "</Collection>\n</VTKFile>\n"
}

/// A comment that names the origin of a file of a run.
pub(super) fn origin_comment(directory: &RunDirectory) -> String {
    // Two hyphens would end a comment
    let origin = directory.provenance().origin.line().replace("--", "- -");
    format!("<!-- {origin} -->\n")
}

/// A file of VTK with a comment that names its origin.
pub(super) fn with_origin(mut bytes: Vec<u8>, origin: &str) -> Vec<u8> {
    // After the first line, which says that this is XML
    let first = bytes.iter().position(|&byte| byte == b'\n').map_or(0, |end| end + 1);
    bytes.splice(first..first, origin.bytes());
    bytes
}

pub(super) fn precision_of(precision: Precision) -> alewife_mesh::Precision {
    match precision {
        Precision::F32 => alewife_mesh::Precision::F32,
        Precision::F64 => alewife_mesh::Precision::F64,
    }
}

/// The size of a file with a flow (bytes).
///
/// # Errors
/// When it cannot be encoded.
pub fn field_file_size<const D: usize>(
    precision: Precision,
    mesh: &Mesh<D>,
    velocity: &[Point<D>],
    pressure: &[f64],
) -> io::Result<usize>
where
    Dimension<D>: Solve<D>,
{
    Ok(content(precision_of(precision), 0.0, mesh, velocity, pressure, &[])?.len())
}

/// The content of one field file, without the comment that names its origin.
fn content<const D: usize>(
    precision: alewife_mesh::Precision,
    time: f64,
    mesh: &Mesh<D>,
    velocity: &[Point<D>],
    pressure: &[f64],
    scalars: &[Array<'_>],
) -> io::Result<Vec<u8>>
where
    Dimension<D>: Solve<D>,
{
    // In the plane it has one part, about z
    let parts = if D == 2 { 2..3 } else { 0..3 };
    let vorticity: Vec<f64> = Dimension::<D>::vorticity(mesh, velocity)
        .iter()
        .flat_map(|curl| curl.as_slice()[parts.clone()].to_vec())
        .collect();
    let velocity: Vec<f64> = velocity.iter().flat_map(|u| <[f64; 3]>::from(in_space(u))).collect();
    let pressure = Dimension::<D>::pressure(mesh, pressure);
    let mut arrays = vec![
        Array::new("velocity", 3, &velocity),
        Array::new("pressure", 1, &pressure),
        Array::new("vorticity", parts.len(), &vorticity),
    ];
    arrays.extend_from_slice(scalars);
    let mut bytes = Vec::new();
    write_vtu_as(precision, &mut bytes, mesh, Some(time), &arrays, &[])?;
    Ok(bytes)
}

impl<const D: usize> Observer<D> for FieldFiles
where
    Dimension<D>: Solve<D>,
{
    fn on_step(&mut self, snapshot: &Snapshot<'_, D>) -> io::Result<()> {
        if !self.schedule.is_due(snapshot.step, snapshot.time, snapshot.is_last) {
            return Ok(());
        }
        if self.frames.is_empty() {
            self.create_folder("fields")?;
        }
        let bytes = self.frame(
            snapshot.time,
            snapshot.mesh,
            snapshot.velocity,
            snapshot.pressure,
            snapshot.scalars,
        )?;
        let name = format!("fields/{:06}.vtu", snapshot.step);
        write_atomic(&self.directory.join(&name), &bytes)?;
        self.frames.push(Frame { time: snapshot.time, file: name });
        self.write_list()
    }

    fn on_end(&mut self, _timing: &Timing) -> io::Result<()> {
        // Where no frame has come since
        if !self.has_stopped {
            return Ok(());
        }
        self.write_list()?;
        match self.frames.is_empty() {
            true => remove_if_there(&self.directory.join(LIST)),
            false => Ok(()),
        }
    }

    fn on_failure(&mut self, error: &RunError, last: Option<&LastState<'_, D>>) -> io::Result<()> {
        let Some(last) = last else { return Ok(()) };
        // Nothing is wrong with the flow, and where a file could not be written this would not help
        if matches!(error, RunError::Output(_)) {
            return Ok(());
        }
        let is_stopped = matches!(error, RunError::Flow(FlowError::Stopped { .. }));
        // There is no flow yet
        if is_stopped && last.saved.is_none() {
            return Ok(());
        }
        let bytes = self.frame(last.time, last.mesh, last.velocity, last.pressure, last.scalars)?;
        if is_stopped {
            let name = STOPPED.to_owned();
            self.create_folder("fields")?;
            write_atomic(&self.directory.join(&name), &bytes)?;
            self.frames.push(Frame { time: last.time, file: name });
            self.has_stopped = false;
            return self.write_list();
        }
        let folder = self.create_folder(FAILURE_FOLDER)?;
        if let Some(state) = last.saved {
            write_state(&folder.join(FAILURE_STATE), state)?;
        }
        write_atomic(&folder.join(FAILURE_FLOW), &bytes)
    }
}
