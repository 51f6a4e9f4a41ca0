//! How a time series becomes one number: the statistics of `[[reference]]`.
//!
//! A series is known at the steps of a run only. Between them it is taken as a parabola where a
//! place or an extremum is wanted, and as straight lines where it is averaged.

use thiserror::Error;

use crate::case::{Case, Reference, Statistic};
use crate::simulation::Series;

/// Part of the range a series must go below its mean before it crosses it again: less is noise.
const HYSTERESIS: f64 = 0.05;

/// Largest spread of the lengths of periods, over their mean, of a periodic series.
const REGULARITY: f64 = 0.05;

/// Why a number cannot be taken from a run.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum StatisticError {
    /// The run has no such column.
    #[error("the run has no quantity `{0}`")]
    UnknownQuantity(String),
    /// The window holds no step.
    #[error("no step lies in the window from {start} to {end}; widen statistics.window")]
    EmptyWindow {
        /// Start (s).
        start: f64,
        /// End (s).
        end: f64,
    },
    /// The run was not computed at that time.
    #[error("the run has no value at time {time}: it reaches from {start} to {end}")]
    OutsideRun {
        /// The time asked for (s).
        time: f64,
        /// Start of the run (s).
        start: f64,
        /// End of the run (s).
        end: f64,
    },
    /// The series does not repeat itself often enough.
    #[error(
        "`{quantity}` crosses its mean upwards {crossings} times in the window; a period takes two: \
         run longer or widen statistics.window"
    )]
    NoPeriod {
        /// Name of the series.
        quantity: String,
        /// Crossings found.
        crossings: usize,
    },
    /// Something the statistic needs is not in the case.
    #[error("the statistic needs {0}")]
    Missing(&'static str),
}

/// Name of a statistic in case files.
#[must_use]
pub fn statistic_name(statistic: Statistic) -> &'static str {
    match statistic {
        Statistic::Final => "final",
        Statistic::At => "at",
        Statistic::Max => "max",
        Statistic::Min => "min",
        Statistic::Mean => "mean",
        Statistic::Rms => "rms",
        Statistic::Strouhal => "strouhal",
        Statistic::HalfPeriodAfterMax => "half-period-after-max",
    }
}

/// The number a reference is held against: its statistic of the run, divided by `per`.
///
/// # Errors
/// [`StatisticError`] when the run does not hold what the statistic needs.
pub fn measured_value(
    series: &Series,
    case: &Case,
    reference: &Reference,
) -> Result<f64, StatisticError> {
    let whole = curve(series, &reference.quantity)?;
    let window = whole.window(case.statistics.window)?;
    let value = match reference.statistic {
        Statistic::Final => whole.last(),
        Statistic::At => {
            let time = reference.at.ok_or(StatisticError::Missing("a time, `at`"))?;
            whole.value_at(time)?
        }
        Statistic::Max => window.largest(1.0).1,
        Statistic::Min => window.largest(-1.0).1,
        Statistic::Mean => window.mean(),
        Statistic::Rms => window.squared().mean().sqrt(),
        Statistic::Strouhal => {
            let scales = case.scales.ok_or(StatisticError::Missing("[scales]"))?;
            scales.length / (scales.velocity * window.period(&reference.quantity)?)
        }
        Statistic::HalfPeriodAfterMax => {
            let name = case.statistics.phase_of.as_deref();
            let name = name.ok_or(StatisticError::Missing("statistics.phase_of"))?;
            let phase = curve(series, name)?.window(case.statistics.window)?;
            let half_period = 0.5 * phase.period(name)?;
            let last = whole.times.last().copied().unwrap_or(0.0) - half_period;
            let (time, _) = phase.until(last)?.largest(1.0);
            whole.value_at(time + half_period)?
        }
    };
    Ok(value / reference.per)
}

/// A column of a series with its times.
#[derive(Debug, Clone)]
struct Curve {
    times: Vec<f64>,
    values: Vec<f64>,
}

