//! `Written`: series and fields of a motion, compiled here and not where they are called.

use std::io;
use std::path::Path;

use super::fields::write_fields;
use super::mesh::Bodies;
use super::model::Model;
use super::series::{Series, series};
use crate::soft::{SoftError, Trajectory};

/// What a run writes of a motion in this many dimensions.
///
/// As [`SolidOf`](super::SolidOf) it is no function of any dimension: of a plate of 1125 nodes over 300 frames the
/// program, which is optimised for a short build, would spend four times as long on it as on the motion.
pub trait Written<const D: usize> {
    /// The series of a motion, as [`series`] has it.
    ///
    /// # Errors
    /// Those of [`series`].
    fn series(model: &Model<D>, motion: &Trajectory) -> Result<Series, SoftError>;

    /// Writes the fields of a motion, as [`write_fields`] does.
    ///
    /// # Errors
    /// What the file system reports.
    fn write_fields(directory: &Path, model: &Model<D>, motion: &Trajectory) -> io::Result<()>;
}

impl Written<2> for Bodies {
    fn series(model: &Model<2>, motion: &Trajectory) -> Result<Series, SoftError> {
        series(model, motion)
    }

    fn write_fields(directory: &Path, model: &Model<2>, motion: &Trajectory) -> io::Result<()> {
        write_fields(directory, model, motion)
    }
}

impl Written<3> for Bodies {
    fn series(model: &Model<3>, motion: &Trajectory) -> Result<Series, SoftError> {
        series(model, motion)
    }

    fn write_fields(directory: &Path, model: &Model<3>, motion: &Trajectory) -> io::Result<()> {
        write_fields(directory, model, motion)
    }
}
