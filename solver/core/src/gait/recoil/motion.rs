//! `RecoilMotion`: how large the rigid motion is that a body's gait leaves out over a period or a recording.

use alewife_mesh::Point;

use crate::gait::error::GaitError;

/// Times of a period at which the motion is taken: the largest values are then within 1e-3.
const TIMES: usize = 128;

/// The rigid motion of a body by which its gait, prescribed as seen from the head, differs from the
/// gait without momentum.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct RecoilMotion {
    /// What it is taken over: a period, or all of a gait that is recorded (s).
    pub duration: f64,
    /// Largest distance of the centre of area from its mean (m).
    pub translation: f64,
    /// Largest speed of the centre of area (m/s), and its root mean square.
    pub largest_speed: f64,
    /// Root mean square of that speed (m/s).
    pub rms_speed: f64,
    /// Largest angle from its mean (rad).
    pub rotation: f64,
    /// Largest angular velocity (rad/s).
    pub largest_angular_velocity: f64,
    /// Root mean square of the angular velocity (rad/s).
    pub rms_angular_velocity: f64,
    /// Angle by which the body is turned in all (rad).
    pub turn: f64,
}

/// Position and velocity of the rigid motion at one time.
#[derive(Debug, Clone, Copy)]
pub(in crate::gait) struct Recoil {
    /// Centre of area as seen from the head (m).
    pub center: Point<2>,
    /// Its velocity (m/s).
    pub velocity: Point<2>,
    /// Angular velocity (rad/s).
    pub angular_velocity: f64,
}

impl RecoilMotion {
    /// From a start (s) on for a duration (s), which is a number of periods.
    pub(in crate::gait) fn over(
        start: f64,
        duration: f64,
        n_periods: usize,
        recoil: impl Fn(f64) -> Result<Recoil, GaitError>,
    ) -> Result<Self, GaitError> {
        let times = TIMES * n_periods;
        let count = times as f64;
        let at = |i: usize| recoil(start + duration * i as f64 / count);
        let cycle = (0..times).map(at).collect::<Result<Vec<_>, _>>()?;
        let center = cycle.iter().map(|at| at.center).sum::<Point<2>>() / count;
        // Angles since the start, by the trapezoidal rule
        let step = duration / count;
        let angles: Vec<f64> = cycle
            .windows(2)
            .map(|pair| 0.5 * step * (pair[0].angular_velocity + pair[1].angular_velocity))
            .scan(0.0, |angle, change| {
                *angle += change;
                Some(*angle)
            })
            .collect();
        let angle = angles.iter().sum::<f64>() / count;
        let from_mean = angles.iter().map(|at| (at - angle).abs());
        let largest = |f: &dyn Fn(&Recoil) -> f64| cycle.iter().map(f).fold(0.0, f64::max);
        let rms = |f: &dyn Fn(&Recoil) -> f64| {
            (cycle.iter().map(|at| f(at).powi(2)).sum::<f64>() / count).sqrt()
        };
        Ok(Self {
            duration,
            translation: largest(&|at| (at.center - center).norm()),
            largest_speed: largest(&|at| at.velocity.norm()),
            rms_speed: rms(&|at| at.velocity.norm()),
            rotation: from_mean.fold(angle.abs(), f64::max),
            largest_angular_velocity: largest(&|at| at.angular_velocity.abs()),
            rms_angular_velocity: rms(&|at| at.angular_velocity),
            turn: step * cycle.iter().map(|at| at.angular_velocity).sum::<f64>(),
        })
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    #[test]
    fn amplitudes_of_a_sine_are_found_and_a_turn_is_told() {
        let recoil = |t: f64| {
            let (sin, cos) = (TAU * t / 2.0).sin_cos();
            Ok(Recoil {
                center: Point::<2>::new(7.0, 0.3 * sin),
                velocity: Point::<2>::new(0.0, 0.3 * TAU / 2.0 * cos),
                angular_velocity: 0.2 * TAU / 2.0 * cos + 0.05,
            })
        };
        let motion = RecoilMotion::over(1.0, 2.0, 1, recoil).unwrap();
        let speed = 0.3 * TAU / 2.0;
        assert!((motion.translation - 0.3).abs() < 1e-3);
        assert!((motion.largest_speed - speed).abs() < 1e-3);
        assert!((motion.rms_speed - speed / 2.0_f64.sqrt()).abs() < 1e-12);
        assert!((motion.largest_angular_velocity - 0.2 * TAU / 2.0 - 0.05).abs() < 1e-3);
        assert!((motion.turn - 0.1).abs() < 1e-12);
        assert!(motion.rotation > 0.15 && motion.rotation < 0.25);
        // A recording is as dense as its periods
        let recorded = RecoilMotion::over(0.0, 8.0, 4, recoil).unwrap();
        assert!((recorded.largest_speed - speed).abs() < 1e-3);
        assert!((recorded.turn - 0.4).abs() < 1e-12 && recorded.duration == 8.0);
        let back_and_forth = |t: f64| Ok(Recoil { angular_velocity: t.cos(), ..recoil(t)? });
        let motion = RecoilMotion::over(0.3, TAU, 1, back_and_forth).unwrap();
        assert!((motion.rotation - 1.0).abs() < 1e-3, "{}", motion.rotation);
        let failing = |time: f64| Err(GaitError::Midline { time });
        assert!(RecoilMotion::over(0.0, 1.0, 1, failing).is_err());
    }
}
