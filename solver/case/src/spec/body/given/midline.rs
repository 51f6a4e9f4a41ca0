//! `gait.midline`: a midline of one's own, by an expression or by a table.

use num_dual::DualNum;
use serde::{Deserialize, Serialize};

use crate::spec::formula::{Definitions, Formula, FormulaError, ParsedFormula};
#[cfg(test)]
use crate::spec::number::{NonNegative, Positive};

/// `gait.midline`: one of `curvature`, `lateral` and `file`; the midline keeps its length.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct MidlineGait {
    /// Period (s).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub period: f64,
    /// Curvature times length, an expression of s (distance from the head over the length) and t (s); counter-clockwise from
    /// head to tail.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub curvature: Option<Formula>,
    /// Displacement across the straight body over its length, an expression of s and t.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lateral: Option<Formula>,
    /// A CSV file: in its header `t` and positions s, from 0 to 1; in each row a time (s) and the values there. It becomes
    /// `positions` and `table` when the case is read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// What the values of a table are.
    #[serde(default)]
    pub values: MidlineValues,
    /// Positions of the values of a table: distances from the head over the length, from 0 to 1.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub positions: Vec<f64>,
    /// [time (s), value at each position] within a period, joined by cubic splines, periodic in time.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub table: Vec<Vec<f64>>,
    /// Duration of the ramp at the start (s); a period if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<NonNegative>"))]
    pub ramp: Option<f64>,
    /// The numbers of `[define]`.
    #[serde(skip)]
    pub definitions: Definitions,
}

/// What the values of a table of a midline are.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum MidlineValues {
    /// Curvature times length.
    #[default]
    Curvature,
    /// Displacement over length.
    Lateral,
}

/// How a midline bends: values by position and time.
#[derive(Debug, Clone, PartialEq)]
pub enum MidlineLaw {
    /// An expression of s and t.
    Formula(ParsedFormula),
    /// Splines through a table.
    Table(MidlineTable),
}

/// Values at positions and times within a period, joined by cubic splines.
#[derive(Debug, Clone, PartialEq)]
pub struct MidlineTable {
    positions: Vec<f64>,
    /// Times within the period, the first again at its end (s).
    times: Vec<f64>,
    period: f64,
    /// Values and second derivatives in time of each position.
    columns: Vec<[Vec<f64>; 2]>,
    /// Second derivatives along the midline of the splines that are 1 at one position and 0 at the others.
    bends: Vec<Vec<f64>>,
}

impl MidlineGait {
    /// Duration of the ramp at the start (s).
    #[must_use]
    pub fn ramp(&self) -> f64 {
        self.ramp.unwrap_or(self.period)
    }

    /// What its values are.
    #[must_use]
    pub fn kind(&self) -> MidlineValues {
        match (&self.curvature, &self.lateral) {
            (None, Some(_)) => MidlineValues::Lateral,
            (Some(_), _) => MidlineValues::Curvature,
            (None, None) => self.values,
        }
    }

    /// Its values by position and time.
    ///
    /// # Errors
    /// Where in an expression something is not understood.
    pub fn law(&self) -> Result<MidlineLaw, FormulaError> {
        match self.curvature.as_ref().or(self.lateral.as_ref()) {
            Some(formula) => Ok(MidlineLaw::Formula(formula.along_midline(&self.definitions)?)),
            None => {
                let (positions, period) = (&self.positions, self.period);
                Ok(MidlineLaw::Table(MidlineTable::new(positions, &self.table, period)))
            }
        }
    }

    /// Positions at which a third derivative of it jumps.
    #[must_use]
    pub fn knots(&self) -> &[f64] {
        if self.curvature.is_some() || self.lateral.is_some() { &[] } else { &self.positions }
    }
}

impl MidlineLaw {
    /// The value at a position over the length and a time (s), with the derivatives these carry.
    pub fn value<D: DualNum<Primitive = f64> + Copy>(&self, position: D, time: D) -> D {
        let zero = D::from(0.0);
        match self {
            Self::Formula(formula) => formula.dual(&[position, zero, zero, time]),
            Self::Table(table) => table.value(position, time),
        }
    }
}