fn curve(series: &Series, name: &str) -> Result<Curve, StatisticError> {
    let values =
        series.column(name).ok_or_else(|| StatisticError::UnknownQuantity(name.to_owned()))?;
    let curve = Curve { times: series.times.clone(), values };
    if curve.times.is_empty() {
        return Err(StatisticError::EmptyWindow { start: 0.0, end: 0.0 });
    }
    Ok(curve)
}

impl Curve {
    /// The steps within a window, which is never empty.
    fn window(&self, window: Option<[f64; 2]>) -> Result<Self, StatisticError> {
        let Some([start, end]) = window else { return Ok(self.clone()) };
        let rounding = 1e-9 * (end - start).abs();
        let (times, values): (Vec<f64>, Vec<f64>) = self
            .times
            .iter()
            .zip(&self.values)
            .filter(|(time, _)| (start - rounding..=end + rounding).contains(*time))
            .unzip();
        if times.is_empty() {
            return Err(StatisticError::EmptyWindow { start, end });
        }
        Ok(Self { times, values })
    }

    fn until(&self, end: f64) -> Result<Self, StatisticError> {
        self.window(Some([self.times[0], end]))
    }

    fn last(&self) -> f64 {
        self.values[self.values.len() - 1]
    }

    fn squared(&self) -> Self {
        Self {
            times: self.times.clone(),
            values: self.values.iter().map(|value| value * value).collect(),
        }
    }

    /// Value at a time, by the parabola through the three nearest steps.
    fn value_at(&self, time: f64) -> Result<f64, StatisticError> {
        let n = self.times.len();
        let (start, end) = (self.times[0], self.times[n - 1]);
        let rounding = 1e-9 * (end - start);
        if !(start - rounding..=end + rounding).contains(&time) {
            return Err(StatisticError::OutsideRun { time, start, end });
        }
        if n < 3 {
            let nearest = usize::from(n == 2 && (time - start) > (end - time));
            return Ok(self.values[nearest]);
        }
        let after = self.times.partition_point(|step| *step < time).clamp(1, n - 1);
        let nearer =
            if time - self.times[after - 1] < self.times[after] - time { after - 1 } else { after };
        Ok(self.parabola(nearer.clamp(1, n - 2)).value(time))
    }

    /// The parabola through a step and its neighbours.
    fn parabola(&self, middle: usize) -> Parabola {
        let time = |i: usize| self.times[i] - self.times[middle];
        let (before, after) = (time(middle - 1), time(middle + 1));
        let here = self.values[middle];
        let (down, up) =
            ((self.values[middle - 1] - here) / before, (self.values[middle + 1] - here) / after);
        let bend = (up - down) / (after - before);
        Parabola { time: self.times[middle], value: here, slope: up - bend * after, bend }
    }

    /// Time and value of the largest value times `sign`, refined by a parabola.
    fn largest(&self, sign: f64) -> (f64, f64) {
        let mut best = 0;
        for i in 1..self.values.len() {
            if sign * self.values[i] > sign * self.values[best] {
                best = i;
            }
        }
        if best == 0 || best + 1 == self.values.len() {
            return (self.times[best], self.values[best]);
        }
        let parabola = self.parabola(best);
        if parabola.bend == 0.0 {
            return (self.times[best], self.values[best]);
        }
        let top = parabola.time - 0.5 * parabola.slope / parabola.bend;
        (top, parabola.value(top))
    }

    /// Time average: over whole periods where the series is periodic, else over all of it.
    fn mean(&self) -> f64 {
        let crossings = self.mean_crossings();
        let lengths: Vec<f64> = crossings.windows(2).map(|pair| pair[1] - pair[0]).collect();
        if let ([first, .., last], true) = (crossings.as_slice(), lengths.len() > 1) {
            let mean = (last - first) / lengths.len() as f64;
            if lengths.iter().all(|length| (length - mean).abs() <= REGULARITY * mean) {
                return self.average(*first, *last);
            }
        }
        self.average(self.times[0], self.times[self.times.len() - 1])
    }

