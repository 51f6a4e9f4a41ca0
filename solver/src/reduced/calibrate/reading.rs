//! `Reader`: runs and records as a calibration names them.

use std::path::{Path, PathBuf};

use super::error::CalibrateError;
use super::file;
use super::record::{Law, Record, Track};
use super::search::directory_of;
use crate::case::{CalibrationSpec, Case, CaseFile, Model, RecordSpec, ReducedSpec, check_reduced};
use crate::reduced::build::Reduced;
use crate::run::Series;

/// Where what the command line sets is written.
const SETTING: &str = "--set";

/// All runs and records of a calibration.
pub fn records(
    file: &CaseFile,
    spec: &CalibrationSpec,
    reduced: &ReducedSpec,
) -> Result<Vec<Record>, CalibrateError> {
    let mut records = Vec::new();
    for (number, from) in spec.from.iter().enumerate() {
        let reader = Reader { file, spec, reduced, number, from };
        match (&from.run, &from.csv) {
            (Some(run), _) => {
                let written = written_in(file, &format!("calibration.from.{number}.run"));
                reader.runs(&directory_of(&written).join(run), run, &mut records)?;
            }
            (None, Some(csv)) => records.push(reader.rows(csv)?),
            (None, None) => return Err(reader.wrong("write one of `run` and `csv`".to_owned())),
        }
    }
    Ok(records)
}

/// The first CSV file of a calibration that cannot be read as the case says, or settings that make no case; runs may
/// still be to come.
pub fn check_records(file: &CaseFile) -> Option<CalibrateError> {
    let spec = file.case().calibration.as_ref()?;
    let reduced = &file.case().reduced_model();
    let of_file = |(number, from)| {
        let reader = Reader { file, spec, reduced, number, from };
        from.csv.as_ref().and_then(|csv| reader.rows(csv).err())
    };
    spec.from.iter().enumerate().find_map(of_file)
}

/// The file that a key is written in, which paths are relative to: that of the case which is extended, if it is there. What
/// the command line sets is as if the case had it.
pub(super) fn written_in(file: &CaseFile, key: &str) -> String {
    let written = file.location(key).map(|at| at.file).filter(|name| name != SETTING);
    written.unwrap_or_else(|| file.file.clone())
}

/// The case of a record, and its model with the law that is calibrated.
struct Of {
    read: CaseFile,
    model: Model,
}

/// What an entry of `from` is read with.
struct Reader<'a> {
    file: &'a CaseFile,
    spec: &'a CalibrationSpec,
    reduced: &'a ReducedSpec,
    number: usize,
    from: &'a RecordSpec,
}