impl MidlineTable {
    /// Splines through a row for each time, which has it in front of the values.
    fn new(positions: &[f64], rows: &[Vec<f64>], period: f64) -> Self {
        let first = rows.first().map_or(0.0, |row| row[0]);
        let is_closed = rows.last().is_some_and(|row| row[0] - first > period * (1.0 - 1e-9));
        let kept = if is_closed { &rows[..rows.len() - 1] } else { rows };
        let times: Vec<f64> = kept.iter().map(|row| row[0]).chain([first + period]).collect();
        let column = |nth: usize| {
            let values: Vec<f64> =
                kept.iter().chain(kept.first()).map(|row| row[nth + 1]).collect();
            let bends = periodic_bends(&times, &values);
            [values, bends]
        };
        let columns = (0..positions.len()).map(column).collect();
        let unit = |own: usize| {
            let values: Vec<f64> =
                (0..positions.len()).map(|nth| if nth == own { 1.0 } else { 0.0 }).collect();
            natural_bends(positions, &values)
        };
        let bends = (0..positions.len()).map(unit).collect();
        Self { positions: positions.to_vec(), times, period, columns, bends }
    }

    fn value<D: DualNum<Primitive = f64> + Copy>(&self, position: D, time: D) -> D {
        // The last time ends the period
        let periods = ((time.re() - self.times[0]) / self.period).floor();
        let time = time - periods * self.period;
        let mut sum = D::from(0.0);
        for (nth, [values, bends]) in self.columns.iter().enumerate() {
            let unit: Vec<f64> =
                (0..self.positions.len()).map(|at| if at == nth { 1.0 } else { 0.0 }).collect();
            let weight = spline(&self.positions, &unit, &self.bends[nth], position);
            sum += weight * spline(&self.times, values, bends, time);
        }
        sum
    }
}

/// The cubic spline with these values and second derivatives at knots.
fn spline<D: DualNum<Primitive = f64> + Copy>(
    knots: &[f64],
    values: &[f64],
    bends: &[f64],
    at: D,
) -> D {
    let last = knots.len() - 1;
    let i = knots.partition_point(|knot| *knot <= at.re()).clamp(1, last) - 1;
    let h = knots[i + 1] - knots[i];
    let (a, b) = ((-at + knots[i + 1]) / h, (at - knots[i]) / h);
    let bent = (a * a * a - a) * bends[i] + (b * b * b - b) * bends[i + 1];
    a * values[i] + b * values[i + 1] + bent * (h * h / 6.0)
}

/// Second derivatives of a natural cubic spline, by Thomas' algorithm.
fn natural_bends(knots: &[f64], values: &[f64]) -> Vec<f64> {
    let n = knots.len();
    let (mut bends, mut factors) = (vec![0.0; n], vec![0.0; n]);
    for i in 1..n.saturating_sub(1) {
        let (before, after) = (knots[i] - knots[i - 1], knots[i + 1] - knots[i]);
        let slopes = [(values[i] - values[i - 1]) / before, (values[i + 1] - values[i]) / after];
        let pivot = 2.0 * (before + after) - before * factors[i - 1];
        factors[i] = after / pivot;
        bends[i] = (6.0 * (slopes[1] - slopes[0]) - before * bends[i - 1]) / pivot;
    }
    for i in (1..n.saturating_sub(1)).rev() {
        bends[i] -= factors[i] * bends[i + 1];
    }
    bends
}

/// Sweeps after which those of the periodic spline have ended: each halves the error at least.
const SWEEPS: usize = 80;

/// Second derivatives of a periodic cubic spline, whose last value is its first, by Gauss and Seidel's sweeps.
fn periodic_bends(knots: &[f64], values: &[f64]) -> Vec<f64> {
    let n = knots.len() - 1;
    let mut bends = vec![0.0; n + 1];
    for _ in 0..SWEEPS {
        for i in 0..n {
            let previous = if i == 0 { n - 1 } else { i - 1 };
            let before = knots[previous + 1] - knots[previous];
            let after = knots[i + 1] - knots[i];
            let slopes = [
                (values[previous + 1] - values[previous]) / before,
                (values[i + 1] - values[i]) / after,
            ];
            let others = before * bends[previous] + after * bends[i + 1];
            bends[i] = (6.0 * (slopes[1] - slopes[0]) - others) / (2.0 * (before + after));
            if i == 0 {
                bends[n] = bends[0];
            }
        }
    }
    bends
}
