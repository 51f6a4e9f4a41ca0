//! `Provenance`: which program ran a case, where and how, in which legs; the content of `provenance.json`.

use std::collections::BTreeMap;
use std::io;
use std::path::Path;
use std::sync::OnceLock;

use serde::{Deserialize, Serialize};

use super::status::Status;
use crate::observer::system::{process, write_whole};

/// Where it is written in the directory of a run.
const FILE: &str = "provenance.json";

/// Variables by which Slurm names the job of a process.
const SLURM: [&str; 9] = [
    "SLURM_CLUSTER_NAME",
    "SLURM_JOB_ID",
    "SLURM_JOB_NAME",
    "SLURM_ARRAY_JOB_ID",
    "SLURM_ARRAY_TASK_ID",
    "SLURM_RESTART_COUNT",
    "SLURM_JOB_NODELIST",
    "SLURM_JOB_PARTITION",
    "SLURM_CPUS_PER_TASK",
];

/// How a leg ended whose process was killed.
const KILLED: &str = "killed";

/// A place in a run.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Steps made.
    pub step: usize,
    /// Time reached (s).
    pub time: f64,
}

/// Which program runs a case, where and how: what is known of a process when it begins.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Origin {
    /// Version of alewife.
    pub alewife: String,
    /// `git describe` of its source, if it was built in a checkout.
    pub git: Option<String>,
    /// Checksum of the program's file: equal for equal programs.
    #[serde(default)]
    pub executable: Option<String>,
    /// Compiler it was built with, if the build recorded it.
    pub rustc: Option<String>,
    /// Target triple, or architecture and system if the build did not record it.
    pub target: String,
    /// Command line.
    pub argv: Vec<String>,
    /// Name of the computer.
    pub host: Option<String>,
    /// Slurm's variables of the job, if it is one.
    pub slurm: BTreeMap<String, String>,
    /// Start (UTC).
    pub started_at: String,
    /// Checksum of `case.toml`: equal for equal cases.
    pub case_hash: String,
    /// Threads the run may use.
    pub threads: usize,
    /// Cores this process may use.
    pub cores: usize,
}

/// What one process did of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Leg {
    /// Where it began in the run.
    pub from: Point,
    /// Where it ended; of a process that was killed, as far as is known.
    pub to: Option<Point>,
    /// When it ended (UTC).
    pub ended_at: Option<String>,
    /// Why: `finished`, `killed`, or what stopped it; nothing while it runs.
    pub end: Option<String>,
    /// What ran it.
    #[serde(flatten)]
    pub origin: Origin,
}

/// The origin of a run, which resuming does not change, and its legs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// That of the first leg.
    #[serde(flatten)]
    pub origin: Origin,
    /// One for each process that ran in the directory, the first one first.
    pub legs: Vec<Leg>,
}

impl Origin {
    /// That of a run of `case_text` that starts now in this process.
    #[must_use]
    pub fn of_this_process(case_text: &str, threads: usize) -> Self {
        let slurm = SLURM.iter().filter_map(|name| Some((*name, std::env::var(name).ok()?)));
        let target = option_env!("ALEWIFE_TARGET").map_or_else(
            || format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS),
            str::to_owned,
        );
        Self {
            alewife: env!("CARGO_PKG_VERSION").to_owned(),
            git: option_env!("ALEWIFE_GIT").filter(|text| !text.is_empty()).map(str::to_owned),
            executable: executable().map(str::to_owned),
            rustc: option_env!("ALEWIFE_RUSTC").filter(|text| !text.is_empty()).map(str::to_owned),
            target,
            argv: std::env::args_os().map(|word| word.to_string_lossy().into_owned()).collect(),
            host: process::host_name(),
            slurm: slurm.map(|(name, value)| (name.to_owned(), value)).collect(),
            started_at: process::now(),
            case_hash: checksum(case_text.as_bytes()),
            threads,
            cores: std::thread::available_parallelism().map_or(1, std::num::NonZero::get),
        }
    }

    /// Name and version of the program.
    #[must_use]
    pub fn program(&self) -> String {
        let git = self.git.as_ref().map_or(String::new(), |git| format!(" ({git})"));
        format!("alewife {}{git}", self.alewife)
    }

    /// What to look for elsewhere to find what this is of, in a line.
    #[must_use]
    pub fn line(&self) -> String {
        format!("{}, case {}", self.program(), self.case_hash)
    }

    /// The same as pairs of texts, lists joined by blanks.
    fn flattened(&self) -> BTreeMap<String, String> {
        let mut pairs = BTreeMap::from([
            ("alewife".to_owned(), self.alewife.clone()),
            ("target".to_owned(), self.target.clone()),
            ("argv".to_owned(), self.argv.join(" ")),
            ("started_at".to_owned(), self.started_at.clone()),
            ("case_hash".to_owned(), self.case_hash.clone()),
            ("threads".to_owned(), self.threads.to_string()),
            ("cores".to_owned(), self.cores.to_string()),
        ]);
        let if_known = [
            ("git", &self.git),
            ("executable", &self.executable),
            ("rustc", &self.rustc),
            ("host", &self.host),
        ];
        for (name, value) in if_known {
            pairs.extend(value.iter().map(|value| (name.to_owned(), value.clone())));
        }
        pairs.extend(self.slurm.iter().map(|(name, value)| (name.clone(), value.clone())));
        pairs
    }
}

