//! Material points of a profile: close to each other where it bends and where its curvature jumps.

use super::piece::Piece;
use crate::number;
use crate::quadrature::integrate;

/// Longest distance between material points, over the length of the body.
pub const LONGEST_SPACING: f64 = 0.01;

/// Largest angle between neighbouring material points on an arc (rad).
const LARGEST_ANGLE: f64 = 0.15;

/// Growth of the distance between material points per distance from where the curvature jumps.
const GROWTH: f64 = 0.4;

/// Error of the spline next to a jump of curvature, over that jump and the squared spacing.
const JUMP_ERROR: f64 = 0.03;

/// Error of the spline that is aimed at, over the half width.
const ERROR: f64 = 2e-5;

/// Most steps on a piece: lengths that ask for more make no body that can be meshed.
const MOST_STEPS: f64 = 1e5;

/// Parameters of the material points of a piece but its first, `longest` (m) apart at most, close to
/// each other where the outline bends and where its curvature jumps.
pub fn spread(pieces: &[Piece], index: usize, longest: f64) -> Vec<f64> {
    let piece = &pieces[index];
    let n = 2000;
    let length = |from: f64, to: f64| integrate(from, to, |x| piece.at(x)[1].norm());
    let jump = |end: f64, neighbour: Option<&Piece>, at: f64| {
        // At the ends of the body the outline continues with the same curvature
        let jump =
            neighbour.map_or(0.0, |other| (other.curvature(at) - piece.curvature(end)).abs());
        let width = piece.at(end)[0].y;
        if jump > 0.0 { (ERROR * width / (JUMP_ERROR * jump)).sqrt() } else { f64::INFINITY }
    };
    let before = index.checked_sub(1).map(|i| &pieces[i]);
    let finest = [jump(0.0, before, 1.0), jump(1.0, pieces.get(index + 1), 0.0)];
    // Number of steps up to each parameter: the integral of one over the wanted spacing
    let total: f64 = length(0.0, 1.0);
    let (mut steps, mut done) = (vec![0.0], 0.0);
    for i in 0..n {
        let (from, to) = (f64::from(i) / f64::from(n), f64::from(i + 1) / f64::from(n));
        let part = length(from, to);
        let from_start = done + 0.5 * part;
        let bend = piece.curvature(0.5 * (from + to)).abs();
        let wanted = longest
            .min(LARGEST_ANGLE / bend)
            .min(finest[0] + GROWTH * from_start)
            .min(finest[1] + GROWTH * (total - from_start));
        steps.push(steps[steps.len() - 1] + part / wanted);
        done += part;
    }
    let count = steps[steps.len() - 1].ceil().clamp(2.0, MOST_STEPS);
    let scale = steps[steps.len() - 1] / count;
    let mut parameters: Vec<f64> = (1..number::whole(count))
        .map(|k| {
            let wanted = k as f64 * scale;
            let i = steps.partition_point(|s| *s <= wanted).clamp(1, steps.len() - 1);
            let part = (wanted - steps[i - 1]) / (steps[i] - steps[i - 1]);
            (i as f64 - 1.0 + part) / f64::from(n)
        })
        .collect();
    parameters.push(1.0);
    parameters
}
