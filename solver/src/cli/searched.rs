//! `SearchDirectory`: what a search has left in its directory, whichever command made it.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use alewife_reduced::search::Journalled;

use crate::observer::RunLock;

/// Which command a search is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// `optimise`.
    Optimisation,
    /// `calibrate`.
    Calibration,
    /// `loop`.
    Loop,
}

impl Kind {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Optimisation => "optimisation",
            Self::Calibration => "calibration",
            Self::Loop => "loop",
        }
    }
}

/// Files that end a search, with what they are of where they alone say it.
const LAST: [(&str, Option<Kind>); 3] = [
    ("report.json", None),
    ("calibrated.toml", Some(Kind::Calibration)),
    ("rounds.csv", Some(Kind::Loop)),
];

/// A journal of a search, by its name.
#[derive(Debug)]
pub struct Named {
    pub file: String,
    pub journal: Journalled,
}

/// What a search has left.
#[derive(Debug)]
pub struct SearchDirectory {
    pub path: PathBuf,
    pub kind: Kind,
    /// The file that ended it, if it came to its end.
    pub last: Option<&'static str>,
    /// Whether a process writes to it.
    pub is_held: bool,
    /// Its journals, in the order in which they were begun.
    pub journals: Vec<Named>,
}

impl Named {
    /// The checksum of the case that is searched, where the journal begins with it.
    pub fn checksum(&self) -> Option<&str> {
        let (_, rest) = self.journal.search.split_once(" of ")?;
        rest.split(", ").next()
    }

    /// The round that the journal begins with, if it is of one.
    pub fn round(&self) -> Option<usize> {
        let (_, rest) = self.journal.search.split_once(", round ")?;
        rest.split(", ").next()?.parse().ok()
    }
}

impl SearchDirectory {
    /// That of a directory; none where no search has written.
    pub fn read(path: &Path) -> io::Result<Option<Self>> {
        // Asked for first: a search that ends meanwhile has written its last file before it gives its lock free
        let is_held = RunLock::is_held(path, &[]);
        let mut files = Vec::new();
        for entry in fs::read_dir(path)? {
            let name = entry?.file_name().to_string_lossy().into_owned();
            if name.ends_with(".journal") {
                files.push(name);
            }
        }
        files.sort_by_key(|name| (round_of(name), name.contains("calibration")));
        let read = |file: String| {
            Journalled::read(&path.join(&file)).map(|journal| Named { file, journal })
        };
        let journals: Vec<Named> = files.into_iter().map(read).collect::<io::Result<_>>()?;
        let last = LAST.into_iter().find(|(name, _)| path.join(name).exists());
        let by_file = last.and_then(|(_, kind)| kind);
        let by_journal = journals.first().map(|first| kind_of(&first.journal.search));
        let kind = by_file.or(by_journal);
        Ok(kind.map(|kind| Self {
            path: path.to_owned(),
            kind,
            last: last.map(|(name, _)| name),
            is_held,
            journals,
        }))
    }

    /// How it stands, in a word.
    pub fn state(&self) -> &'static str {
        match (self.last, self.is_held) {
            (_, true) => "running",
            (Some(_), false) => "finished",
            (None, false) => "stopped",
        }
    }

    /// Evaluations so far.
    pub fn n_evaluations(&self) -> usize {
        self.journals.iter().map(|one| one.journal.known.len()).sum()
    }

    /// The best of what is sought at the moment, with its sign: of an optimisation the objective, else what is left.
    pub fn best(&self) -> Option<f64> {
        let last = self.journals.last()?;
        Some(sign_of(&last.journal.search) * last.journal.best()?.objective)
    }

    /// The sign that journals have what is sought with: what is made large stands there with its sign turned.
    pub fn sign(&self) -> f64 {
        self.journals.first().map_or(1.0, |first| sign_of(&first.journal.search))
    }
}

/// The round in the name of a journal; 0 where there is one for all of a search.
pub fn round_of(file: &str) -> usize {
    let number = file.strip_prefix("round-").and_then(|rest| rest.split(['-', '.']).next());
    number.and_then(|number| number.parse().ok()).unwrap_or(0)
}

fn sign_of(search: &str) -> f64 {
    if search.starts_with("alewife optimisation") { -1.0 } else { 1.0 }
}

/// The command that has begun a journal.
fn kind_of(search: &str) -> Kind {
    if search.ends_with("in a loop") {
        Kind::Loop
    } else if search.starts_with("alewife optimisation") {
        Kind::Optimisation
    } else {
        Kind::Calibration
    }
}
