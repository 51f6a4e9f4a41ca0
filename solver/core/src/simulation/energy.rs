//! `EnergyBalance`: where the work of the bodies goes: dissipation and kinetic energy.

use serde::{Deserialize, Serialize};

/// Powers and energies at one time.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct EnergyRecord {
    /// Time (s).
    pub time: f64,
    /// Rate of work of the bodies on the fluid (W).
    pub power: f64,
    /// Dissipation (W).
    pub dissipation: f64,
    /// Kinetic energy of the fluid (J).
    pub kinetic_energy: f64,
}

/// Where the work of the bodies went, since the first record.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct EnergyBalance {
    /// The last record.
    last: Option<EnergyRecord>,
    /// Work without dissipation and change of kinetic energy so far (J).
    defect: f64,
    /// Work, or dissipation where that is larger, so far (J).
    turnover: f64,
}

impl EnergyBalance {
    /// Adds a record; the defect over the turnover, of the present rates where the flow has no memory.
    pub fn add(&mut self, has_memory: bool, now: EnergyRecord) -> f64 {
        let EnergyRecord { time, power, dissipation, kinetic_energy } = now;
        let last = self.last.replace(now);
        if !has_memory {
            return (power - dissipation) / power.abs().max(dissipation);
        }
        if let Some(before) = last {
            let half = 0.5 * (time - before.time);
            let change = kinetic_energy - before.kinetic_energy;
            self.defect +=
                half * (power - dissipation + before.power - before.dissipation) - change;
            self.turnover +=
                half * (power.abs().max(dissipation) + before.power.abs().max(before.dissipation));
        }
        if self.turnover > 0.0 { self.defect / self.turnover } else { 0.0 }
    }
}
