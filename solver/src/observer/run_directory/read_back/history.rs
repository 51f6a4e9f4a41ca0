//! `History`: what a run wrote before it stopped, for the run that resumes it to continue.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::series_rows::read_series;
use crate::case::Cadence;
use crate::observer::run_directory::restarts::Restarts;
use crate::observer::system::AtPath;
use crate::run::Series;

/// One field file.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Time (s).
    pub time: f64,
    /// Its name relative to the run directory.
    pub file: String,
}

/// What the files of a run hold up to the time of its last state.
#[derive(Debug, Clone, Default)]
pub struct History {
    /// Steps made up to the state.
    pub step: usize,
    /// Time of the state (s).
    pub time: f64,
    /// The rows of `series.csv`.
    pub series: Series,
    /// The files in `fields/`; none of them if the run continues in another directory.
    pub frames: Vec<Frame>,
    /// The files in `tracers/`, likewise.
    pub tracer_frames: Vec<Frame>,
    /// The directory it wrote to.
    pub directory: PathBuf,
    /// Restarts at the step of the state so far, this one included.
    pub restarts: Restarts,
    /// The longest time a state took to write so far (s), if that is known.
    pub longest_checkpoint: Option<f64>,
}

impl History {
    /// What the run in `directory` wrote up to a step and its time (s).
    ///
    /// # Errors
    /// When its files cannot be read, or are damaged.
    pub fn read(directory: &Path, step: usize, time: f64) -> io::Result<Self> {
        let mut series = match read_series(directory) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Series::default(),
            read => read?,
        };
        let n_rows = series.times.partition_point(|&then| then <= time);
        series.times.truncate(n_rows);
        series.rows.truncate(n_rows);
        let is_kept = |frame: &Frame| {
            let is_step = !frame.file.ends_with("stopped.vtu");
            frame.time <= time && is_step && directory.join(&frame.file).is_file()
        };
        let frames = frames(directory)?.into_iter().filter(is_kept).collect();
        let tracer_frames = listed(directory, "tracers.pvd")?;
        let tracer_frames = tracer_frames.into_iter().filter(is_kept).collect();
        let directory = directory.to_owned();
        Ok(Self {
            step,
            time,
            series,
            frames,
            tracer_frames,
            directory,
            restarts: Restarts::default(),
            longest_checkpoint: None,
        })
    }

    /// Takes rows that `series.csv` has lost from those of the state, which has all steps.
    pub fn complete(&mut self, all: &Series, cadence: Cadence) {
        let written = &self.series;
        let is_same = written.names.is_empty() || written.names == all.names;
        let has_lost = match cadence {
            Cadence::Steps(1) => written.times != all.times,
            // Whatever the cadence is, the start is written
            Cadence::Steps(_) | Cadence::Time(_) => written.times.first() != all.times.first(),
            Cadence::Never | Cadence::End => false,
        };
        if is_same && has_lost {
            tracing::warn!(
                "series.csv has {} rows up to the checkpoint, which has {}: all of these are written",
                written.times.len(),
                all.times.len()
            );
            self.series = all.clone();
        }
    }
}

/// The field files that the list of the run in a directory names; none where there is no list.
///
/// # Errors
/// When it cannot be read.
pub fn frames(directory: &Path) -> io::Result<Vec<Frame>> {
    listed(directory, "fields.pvd")
}

/// The files that a list in a directory names; none where there is no list.
fn listed(directory: &Path, list: &str) -> io::Result<Vec<Frame>> {
    Ok(read_text(&directory.join(list))?.lines().filter_map(frame).collect())
}

/// The text of a file, empty if there is none.
fn read_text(path: &Path) -> io::Result<String> {
    match fs::read(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(String::new()),
        read => Ok(String::from_utf8_lossy(&read.at(path)?).into_owned()),
    }
}

/// The field file of a line of `fields.pvd`.
fn frame(line: &str) -> Option<Frame> {
    let value = |key: &str| line.split_once(&format!("{key}=\""))?.1.split('"').next();
    Some(Frame { time: value("timestep")?.parse().ok()?, file: value("file")?.to_owned() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_that_are_lost_are_those_of_the_state() {
        let series = |times: &[f64]| Series {
            names: vec!["a".to_owned()],
            times: times.to_vec(),
            rows: times.iter().map(|time| vec![10.0 * time]).collect(),
        };
        let all = series(&[0.0, 0.1, 0.2]);
        let completed = |written: Series, cadence| {
            let mut history = History { series: written, ..History::default() };
            history.complete(&all, cadence);
            history.series
        };
        assert_eq!(completed(series(&[0.2]), Cadence::Steps(1)), all);
        assert_eq!(completed(Series::default(), Cadence::Steps(1)), all);
        assert_eq!(completed(Series::default(), Cadence::Time(0.1)), all);
        // Those of a cadence are not lost, and other quantities stay
        let every_other = series(&[0.0, 0.2]);
        assert_eq!(completed(every_other.clone(), Cadence::Steps(2)), every_other);
        let other = Series { names: vec!["b".to_owned()], ..every_other };
        assert_eq!(completed(other.clone(), Cadence::Steps(1)), other);
        assert_eq!(completed(Series::default(), Cadence::Never), Series::default());
    }

    #[test]
    fn what_was_written_after_the_state_is_left_out() {
        let place = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| fs::write(place.path().join(name), text).unwrap();
        write("series.csv", "time,a\n0.0,1.0\n0.1,2.0\n0.2,3.0\n0.3,4.");
        fs::create_dir(place.path().join("fields")).unwrap();
        write("fields/000000.vtu", "");
        write("fields/000002.vtu", "");
        let line = |time: &str, file: &str| {
            format!("<DataSet timestep=\"{time}\" part=\"0\" file=\"fields/{file}.vtu\"/>\n")
        };
        let lines = [("0.0", "000000"), ("0.1", "000001"), ("0.1", "stopped"), ("0.2", "000002")];
        write("fields.pvd", &lines.map(|(time, file)| line(time, file)).concat());
        let history = History::read(place.path(), 1, 0.1).unwrap();
        assert_eq!(history.series.times, [0.0, 0.1]);
        assert_eq!(history.series.rows, [[1.0], [2.0]]);
        assert_eq!(history.frames, [Frame { time: 0.0, file: "fields/000000.vtu".to_owned() }]);
        write("series.csv", "time,a\n0.0,1.0,2.0\n");
        let reported = History::read(place.path(), 1, 0.1).unwrap_err().to_string();
        assert!(reported.contains("series.csv: line 2 is damaged"), "{reported}");
    }
}
