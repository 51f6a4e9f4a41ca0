//! `Steps`: numbers of periods by which copies in a periodic domain differ.

use crate::Point;

/// Numbers of periods along x and y.
pub type Steps = [i32; 2];

/// Sum of whole periods (m).
pub fn displacement(steps: Steps, periods: [Option<f64>; 2]) -> Point<2> {
    let along = |axis: usize| periods[axis].map_or(0.0, |l: f64| l * f64::from(steps[axis]));
    Point::<2>::new(along(0), along(1))
}

/// Both one after the other.
pub fn sum(a: Steps, b: Steps) -> Steps {
    [a[0] + b[0], a[1] + b[1]]
}
