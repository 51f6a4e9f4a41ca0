//! `MomentumBalance`: whether the momentum of the fluid and of each body changes by the forces on them.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::energy::LARGEST_PART;

/// Records before the balance begins: after a velocity that jumps at the start forces fall like
/// t^-1/2, which is not resolved by a few steps, and leaves 1e-2 of all momentum.
const START_RECORDS: usize = 20;

/// Momentum exchanged that is rounding, over the largest there could be at the kinetic energy so far.
const NEGLIGIBLE: f64 = 1e-6;

/// A part of the system: what momentum it has, and the force on it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Part {
    /// Momentum (kg m/s).
    pub momentum: Vector3<f64>,
    /// Force (N), but for contact.
    pub force: Vector3<f64>,
    /// Impulse of contact since the start (N s).
    pub contact: Vector3<f64>,
}

/// Momentum of the fluid and of the bodies at one time.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct MomentumRecord {
    /// Time (s).
    pub time: f64,
    /// The fluid, with the force of sides, bodies and mean flow.
    pub fluid: Part,
    /// The bodies, along directions in which they are free, with all forces.
    pub bodies: Vec<Part>,
    /// Rate at which momentum is exchanged (N).
    pub exchange: f64,
    /// The largest momentum of the fluid at its kinetic energy (kg m/s).
    pub scale: f64,
}

impl MomentumRecord {
    fn parts(&self) -> impl Iterator<Item = &Part> {
        std::iter::once(&self.fluid).chain(&self.bodies)
    }
}

/// Momentum of the fluid and of each body against the impulses of the forces on them.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct MomentumBalance {
    /// The last record.
    last: Option<MomentumRecord>,
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
    /// Adds a record; the sum of the defects of fluid and bodies over what has been exchanged.
    ///
    /// Not a number while that is too little.
    pub fn add(&mut self, now: MomentumRecord) -> f64 {
        self.records += 1;
        self.scale = self.scale.max(now.scale);
        self.defects.resize(now.bodies.len() + 1, Vector3::zeros());
        let before = self.last.replace(now.clone());
        let Some(before) = before.filter(|_| self.records > START_RECORDS) else {
            return f64::NAN;
        };
        let half = 0.5 * (now.time - before.time);
        for (defect, (now, before)) in self.defects.iter_mut().zip(now.parts().zip(before.parts()))
        {
            *defect += (now.force + before.force) * half + (now.contact - before.contact)
                - (now.momentum - before.momentum);
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

    /// A body that is pulled through fluid, which takes its drag; momenta follow from the forces.
    fn record(time: f64, density_error: f64) -> MomentumRecord {
        let drag = 1.0 - (-time).exp();
        let body = Vector3::new(1.0 - drag, 0.0, 0.0);
        let fluid = Vector3::new(drag, 0.0, 0.0);
        let lost = |force: f64| time * force + (-time).exp() - 1.0;
        MomentumRecord {
            time,
            fluid: Part {
                momentum: Vector3::new(lost(1.0) * (1.0 + density_error), 0.0, 0.0),
                force: fluid,
                contact: Vector3::zeros(),
            },
            bodies: vec![Part {
                momentum: Vector3::new(drag, 0.0, 0.0),
                force: body,
                contact: Vector3::zeros(),
            }],
            exchange: body.norm(),
            scale: 1.0,
        }
    }

    #[test]
    fn forces_balance_momenta_to_second_order_and_errors_show() {
        let at = |step: f64, error: f64| {
            let mut balance = MomentumBalance::default();
            let records = (0..).map(|n| f64::from(n) * step).take_while(|time| *time < 2.0);
            records.fold(f64::NAN, |_, time| balance.add(record(time, error)))
        };
        let (coarse, fine) = (at(0.02, 0.0), at(0.01, 0.0));
        assert!(coarse < 1e-4 && fine < 0.27 * coarse, "{coarse} {fine}");
        assert!(at(0.01, 0.1) > 0.05, "{}", at(0.01, 0.1));
        let mut start = MomentumBalance::default();
        assert!((0..3).all(|n| start.add(record(f64::from(n), 0.0)).is_nan()));
    }
}
