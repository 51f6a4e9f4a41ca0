//! Forces on a tree from outside, and thrusters with what they remember.

use alewife_reduced::tree::{Lag, Number, Pose, Thruster, Thrusters, Wrench, real};
use nalgebra::{Matrix3, Vector3};

use crate::case::{LagSpec, Stroke, ThrusterSpec, TimeFunction};

/// A force and a torque from outside on a body, about its centre of mass.
#[derive(Debug, Clone)]
pub(in crate::reduced) struct Pull {
    pub link: usize,
    /// The centre and axes of the body in the frame of the link.
    pub inside: Pose<f64>,
    pub load: Wrench<f64>,
    pub factor: Option<TimeFunction>,
    /// Whether it turns with the body; it keeps the axes of the laboratory otherwise.
    pub is_in_body: bool,
}

impl Pull {
    /// About the origin of the link, in its axes.
    pub fn wrench<T: Number>(&self, time: f64, rotation: &Matrix3<T>) -> Wrench<T> {
        let factor: T = real(self.factor.as_ref().map_or(1.0, |factor| factor.at(time)));
        let own = self.inside.rotation.map(real::<T>);
        let turn = if self.is_in_body { own } else { rotation.transpose() };
        let force = turn * self.load.force.map(real::<T>) * factor;
        let lever = self.inside.position.map(real::<T>);
        let torque = turn * self.load.torque.map(real::<T>) * factor + lever.cross(&force);
        Wrench { force, torque }
    }
}

/// What a propeller remembers between steps: its lag, and its force at the end of the last one.
#[derive(Debug, Clone, Copy)]
pub(in crate::reduced) struct PropellerMemory {
    lag: Vector3<f64>,
    before: Wrench<f64>,
}

/// A propeller, and what it gives over a step.
#[derive(Debug, Clone)]
pub(in crate::reduced) struct Propeller {
    pub link: usize,
    drive: Stroke,
    thruster: Thrusters<f64>,
    has_lag: bool,
    /// At the end of the step before.
    before: Wrench<f64>,
    /// Over the step.
    pub wrench: Wrench<f64>,
}

impl Propeller {
    /// A propeller at rest on a body whose frame has a pose in that of a link.
    pub fn new(spec: &ThrusterSpec, link: usize, frame: &Pose<f64>) -> Self {
        let vector = |v: &[f64]| Vector3::from_fn(|k, _| v.get(k).copied().unwrap_or(0.0));
        let thruster = Thruster {
            position: frame.position + frame.rotation * vector(&spec.position),
            direction: frame.rotation * vector(&spec.direction).normalize(),
            curve: spec.curve.clone(),
        };
        let lag = spec.lag.map(|LagSpec { numerator, denominator }| Lag { numerator, denominator });
        Self {
            link,
            drive: spec.drive.clone(),
            has_lag: lag.is_some(),
            thruster: Thrusters::new(vec![thruster], lag),
            before: Wrench::zero(),
            wrench: Wrench::zero(),
        }
    }

    /// What it waits for, or does by itself.
    pub fn drive(&self) -> &Stroke {
        &self.drive
    }

    /// What it remembers between steps.
    pub fn memory(&self) -> PropellerMemory {
        PropellerMemory { lag: self.thruster.memory(0), before: self.before }
    }

    /// Has it remember something else.
    pub fn remember(&mut self, memory: &PropellerMemory) {
        self.thruster.remember(0, memory.lag);
        self.before = memory.before;
    }

    /// Goes on by a step (s): its command is that of the middle, its force the mean of both ends.
    pub fn advance(&mut self, time: f64, step: f64) {
        let [command, _] = self.drive.at(time + 0.5 * step);
        self.advance_by(command, step);
    }

    /// The same with a command that somebody else knows.
    pub fn advance_by(&mut self, command: f64, step: f64) {
        let after = self.thruster.advance(step, &[command]);
        self.wrench = if self.has_lag {
            Wrench::zero().plus(&self.before, 0.5).plus(&after, 0.5)
        } else {
            after
        };
        self.before = after;
    }
}