/// Checksum of the file of this program, if it can be read.
pub fn executable() -> Option<&'static str> {
    static CHECKSUM: OnceLock<Option<String>> = OnceLock::new();
    let read = || Some(checksum(&std::fs::read(std::env::current_exe().ok()?).ok()?));
    CHECKSUM.get_or_init(read).as_deref()
}

/// The checksum of bytes, as it is written of cases and programs.
#[must_use]
pub fn checksum(bytes: &[u8]) -> String {
    format!("crc32:{:08x}", crc32fast::hash(bytes))
}

impl Provenance {
    /// That of a run that begins at a place: the start, or that of a state of another directory.
    #[must_use]
    pub fn beginning(origin: Origin, from: Point) -> Self {
        let leg = Leg { from, to: None, ended_at: None, end: None, origin: origin.clone() };
        Self { origin, legs: vec![leg] }
    }

    /// The same after what was run in a directory before, as far as that can be read.
    #[must_use]
    pub fn continuing(directory: &Path, origin: Origin, from: Point) -> Self {
        let new = Self::beginning(origin, from);
        let Ok(mut earlier) = Self::read(directory) else { return new };
        if let Some(last) = earlier.legs.last_mut().filter(|last| last.end.is_none()) {
            last.end = Some(KILLED.to_owned());
            last.to = Some(from);
            // A checkpoint may be newer than the last status, which is up to a second behind
            if let Ok(status) = Status::read(directory) {
                if status.step > from.step {
                    last.to = Some(Point { step: status.step, time: status.time });
                }
                last.ended_at = Some(status.updated_at);
            }
        }
        earlier.legs.extend(new.legs);
        earlier
    }

    /// That of the run in a directory.
    ///
    /// # Errors
    /// When there is none, or it cannot be read.
    pub fn read(directory: &Path) -> io::Result<Self> {
        Ok(serde_json::from_slice(&std::fs::read(directory.join(FILE))?)?)
    }

    /// Writes `provenance.json` to a directory.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn write(&self, directory: &Path) -> io::Result<()> {
        let mut text = serde_json::to_vec_pretty(self)?;
        text.push(b'\n');
        write_whole(&directory.join(FILE), &text)
    }

    /// The end of the present leg.
    pub fn end_leg(&mut self, to: Point, end: &str) {
        if let Some(leg) = self.legs.last_mut() {
            leg.to = Some(to);
            leg.ended_at = Some(process::now());
            leg.end = Some(end.to_owned());
        }
    }

    /// The same as pairs of texts, for formats that hold no more: those of the origin, and the legs as JSON.
    ///
    /// # Errors
    /// None that is known of.
    pub fn flattened(&self) -> io::Result<BTreeMap<String, String>> {
        let mut pairs = self.origin.flattened();
        pairs.insert("legs".to_owned(), serde_json::to_string(&self.legs)?);
        Ok(pairs)
    }
}
