//! Sums of whole periods: where a periodic domain repeats.

use crate::Point;

/// All sums of up to `most` periods along each periodic direction, zero first (m).
pub(crate) fn lattice(periods: [Option<f64>; 2], most: usize) -> Vec<Point<2>> {
    let steps = |period: Option<f64>| {
        let mut steps = vec![0.0];
        if let Some(length) = period {
            steps.extend((1..=most).flat_map(|k| [k as f64 * length, -(k as f64) * length]));
        }
        steps
    };
    let mut all = Vec::new();
    for y in steps(periods[1]) {
        all.extend(steps(periods[0]).iter().map(|x| Point::<2>::new(*x, y)));
    }
    all
}
