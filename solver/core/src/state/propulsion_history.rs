//! `PropulsionHistory`: what a group of bodies does and has done: powers, their integrals, its cycles.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::cycle_error::{CycleError, Leg};
use super::cycles::{Cycles, Record};
use crate::body::Orientation;
use crate::coupling::PropulsionPower;

/// What a group of bodies does and has done.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct PropulsionHistory {
    /// Numbers of its present power.
    power: [f64; 6],
    /// Their time integrals since the start.
    work: [f64; 6],
    /// Time integral of the power where it is positive (J).
    positive_work: f64,
    /// The last two cycles.
    pub cycles: Cycles,
    /// What its steps have done wrong in the first one.
    pub error: CycleError,
}

/// The powers of a group in a step.
#[derive(Debug, Clone, PartialEq)]
pub struct PropulsionStep {
    /// At some times in the step, with their shares of it.
    pub shares: Vec<PowerShare>,
    /// At its end.
    pub end: PropulsionPower,
    /// Its way, where its poses are all that evolves.
    pub leg: Option<Leg>,
}

/// A power with its share of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PowerShare {
    /// The power.
    pub power: PropulsionPower,
    /// Its weight in the integral over the step, relative to the size of the step.
    pub share: f64,
}

impl PropulsionHistory {
    /// What it does at present.
    #[must_use]
    pub fn power(&self) -> PropulsionPower {
        PropulsionPower::of(self.power)
    }

    /// Begins with a power.
    pub fn start(&mut self, power: &PropulsionPower) {
        self.power = power.numbers();
    }

    /// Adds a step of a size (s).
    pub fn add_step(&mut self, size: f64, step: &PropulsionStep) {
        for PowerShare { power, share } in &step.shares {
            let numbers = power.numbers();
            self.work.iter_mut().zip(numbers).for_each(|(sum, value)| *sum += size * share * value);
            self.positive_work += size * share * power.power.max(0.0);
        }
        self.power = step.end.numbers();
        if let Some(leg) = &step.leg {
            self.error.add_step(size, leg);
        }
    }

    /// The record of a time (s) with the centre of mass (m) and how the first body is turned.
    #[must_use]
    pub fn record(&self, time: f64, center: Vector3<f64>, orientation: Orientation) -> Record {
        let Self { work, positive_work, .. } = *self;
        Record { time, center, orientation, work, positive_work }
    }
}