    /// Average of straight lines between the steps from one time to another.
    fn average(&self, start: f64, end: f64) -> f64 {
        if end <= start {
            return self.last();
        }
        let mut integral = 0.0;
        for i in 1..self.times.len() {
            let (a, b) = (self.times[i - 1], self.times[i]);
            let (from, to) = (a.max(start), b.min(end));
            if to > from {
                let slope = (self.values[i] - self.values[i - 1]) / (b - a);
                let middle = self.values[i - 1] + slope * (0.5 * (from + to) - a);
                integral += middle * (to - from);
            }
        }
        integral / (end - start)
    }

    /// Length of a period: the mean distance of upward crossings of the mean.
    fn period(&self, name: &str) -> Result<f64, StatisticError> {
        let crossings = self.mean_crossings();
        match crossings.as_slice() {
            [first, .., last] => Ok((last - first) / (crossings.len() - 1) as f64),
            _ => Err(StatisticError::NoPeriod {
                quantity: name.to_owned(),
                crossings: crossings.len(),
            }),
        }
    }

    /// Times at which the series rises through its mean over whole periods.
    fn mean_crossings(&self) -> Vec<f64> {
        let rough = self.average(self.times[0], self.times[self.times.len() - 1]);
        match self.crossings(rough).as_slice() {
            [first, .., last] => self.crossings(self.average(*first, *last)),
            few => few.to_vec(),
        }
    }

    fn crossings(&self, level: f64) -> Vec<f64> {
        let (low, high) = self
            .values
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)));
        let margin = HYSTERESIS * (high - low);
        let mut found = Vec::new();
        let mut was_below = false;
        for i in 0..self.values.len() {
            was_below |= self.values[i] < level - margin;
            if was_below && i > 0 && self.values[i] >= level {
                let (before, after) = (self.values[i - 1], self.values[i]);
                let part = (level - before) / (after - before);
                found.push(self.times[i - 1] + part * (self.times[i] - self.times[i - 1]));
                was_below = false;
            }
        }
        found
    }
}

/// value + slope (t - time) + bend (t - time)^2.
#[derive(Debug, Clone, Copy)]
struct Parabola {
    time: f64,
    value: f64,
    slope: f64,
    bend: f64,
}

