//! `OpenAngle`: the angle that removes a body's own angular momentum, where what the gait does later is not known yet.

use std::sync::{Mutex, PoisonError};

use alewife_mesh::GaussRule;

use crate::gait::error::GaitError;

/// Gauss points of an interval.
const POINTS: usize = 8;

/// Integral over time of a rate that later times may change.
///
/// Intervals go from kink to kink, and are no longer than a given time; the last one goes to the time that is asked
/// for. What is kept of them does not depend on when they were computed.
#[derive(Debug)]
pub struct OpenAngle {
    rule: GaussRule,
    longest: f64,
    kept: Mutex<Kept>,
}

/// Ends of intervals (s) and integrals up to there, and the kinks that were known.
#[derive(Debug, Default)]
struct Kept {
    kinks: Vec<f64>,
    ends: Vec<[f64; 2]>,
}

impl OpenAngle {
    /// With intervals of a length (s) at most.
    pub fn new(longest: f64) -> Self {
        Self { rule: GaussRule::new(POINTS), longest, kept: Mutex::default() }
    }

    /// Integral of the rate from 0 to a time (s); before 0 the rate is zero. `kinks` (s) ascend; the rate before the
    /// first one that has changed since has not.
    ///
    /// # Errors
    /// That of the rate.
    pub fn at(
        &self,
        time: f64,
        kinks: Vec<f64>,
        rate: impl Fn(f64) -> Result<f64, GaitError>,
    ) -> Result<f64, GaitError> {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.forget_changed(kinks);
        let before = kept.ends.partition_point(|[end, _]| *end <= time);
        let [mut from, mut integral] = before.checked_sub(1).map_or([0.0; 2], |nth| kept.ends[nth]);
        while from < time {
            let next = kept.kinks.partition_point(|kink| *kink <= from);
            let kink = kept.kinks.get(next).copied().unwrap_or(f64::INFINITY);
            let end = kink.min(from + self.longest);
            let to = end.min(time);
            let points = self.rule.points.iter().zip(&self.rule.weights);
            let mut sum = 0.0;
            for (point, weight) in points {
                sum += weight * rate(from + (to - from) * point)?;
            }
            integral += (to - from) * sum;
            from = to;
            if to == end {
                kept.ends.push([end, integral]);
            }
        }
        Ok(integral)
    }
}

impl Kept {
    /// Forgets what lies behind the first kink that is another one than before.
    fn forget_changed(&mut self, kinks: Vec<f64>) {
        let pairs = self.kinks.iter().zip(&kinks);
        let same = pairs.take_while(|(one, other)| one == other).count();
        let [old, new] = [&self.kinks, &kinks].map(|kinks| kinks.get(same).copied());
        let changed = old.into_iter().chain(new).fold(f64::INFINITY, f64::min);
        let valid = self.ends.partition_point(|[end, _]| *end <= changed);
        self.ends.truncate(valid);
        self.kinks = kinks;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_integral_is_that_of_the_rate_whenever_it_is_asked_for() {
        // A rate that is asked for: a jump at each kink
        let rate = |kinks: &[f64], t: f64| {
            let n = kinks.iter().filter(|kink| **kink <= t).count();
            Ok((n as f64 + 1.0) * (3.0 * t).cos())
        };
        let exact = |kinks: &[f64], t: f64| {
            let from = |t: f64, kink: f64| (t.sin_3() - kink.sin_3()).max(f64::NEG_INFINITY);
            t.sin_3()
                + kinks.iter().filter(|kink| **kink < t).map(|kink| from(t, *kink)).sum::<f64>()
        };
        let all = [0.31, 0.9, 1.7];
        let (known, late) = (OpenAngle::new(0.1), OpenAngle::new(0.1));
        let mut seen = Vec::new();
        for n in 0..=all.len() {
            let kinks = &all[..n];
            let end = all.get(n).copied().unwrap_or(2.5);
            // Beyond the next kink before it is known
            let _ = known.at(end + 0.4, kinks.to_vec(), |t| rate(kinks, t)).unwrap();
            let angle = known.at(end, kinks.to_vec(), |t| rate(kinks, t)).unwrap();
            assert!((angle - exact(kinks, end)).abs() < 1e-12, "{n}: {angle}");
            seen.push((end, angle.to_bits()));
        }
        for (end, angle) in seen {
            let again = late.at(end, all.to_vec(), |t| rate(&all, t)).unwrap();
            assert_eq!(again.to_bits(), angle, "{end}");
        }
    }

    trait Sin3 {
        fn sin_3(self) -> f64;
    }

    impl Sin3 for f64 {
        fn sin_3(self) -> f64 {
            (3.0 * self).sin() / 3.0
        }
    }
}
