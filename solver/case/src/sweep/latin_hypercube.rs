//! Latin hypercubes: points at random, one in each of the equal parts of every range (@mckay1979).

use alewife_mesh::whole;

use super::range::Range;
use crate::model::random::SplitMix64;

/// Values of all ranges at so many points, row by row; those of the seed.
pub fn sample(ranges: &[Range], n: usize, seed: u64) -> Vec<Vec<f64>> {
    let mut random = SplitMix64(seed);
    let mut rows = vec![Vec::with_capacity(ranges.len()); n];
    for range in ranges {
        let order = shuffled(n, &mut random);
        for (row, stratum) in rows.iter_mut().zip(order) {
            row.push(range.at((stratum as f64 + random.uniform()) / n as f64));
        }
    }
    rows
}

/// The numbers below n in an order at random (Fisher and Yates).
fn shuffled(n: usize, random: &mut SplitMix64) -> Vec<usize> {
    let mut order: Vec<usize> = (0..n).collect();
    for last in (1..n).rev() {
        // The product may round to the upper end
        order.swap(last, whole(random.uniform() * (last + 1) as f64).min(last));
    }
    order
}