impl Parabola {
    fn value(&self, time: f64) -> f64 {
        let s = time - self.time;
        self.value + s * (self.slope + s * self.bend)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    const CASE: &str = r#"
        title = "t"
        geometry = "planar"
        fluid = { model = "stokes", viscosity = 1.0 }
        domain = { disc = { radius = 1.0 } }
        mesh = { size = 1.0 }
        time = { steady = {} }
        scales = { length = 0.1, velocity = 2.0 }
        statistics = { phase_of = "b.lift" }
    "#;

    fn series(dt: f64, n: usize, columns: &[(&str, &dyn Fn(f64) -> f64)]) -> Series {
        let times: Vec<f64> = (0..=n).map(|i| i as f64 * dt).collect();
        Series {
            names: columns.iter().map(|(name, _)| (*name).to_owned()).collect(),
            rows: times
                .iter()
                .map(|time| columns.iter().map(|(_, value)| value(*time)).collect())
                .collect(),
            times,
        }
    }

    fn value(
        series: &Series,
        quantity: &str,
        statistic: Statistic,
        window: Option<[f64; 2]>,
    ) -> Result<f64, StatisticError> {
        let mut case = Case::parse("t.toml", CASE, &[]).unwrap().case;
        case.statistics.window = window;
        let reference = Reference {
            quantity: quantity.to_owned(),
            statistic,
            at: Some(0.33),
            value: 1.0,
            per: 1.0,
            relative: Some(0.1),
            absolute: None,
            source: "test".to_owned(),
            note: None,
        };
        measured_value(series, &case, &reference)
    }

    #[test]
    fn a_parabola_is_met_exactly_between_steps() {
        let arch = series(0.1, 10, &[("q", &|t| 3.0 - (t - 0.47) * (t - 0.47))]);
        let of = |statistic| value(&arch, "q", statistic, None).unwrap();
        assert!((of(Statistic::Max) - 3.0).abs() < 1e-13);
        assert!((of(Statistic::At) - (3.0 - 0.14 * 0.14)).abs() < 1e-13);
        assert!((of(Statistic::Final) - (3.0 - 0.53 * 0.53)).abs() < 1e-13);
        let bowl = series(0.1, 10, &[("q", &|t| (t - 0.47) * (t - 0.47) - 3.0)]);
        assert!((value(&bowl, "q", Statistic::Min, None).unwrap() + 3.0).abs() < 1e-13);
    }

    #[test]
    fn an_extremum_at_the_edge_of_the_window_is_taken_as_it_is() {
        let line = series(0.1, 10, &[("q", &|t| t)]);
        assert_eq!(value(&line, "q", Statistic::Max, Some([0.2, 0.5])), Ok(0.5));
        assert_eq!(value(&line, "q", Statistic::Min, Some([0.2, 0.5])), Ok(0.2));
    }

    #[test]
    fn a_periodic_series_is_averaged_over_whole_periods() {
        // 3.3 periods, so that the plain average would be off by several per cent.
        let wave = series(0.01, 330, &[("q", &|t| 2.0 + (TAU * t + 0.4).sin())]);
        let mean = value(&wave, "q", Statistic::Mean, None).unwrap();
        assert!((mean - 2.0).abs() < 1e-5, "{mean}");
        let swing = series(0.01, 330, &[("q", &|t| (TAU * t + 0.4).sin())]);
        let rms = value(&swing, "q", Statistic::Rms, None).unwrap();
        assert!((rms - 0.5_f64.sqrt()).abs() < 1e-3, "{rms}");
    }

    #[test]
    fn a_series_that_does_not_repeat_is_averaged_over_the_window() {
        let line = series(0.1, 10, &[("q", &|t| 4.0 * t)]);
        let mean = value(&line, "q", Statistic::Mean, Some([0.5, 1.0])).unwrap();
        assert!((mean - 3.0).abs() < 1e-13);
    }

    #[test]
    fn the_strouhal_number_is_frequency_times_length_over_velocity() {
        let wave = series(0.013, 400, &[("q", &|t| 1.0 + (TAU * 2.5 * t).sin())]);
        let strouhal = value(&wave, "q", Statistic::Strouhal, None).unwrap();
        assert!((strouhal - 2.5 * 0.1 / 2.0).abs() < 1e-5, "{strouhal}");
        let line = series(0.1, 10, &[("q", &|t| t)]);
        let error = value(&line, "q", Statistic::Strouhal, None).unwrap_err();
        assert!(matches!(error, StatisticError::NoPeriod { .. }), "{error}");
    }

    #[test]
    fn half_a_period_after_the_maximum_is_where_the_lift_is_lowest() {
        // Lift peaks at 0.1 + k; the pressure is a line there plus a wave of the same period.
        let lift = |t: f64| (TAU * (t - 0.1)).cos();
        let pressure = |t: f64| 5.0 + (TAU * (t - 0.1)).cos();
        let run = series(0.01, 400, &[("b.lift", &lift), ("p", &pressure)]);
        let found = value(&run, "p", Statistic::HalfPeriodAfterMax, None).unwrap();
        assert!((found - 4.0).abs() < 1e-4, "{found}");
    }

    #[test]
    fn what_was_not_computed_is_an_error() {
        let line = series(0.1, 2, &[("q", &|t| t)]);
        assert!(value(&line, "r", Statistic::Final, None).is_err());
        assert!(value(&line, "q", Statistic::At, None).is_err());
        assert!(value(&line, "q", Statistic::Max, Some([5.0, 6.0])).is_err());
    }
}
