//! `Cycle`: cubic polynomials between knots over one period, over and over.

use serde::{Deserialize, Serialize};

use super::{Cubic, extent};
#[cfg(test)]
use crate::spec::number::Positive;

/// Cubic polynomials that come again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(inline))]
#[serde(deny_unknown_fields)]
pub struct Cycle {
    /// (time, value, rate) knots over one period; after the last one the first comes again.
    pub knots: Vec<[f64; 3]>,
    /// Period (s).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub period: f64,
}

impl Cycle {
    /// Value and rate at a time (s).
    #[must_use]
    pub fn at(&self, time: f64) -> [f64; 2] {
        let Some(&[start, ..]) = self.knots.first() else { return [0.0, 0.0] };
        // Without a period, which is refused elsewhere, it is what it is at first
        let past = if self.period > 0.0 { (time - start).rem_euclid(self.period) } else { 0.0 };
        let within = start + past;
        let after = self.knots.partition_point(|knot| knot[0] <= within).max(1);
        Cubic::between(self.knots[after - 1], self.knot(after)).at(within)
    }

    /// Smallest and largest value.
    #[must_use]
    pub fn range(&self) -> [f64; 2] {
        let pieces = 1..=self.knots.len();
        let turns =
            pieces.flat_map(|nth| Cubic::between(self.knots[nth - 1], self.knot(nth)).extrema());
        extent(self.knots.iter().map(|knot| knot[1]).chain(turns))
    }

    /// Its integral from time 0 to a time that is not before (s).
    #[must_use]
    pub fn integral(&self, time: f64) -> f64 {
        let Some(&[start, ..]) = self.knots.first() else { return 0.0 };
        // From the first knot on, where the pieces begin
        let from_start = |time: f64| {
            let turns = ((time - start) / self.period).floor();
            let end = start + (time - start - turns * self.period).clamp(0.0, self.period);
            turns * self.within(start + self.period) + self.within(end)
        };
        from_start(time) - from_start(0.0)
    }

    /// The integral from the first knot to a time within the period after it (s).
    fn within(&self, end: f64) -> f64 {
        let pieces = (1..=self.knots.len()).map(|nth| {
            let (before, after) = (self.knots[nth - 1], self.knot(nth));
            let to = after[0].min(end);
            if to <= before[0] {
                return 0.0;
            }
            let piece = Cubic::between(before, after);
            let at = |time: f64| piece.at(time)[0];
            // Simpson's rule, exact of cubic polynomials
            (to - before[0]) / 6.0 * (at(before[0]) + 4.0 * at(0.5 * (before[0] + to)) + at(to))
        });
        pieces.sum()
    }

    /// A knot; behind the last one the first again.
    fn knot(&self, nth: usize) -> [f64; 3] {
        self.knots.get(nth).copied().unwrap_or_else(|| {
            let [time, value, rate] = self.knots.first().copied().unwrap_or_default();
            [time + self.period, value, rate]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Cycle;

    #[test]
    fn it_comes_again_with_its_rate_and_integral() {
        let knots = vec![[-0.2, 0.0, 3.0], [0.5, 1.0, -1.0], [1.1, -2.0, 0.5]];
        let cycle = Cycle { knots: knots.clone(), period: 2.0 };
        for [time, value, rate] in knots {
            for turn in [0.0, 2.0, 14.0, -6.0] {
                let [v, r] = cycle.at(time + turn + 1e-13);
                assert!((v - value).abs() < 1e-11 && (r - rate).abs() < 1e-11, "{time} {turn}");
            }
        }
        for time in [0.1, 0.9, 1.79, 1.81, 3.3, 7.7] {
            let [value, rate] = cycle.at(time);
            let slope = (cycle.at(time + 1e-6)[0] - cycle.at(time - 1e-6)[0]) / 2e-6;
            assert!((rate - slope).abs() < 1e-6, "{time}: {rate} {slope}");
            let change = (cycle.integral(time + 1e-6) - cycle.integral(time - 1e-6)) / 2e-6;
            assert!((value - change).abs() < 1e-6, "{time}: {value} {change}");
            assert!((cycle.at(time + 4.0)[0] - value).abs() < 1e-12);
        }
        assert_eq!(cycle.integral(0.0), 0.0);
        let values = (0..4000).map(|nth| cycle.at(f64::from(nth) / 1000.0)[0]);
        let [low, high] = super::extent(values);
        let [least, most] = cycle.range();
        assert!((low - least).abs() < 1e-5 && (high - most).abs() < 1e-5, "{low} {high}");
    }
}
