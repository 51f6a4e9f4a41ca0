//! Tangential slip of a spherical or circular squirmer.
//!
//! u_theta = sum_n B_n V_n(theta), theta from the swimming axis; on a sphere
//! V_n = 2 / (n (n + 1)) sin(theta) P_n'(cos theta), so V_1 = sin, V_2 = sin cos (@lighthill1952,
//! @blake1971); on a disc V_n = sin(n theta). A positive B_1 swims along the axis. Each mode may have
//! a factor in time, and the axis may turn relative to the body, as that of a swimmer does that runs
//! and tumbles.

use nalgebra::{Rotation3, Vector3};

use super::{Gait, InTime};

/// Slip modes and swimming axis of a squirmer.
#[derive(Debug)]
pub struct Squirmer {
    /// B_1, B_2, ... (m/s).
    pub modes: Vec<f64>,
    /// Factor (1) of each mode in time; 1 where there is none, or the list ends.
    pub factors: Vec<Option<InTime>>,
    /// Unit vector of the swimming axis in the body frame.
    pub axis: Vector3<f64>,
    /// Angle (rad) by which the axis is turned about z, relative to the body.
    pub turn: Option<InTime>,
    /// Whether the squirmer is a sphere; otherwise it is a disc in the plane.
    pub is_sphere: bool,
}

impl Squirmer {
    /// Sum of B_n V_n over sin(theta): the slip is this times (cos(theta) e_r - axis), which is
    /// sin(theta) e_theta and has no singularity at the poles.
    fn profile(&self, cosine: f64, time: f64) -> f64 {
        let terms = self.modes.iter().enumerate().map(|(index, mode)| {
            let n = index as f64 + 1.0;
            let shape = if self.is_sphere {
                2.0 / (n * (n + 1.0)) * legendre_derivative(index + 1, cosine)
            } else {
                chebyshev_second(index, cosine)
            };
            let factor = self.factors.get(index).and_then(Option::as_ref);
            mode * shape * factor.map_or(1.0, |factor| factor.0(time))
        });
        terms.sum()
    }
}

impl Gait for Squirmer {
    fn velocity(&self, point: &Vector3<f64>, time: f64) -> Vector3<f64> {
        let outward = point.normalize();
        let axis = self.turn.as_ref().map_or(self.axis, |turn| {
            Rotation3::from_axis_angle(&Vector3::z_axis(), turn.0(time)) * self.axis
        });
        let cosine = outward.dot(&axis);
        (outward * cosine - axis) * self.profile(cosine, time)
    }
}

/// P_n'(x) by the recurrence P_n' = P_(n-2)' + (2n - 1) P_(n-1).
fn legendre_derivative(n: usize, x: f64) -> f64 {
    let (mut value, mut value_next) = (1.0, x);
    let (mut slope, mut slope_next) = (0.0, 1.0);
    for k in 1..n {
        let k = k as f64;
        let value_after = ((2.0 * k + 1.0) * x * value_next - k * value) / (k + 1.0);
        let slope_after = slope + (2.0 * k + 1.0) * value_next;
        (value, value_next) = (value_next, value_after);
        (slope, slope_next) = (slope_next, slope_after);
    }
    if n == 0 { slope } else { slope_next }
}

/// U_n(x) = sin((n + 1) theta) / sin(theta) at x = cos(theta).
fn chebyshev_second(n: usize, x: f64) -> f64 {
    let (mut value, mut next) = (1.0, 2.0 * x);
    for _ in 0..n {
        (value, next) = (next, 2.0 * x * next - value);
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slip(modes: Vec<f64>, is_sphere: bool, theta: f64) -> f64 {
        let (factors, axis, turn) = (Vec::new(), Vector3::x(), None);
        let squirmer = Squirmer { modes, factors, axis, turn, is_sphere };
        let point = Vector3::new(theta.cos(), theta.sin(), 0.0) * 2.0;
        let along = Vector3::new(-theta.sin(), theta.cos(), 0.0);
        squirmer.velocity(&point, 0.0).dot(&along)
    }

    #[test]
    fn modes_have_their_published_form() {
        for theta in [0.3, 1.0, 2.5_f64] {
            let (sin, cos) = theta.sin_cos();
            assert!((slip(vec![1.0], true, theta) - sin).abs() < 1e-14);
            assert!((slip(vec![0.0, 1.0], true, theta) - sin * cos).abs() < 1e-14);
            let third = sin * (5.0 * cos * cos - 1.0) / 4.0;
            assert!((slip(vec![0.0, 0.0, 1.0], true, theta) - third).abs() < 1e-14);
            for n in 1..5 {
                let mut modes = vec![0.0; n];
                modes[n - 1] = 1.0;
                assert!((slip(modes, false, theta) - (n as f64 * theta).sin()).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn modes_follow_their_factors_and_the_axis_its_turn() {
        let squirmer = Squirmer {
            modes: vec![1.0, 2.0, 4.0],
            factors: vec![None, Some(InTime(Box::new(|time| 3.0 * time)))],
            axis: Vector3::y(),
            turn: Some(InTime(Box::new(|time| 0.2 * time))),
            is_sphere: false,
        };
        let (theta, time) = (0.7_f64, 1.5);
        let angle = theta + std::f64::consts::FRAC_PI_2 + 0.2 * time;
        let point = Vector3::new(angle.cos(), angle.sin(), 0.0);
        let along = Vector3::new(-angle.sin(), angle.cos(), 0.0);
        let expected = theta.sin() + 9.0 * (2.0 * theta).sin() + 4.0 * (3.0 * theta).sin();
        let velocity = squirmer.velocity(&point, time);
        assert!((velocity - along * expected).norm() < 1e-13);
    }

    /// A force-free sphere swims at minus its mean slip, 2 B_1 / 3; a disc at B_1 / 2.
    #[test]
    fn mean_slip_gives_the_swimming_speed() {
        let n = 2000;
        let (mut sphere, mut disc) = (0.0, 0.0);
        for index in 0..n {
            let theta = std::f64::consts::PI * (f64::from(index) + 0.5) / f64::from(n);
            let weight = std::f64::consts::PI / f64::from(n);
            let along = |speed: f64| -speed * theta.sin();
            sphere += along(slip(vec![1.5, 2.0], true, theta)) * theta.sin() / 2.0 * weight;
            disc += along(slip(vec![1.5, 2.0], false, theta)) * weight / std::f64::consts::PI;
        }
        assert!((-sphere - 1.0).abs() < 1e-5);
        assert!((-disc - 0.75).abs() < 1e-5);
    }
}
