//! `Journal`: the evaluations of a search in a file, from which it is taken up again with the same bits.

use std::fs::{File, OpenOptions};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::{Evaluated, SearchError};

/// What ends a line that was written whole.
const END: &str = ".";

/// A journal that is open, and what stands in it.
#[derive(Debug)]
pub struct Opened {
    /// The journal.
    pub journal: Journal,
    /// The evaluations it has.
    pub known: Vec<Evaluated>,
}

/// A file with one line an evaluation, below a line that says which search it is of.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: File,
}

impl Journal {
    /// Opens a journal, or begins one; also the evaluations it has. A line that was not written whole, as by a
    /// process that was killed, is taken out. `search` says which search it is, in one line.
    ///
    /// # Errors
    /// [`SearchError::OtherSearch`] and [`SearchError::File`].
    pub fn open(path: &Path, search: &str) -> Result<Opened, SearchError> {
        let name = || path.display().to_string();
        let failed =
            |error: std::io::Error| SearchError::File { file: name(), error: error.to_string() };
        let mut options = OpenOptions::new();
        let mut file = options
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(path)
            .map_err(failed)?;
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(failed)?;
        let Journalled { search: of, known, length, .. } = Journalled::of(&bytes);
        if length > 0 && of != search {
            return Err(SearchError::OtherSearch(name()));
        }
        file.set_len(length as u64).map_err(failed)?;
        file.seek(SeekFrom::End(0)).map_err(failed)?;
        let mut journal = Self { path: path.to_owned(), file };
        if length == 0 {
            journal.write(&format!("{search}\n"))?;
        }
        Ok(Opened { journal, known })
    }

    /// Adds an evaluation, on the disk when this returns.
    ///
    /// # Errors
    /// [`SearchError::File`].
    pub fn add(&mut self, found: &Evaluated) -> Result<(), SearchError> {
        let numbers = [found.objective].into_iter().chain(found.values.iter().copied());
        let numbers = numbers.chain(found.slopes.iter().copied());
        // Shortest decimals that read back as the same bits
        let words: Vec<String> = numbers.map(|number| format!("{number:?}")).collect();
        self.write(&format!("{} {END}\n", words.join(" ")))
    }

    fn write(&mut self, text: &str) -> Result<(), SearchError> {
        let written = self.file.write_all(text.as_bytes()).and_then(|()| self.file.sync_data());
        written.map_err(|error| SearchError::File {
            file: self.path.display().to_string(),
            error: error.to_string(),
        })
    }
}

/// What stands in a journal.
#[derive(Debug, Clone, PartialEq)]
pub struct Journalled {
    /// Which search it is of.
    pub search: String,
    /// The evaluations, in order.
    pub known: Vec<Evaluated>,
    /// Bytes of the lines that were written whole.
    length: usize,
    /// Whether there is nothing but these.
    pub is_whole: bool,
}

impl Journalled {
    /// Reads a journal, which is left as it is.
    ///
    /// # Errors
    /// What the file system reports.
    pub fn read(path: &Path) -> std::io::Result<Self> {
        Ok(Self::of(&std::fs::read(path)?))
    }

    fn of(bytes: &[u8]) -> Self {
        let text = String::from_utf8_lossy(bytes);
        let whole = text.rfind('\n').map_or(0, |end| end + 1);
        let mut lines = text[..whole].lines();
        let search = lines.next().unwrap_or_default().to_owned();
        let mut length = if whole > 0 { search.len() + 1 } else { 0 };
        let mut known = Vec::new();
        for line in lines {
            let Some(found) = read(line) else { break };
            known.push(found);
            length += line.len() + 1;
        }
        Self { search, known, length, is_whole: length == bytes.len() }
    }

    /// The best evaluation, the first of them.
    #[must_use]
    pub fn best(&self) -> Option<&Evaluated> {
        self.known.iter().min_by(|a, b| a.objective.total_cmp(&b.objective))
    }
}

/// An evaluation of a line that was written whole.
fn read(line: &str) -> Option<Evaluated> {
    let words = line.strip_suffix(END)?.split_whitespace();
    let numbers: Option<Vec<f64>> = words.map(|word| word.parse().ok()).collect();
    let numbers = numbers.filter(|numbers| numbers.len() % 2 == 1)?;
    let (objective, rest) = numbers.split_first()?;
    let (values, slopes) = rest.split_at(rest.len() / 2);
    Some(Evaluated { values: values.to_vec(), objective: *objective, slopes: slopes.to_vec() })
}