impl Reader<'_> {
    /// What is wrong with the run or the file.
    fn wrong(&self, what: String) -> CalibrateError {
        self.wrong_at(if self.from.csv.is_some() { "csv" } else { "run" }, what)
    }

    /// What is wrong with a key.
    fn wrong_at(&self, key: &str, what: String) -> CalibrateError {
        CalibrateError::Record { number: self.number, key: key.to_owned(), what }
    }

    /// A run, or all runs in a directory, by name.
    fn runs(
        &self,
        path: &Path,
        name: &str,
        records: &mut Vec<Record>,
    ) -> Result<(), CalibrateError> {
        if path.join("series.csv").exists() {
            records.push(self.run(path, name)?);
            return Ok(());
        }
        let mut inside: Vec<PathBuf> = std::fs::read_dir(path)
            .map_err(|error| self.wrong(format!("{}: {error}", path.display())))?
            .flatten()
            .map(|entry| entry.path())
            .filter(|path| path.join("series.csv").exists())
            .collect();
        inside.sort();
        if inside.is_empty() {
            let what = format!(
                "{} is no run: it has no series.csv, nor directories that have",
                path.display()
            );
            return Err(self.wrong(what));
        }
        for path in inside {
            let own = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            records.push(self.run(&path, &format!("{name}/{own}"))?);
        }
        Ok(())
    }

    fn run(&self, path: &Path, name: &str) -> Result<Record, CalibrateError> {
        let case = path.join("case.toml");
        let read = Case::read(&case.to_string_lossy(), &[]).map_err(|error| {
            CalibrateError::Case { number: self.number, error: Box::new(error) }
        })?;
        let model = self.model(&read)?;
        let bytes = std::fs::read(path.join("series.csv"))
            .map_err(|error| self.wrong(format!("{}: {error}", path.display())))?;
        let series = file::series(&bytes).map_err(|what| self.wrong(format!("{name}: {what}")))?;
        let first = &model.bodies[0].name;
        let last = if model.case.geometry.dimensions() == 3 { "z" } else { "angle" };
        let wanted = if self.spec.tracks.is_empty() {
            ["x", "y", last].map(|axis| format!("{first}.{axis}")).to_vec()
        } else {
            self.spec.tracks.clone()
        };
        let mut tracks = Vec::new();
        for track in wanted {
            let values = series
                .column(&track)
                .ok_or_else(|| self.wrong(format!("{name} has no column {track}")))?;
            tracks.push(self.track(&model, track, values)?);
        }
        let times = series.times.clone();
        let of = Of { read, model };
        self.record([name, &file::hash(&bytes)], of, times, tracks, Some(series))
    }

    /// Rows of a CSV file.
    fn rows(&self, name: &str) -> Result<Record, CalibrateError> {
        let read = if self.from.set.is_empty() {
            self.file.clone()
        } else {
            let argument = match crate::case::library::find(&self.file.name) {
                Some(shipped) if shipped.file == self.file.file => self.file.name.clone(),
                _ => self.file.file.clone(),
            };
            Case::read(&argument, &self.from.set).map_err(|error| CalibrateError::Case {
                number: self.number,
                error: Box::new(error),
            })?
        };
        let model = self.model(&read)?;
        let key = format!("calibration.from.{}.csv", self.number);
        let bytes = self.file.bytes_beside(&key, name).map_err(|what| self.wrong(what))?;
        let table = file::table(&bytes).map_err(|what| self.wrong(format!("{name}: {what}")))?;
        let column = |key: &str, wanted: &String| {
            table.column(wanted).map_err(|what| self.wrong_at(key, format!("{name}: {what}")))
        };
        let times = match (&self.from.time, self.from.rate) {
            (Some(time), _) => column("time", time)?,
            (None, rate) => {
                let rate = rate.unwrap_or(1.0);
                (0..table.n_rows()).map(|row| row as f64 / rate).collect()
            }
        };
        let rises = times.windows(2).all(|pair| pair[1] > pair[0]);
        if !rises || times.first().is_none_or(|first| *first < 0.0) || times.len() < 3 {
            let row = times.windows(2).position(|pair| pair[1] <= pair[0]);
            let line =
                row.map_or_else(String::new, |row| format!(", and fall in line {}", row + 3));
            let what =
                format!("{name}: its times have to rise from 0 or later over 3 rows or more{line}");
            return Err(self.wrong(what));
        }
        let mut tracks = Vec::new();
        for (quantity, wanted) in &self.from.columns {
            let unit = self.from.units.get(quantity).copied().unwrap_or(1.0);
            let values = column(&format!("columns.{quantity}"), wanted)?
                .into_iter()
                .map(|value| value * unit)
                .collect();
            tracks.push(self.track(&model, quantity.clone(), values)?);
        }
        self.place(&mut tracks)?;
        let times = match self.from.start {
            Some(start) => times.iter().map(|time| start + time - times[0]).collect(),
            None => times,
        };
        self.record([name, &file::hash(&bytes)], Of { read, model }, times, tracks, None)
    }

    /// Puts planar tracks into the frame of the case.
    fn place(&self, tracks: &mut [Track]) -> Result<(), CalibrateError> {
        let Some(frame) = self.from.frame else { return Ok(()) };
        let (sine, cosine) = frame.angle.sin_cos();
        for k in 0..tracks.len() {
            match tracks[k].axis {
                0 => {
                    let body = tracks[k].body;
                    let beside = tracks.iter().position(|one| one.body == body && one.axis == 1);
                    let Some(y) = beside else {
                        let what = format!("{} has a frame, and no y beside it", tracks[k].name);
                        return Err(self.wrong_at("frame", what));
                    };
                    for row in 0..tracks[k].values.len() {
                        let at = [tracks[k].values[row], tracks[y].values[row]];
                        let [x0, y0] = frame.origin;
                        tracks[k].values[row] = x0 + cosine * at[0] - sine * at[1];
                        tracks[y].values[row] = y0 + sine * at[0] + cosine * at[1];
                    }
                }
                1 => {
                    let body = tracks[k].body;
                    if !tracks.iter().any(|one| one.body == body && one.axis == 0) {
                        let what = format!("{} has a frame, and no x beside it", tracks[k].name);
                        return Err(self.wrong_at("frame", what));
                    }
                }
                _ => tracks[k].values.iter_mut().for_each(|angle| *angle += frame.angle),
            }
        }
        Ok(())
    }

    fn track(
        &self,
        model: &Model,
        name: String,
        values: Vec<f64>,
    ) -> Result<Track, CalibrateError> {
        let (owner, what) = name.rsplit_once('.').unwrap_or_default();
        let axis = ["x", "y", "z", "angle"].iter().position(|axis| *axis == what);
        let (Some(body), Some(axis)) = (model.body_index(owner), axis) else {
            return Err(self.wrong(format!("{name} is no way or angle of a body")));
        };
        Ok(Track { name, body, axis, values })
    }

    /// A record may have its own of what moves the swimmer, as its `set` says, and takes the law that is calibrated.
    fn law(&self) -> Law {
        Law { reduced: self.reduced.clone(), keeps_own: self.from.csv.is_some() }
    }

    /// The model of a run with the law that is calibrated, if it is of the same swimmer.
    fn model(&self, read: &CaseFile) -> Result<Model, CalibrateError> {
        let mut model = read.model.clone();
        let names = |model: &Model| -> Vec<String> {
            model.bodies.iter().map(|body| body.name.clone()).collect()
        };
        let (ours, theirs) = (names(&self.file.model), names(&model));
        if ours != theirs || model.case.geometry != self.file.case().geometry {
            let what = format!(
                "it is a run of another swimmer: its bodies are {}, and those of the case {}",
                theirs.join(", "),
                ours.join(", ")
            );
            return Err(self.wrong(what));
        }
        self.law().put_into(&mut model);
        let mut changed = read.clone();
        changed.model = model;
        let unknown = check_reduced(&changed);
        if let Some(first) = unknown.first() {
            return Err(self.wrong(format!("{}: {}", first.key, first.message)));
        }
        Ok(changed.model)
    }

    fn record(
        &self,
        [name, hash]: [&str; 2],
        of: Of,
        times: Vec<f64>,
        mut tracks: Vec<Track>,
        series: Option<Series>,
    ) -> Result<Record, CalibrateError> {
        let Of { read, model } = of;
        let reduced = Reduced::new(&model)?;
        let is_relative = self.from.start.is_some();
        for track in tracks.iter_mut().filter(|_| is_relative) {
            let first = track.values[0];
            track.values.iter_mut().for_each(|value| *value -= first);
        }
        Ok(Record {
            name: name.to_owned(),
            hash: hash.to_owned(),
            is_held_out: self.from.holdout,
            read,
            law: self.law(),
            model,
            reduced,
            times,
            tracks,
            is_relative,
            series,
        })
    }
}
