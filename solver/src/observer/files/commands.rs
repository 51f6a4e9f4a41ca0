//! `commands.csv`: what was asked for in a session, and where it paused.

use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::case::Recording;
use crate::observer::system::{AtPath, write_whole};
use crate::run::{Observer, Recorded, Snapshot};

/// Its name.
const COMMANDS_FILE: &str = "commands.csv";

/// The file, which is made with the first thing that is recorded.
#[derive(Debug)]
pub struct CommandsFile {
    path: PathBuf,
    file: Option<File>,
}

impl CommandsFile {
    /// `commands.csv` in `directory`; nothing is written yet.
    #[must_use]
    pub fn new(directory: &Path) -> Self {
        Self { path: directory.join(COMMANDS_FILE), file: None }
    }

    fn begin(&mut self, before: &Recording) -> io::Result<()> {
        write_whole(&self.path, before.to_csv().as_bytes())?;
        self.file = Some(File::options().append(true).open(&self.path).at(&self.path)?);
        Ok(())
    }

    fn add(&mut self, row: &str) -> io::Result<()> {
        match &mut self.file {
            Some(file) => file.write_all(row.as_bytes()).at(&self.path),
            None => Ok(()),
        }
    }
}

impl<const D: usize> Observer<D> for CommandsFile {
    fn on_step(&mut self, _snapshot: &Snapshot<'_, D>) -> io::Result<()> {
        Ok(())
    }

    fn on_recorded(&mut self, recorded: Recorded<'_>) -> io::Result<()> {
        match recorded {
            Recorded::Before(recording) => self.begin(recording),
            Recorded::Asked(asked) => self.add(&Recording::row(asked)),
            Recorded::Pause(time) => self.add(&Recording::pause(time)),
        }
    }
}
