//! What swimmers did over the last cycle: displacement, work, efficiency, and how much that still changes.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::body::Orientation;

/// A swimmer at one time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Time (s).
    pub time: f64,
    /// Centre of mass (m).
    pub center: Vector3<f64>,
    /// How its first body is turned.
    pub orientation: Orientation,
    /// Time integrals of the numbers of a [`PropulsionPower`](crate::coupling::PropulsionPower) (J; N s for thrust and drag).
    pub work: [f64; 6],
    /// Time integral of the power where it is positive (J).
    pub positive_work: f64,
}

/// The last two cycles of a swimmer.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Cycles {
    /// Records of the last two cycles, ascending in time.
    records: Vec<Record>,
}

/// Averages over a cycle; not a number before its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CycleMeans {
    /// Displacement of the centre of mass (m).
    pub displacement: Vector3<f64>,
    /// Angle turned (rad).
    pub angle: f64,
    /// Its length over the period (m/s).
    pub speed: f64,
    /// Mean rate of work on the fluid (W).
    pub power: f64,
    /// Positive work over the length of the displacement (J/m).
    pub cost_of_transport: f64,
    /// Mean of thrust times speed over itself and the mean power of the shape.
    pub efficiency: f64,
    /// Power to tow it at its mean speed over its mean power (@lighthill1952).
    pub lighthill_efficiency: f64,
    /// Change of the displacement since the cycle before, over its length.
    pub drift: f64,
}

/// Records whose times differ by less than this part of the period are of the same time.
const SAME: f64 = 1e-6;

impl Cycles {
    /// Adds a record and drops what is more than two periods (s) old.
    pub fn push(&mut self, record: Record, period: f64) {
        // A step that is repeated replaces the one before
        self.records.retain(|known| known.time < record.time - SAME * period);
        self.records.push(record);
        let oldest = record.time - 2.0 * period * (1.0 + SAME);
        let first = self.records.partition_point(|known| known.time < oldest);
        self.records.drain(..first.saturating_sub(2));
    }

    /// How far the records are from the last one, at most (m).
    #[must_use]
    pub fn extent(&self) -> f64 {
        let Some(last) = self.records.last() else { return 0.0 };
        let distance = |record: &Record| (record.center - last.center).norm();
        self.records.iter().map(distance).fold(0.0, f64::max)
    }

    /// The record of a time, between records by a parabola through three of them.
    fn at(&self, time: f64, period: f64) -> Option<Record> {
        let near = SAME * period;
        if let Some(same) = self.records.iter().find(|known| (known.time - time).abs() <= near) {
            return Some(*same);
        }
        let after = self.records.partition_point(|known| known.time < time);
        if after == 0 || after == self.records.len() || self.records.len() < 3 {
            return None;
        }
        let first = (after - 1).min(self.records.len() - 3);
        let three = &self.records[first..first + 3];
        let weight = |nth: usize| {
            let others = (0..3).filter(|other| *other != nth);
            let factor =
                |other: usize| (time - three[other].time) / (three[nth].time - three[other].time);
            others.map(factor).product::<f64>()
        };
        let weights = [weight(0), weight(1), weight(2)];
        let mix = |value: &dyn Fn(&Record) -> f64| {
            three.iter().zip(weights).map(|(record, weight)| weight * value(record)).sum()
        };
        Some(Record {
            time,
            center: Vector3::from_fn(|axis, _| mix(&|record| record.center[axis])),
            orientation: Orientation::mean([0, 1, 2].map(|nth| three[nth].orientation), weights),
            work: std::array::from_fn(|i| mix(&|record| record.work[i])),
            positive_work: mix(&|record| record.positive_work),
        })
    }

    /// Averages over the cycle that ends with the last record.
    #[must_use]
    pub fn means(&self, period: f64, resistance: Option<f64>) -> CycleMeans {
        let nothing = CycleMeans {
            displacement: Vector3::repeat(f64::NAN),
            angle: f64::NAN,
            speed: f64::NAN,
            power: f64::NAN,
            cost_of_transport: f64::NAN,
            efficiency: f64::NAN,
            lighthill_efficiency: f64::NAN,
            drift: f64::NAN,
        };
        let Some(now) = self.records.last() else { return nothing };
        let Some(before) = self.at(now.time - period, period) else { return nothing };
        let displacement = now.center - before.center;
        let length = displacement.norm();
        let mean = |nth: usize| (now.work[nth] - before.work[nth]) / period;
        let [power, shape_power, .., thrust_power] = std::array::from_fn::<f64, 6, _>(mean);
        let speed = length / period;
        let drift = self.at(now.time - 2.0 * period, period).map_or(f64::NAN, |earlier| {
            (displacement - (before.center - earlier.center)).norm() / length
        });
        CycleMeans {
            displacement,
            angle: now.orientation.angle_from(&before.orientation),
            speed,
            power,
            cost_of_transport: (now.positive_work - before.positive_work) / length,
            efficiency: thrust_power / (thrust_power + shape_power),
            lighthill_efficiency: resistance
                .map_or(f64::NAN, |force| force * speed * speed / power),
            drift,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_are_those_of_the_last_cycle_also_between_records() {
        for step in [0.25, 0.3] {
            let mut cycles = Cycles::default();
            let period = 2.0;
            for n in 0..40 {
                let time = f64::from(n) * step;
                let center = Vector3::new(0.3 * time, 0.4 * time, 0.0);
                let orientation = Orientation::Planar(0.1 * time * time);
                let work = [2.0 * time, time, 0.0, 0.0, 0.0, 3.0 * time];
                let positive_work = 2.5 * time;
                let record = Record { time, center, orientation, work, positive_work };
                cycles.push(record, period);
            }
            let now = 39.0 * step;
            let means = cycles.means(period, Some(4.0));
            assert!((means.speed - 0.5).abs() < 1e-12);
            assert!((means.angle - 0.1 * period * (2.0 * now - period)).abs() < 1e-11);
            assert!((means.power - 2.0).abs() < 1e-12);
            assert!((means.efficiency - 0.75).abs() < 1e-12);
            assert!((means.cost_of_transport - 5.0).abs() < 1e-11);
            assert!((means.lighthill_efficiency - 0.5).abs() < 1e-11);
            assert!(means.drift < 1e-12);
            assert!(cycles.records.len() as f64 <= 2.0 * period / step + 4.0);
        }
        let mut short = Cycles::default();
        let center = Vector3::zeros();
        let orientation = Orientation::Planar(0.0);
        let record = Record { time: 0.0, center, orientation, work: [0.0; 6], positive_work: 0.0 };
        short.push(record, 1.0);
        assert!(short.means(1.0, None).speed.is_nan());
    }
}
