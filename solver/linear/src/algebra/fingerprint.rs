//! `Fingerprints`: whether the values of a matrix are those it had before.

use crate::sparse::{Revision, SparseMatrix};

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
    /// Hash of the values of a matrix, taken once for each revision.
    ///
    /// A revision alone does not tell whether the factors at hand are those of a matrix: assembled again
    /// from the same terms it has equal values at another revision.
    pub fn hash_of(&mut self, matrix: &SparseMatrix) -> u64 {
        let known = self.latest.as_ref().filter(|latest| latest.revision == *matrix.revision());
        let hash = known.map_or_else(|| hash(matrix.values()), |known| known.hash);
        self.latest = Some(Fingerprint { revision: matrix.revision().clone(), hash });
        hash
    }
}

/// A hash of all bits of all values.
fn hash(values: &[f64]) -> u64 {
    const MIX: u64 = 0x9E37_79B9_7F4A_7C15;
    let mut lanes = [1u64, 2, 3, 4];
    let chunks = values.chunks_exact(4);
    let rest = chunks.remainder();
    for chunk in chunks {
        for (lane, value) in lanes.iter_mut().zip(chunk) {
            *lane = (*lane ^ value.to_bits()).wrapping_mul(MIX).rotate_left(29);
        }
    }
    let all = lanes.into_iter().chain(rest.iter().map(|value| value.to_bits()));
    all.fold(0, |hash, part| (hash ^ part).wrapping_mul(MIX).rotate_left(29))
}
