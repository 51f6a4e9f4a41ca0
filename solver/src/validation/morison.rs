//! Morison's equation: drag and inertia coefficient of a body that oscillates in fluid at rest.

use std::f64::consts::PI;

/// Smallest angle between drag and inertia, as its squared sine, at which a fit separates them.
const APART: f64 = 1e-10;

/// Force on a body (per unit length) and its motion along the same axis, over time.
#[derive(Debug, Clone, Copy)]
pub struct Oscillation<'a> {
    /// Times (s).
    pub times: &'a [f64],
    /// Force of the fluid on the body (N/m).
    pub force: &'a [f64],
    /// Velocity (m/s).
    pub velocity: &'a [f64],
    /// Acceleration (m/s2).
    pub acceleration: &'a [f64],
}

/// c_D and c_I of F = -1/2 rho D c_D |v| v - rho (pi D^2/4) c_I dv/dt (@dutsch1998).
///
/// They make the integral over time of the squared difference least; `None` where the motion does
/// not separate them.
pub fn fit(oscillation: Oscillation<'_>, density: f64, diameter: f64) -> Option<[f64; 2]> {
    let drag = -0.5 * density * diameter;
    let inertia = -0.25 * PI * density * diameter * diameter;
    let (mut matrix, mut right) = ([[0.0; 2]; 2], [0.0; 2]);
    for i in 0..oscillation.times.len() {
        // Steps are uneven: each counts for half the time between its neighbours.
        let before = oscillation.times[i.saturating_sub(1)];
        let after = oscillation.times[(i + 1).min(oscillation.times.len() - 1)];
        let weight = 0.5 * (after - before);
        let speed = oscillation.velocity[i];
        let terms = [drag * speed.abs() * speed, inertia * oscillation.acceleration[i]];
        for row in 0..2 {
            right[row] += weight * terms[row] * oscillation.force[i];
            for column in 0..2 {
                matrix[row][column] += weight * terms[row] * terms[column];
            }
        }
    }
    let [[a, b], [_, c]] = matrix;
    let determinant = a * c - b * b;
    let [p, q] = right;
    (determinant > APART * a * c)
        .then(|| [(c * p - b * q) / determinant, (a * q - b * p) / determinant])
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    const DENSITY: f64 = 1.3;
    const DIAMETER: f64 = 0.2;

    /// Times from 0 to 2 with steps that grow from 1e-4 to 0.0199.
    fn uneven() -> Vec<f64> {
        (0..=200).map(|i| f64::from(i) / 200.0).map(|s| 2.0 * (0.01 * s + 0.99 * s * s)).collect()
    }

    /// The fit to Morison's force with these coefficients, and some more force.
    fn fitted(coefficients: [f64; 2], more: impl Fn(f64) -> f64) -> [f64; 2] {
        let times = uneven();
        let velocity: Vec<f64> = times.iter().map(|t| 0.7 * (TAU * t).cos()).collect();
        let acceleration: Vec<f64> = times.iter().map(|t| -0.7 * TAU * (TAU * t).sin()).collect();
        let force: Vec<f64> = (0..times.len())
            .map(|i| {
                let drag = 0.5 * DENSITY * DIAMETER * velocity[i].abs() * velocity[i];
                let inertia = DENSITY * PI * DIAMETER.powi(2) / 4.0 * acceleration[i];
                more(times[i]) - coefficients[0] * drag - coefficients[1] * inertia
            })
            .collect();
        let oscillation = Oscillation {
            times: &times,
            force: &force,
            velocity: &velocity,
            acceleration: &acceleration,
        };
        fit(oscillation, DENSITY, DIAMETER).unwrap()
    }

    #[test]
    fn the_coefficients_of_a_made_up_force_come_back() {
        let [drag, inertia] = fitted([2.1, 1.4], |_| 0.0);
        assert!((drag - 2.1).abs() < 1e-12 && (inertia - 1.4).abs() < 1e-12, "{drag} {inertia}");
    }

    #[test]
    fn a_force_square_to_both_terms_changes_nothing_however_uneven_the_steps() {
        // Over whole periods a constant and an even harmonic are square to both terms.
        let [drag, inertia] = fitted([2.1, 1.4], |t| 0.05 + 0.05 * (2.0 * TAU * t).cos());
        assert!((drag - 2.1).abs() < 2e-3 && (inertia - 1.4).abs() < 2e-3, "{drag} {inertia}");
    }

    #[test]
    fn a_body_at_rest_or_in_steady_motion_tells_nothing() {
        let (times, force) = ([0.0, 0.1, 0.3], [1.0, 2.0, 3.0]);
        for velocity in [[0.0; 3], [2.0; 3]] {
            let acceleration = [0.0; 3];
            let oscillation = Oscillation {
                times: &times,
                force: &force,
                velocity: &velocity,
                acceleration: &acceleration,
            };
            assert_eq!(fit(oscillation, 1.0, 1.0), None);
        }
    }
}
