//! `Buckets`: items sorted into buckets by counting.

use crate::sparse::index::to_u32;

/// The members of some buckets, in ascending order within each.
#[derive(Debug, Clone)]
pub(super) struct Buckets {
    /// Start of each bucket in `members`, and the end of the last.
    pub starts: Vec<usize>,
    pub members: Vec<u32>,
}

impl Buckets {
    /// Sorts items into `n` buckets by the bucket of each.
    pub fn new(bucket_of: &[u32], n: usize) -> Self {
        let mut starts = vec![0usize; n + 1];
        for &bucket in bucket_of {
            starts[bucket as usize + 1] += 1;
        }
        for bucket in 0..n {
            starts[bucket + 1] += starts[bucket];
        }
        let mut fill = starts.clone();
        let mut members = vec![0u32; bucket_of.len()];
        for (member, &bucket) in (0..to_u32(bucket_of.len())).zip(bucket_of) {
            members[fill[bucket as usize]] = member;
            fill[bucket as usize] += 1;
        }
        Self { starts, members }
    }

    pub fn of(&self, bucket: usize) -> &[u32] {
        &self.members[self.starts[bucket]..self.starts[bucket + 1]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_item_is_in_its_bucket() {
        let buckets = Buckets::new(&[2, 0, 2, 3], 5);
        let sorted: Vec<&[u32]> = (0..5).map(|bucket| buckets.of(bucket)).collect();
        assert_eq!(sorted, [&[1][..], &[], &[0, 2], &[3], &[]]);
    }
}
