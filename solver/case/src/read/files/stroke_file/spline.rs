//! Slopes of cubic splines: natural ones, and periodic ones.

/// Slopes of the natural cubic spline through two points or more, their abscissae ascending:
/// continuous second derivatives, zero at both ends.
pub(super) fn natural_slopes(points: &[[f64; 2]]) -> Vec<f64> {
    let n = points.len();
    let inverse = |i: usize| 1.0 / (points[i + 1][0] - points[i][0]);
    let chord = |i: usize| (points[i + 1][1] - points[i][1]) * inverse(i);
    // Thomas algorithm for a_(i-1) s_(i-1) + 2 (a_(i-1) + a_i) s_i + a_i s_(i+1)
    // = 3 (a_(i-1) c_(i-1) + a_i c_i), with a the inverse distances and c the slopes of the chords
    let mut slopes = vec![0.0; n];
    let mut factors = vec![0.0; n];
    for i in 0..n {
        let before = if i > 0 { inverse(i - 1) } else { 0.0 };
        let after = if i + 1 < n { inverse(i) } else { 0.0 };
        let behind = if i > 0 { before * chord(i - 1) } else { 0.0 };
        let ahead = if i + 1 < n { after * chord(i) } else { 0.0 };
        let (factor, slope) = if i > 0 { (factors[i - 1], slopes[i - 1]) } else { (0.0, 0.0) };
        let pivot = 2.0 * (before + after) - before * factor;
        factors[i] = after / pivot;
        slopes[i] = (3.0 * (behind + ahead) - before * slope) / pivot;
    }
    for i in (0..n - 1).rev() {
        slopes[i] -= factors[i] * slopes[i + 1];
    }
    slopes
}

/// Slopes of the periodic cubic spline through two points or more, the first of which comes again after a period:
/// second derivatives are continuous there, too.
pub(super) fn periodic_slopes(points: &[[f64; 2]], period: f64) -> Vec<f64> {
    let n = points.len();
    let next = |i: usize| (i + 1) % n;
    let inverse: Vec<f64> = (0..n)
        .map(|i| {
            let end = if i + 1 < n { points[i + 1][0] } else { points[0][0] + period };
            1.0 / (end - points[i][0])
        })
        .collect();
    let chord = |i: usize| (points[next(i)][1] - points[i][1]) * inverse[i];
    let before = |i: usize| (i + n - 1) % n;
    let right: Vec<f64> = (0..n)
        .map(|i| 3.0 * (inverse[before(i)] * chord(before(i)) + inverse[i] * chord(i)))
        .collect();
    if n == 2 {
        // Each is the neighbour of the other on both sides
        let sum = inverse[0] + inverse[1];
        let det = 3.0 * sum * sum;
        let of = |one: f64, other: f64| sum * (2.0 * one - other) / det;
        return vec![of(right[0], right[1]), of(right[1], right[0])];
    }
    // The corners of the matrix as a change of rank one (Sherman and Morrison)
    let corner = inverse[n - 1];
    let mut diagonal: Vec<f64> = (0..n).map(|i| 2.0 * (inverse[before(i)] + inverse[i])).collect();
    let shift = -diagonal[0];
    diagonal[0] -= shift;
    diagonal[n - 1] -= corner * corner / shift;
    let mut column = vec![0.0; n];
    column[0] = shift;
    column[n - 1] = corner;
    let (plain, changed) =
        (tridiagonal(&diagonal, &inverse, &right), tridiagonal(&diagonal, &inverse, &column));
    let along = |x: &[f64]| x[0] + corner / shift * x[n - 1];
    let factor = along(&plain) / (1.0 + along(&changed));
    plain.iter().zip(&changed).map(|(one, other)| one - factor * other).collect()
}

/// The solution of a symmetric tridiagonal system, `beside` the diagonal, by the Thomas algorithm.
fn tridiagonal(diagonal: &[f64], beside: &[f64], right: &[f64]) -> Vec<f64> {
    let n = diagonal.len();
    let (mut factors, mut solution) = (vec![0.0; n], vec![0.0; n]);
    for i in 0..n {
        let (factor, value, below) =
            if i > 0 { (factors[i - 1], solution[i - 1], beside[i - 1]) } else { (0.0, 0.0, 0.0) };
        let pivot = diagonal[i] - below * factor;
        factors[i] = beside[i] / pivot;
        solution[i] = (right[i] - below * value) / pivot;
    }
    for i in (0..n - 1).rev() {
        solution[i] -= factors[i] * solution[i + 1];
    }
    solution
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::Stroke;

    #[test]
    fn a_sampled_sine_is_a_sine_with_its_rate() {
        let error = |n: u32| {
            let time = |i: u32| 2.0 * f64::from(i) / f64::from(n);
            let points: Vec<[f64; 2]> = (0..=n).map(|i| [time(i), (TAU * time(i)).sin()]).collect();
            let slopes = natural_slopes(&points);
            let knots = points.iter().zip(slopes).map(|([t, x], slope)| [*t, *x, slope]);
            let stroke = Stroke::Cubic(knots.collect());
            (1..400).map(|i| f64::from(i) / 200.0).fold([0.0f64; 2], |most, time| {
                let [value, rate] = stroke.at(time);
                let (sin, cos) = (TAU * time).sin_cos();
                [most[0].max((value - sin).abs()), most[1].max((rate / TAU - cos).abs())]
            })
        };
        let [coarse, fine] = [error(40), error(80)];
        // Fourth order in values, third in rates; the sine has no curvature at the ends either
        assert!(fine[0] < 2e-6 && coarse[0] / fine[0] > 12.0, "{coarse:?} {fine:?}");
        assert!(fine[1] < 1e-4 && coarse[1] / fine[1] > 6.0, "{coarse:?} {fine:?}");
    }

    #[test]
    fn two_points_are_joined_by_a_line() {
        assert_eq!(natural_slopes(&[[0.0, 1.0], [2.0, 5.0]]), vec![2.0, 2.0]);
    }

    #[test]
    fn a_periodic_spline_knows_no_end() {
        let wave = |time: f64| (TAU * time).sin() + 0.3 * (2.0 * TAU * time).cos();
        let slope = |time: f64| TAU * (TAU * time).cos() - 0.6 * TAU * (2.0 * TAU * time).sin();
        let error = |n: u32| {
            // Unevenly, and not from time 0
            let time = |i: u32| {
                let even = f64::from(i) / f64::from(n);
                0.37 + even + 0.2 / f64::from(n) * (TAU * even).sin()
            };
            let points: Vec<[f64; 2]> = (0..n).map(|i| [time(i), wave(time(i))]).collect();
            let slopes = periodic_slopes(&points, 1.0);
            points.iter().zip(slopes).map(|([t, _], s)| (s - slope(*t)).abs()).fold(0.0, f64::max)
        };
        let [coarse, fine] = [error(32), error(64)];
        assert!(fine < 2e-3 && coarse / fine > 7.0, "{coarse:e} {fine:e}");
        // Two points, and the same ones written over two periods
        let two = [[0.0, 1.0], [0.4, -2.0]];
        let four = [two[0], two[1], [1.0, 1.0], [1.4, -2.0]];
        let [short, long] = [periodic_slopes(&two, 1.0), periodic_slopes(&four, 2.0)];
        for i in 0..4 {
            assert!((short[i % 2] - long[i]).abs() < 1e-12, "{short:?} {long:?}");
        }
    }
}
