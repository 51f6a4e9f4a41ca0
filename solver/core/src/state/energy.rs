//! `EnergyBalance`: where the work of the bodies goes: dissipation and kinetic energy.

use serde::{Deserialize, Serialize};

/// Records after the first one before a balance begins: a velocity that jumps at the start is an impulse,
/// whose force is in no record, or in the first two with both signs.
const IMPULSE_RECORDS: usize = 2;

/// Fraction of what has been exchanged that a step may add for a balance to mean something.
pub(super) const LARGEST_PART: f64 = 0.1;

/// The turnover that means something, over the largest kinetic energy so far.
const MEANINGFUL: f64 = 1e-2;

/// Work and dissipation that are rounding, over the dissipation of such a flow if its velocity varied
/// over the size of the domain.
const NEGLIGIBLE: f64 = 1e-9;

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
    /// Dissipation if the velocity varied over the size of the domain (W).
    pub dissipation_scale: f64,
}

impl EnergyRecord {
    /// Work or dissipation, whichever is larger (W).
    fn turnover(&self) -> f64 {
        self.power.abs().max(self.dissipation)
    }
}

/// Where the work of the bodies went, since the first record.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct EnergyBalance {
    /// The first record, and the last one.
    ends: Option<[EnergyRecord; 2]>,
    /// Records so far.
    records: usize,
    /// Work without dissipation and change of kinetic energy so far (J).
    defect: f64,
    /// Work, or dissipation where that is larger, so far (J).
    turnover: f64,
    /// The largest kinetic energy so far (J).
    largest_kinetic_energy: f64,
}

impl EnergyBalance {
    /// Adds a record; the defect over the turnover, of the present rates where the flow has no memory.
    ///
    /// Not a number while there is no turnover to speak of. What velocities that jump at the start do
    /// at once is the kinetic energy they leave.
    pub fn add(&mut self, has_memory: bool, now: EnergyRecord) -> f64 {
        if !has_memory {
            let turnover = now.turnover();
            let is_rounding = turnover <= NEGLIGIBLE * now.dissipation_scale;
            return if is_rounding { f64::NAN } else { (now.power - now.dissipation) / turnover };
        }
        let [first, before] = self.ends.unwrap_or([now; 2]);
        self.ends = Some([first, now]);
        self.records += 1;
        self.largest_kinetic_energy = self.largest_kinetic_energy.max(now.kinetic_energy);
        let change = now.kinetic_energy - before.kinetic_energy;
        if self.records <= IMPULSE_RECORDS + 1 {
            self.turnover = (now.kinetic_energy - first.kinetic_energy).max(0.0);
            return f64::NAN;
        }
        let half = 0.5 * (now.time - before.time);
        let supply = half * (now.power - now.dissipation + before.power - before.dissipation);
        let part = half * (now.turnover() + before.turnover());
        self.defect += supply - change;
        self.turnover += part;
        let is_meaningful = part <= LARGEST_PART * self.turnover
            && self.turnover > MEANINGFUL * self.largest_kinetic_energy;
        if is_meaningful { self.defect / self.turnover } else { f64::NAN }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fluid in a box that is set in motion at once and kept there against friction.
    fn record(time: f64, power: f64) -> EnergyRecord {
        let kinetic_energy = if time > 0.0 { 0.5 } else { 0.0 };
        EnergyRecord { time, power, dissipation: 0.2, kinetic_energy, dissipation_scale: 1.0 }
    }

    /// The work of an impulse is what it leaves, whatever powers the first pieces of a step had.
    #[test]
    fn a_velocity_that_is_switched_on_is_counted() {
        let mut balance = EnergyBalance::default();
        let spikes = [0.0, 400.0, -200.0];
        let start: Vec<f64> = spikes
            .into_iter()
            .enumerate()
            .map(|(nth, power)| balance.add(true, record(nth as f64 * 1e-3, power)))
            .collect();
        assert!(start.iter().all(|defect| defect.is_nan()), "{start:?}");
        let later: Vec<f64> =
            (1..=50).map(|n| balance.add(true, record(f64::from(n) * 0.1, 0.2))).collect();
        // The spike of the second piece belongs to the impulse
        let spike = 0.5 * 0.098 * -200.2;
        assert!(balance.turnover > 0.5 && later[49].is_finite());
        assert!((balance.defect - spike).abs() < 1e-9, "{} {spike}", balance.defect);
    }

    #[test]
    fn there_is_no_defect_before_it_means_something() {
        let mut balance = EnergyBalance::default();
        // A body that is carried along: much kinetic energy, and hardly any work
        let carried = |n: u32| EnergyRecord {
            time: f64::from(n),
            power: 1.1e-5,
            dissipation: 1e-5,
            kinetic_energy: 1.0,
            dissipation_scale: 1.0,
        };
        let defects: Vec<f64> = (0..2000).map(|n| balance.add(true, carried(n))).collect();
        assert!(defects[..900].iter().all(|defect| defect.is_nan()));
        assert!((defects[1999] - 0.1 / 1.1).abs() < 1e-3, "{}", defects[1999]);
        let rounding =
            EnergyRecord { power: 1e-14, dissipation: -1e-15, kinetic_energy: 0.0, ..carried(0) };
        assert!(balance.add(false, rounding).is_nan());
        let creeping = EnergyRecord { power: 1.0, dissipation: 0.9, ..rounding };
        assert!((balance.add(false, creeping) - 0.1).abs() < 1e-14);
    }
}
