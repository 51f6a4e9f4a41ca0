//! `Fingerprints`: whether the values of a matrix are those it had before.

use rayon::prelude::*;

use crate::sparse::Revision;

/// Values that are hashed on their own, whatever the number of threads.
const CHUNK: usize = 1 << 14;

/// The hash of the values of a matrix at the revision last asked for.
#[derive(Debug, Default)]
pub(super) struct Fingerprints {
    latest: Option<Fingerprint>,
}

/// Hash of the values of a matrix at a revision.
#[derive(Debug)]
struct Fingerprint {
    revision: Revision,
    hash: u64,
}

impl Fingerprints {
    /// The hash of the values of a matrix at a revision, taken once for each.
    ///
    /// A revision alone does not show whether the factors at hand are those of a matrix: assembled again
    /// from the same terms it has equal values at another revision.
    pub fn hash_of(&mut self, revision: &Revision, hash: impl FnOnce() -> u64) -> u64 {
        let known = self.latest.as_ref().filter(|latest| latest.revision == *revision);
        let hash = known.map_or_else(hash, |known| known.hash);
        self.latest = Some(Fingerprint { revision: revision.clone(), hash });
        hash
    }
}

/// A hash of the bits of all values.
pub(super) fn hash_of_values<T: Sync>(values: &[T], bits: impl Fn(&T) -> u64 + Sync) -> u64 {
    let chunks = values.par_chunks(CHUNK);
    let hashes: Vec<u64> = chunks.map(|chunk| hash(chunk.iter().map(&bits))).collect();
    hash(hashes.into_iter())
}

/// A hash of some numbers.
pub(super) fn hash(values: impl Iterator<Item = u64>) -> u64 {
    const MIX: u64 = 0x9E37_79B9_7F4A_7C15;
    let mix = |hash: u64, value: u64| (hash ^ value).wrapping_mul(MIX).rotate_left(29);
    // Lanes do not wait for each other
    let mut lanes = [1, 2, 3, 4];
    for (index, value) in values.enumerate() {
        let lane = &mut lanes[index % 4];
        *lane = mix(*lane, value);
    }
    lanes.into_iter().fold(0, mix)
}
