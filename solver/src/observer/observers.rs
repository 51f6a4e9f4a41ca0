//! `observers`: all who see a run, in the order in which they are notified.

use super::console::Progress;
use super::files::{CheckpointFiles, CommandsFile, FieldFiles, SeriesFile, TracerFiles};
use super::live::LiveServer;
use super::message_file::MessageFile;
use super::run_directory::{History, LegFile, RunDirectory, StatusFile, WriteTimes, write_bodies};
use crate::case::Model;
use crate::run::{Dimension, Observer, Solve};

/// What is shown of a run while it is under way.
#[derive(Debug, Default)]
pub struct Shown {
    /// Whether there is no progress on the terminal.
    pub quiet: bool,
    /// Whom viewers connect to.
    pub live: Option<LiveServer>,
}

/// All observers of a run in `directory`, which continues after a `history` if there is one. What states take to write is reported in `times`.
///
/// Make them before the mesh is generated: `status.json` shows the run from then on, and they are
/// notified if the simulation cannot be built.
///
/// # Errors
/// When a file cannot be made.
pub fn observers<const D: usize>(
    model: &Model,
    directory: &RunDirectory,
    history: Option<&History>,
    shown: Shown,
    times: &WriteTimes,
) -> std::io::Result<Vec<Box<dyn Observer<D>>>>
where
    Dimension<D>: Solve<D>,
{
    let case = &model.case;
    write_bodies(directory.path(), model)?;
    let checkpoints = CheckpointFiles::create(directory.path(), case, history, times.clone())?;
    let mut everyone: Vec<Box<dyn Observer<D>>> = vec![
        Box::new(SeriesFile::create(directory.path(), case, history)?),
        Box::new(MessageFile::create(directory, model, history, shown.live)?),
        Box::new(FieldFiles::new(directory, case, history)),
        Box::new(TracerFiles::new(directory, case, history)),
        Box::new(CommandsFile::new(directory.path())),
        // After those whose rows and messages belong to a state
        Box::new(checkpoints),
        Box::new(LegFile::new(directory, history)),
    ];
    if !shown.quiet {
        everyone.push(Box::new(Progress::new(model)));
    }
    // The status comes last: when it says `finished`, all other files are complete.
    everyone.push(Box::new(StatusFile::create(directory.path(), case, history, times.clone())?));
    Ok(everyone)
}
