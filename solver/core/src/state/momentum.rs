//! `MomentumBalance`: whether the momentum of the fluid and of each body changes by the forces on them.
//!
//! What a force gives in a step is taken as the backward difference has it: the force of fluid on a body that another one hits
//! jumps within a step, and no rule that takes it for smooth gives what the step has made of it.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::energy::LARGEST_PART;
use crate::time::Bdf;

/// Records before the balance begins: after a velocity that jumps at the start forces fall like
/// t^-1/2, which is not resolved by a few steps, and leaves 1e-2 of all momentum.
const START_RECORDS: usize = 20;

/// Momentum exchanged that is rounding, over the largest there could be at the kinetic energy so far.
const NEGLIGIBLE: f64 = 1e-6;

/// The impulses of the forces on fluid and bodies, the fluid first (N s).
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
struct Impulses {
    /// In the last step.
    last: Vec<Vector3<f64>>,
    /// Since the start.
    sums: Vec<Vector3<f64>>,
}

impl Impulses {
    /// Adds those of forces at the end of a step (N).
    fn add(&mut self, forces: &[Vector3<f64>], bdf: &Bdf) {
        for own in [&mut self.last, &mut self.sums] {
            own.resize(forces.len(), Vector3::zeros());
        }
        for ((last, sum), force) in self.last.iter_mut().zip(&mut self.sums).zip(forces) {
            *last = bdf.increment(*force, *last);
            *sum += *last;
        }
    }
}

/// Momentum of the fluid and of the bodies at one time.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct MomentumRecord {
    /// Time (s).
    pub time: f64,
    /// Momenta (kg m/s) of the fluid, and of the bodies along directions in which they are free.
    pub momenta: Vec<Vector3<f64>>,
    /// Rate at which momentum is exchanged (N).
    pub exchange: f64,
    /// The largest momentum of the fluid at its kinetic energy (kg m/s).
    pub scale: f64,
}

/// Momentum of the fluid and of each body against the impulses of the forces on them.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct MomentumBalance {
    /// Those of all forces so far.
    impulses: Impulses,
    /// The last record.
    last: Option<MomentumRecord>,
    /// Impulses at the last record.
    impulses_then: Vec<Vector3<f64>>,
    /// Records so far.
    records: usize,
    /// Impulses less the change of momentum so far, of fluid and bodies (N s).
    defects: Vec<Vector3<f64>>,
    /// Momentum that was exchanged so far (N s).
    turnover: f64,
    /// The largest of all scales so far (kg m/s).
    scale: f64,
}

impl MomentumBalance {
    /// Adds the impulses of forces (N) on the fluid and on the bodies at the end of a step.
    pub fn add_forces(&mut self, forces: &[Vector3<f64>], bdf: &Bdf) {
        self.impulses.add(forces, bdf);
    }

    /// Adds a record; the sum of the defects of fluid and bodies over what has been exchanged.
    ///
    /// Not a number while that is too little.
    pub fn add(&mut self, now: MomentumRecord) -> f64 {
        self.records += 1;
        self.scale = self.scale.max(now.scale);
        let n_parts = now.momenta.len();
        self.defects.resize(n_parts, Vector3::zeros());
        let before = self.last.replace(now.clone());
        let mut impulses = self.impulses.sums.clone();
        impulses.resize(n_parts, Vector3::zeros());
        let impulses_before = std::mem::replace(&mut self.impulses_then, impulses.clone());
        let Some(before) = before.filter(|_| self.records > START_RECORDS) else {
            return f64::NAN;
        };
        let half = 0.5 * (now.time - before.time);
        let gains = impulses.iter().zip(&impulses_before).map(|(now, before)| now - before);
        let changes = now.momenta.iter().zip(&before.momenta).map(|(now, before)| now - before);
        for (defect, (gain, change)) in self.defects.iter_mut().zip(gains.zip(changes)) {
            *defect += gain - change;
        }
        let part = half * (now.exchange + before.exchange);
        self.turnover += part;
        let is_meaningful =
            part <= LARGEST_PART * self.turnover && self.turnover > NEGLIGIBLE * self.scale;
        if !is_meaningful {
            return f64::NAN;
        }
        self.defects.iter().map(|defect| defect.norm()).sum::<f64>() / self.turnover
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A body that is pulled through fluid, which takes its drag, in steps of the backward difference. From a half of the time
    /// on the drag is ten times as large. The momentum of the fluid is its own but for an error of its density.
    fn defect(steps: u32, density_error: f64) -> f64 {
        let step = 2.0 / f64::from(steps);
        let (mut balance, mut last) = (MomentumBalance::default(), f64::NAN);
        let mut momenta = [[Vector3::zeros(); 2]; 2];
        for n in 0..steps {
            let time = f64::from(n) * step;
            let drag = if time < 1.0 { 1.0 - (-time).exp() } else { 10.0 };
            let bdf = if n < 2 { Bdf::first_order(step) } else { Bdf::second_order(step, step) };
            let forces = [drag, 1.0 - drag].map(|force| Vector3::new(force, 0.0, 0.0));
            if n > 0 {
                balance.add_forces(&forces, &bdf);
                for ([now, before], force) in momenta.iter_mut().zip(forces) {
                    let next = bdf.integrate(force, *now, *before);
                    (*before, *now) = (*now, next);
                }
            }
            last = balance.add(MomentumRecord {
                time,
                momenta: vec![momenta[0][0] * (1.0 + density_error), momenta[1][0]],
                exchange: forces[1].norm(),
                scale: 1.0,
            });
        }
        last
    }

    #[test]
    fn forces_that_jump_balance_momenta_and_errors_show() {
        for steps in [100, 200] {
            assert!(defect(steps, 0.0) < 1e-13, "{}", defect(steps, 0.0));
        }
        assert!(defect(200, 0.1) > 0.05, "{}", defect(200, 0.1));
    }

    #[test]
    fn the_balance_begins_after_some_records() {
        let mut start = MomentumBalance::default();
        let record = |time| MomentumRecord {
            time,
            momenta: vec![Vector3::zeros()],
            exchange: 1.0,
            scale: 1.0,
        };
        assert!((0..3).all(|n| start.add(record(f64::from(n))).is_nan()));
    }
}
