//! Checksums of the cases of points: which point a run directory is of, wherever it lies.

use std::collections::BTreeMap;
use std::thread;

use serde_json::Value;

use crate::case::{CaseError, Sweep, collect_keys};

/// Tables and keys of a case at its top that change nothing of what is computed.
pub(super) const IRRELEVANT: [&str; 7] =
    ["title", "description", "optimisation", "output", "quick", "reference", "variant"];

/// All keys of a case that decide what is computed, by their paths.
pub(super) fn keys_of(case: &Value) -> BTreeMap<String, String> {
    let mut keys = BTreeMap::new();
    if let Value::Object(tables) = case {
        for (name, value) in tables.iter().filter(|(name, _)| !IRRELEVANT.contains(&&***name)) {
            collect_keys(name.clone(), value, &mut keys);
        }
    }
    // A mesh is known by its checksum, wherever it lies; files of a soft case lie beside what its run writes
    for file in ["domain.mesh.file", "record.file", "solid.0.mesh.file"] {
        keys.remove(file);
    }
    keys
}

/// The checksum of what is computed by a case, from its text; nothing where that is no TOML.
pub(super) fn hash_of(text: &str) -> Option<String> {
    let keys = keys_of(&toml::from_str(text).ok()?);
    let mut hasher = crc32fast::Hasher::new();
    for (key, value) in keys {
        hasher.update(format!("{key} = {value}\n").as_bytes());
    }
    Some(format!("crc32:{:08x}", hasher.finalize()))
}

/// The checksum of the case of a point as its run writes it.
fn hash_of_point(sweep: &Sweep, index: usize) -> Result<Option<String>, CaseError> {
    let text = if sweep.is_soft() {
        toml::to_string_pretty(&sweep.soft_case(index)?.case).ok()
    } else {
        sweep.case(index)?.case().to_toml().ok()
    };
    Ok(text.and_then(|text| hash_of(&text)))
}

/// The checksums of all points of a sweep.
///
/// # Errors
/// What is wrong in the case of a point.
pub fn hashes_of(sweep: &Sweep) -> Result<Vec<String>, CaseError> {
    let n = sweep.n_points();
    let n_threads = thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let per_thread = n.div_ceil(n_threads).max(1);
    let hash = |index| Ok(hash_of_point(sweep, index)?.unwrap_or_default());
    thread::scope(|scope| {
        let parts = (0..n).step_by(per_thread).map(|first| first..(first + per_thread).min(n));
        let workers: Vec<_> =
            parts.map(|part| scope.spawn(move || part.map(hash).collect::<Vec<_>>())).collect();
        let joined = workers.into_iter().map(thread::ScopedJoinHandle::join);
        joined
            .flat_map(|part| part.unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
            .collect()
    })
}
