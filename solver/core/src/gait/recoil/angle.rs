//! `RecoilAngle`: the angle that removes a body's own angular momentum, from a table that grows.

use std::sync::{Mutex, PoisonError};

use alewife_mesh::{GaussRule, whole};

use crate::gait::error::GaitError;

/// Intervals of the table in a period.
const INTERVALS: usize = 16;

/// Gauss points of an interval.
const POINTS: usize = 8;

/// Integral over time of a rate that is periodic after some time.
#[derive(Debug)]
pub struct RecoilAngle {
    rule: GaussRule,
    /// Duration after which the rate is periodic (s), and intervals up to there.
    transient: f64,
    before: usize,
    period: f64,
    /// Filled as far as needed; its entries do not depend on when they were computed.
    table: Mutex<Vec<Interval>>,
}

/// The rates in an interval of time, and the integral before.
#[derive(Debug, Clone)]
struct Interval {
    start: f64,
    rates: Vec<f64>,
}

impl RecoilAngle {
    /// For a rate that has this period (s) after a transient (s).
    pub fn new(transient: f64, period: f64) -> Self {
        let before = whole((transient / period * INTERVALS as f64).ceil());
        let table = Mutex::new(Vec::new());
        Self { rule: GaussRule::new(POINTS), transient, before, period, table }
    }

    /// Integral of the rate from 0 to a time (s); before 0 the rate is zero.
    ///
    /// # Errors
    /// That of the rate.
    pub fn at(
        &self,
        time: f64,
        rate: impl Fn(f64) -> Result<f64, GaitError>,
    ) -> Result<f64, GaitError> {
        if time <= 0.0 {
            return Ok(0.0);
        }
        if time < self.transient {
            return self.within(time, &rate);
        }
        let periods = ((time - self.transient) / self.period).floor();
        let within = (time - self.transient - periods * self.period).clamp(0.0, self.period);
        let start = self.within(self.transient, &rate)?;
        let drift = if periods > 0.0 {
            self.within(self.transient + self.period, &rate)? - start
        } else {
            0.0
        };
        Ok(self.within(self.transient + within, &rate)? + periods * drift)
    }

    /// Start (s) and duration (s) of an interval.
    fn span(&self, index: usize) -> [f64; 2] {
        if index < self.before {
            let step = self.transient / self.before as f64;
            [step * index as f64, step]
        } else {
            let step = self.period / INTERVALS as f64;
            [self.transient + step * (index - self.before) as f64, step]
        }
    }

    /// The integral up to the end of the first period.
    fn within(
        &self,
        time: f64,
        rate: &impl Fn(f64) -> Result<f64, GaitError>,
    ) -> Result<f64, GaitError> {
        let last = self.before + INTERVALS - 1;
        let index = if time < self.transient {
            whole(time / self.transient * self.before as f64)
        } else {
            let part = (time - self.transient) / self.period * INTERVALS as f64;
            self.before + whole(part)
        };
        let index = index.min(last);
        let mut table = self.table.lock().unwrap_or_else(PoisonError::into_inner);
        while table.len() <= index {
            let [from, step] = self.span(table.len());
            let start = table.last().map_or(0.0, |interval| {
                let [_, step] = self.span(table.len() - 1);
                interval.start + step * dot(&self.rule.weights, &interval.rates)
            });
            let rates = self.rule.points.iter().map(|x| rate(from + step * x));
            let rates = rates.collect::<Result<_, GaitError>>()?;
            table.push(Interval { start, rates });
        }
        let [from, step] = self.span(index);
        let row = self.rule.up_to(((time - from) / step).clamp(0.0, 1.0));
        Ok(table[index].start + step * dot(&row, &table[index].rates))
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_periodic_rate_is_integrated_for_ever() {
        let rate = |t: f64| {
            let periodic = 0.3 + (5.0 * t).sin();
            Ok(if t < 1.7 { periodic * t / 1.7 } else { periodic })
        };
        let angle = RecoilAngle::new(1.7, std::f64::consts::TAU / 5.0);
        let after = |t: f64| 0.3 * t - (5.0 * t).cos() / 5.0;
        let ramped = |t: f64| {
            let wave = (5.0 * t).sin() / 25.0 - t * (5.0 * t).cos() / 5.0;
            (0.15 * t * t + wave) / 1.7
        };
        for time in [100.0, 0.4, 1.7, 2.9, 0.0, 17.3] {
            let exact =
                if time < 1.7 { ramped(time) } else { ramped(1.7) + after(time) - after(1.7) };
            assert!((angle.at(time, rate).unwrap() - exact).abs() < 1e-12, "{time}");
        }
    }

    /// The table keeps no interval with a rate that failed.
    #[test]
    fn a_rate_that_fails_is_an_error_until_it_no_longer_does() {
        let angle = RecoilAngle::new(0.0, 1.0);
        let failing = |t: f64| if t < 0.5 { Ok(t) } else { Err(GaitError::Midline { time: t }) };
        assert!((angle.at(0.4, failing).unwrap() - 0.08).abs() < 1e-14);
        let error = angle.at(0.9, failing).unwrap_err();
        assert!(matches!(error, GaitError::Midline { time } if (0.5..0.6).contains(&time)));
        assert!((angle.at(0.9, Ok).unwrap() - 0.405).abs() < 1e-14);
    }
}
