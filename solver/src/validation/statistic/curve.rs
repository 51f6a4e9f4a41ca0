//! `Curve`: a column of a series: averages, extrema, periods, and when it reaches a level.
//!
//! A series is known at the steps of a run only. Between them it is taken as a parabola where a
//! time or an extremum is wanted, and as straight lines where it is averaged.

use super::error::StatisticError;
use crate::run::Series;

/// Part of the range a series must go below its mean before it crosses it again: less is noise.
const HYSTERESIS: f64 = 0.05;

/// Largest spread of the lengths of periods, over their mean, of a periodic series.
const REGULARITY: f64 = 0.05;

/// A column of a series with its times.
#[derive(Debug, Clone)]
pub(super) struct Curve {
    pub times: Vec<f64>,
    pub values: Vec<f64>,
}

impl Curve {
    /// A column of a series.
    pub(super) fn of(series: &Series, name: &str) -> Result<Self, StatisticError> {
        let values =
            series.column(name).ok_or_else(|| StatisticError::UnknownQuantity(name.to_owned()))?;
        if series.times.is_empty() {
            return Err(StatisticError::EmptyWindow { start: 0.0, end: 0.0 });
        }
        Ok(Self { times: series.times.clone(), values })
    }

    /// The steps within a window, which is never empty.
    pub(super) fn window(&self, window: Option<[f64; 2]>) -> Result<Self, StatisticError> {
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

    /// The steps within a window that the run has reached the end of.
    pub(super) fn whole_window(&self, window: Option<[f64; 2]>) -> Result<Self, StatisticError> {
        if let Some([start, end]) = window {
            let last = self.times[self.times.len() - 1];
            if last < end - 1e-9 * (end - start).abs() {
                return Err(StatisticError::UnfinishedWindow { start, end, last });
            }
        }
        self.window(window)
    }

    pub(super) fn until(&self, end: f64) -> Result<Self, StatisticError> {
        self.window(Some([self.times[0], end]))
    }

    pub(super) fn last(&self) -> f64 {
        self.values[self.values.len() - 1]
    }

    pub(super) fn squared(&self) -> Self {
        Self {
            times: self.times.clone(),
            values: self.values.iter().map(|value| value * value).collect(),
        }
    }

    /// Value at a time, by the parabola through the three nearest steps.
    pub(super) fn value_at(&self, time: f64) -> Result<f64, StatisticError> {
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
    pub(super) fn time_of(
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

    /// Where the series times `sign` is largest, refined by a parabola.
    pub(super) fn extremum(&self, sign: f64) -> Extremum {
        let mut best = 0;
        for i in 1..self.values.len() {
            if sign * self.values[i] > sign * self.values[best] {
                best = i;
            }
        }
        if best == 0 || best + 1 == self.values.len() {
            return Extremum { time: self.times[best], value: self.values[best] };
        }
        let parabola = self.parabola(best);
        if parabola.bend == 0.0 {
            return Extremum { time: self.times[best], value: self.values[best] };
        }
        let top = parabola.time - 0.5 * parabola.slope / parabola.bend;
        Extremum { time: top, value: parabola.value(top) }
    }

    /// Time average: over whole periods where the series is periodic, else over all of it.
    pub(super) fn mean(&self) -> f64 {
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

    pub(super) fn average_of_all(&self) -> f64 {
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
    pub(super) fn period(&self, name: &str) -> Result<f64, StatisticError> {
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

/// A largest or smallest value.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extremum {
    /// When (s).
    pub time: f64,
    /// The value.
    pub value: f64,
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
