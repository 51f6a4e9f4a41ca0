//! `Thrusters`: forces of propellers by a curve of their command, and how they lag behind it.

use nalgebra::{Matrix3, Vector3};

use super::spatial::{Number, Wrench, real};

/// Where a propeller is on a link, and what it gives.
#[derive(Debug, Clone, PartialEq)]
pub struct Thruster<T: Number> {
    /// Place in the frame of the link (m).
    pub position: Vector3<T>,
    /// Unit vector along a positive force.
    pub direction: Vector3<T>,
    /// Force (N) by the first, third, fifth ... power of the command V, from -1 to 1.
    pub curve: Vec<T>,
}

impl<T: Number> Thruster<T> {
    /// Force (N) of a command, which is cut to -1 and 1, once it has lasted.
    #[must_use]
    pub fn force(&self, command: T) -> T {
        let command = if command.re().abs() > 1.0 { real(command.re().signum()) } else { command };
        let square = command * command;
        let zero: T = real(0.0);
        command * self.curve.iter().rev().fold(zero, |sum, c| sum * square + *c)
    }
}

/// How a force F follows the one G of the curve, as a transfer function of the third order,
///
/// ```text
/// F/G = (b_1 s + b_0) / (s^3 + a_2 s^2 + a_1 s + a_0).
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lag {
    /// `b_0` (1/s3), `b_1` (1/s2).
    pub numerator: [f64; 2],
    /// `a_0` (1/s3), `a_1` (1/s2), `a_2` (1/s).
    pub denominator: [f64; 3],
}

/// Some propellers of one link, and what their lag remembers.
#[derive(Debug, Clone, PartialEq)]
pub struct Thrusters<T: Number> {
    thrusters: Vec<Thruster<T>>,
    lag: Option<Lag>,
    memories: Vec<Vector3<T>>,
    /// The step (s) that `forward` and `inverse` are for.
    step: f64,
    forward: Matrix3<f64>,
    inverse: Matrix3<f64>,
}

fn apply<T: Number>(matrix: &Matrix3<f64>, v: &Vector3<T>) -> Vector3<T> {
    Vector3::from_fn(|i, _| v.x * matrix[(i, 0)] + v.y * matrix[(i, 1)] + v.z * matrix[(i, 2)])
}

impl<T: Number> Thrusters<T> {
    /// Propellers at rest.
    #[must_use]
    pub fn new(thrusters: Vec<Thruster<T>>, lag: Option<Lag>) -> Self {
        let memories = vec![Vector3::from_element(real(0.0)); thrusters.len()];
        let identity = Matrix3::identity();
        Self { thrusters, lag, memories, step: 0.0, forward: identity, inverse: identity }
    }

    /// What the lag of one of them remembers.
    #[must_use]
    pub fn memory(&self, nth: usize) -> Vector3<T> {
        self.memories[nth]
    }

    /// Has one of them remember something else.
    pub fn remember(&mut self, nth: usize, memory: Vector3<T>) {
        self.memories[nth] = memory;
    }

    /// The wrench on the link, about its origin in its axes, after a step (s) with commands, one a propeller,
    /// that are constant over it; by the trapezoidal rule.
    #[must_use]
    pub fn advance(&mut self, step: f64, commands: &[T]) -> Wrench<T> {
        self.prepare(step);
        let mut sum = Wrench::zero();
        let thrusters = self.thrusters.iter().zip(&mut self.memories);
        for ((thruster, memory), command) in thrusters.zip(commands) {
            let mut size = thruster.force(*command);
            if let Some(lag) = &self.lag {
                let mut right = apply(&self.forward, memory);
                right.z += size * step;
                *memory = apply(&self.inverse, &right);
                size = memory.x * lag.numerator[0] + memory.y * lag.numerator[1];
            }
            let force = thruster.direction * size;
            let wrench = Wrench { force, torque: thruster.position.cross(&force) };
            sum = sum.plus(&wrench, real(1.0));
        }
        sum
    }

    fn prepare(&mut self, step: f64) {
        let Some(lag) = &self.lag else { return };
        if (step - self.step).abs() <= f64::EPSILON * step {
            return;
        }
        let [a, b, c] = lag.denominator;
        let half = Matrix3::new(0.0, 1.0, 0.0, 0.0, 0.0, 1.0, -a, -b, -c) * (0.5 * step);
        self.forward = Matrix3::identity() + half;
        // Singular only where the lag grows, which a step of another length does not cure
        self.inverse = (Matrix3::identity() - half).try_inverse().unwrap_or_else(Matrix3::identity);
        self.step = step;
    }
}
