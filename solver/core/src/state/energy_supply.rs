//! `EnergySupply`: the work done on fluid and bodies so far, and the speeds that what drives them gives by itself.

use serde::{Deserialize, Serialize};

/// What drives fluid and bodies, in one step of time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Drives {
    /// Work done on fluid and bodies (J); what they give away again is not subtracted.
    pub work: f64,
    /// Largest speed that is given (m/s): of sides, imposed motions, strokes and gaits.
    pub given_speed: f64,
    /// Loads on each body.
    pub loads: Vec<LoadStep>,
    /// Force per volume on the fluid, over its density (m/s2).
    pub gradient: f64,
}

/// The load on a body, without those of fluid and contact, in one step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct LoadStep {
    /// What it is (N; N/m planar), of a torque that of a force at the radius of the body.
    pub load: f64,
    /// The acceleration it gives to the body and as much fluid as it displaces (m/s2).
    pub acceleration: f64,
}

/// The loads on a body so far.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct LoadHistory {
    /// The largest (N; N/m planar).
    pub largest: f64,
    /// The speed they would have given without resistance, all along one line (m/s).
    pub free_fall: f64,
}

/// The work done on fluid and bodies so far, and what drives them.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct EnergySupply {
    /// Kinetic and elastic energy of fluid and bodies at the start (J), once it is known.
    pub initial: Option<f64>,
    /// The speed at the start (m/s), and that which elastic energy there gives.
    pub initial_speed: f64,
    /// Work since then (J).
    pub work: f64,
    /// Largest speed that was given so far (m/s).
    pub given_speed: f64,
    /// Loads on each body.
    pub loads: Vec<LoadHistory>,
    /// The largest force per volume on the fluid so far, over its density (m/s2).
    pub largest_gradient: f64,
    /// The speed it would have given the fluid without resistance (m/s).
    pub gradient_speed: f64,
}

impl EnergySupply {
    /// Adds what drives in a step of a size (s).
    pub(super) fn add(&mut self, step: f64, drives: &Drives) {
        self.work += drives.work;
        self.given_speed = self.given_speed.max(drives.given_speed);
        self.largest_gradient = self.largest_gradient.max(drives.gradient);
        self.gradient_speed += step * drives.gradient;
        self.loads.resize(drives.loads.len(), LoadHistory::default());
        for (history, now) in self.loads.iter_mut().zip(&drives.loads) {
            history.largest = history.largest.max(now.load);
            history.free_fall += step * now.acceleration;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_and_falls_add_up_and_speeds_and_loads_stay_the_largest() {
        let mut supply = EnergySupply::default();
        let drives = |work, given_speed, load| Drives {
            work,
            given_speed,
            loads: vec![LoadStep { load, acceleration: 2.0 * load }],
            gradient: load,
        };
        supply.add(0.5, &drives(1.0, 3.0, 1.0));
        supply.add(0.25, &drives(2.0, 2.0, 0.5));
        assert_eq!((supply.work, supply.given_speed, supply.largest_gradient), (3.0, 3.0, 1.0));
        assert_eq!(supply.loads, [LoadHistory { largest: 1.0, free_fall: 1.25 }]);
        assert_eq!(supply.gradient_speed, 0.625);
    }
}
