//! `tracers/*.vtu` and `tracers.pvd`: the particles of `[[tracer]]`, for ParaView.

use std::fs;
use std::io;
use std::path::PathBuf;

use alewife_mesh::{Array, write_points_vtu};

use super::fields::{collection, origin_comment, precision_of, with_origin};
use crate::body::in_space;
use crate::case::Case;
use crate::observer::run_directory::{Frame, History, RunDirectory};
use crate::observer::schedule::Schedule;
use crate::observer::system::{AtPath, write_atomic};
use crate::run::{Observer, Snapshot};
use crate::tracer::{Cloud, Particle};

/// The folder of all files.
const FOLDER: &str = "tracers";
/// The list of all files.
const LIST: &str = "tracers.pvd";

/// The files written so far, each with the particles of all clouds, as often as the fields.
#[derive(Debug)]
pub struct TracerFiles {
    directory: PathBuf,
    /// The comment that names it.
    origin: String,
    schedule: Schedule,
    precision: alewife_mesh::Precision,
    frames: Vec<Frame>,
}

impl TracerFiles {
    /// Files in `directory`, after those of a run that resumes there; none are written without tracers.
    #[must_use]
    pub fn new(directory: &RunDirectory, case: &Case, history: Option<&History>) -> Self {
        Self {
            directory: directory.path().to_owned(),
            origin: origin_comment(directory),
            schedule: Schedule::new(case.output.fields, history.map(|history| history.time)),
            precision: precision_of(case.output.precision),
            frames: history.map(|history| history.tracer_frames.clone()).unwrap_or_default(),
        }
    }

    /// The content of a file.
    fn content<const D: usize>(&self, time: f64, clouds: &[Cloud<D>]) -> io::Result<Vec<u8>> {
        let all: Vec<(usize, &Particle<D>)> = clouds
            .iter()
            .enumerate()
            .flat_map(|(nth, cloud)| cloud.particles.iter().map(move |particle| (nth, particle)))
            .collect();
        let numbers = |of: &dyn Fn(&Particle<D>) -> f64| -> Vec<f64> {
            all.iter().map(|(_, particle)| of(particle)).collect()
        };
        let vectors = |of: &dyn Fn(&Particle<D>) -> alewife_mesh::Point<D>| -> Vec<f64> {
            all.iter().flat_map(|(_, one)| <[f64; 3]>::from(in_space(&of(one)))).collect()
        };
        let places = vectors(&|one| one.position + one.shift);
        let start = vectors(&|one| one.start);
        let position = vectors(&|one| one.position);
        let velocity = vectors(&|one| one.velocity);
        let cloud: Vec<f64> = all.iter().map(|(nth, _)| *nth as f64).collect();
        let seed = numbers(&|one| one.seed as f64);
        let released = numbers(&|one| one.released);
        let residence = numbers(&|one| one.residence);
        let left = numbers(&|one| if one.is_in_fluid() { 0.0 } else { 1.0 });
        let arrays = [
            Array::new("tracer", 1, &cloud),
            Array::new("seed", 1, &seed),
            Array::new("released", 1, &released),
            Array::new("start", 3, &start),
            Array::new("position", 3, &position),
            Array::new("velocity", 3, &velocity),
            Array::new("residence", 1, &residence),
            Array::new("left", 1, &left),
        ];
        let mut bytes = Vec::new();
        write_points_vtu(self.precision, &mut bytes, &places, time, &arrays)?;
        Ok(with_origin(bytes, &self.origin))
    }
}

impl<const D: usize> Observer<D> for TracerFiles {
    fn on_step(&mut self, snapshot: &Snapshot<'_, D>) -> io::Result<()> {
        let is_due = self.schedule.is_due(snapshot.step, snapshot.time, snapshot.is_last);
        if !is_due || snapshot.tracers.is_empty() {
            return Ok(());
        }
        let folder = self.directory.join(FOLDER);
        fs::create_dir_all(&folder).at(&folder)?;
        let name = format!("{FOLDER}/{:06}.vtu", snapshot.step);
        let bytes = self.content(snapshot.time, snapshot.tracers)?;
        write_atomic(&self.directory.join(&name), &bytes)?;
        self.frames.push(Frame { time: snapshot.time, file: name });
        let list = collection(&self.origin, &self.frames);
        write_atomic(&self.directory.join(LIST), list.as_bytes())
    }
}
