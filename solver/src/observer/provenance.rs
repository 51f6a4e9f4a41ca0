//! `Provenance`: which program ran a case, where and how; the content of `provenance.json`.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::process;

/// Where it is written in the directory of a run.
pub const FILE: &str = "provenance.json";

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

/// Which program ran a case, where and how.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Provenance {
    /// Version of alewife.
    pub alewife: String,
    /// `git describe` of its source, if it was built in a checkout.
    pub git: Option<String>,
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
    /// Those of the parts that were run in the directory before this one, the first part first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub earlier: Vec<Provenance>,
}

impl Provenance {
    /// The provenance of a run of `case_text` that starts now in this process.
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
            rustc: option_env!("ALEWIFE_RUSTC").filter(|text| !text.is_empty()).map(str::to_owned),
            target,
            argv: std::env::args_os().map(|word| word.to_string_lossy().into_owned()).collect(),
            host: process::host_name(),
            slurm: slurm.map(|(name, value)| (name.to_owned(), value)).collect(),
            started_at: process::now(),
            case_hash: format!("crc32:{:08x}", crc32fast::hash(case_text.as_bytes())),
            threads,
            cores: std::thread::available_parallelism().map_or(1, std::num::NonZero::get),
            earlier: Vec::new(),
        }
    }

    /// The same after what was run in a directory before, as far as that can be read.
    #[must_use]
    pub fn continuing(self, directory: &Path) -> Self {
        let read = || -> Option<Self> {
            serde_json::from_slice(&std::fs::read(directory.join(FILE)).ok()?).ok()
        };
        let mut earlier = Vec::new();
        if let Some(mut last) = read() {
            earlier = std::mem::take(&mut last.earlier);
            earlier.push(last);
        }
        Self { earlier, ..self }
    }

    /// The same as pairs of texts, lists joined by blanks, for formats that hold no more.
    #[must_use]
    pub fn flattened(&self) -> BTreeMap<String, String> {
        let mut pairs = BTreeMap::from([
            ("alewife".to_owned(), self.alewife.clone()),
            ("target".to_owned(), self.target.clone()),
            ("argv".to_owned(), self.argv.join(" ")),
            ("started_at".to_owned(), self.started_at.clone()),
            ("case_hash".to_owned(), self.case_hash.clone()),
            ("threads".to_owned(), self.threads.to_string()),
            ("cores".to_owned(), self.cores.to_string()),
        ]);
        for (name, value) in [("git", &self.git), ("rustc", &self.rustc), ("host", &self.host)] {
            pairs.extend(value.iter().map(|value| (name.to_owned(), value.clone())));
        }
        pairs.extend(self.slurm.iter().map(|(name, value)| (name.clone(), value.clone())));
        pairs
    }
}
