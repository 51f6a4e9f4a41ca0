//! How a time series becomes one number: the statistics of `[[reference]]`.
//!
//! A series is known at the steps of a run only. Between them it is taken as a parabola where a
//! place or an extremum is wanted, and as straight lines where it is averaged.

use thiserror::Error;

use super::morison::{self, Swing};
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
    /// The series stays on one side of a level.
    #[error(
        "`{quantity}` does not reach {level} in the window: it goes from {lowest} to {highest} there"
    )]
    NotReached {
        /// Name of the series.
        quantity: String,
        /// The level.
        level: f64,
        /// Smallest value in the window.
        lowest: f64,
        /// Largest value in the window.
        highest: f64,
    },
    /// Drag and inertia cannot be told apart.
    #[error("body `{body}` does not swing along {axis} in the window, as Morison's equation needs")]
    NoSwing {
        /// Name of the body.
        body: String,
        /// Axis of the force.
        axis: String,
    },
    /// Something the statistic needs is not in the case.
    #[error("the statistic needs {0}")]
    Missing(&'static str),
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
    let whole = compared(series, reference)?;
    let window = whole.window(case.statistics.window)?;
    let mean = |curve: &Curve| {
        if case.statistics.whole_periods { curve.mean() } else { curve.average_of_all() }
    };
    let value = match reference.statistic {
        Statistic::Final => whole.last(),
        Statistic::At => {
            let time = reference.at.ok_or(StatisticError::Missing("a time, `at`"))?;
            whole.value_at(time)?
        }
        Statistic::Max => window.largest(1.0).1,
        Statistic::Min => window.largest(-1.0).1,
        Statistic::Mean => mean(&window),
        Statistic::Rms => mean(&window.squared()).sqrt(),
        Statistic::Strouhal => {
            let scales = case.scales.ok_or(StatisticError::Missing("[scales]"))?;
            scales.length / (scales.velocity * window.period(&reference.formula())?)
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
        Statistic::Crossing => {
            let level = reference.level.ok_or(StatisticError::Missing("a value, `level`"))?;
            whole.time_of(level, case.statistics.window, &reference.formula())?
        }
        Statistic::When => {
            let level = reference.level.ok_or(StatisticError::Missing("a value, `level`"))?;
            let of = reference.of.as_deref();
            let of = of.ok_or(StatisticError::Missing("a quantity, `of`"))?;
            let time = curve(series, of)?.time_of(level, case.statistics.window, of)?;
            whole.value_at(time)?
        }
        Statistic::Range => window.largest(1.0).1 - window.largest(-1.0).1,
        Statistic::MorisonDrag => morison_fit(series, case, reference)?[0],
        Statistic::MorisonInertia => morison_fit(series, case, reference)?[1],
    };
    Ok(value / reference.per)
}

/// The quantity of a reference, less the one that is subtracted.
fn compared(series: &Series, reference: &Reference) -> Result<Curve, StatisticError> {
    let mut whole = curve(series, &reference.quantity)?;
    if let Some(minus) = &reference.minus {
        for (value, less) in whole.values.iter_mut().zip(curve(series, minus)?.values) {
            *value -= less;
        }
    }
    Ok(whole)
}

/// Drag and inertia coefficient of Morison's equation over the window.
fn morison_fit(
    series: &Series,
    case: &Case,
    reference: &Reference,
) -> Result<[f64; 2], StatisticError> {
    let scales = case.scales.ok_or(StatisticError::Missing("[scales]"))?;
    let (body, axis) = reference.force_of().ok_or(StatisticError::Missing("a force on a body"))?;
    let column = |name: &str| curve(series, name)?.window(case.statistics.window);
    let force = column(&reference.quantity)?;
    let velocity = column(&format!("{body}.velocity.{axis}"))?;
    let acceleration = column(&format!("{body}.acceleration.{axis}"))?;
    let swing = Swing {
        times: &force.times,
        force: &force.values,
        velocity: &velocity.values,
        acceleration: &acceleration.values,
    };
    morison::fit(swing, case.fluid.density, scales.length)
        .ok_or_else(|| StatisticError::NoSwing { body: body.to_owned(), axis: axis.to_owned() })
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

    /// The time in a window at which the series first reaches a level, from either side.
    fn time_of(
        &self,
        level: f64,
        window: Option<[f64; 2]>,
        name: &str,
    ) -> Result<f64, StatisticError> {
        let inside = self.window(window)?;
        let [start, end] = window.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        // The whole series is searched: it may reach the level in the part of a step that is
        // inside the window.
        let reached = (0..self.times.len()).find_map(|i| {
            let time = self.time_in_step(i, level)?;
            (start..=end).contains(&time).then_some(time)
        });
        reached.ok_or_else(|| {
            let lowest = inside.values.iter().copied().fold(f64::INFINITY, f64::min);
            let highest = inside.values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            StatisticError::NotReached { quantity: name.to_owned(), level, lowest, highest }
        })
    }

    /// When the series is at a level, from one row on and before the next.
    fn time_in_step(&self, i: usize, level: f64) -> Option<f64> {
        let (start, here) = (self.times[i], self.values[i]);
        if here == level {
            return Some(start);
        }
        let (end, next) = (*self.times.get(i + 1)?, *self.values.get(i + 1)?);
        if !(here.min(next) < level && level < here.max(next)) {
            return None;
        }
        let part = (level - here) / (next - here);
        let n = self.times.len();
        if n < 3 {
            return Some(start + part * (end - start));
        }
        let nearer = if part < 0.5 { i } else { i + 1 };
        Some(self.parabola(nearer.clamp(1, n - 2)).crossing(level, start, end))
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
        self.average_of_all()
    }

    fn average_of_all(&self) -> f64 {
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

    /// Where it passes a level between two times at which it is on different sides of it.
    fn crossing(&self, level: f64, mut low: f64, mut high: f64) -> f64 {
        let is_above_at_the_end = self.value(high) > level;
        // Bisection to the last bit: a parabola passes a level once in such a stretch.
        for _ in 0..64 {
            let middle = 0.5 * (low + high);
            if (self.value(middle) > level) == is_above_at_the_end {
                high = middle;
            } else {
                low = middle;
            }
        }
        0.5 * (low + high)
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
        let mut case = Case::parse("t.toml", CASE, &[]).unwrap().model.case;
        case.statistics.window = window;
        measured_value(series, &case, &reference(quantity, statistic))
    }

    fn reference(quantity: &str, statistic: Statistic) -> Reference {
        Reference {
            quantity: quantity.to_owned(),
            minus: None,
            statistic,
            at: Some(0.33),
            level: None,
            of: None,
            value: 1.0,
            per: 1.0,
            relative: Some(0.1),
            absolute: None,
            source: "test".to_owned(),
            note: None,
        }
    }

    /// As `series`, with steps that grow threefold from the first to the last.
    fn uneven(end: f64, n: usize, columns: &[(&str, &dyn Fn(f64) -> f64)]) -> Series {
        let mut run = series(1.0 / n as f64, n, columns);
        for (time, row) in run.times.iter_mut().zip(&mut run.rows) {
            *time = end * 0.5 * *time * (1.0 + *time);
            *row = columns.iter().map(|(_, value)| value(*time)).collect();
        }
        run
    }

    /// When `quantity`, less `minus`, is at a level.
    fn crossing(
        run: &Series,
        [quantity, minus]: [&str; 2],
        level: f64,
        window: Option<[f64; 2]>,
    ) -> Result<f64, StatisticError> {
        let mut case = Case::parse("t.toml", CASE, &[]).unwrap().model.case;
        case.statistics.window = window;
        let minus = (!minus.is_empty()).then(|| minus.to_owned());
        let plain = reference(quantity, Statistic::Crossing);
        measured_value(run, &case, &Reference { level: Some(level), minus, ..plain })
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
    fn a_level_is_met_at_its_time_from_either_side() {
        let fall = |t: f64| 2.0 - t * t;
        let run =
            uneven(3.0, 17, &[("q", &fall), ("up", &|t| t * t - 2.0), ("half", &|t| 0.5 * t * t)]);
        for [quantity, minus] in [["q", ""], ["up", ""], ["up", "half"]] {
            let (level, wanted) = match minus {
                "" if quantity == "q" => (-0.5, 2.5_f64.sqrt()),
                "" => (0.5, 2.5_f64.sqrt()),
                // 1/2 t^2 - 2
                _ => (-1.0, 2.0_f64.sqrt()),
            };
            let time = crossing(&run, [quantity, minus], level, None).unwrap();
            assert!((time - wanted).abs() < 1e-12, "{quantity} {minus}: {time}");
        }
        // In a step at the beginning or the end of the run, and at a row of it.
        for wanted in [0.01, 2.95, run.times[6]] {
            let time = crossing(&run, ["q", ""], fall(wanted), None).unwrap();
            assert!((time - wanted).abs() < 1e-12, "{time} {wanted}");
        }
        assert_eq!(crossing(&run, ["q", ""], 2.0, None), Ok(0.0));
    }

    #[test]
    fn only_what_happens_in_the_window_counts() {
        let wave = |t: f64| (TAU * t).sin();
        let run = uneven(3.0, 400, &[("q", &wave)]);
        let at = |level, window| crossing(&run, ["q", ""], level, Some(window));
        assert!((at(0.5, [0.3, 3.0]).unwrap() - 5.0 / 12.0).abs() < 1e-5);
        assert!((at(0.5, [0.5, 3.0]).unwrap() - 13.0 / 12.0).abs() < 1e-5);
        // The window may begin within the step that reaches the level.
        let line = series(0.4, 5, &[("q", &|t| t)]);
        let begun = crossing(&line, ["q", ""], 1.0, Some([0.9, 2.0])).unwrap();
        assert!((begun - 1.0).abs() < 1e-12, "{begun}");
        let error = at(1.5, [0.5, 1.5]).unwrap_err();
        let StatisticError::NotReached { level, lowest, highest, .. } = &error else {
            panic!("{error}")
        };
        assert_eq!(*level, 1.5);
        assert!(*lowest < -0.99 && *highest > 0.99, "{error}");
        assert!(at(0.5, [0.5, 0.9]).is_err());
    }

    #[test]
    fn a_quantity_is_taken_when_another_reaches_a_level() {
        let run = uneven(2.0, 23, &[("y", &|t| 3.0 - t * t), ("x", &|t| 4.0 * t)]);
        let case = Case::parse("t.toml", CASE, &[]).unwrap().model.case;
        let plain = Reference { level: Some(1.0), ..reference("x", Statistic::When) };
        assert!(measured_value(&run, &case, &plain).is_err());
        let when = Reference { of: Some("y".to_owned()), ..plain };
        let x = measured_value(&run, &case, &when).unwrap();
        assert!((x - 4.0 * 2.0_f64.sqrt()).abs() < 1e-11, "{x}");
        // Less another quantity: 4 t - (3 - t^2), where t^2 = 2.
        let apart = Reference { minus: Some("y".to_owned()), ..when.clone() };
        let x = measured_value(&run, &case, &apart).unwrap();
        assert!((x - 4.0 * 2.0_f64.sqrt() + 1.0).abs() < 1e-11, "{x}");
        let never = Reference { level: Some(5.0), ..when };
        let error = measured_value(&run, &case, &never).unwrap_err();
        assert!(error.to_string().contains("`y` does not reach 5"), "{error}");
    }

    #[test]
    fn the_range_is_from_trough_to_peak_in_the_window() {
        let run = uneven(2.0, 300, &[("q", &|t| 1.0 + 0.3 * (TAU * t + 0.2).sin())]);
        let range = value(&run, "q", Statistic::Range, None).unwrap();
        assert!((range - 0.6).abs() < 1e-6, "{range}");
        let line = series(0.1, 10, &[("q", &|t| -t)]);
        let range = value(&line, "q", Statistic::Range, Some([0.2, 0.5])).unwrap();
        assert!((range - 0.3).abs() < 1e-13, "{range}");
    }

    #[test]
    fn a_difference_is_taken_before_its_statistic() {
        let run = series(
            0.01,
            100,
            &[("a", &|t| 5.0 * t), ("b", &|t| 5.0 * t - 1.0 + (t - 0.4) * (t - 0.4))],
        );
        let case = Case::parse("t.toml", CASE, &[]).unwrap().model.case;
        let minus = Some("b".to_owned());
        let largest = Reference { minus, ..reference("a", Statistic::Max) };
        assert!((measured_value(&run, &case, &largest).unwrap() - 1.0).abs() < 1e-12);
        let unknown = Reference { minus: Some("c".to_owned()), ..largest };
        let error = measured_value(&run, &case, &unknown).unwrap_err();
        assert_eq!(error, StatisticError::UnknownQuantity("c".to_owned()));
    }

    #[test]
    fn morisons_coefficients_are_those_of_the_bodys_own_motion() {
        // D = 0.1 and rho = 2: F = -0.1 c_D |v| v - pi/200 c_I dv/dt
        let (v, a) = (|t: f64| (TAU * t).sin(), |t: f64| TAU * (TAU * t).cos());
        let force =
            |t: f64| -0.1 * 1.7 * v(t).abs() * v(t) - std::f64::consts::PI / 200.0 * 1.2 * a(t);
        let run = uneven(
            3.0,
            500,
            &[
                ("b.force.y", &force),
                ("b.velocity.y", &v),
                ("b.acceleration.y", &a),
                ("b.force.x", &force),
                ("b.velocity.x", &|_| 0.0),
                ("b.acceleration.x", &|_| 0.0),
            ],
        );
        let mut case = Case::parse("t.toml", CASE, &[]).unwrap().model.case;
        case.fluid.density = 2.0;
        case.statistics.window = Some([1.0, 3.0]);
        let of = |quantity, statistic| measured_value(&run, &case, &reference(quantity, statistic));
        let drag = of("b.force.y", Statistic::MorisonDrag).unwrap();
        let inertia = of("b.force.y", Statistic::MorisonInertia).unwrap();
        assert!((drag - 1.7).abs() < 1e-11 && (inertia - 1.2).abs() < 1e-11, "{drag} {inertia}");
        let error = of("b.force.x", Statistic::MorisonDrag).unwrap_err();
        assert!(matches!(error, StatisticError::NoSwing { .. }), "{error}");
        assert!(of("b.velocity.y", Statistic::MorisonDrag).is_err());
    }

    #[test]
    fn what_was_not_computed_is_an_error() {
        let line = series(0.1, 2, &[("q", &|t| t)]);
        assert!(value(&line, "r", Statistic::Final, None).is_err());
        assert!(value(&line, "q", Statistic::At, None).is_err());
        assert!(value(&line, "q", Statistic::Max, Some([5.0, 6.0])).is_err());
    }
}
