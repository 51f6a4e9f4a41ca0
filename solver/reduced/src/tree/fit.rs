//! Fits of coefficients: bounded linear least squares, and the method of Gauss and Newton with exact derivatives.

use alewife_interrupt::check;
use num_dual::Dual64;

use super::cholesky::{factor, solve};
use super::error::TreeError;

/// Bounds of a parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Smallest value.
    pub lower: f64,
    /// Largest value.
    pub upper: f64,
}

/// What a fit has found.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// The parameters.
    pub parameters: Vec<f64>,
    /// Half the sum of the squares of what is left.
    pub cost: f64,
    /// The same at the start.
    pub start_cost: f64,
    /// Part of the cost that a step of Gauss and Newton from here would take off: none where the fit has converged.
    pub promised: f64,
    /// Root of the sum of the squares of the derivatives of all residuals by each parameter.
    pub sensitivities: Vec<f64>,
    /// By how much each parameter may be off, in units of what is left: the roots of the diagonal of the inverse
    /// of the normal matrix times the mean square left; infinite where the residuals do not determine it, and
    /// zero at a bound.
    pub uncertainties: Vec<f64>,
    /// Steps that were made.
    pub steps: usize,
}

/// Residuals of a fit.
pub trait Residuals {
    /// All residuals at some parameters, in the same number and order each time; derivatives go with them.
    ///
    /// # Errors
    /// When there are none at these parameters.
    fn residuals(&self, parameters: &[Dual64]) -> Result<Vec<Dual64>, TreeError>;

    /// The part of each parameter that central differences go to either side, in place of exact derivatives; none if these
    /// are taken. Those of a motion that forgets how it began grow without end along it, and say nothing of its mean.
    fn differences(&self) -> Option<f64> {
        None
    }

    /// The same without derivatives.
    ///
    /// # Errors
    /// When there are none at these parameters.
    fn values(&self, parameters: &[f64]) -> Result<Vec<f64>, TreeError> {
        let parameters: Vec<Dual64> = parameters.iter().map(|one| Dual64::from(*one)).collect();
        Ok(self.residuals(&parameters)?.iter().map(|one| one.re).collect())
    }
}

/// Part of the largest diagonal entry of a normal matrix below which a parameter is undetermined.
const UNDETERMINED: f64 = 1e-12;

/// The least change of parameters, of their size, that another step is made for.
const LEAST: f64 = 1e-10;

/// J^T J and J^T r of residuals that are linear about some parameters.
struct Normal {
    matrix: Vec<f64>,
    gradient: Vec<f64>,
    n: usize,
}

impl Normal {
    /// From rows of derivatives, one of each parameter, and residuals.
    fn new(columns: &[Vec<f64>], residuals: &[f64]) -> Self {
        let n = columns.len();
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let mut matrix = vec![0.0; n * n];
        for i in 0..n {
            for j in 0..n {
                matrix[i * n + j] = product(&columns[i], &columns[j]);
            }
        }
        let gradient = columns.iter().map(|column| product(column, residuals)).collect();
        Self { matrix, gradient, n }
    }

    /// The change of the parameters that makes the squares least within bounds of the change, by an active set:
    /// what would leave its bounds is put on them, and let go where that makes the squares less.
    fn step(&self, damping: f64, bounds: &[Bounds]) -> Vec<f64> {
        let n = self.n;
        let mut step = vec![0.0; n];
        let mut is_held = vec![false; n];
        for _ in 0..4 * n + 4 {
            let free: Vec<usize> = (0..n).filter(|k| !is_held[*k]).collect();
            let wanted = self.solve(&free, &is_held, &step, damping);
            // As far as no bound is met
            let mut part = 1.0;
            let mut met = None;
            for (a, k) in free.iter().copied().enumerate() {
                let change = wanted[a] - step[k];
                let room = if change > 0.0 {
                    bounds[k].upper - step[k]
                } else {
                    bounds[k].lower - step[k]
                };
                if change != 0.0 && room / change < part {
                    part = (room / change).max(0.0);
                    met = Some(k);
                }
            }
            for (a, k) in free.iter().copied().enumerate() {
                step[k] += part * (wanted[a] - step[k]);
            }
            if let Some(k) = met {
                is_held[k] = true;
                continue;
            }
            // All is within bounds: what is held although the squares fall away from its bound is let go
            let slope = |k: usize| {
                let row = (0..n).map(|j| self.matrix[k * n + j] * step[j]).sum::<f64>();
                row + self.gradient[k] + damping * self.matrix[k * n + k] * step[k]
            };
            let inward = |k: usize| {
                let at_lower =
                    (step[k] - bounds[k].lower).abs() <= (step[k] - bounds[k].upper).abs();
                if at_lower { -slope(k) } else { slope(k) }
            };
            let most =
                (0..n).filter(|k| is_held[*k]).max_by(|a, b| inward(*a).total_cmp(&inward(*b)));
            match most.filter(|k| inward(*k) > 1e-12 * self.gradient[*k].abs()) {
                Some(k) => is_held[k] = false,
                None => break,
            }
        }
        step
    }

    /// Least squares in the free parameters with the others where they are.
    fn solve(&self, free: &[usize], is_held: &[bool], step: &[f64], damping: f64) -> Vec<f64> {
        let (n, m) = (self.n, free.len());
        let largest = (0..n).fold(0.0_f64, |a, k| a.max(self.matrix[k * n + k]));
        let mut matrix = vec![0.0; m * m];
        let mut right = vec![0.0; m];
        for (a, i) in free.iter().copied().enumerate() {
            right[a] = -self.gradient[i];
            for j in (0..n).filter(|j| is_held[*j]) {
                right[a] -= self.matrix[i * n + j] * step[j];
            }
            for (b, j) in free.iter().copied().enumerate() {
                matrix[a * m + b] = self.matrix[i * n + j];
            }
            // What is undetermined stays
            matrix[a * m + a] += matrix[a * m + a] * damping + largest * UNDETERMINED;
        }
        if factor(&mut matrix, m).is_err() {
            return free.iter().map(|k| step[*k]).collect();
        }
        solve(&matrix, &mut right);
        right
    }

    /// Root of the sum of the squares of the derivatives by each parameter.
    fn sensitivities(&self) -> Vec<f64> {
        (0..self.n).map(|k| self.matrix[k * self.n + k].sqrt()).collect()
    }

    /// By how much half the sum of squares, which is `cost`, would fall in a step within bounds, over it.
    fn promised(&self, cost: f64, rooms: &[Bounds]) -> f64 {
        let step = self.step(0.0, rooms);
        let mut change = 0.0;
        for k in 0..self.n {
            let row = (0..self.n).map(|j| self.matrix[k * self.n + j] * step[j]).sum::<f64>();
            change += step[k] * (self.gradient[k] + 0.5 * row);
        }
        if cost > 0.0 { -change / cost } else { 0.0 }
    }

    /// Uncertainties of parameters that are within their bounds.
    fn uncertainties(&self, mean_square: f64, is_held: &[bool]) -> Vec<f64> {
        let mut sizes = vec![0.0; self.n];
        // What changes nothing says nothing of the others
        let is_seen = |k: &usize| self.matrix[k * self.n + k] > 0.0;
        for k in (0..self.n).filter(|k| !is_held[*k] && !is_seen(k)) {
            sizes[k] = f64::INFINITY;
        }
        let free: Vec<usize> = (0..self.n).filter(|k| !is_held[*k] && is_seen(k)).collect();
        let m = free.len();
        let mut matrix: Vec<f64> = Vec::new();
        for i in &free {
            matrix.extend(free.iter().map(|j| self.matrix[i * self.n + j]));
        }
        let is_definite = factor(&mut matrix, m).is_ok();
        for (a, k) in free.iter().copied().enumerate() {
            let mut unit = vec![0.0; m];
            unit[a] = 1.0;
            if is_definite {
                solve(&matrix, &mut unit);
            }
            sizes[k] = if is_definite { (unit[a] * mean_square).sqrt() } else { f64::INFINITY };
        }
        sizes
    }
}

fn checked(start: &[f64], bounds: &[Bounds]) -> Result<(), TreeError> {
    let wrong = |what: String| Err(TreeError::Given(what));
    if start.len() != bounds.len() {
        return wrong(format!("{} parameters have {} bounds", start.len(), bounds.len()));
    }
    for (k, (value, bounds)) in start.iter().zip(bounds).enumerate() {
        let Bounds { lower, upper } = bounds;
        if !(lower..=upper).contains(&value) {
            return wrong(format!(
                "parameter {k} starts at {value}, outside of {lower} to {upper}"
            ));
        }
    }
    Ok(())
}

/// Fits what residuals depend on linearly: residuals are `constant` plus parameters times `columns`.
///
/// # Errors
/// `TreeError::Given` when the start is not within the bounds, or columns have other lengths.
pub fn fit_linear(
    columns: &[Vec<f64>],
    constant: &[f64],
    bounds: &[Bounds],
) -> Result<Fit, TreeError> {
    if let Some(column) = columns.iter().find(|column| column.len() != constant.len()) {
        let what = format!("a column has {} rows in place of {}", column.len(), constant.len());
        return Err(TreeError::Given(what));
    }
    let start: Vec<f64> = bounds.iter().map(|one| one.lower.max(0.0_f64.min(one.upper))).collect();
    checked(&start, bounds)?;
    if columns.len() != bounds.len() {
        return Err(TreeError::Given("each column needs its bounds".to_owned()));
    }
    let left = |parameters: &[f64]| {
        let mut left = constant.to_vec();
        for (column, parameter) in columns.iter().zip(parameters) {
            left.iter_mut().zip(column).for_each(|(sum, value)| *sum += value * parameter);
        }
        left
    };
    let normal = Normal::new(columns, &left(&start));
    let step = normal.step(0.0, &room(&start, bounds));
    let parameters: Vec<f64> = start.iter().zip(&step).map(|(at, by)| at + by).collect();
    let (before, after) = (left(&start), left(&parameters));
    let there = Normal::new(columns, &after);
    let fit = finished(&there, parameters, &after, bounds, 1);
    Ok(Fit { start_cost: half_square(&before), ..fit })
}

/// Half the sum of squares.
fn half_square(values: &[f64]) -> f64 {
    0.5 * values.iter().map(|one| one * one).sum::<f64>()
}

fn room(at: &[f64], bounds: &[Bounds]) -> Vec<Bounds> {
    let room = |(at, one): (&f64, &Bounds)| Bounds { lower: one.lower - at, upper: one.upper - at };
    at.iter().zip(bounds).map(room).collect()
}

/// A fit that ends at some parameters, where a normal matrix and residuals are known; its start cost is that of its end.
fn finished(
    normal: &Normal,
    parameters: Vec<f64>,
    left: &[f64],
    bounds: &[Bounds],
    steps: usize,
) -> Fit {
    let cost = half_square(left);
    let spare = left.len().saturating_sub(parameters.len()).max(1);
    let is_held: Vec<bool> = parameters
        .iter()
        .zip(bounds)
        .map(|(at, one)| at <= &one.lower || at >= &one.upper)
        .collect();
    let uncertainties = normal.uncertainties(2.0 * cost / spare as f64, &is_held);
    let promised = normal.promised(cost, &room(&parameters, bounds));
    let sensitivities = normal.sensitivities();
    Fit { parameters, cost, start_cost: cost, promised, sensitivities, uncertainties, steps }
}

/// Values and derivatives of residuals.
struct Linear {
    values: Vec<f64>,
    columns: Vec<Vec<f64>>,
}

fn linear(residuals: &impl Residuals, at: &[f64], bounds: &[Bounds]) -> Result<Linear, TreeError> {
    if let Some(part) = residuals.differences() {
        return about(residuals, at, bounds, part);
    }
    let mut made = Linear { values: Vec::new(), columns: Vec::new() };
    for k in 0..at.len() {
        let dual = |(j, value): (usize, &f64)| Dual64::new(*value, if j == k { 1.0 } else { 0.0 });
        let parameters: Vec<Dual64> = at.iter().enumerate().map(dual).collect();
        let found = residuals.residuals(&parameters)?;
        made.values = found.iter().map(|one| one.re).collect();
        made.columns.push(found.iter().map(|one| one.eps).collect());
    }
    Ok(made)
}

/// The same by central differences over a part of each parameter, within its bounds.
fn about(
    residuals: &impl Residuals,
    at: &[f64],
    bounds: &[Bounds],
    part: f64,
) -> Result<Linear, TreeError> {
    let mut made = Linear { values: residuals.values(at)?, columns: Vec::new() };
    for (k, one) in bounds.iter().enumerate() {
        let way = part * at[k].abs().max(1e-3);
        let ends = [-way, way].map(|way| (at[k] + way).clamp(one.lower, one.upper));
        let values = |end: f64| {
            let mut there = at.to_vec();
            there[k] = end;
            residuals.values(&there)
        };
        let (low, high) = (values(ends[0])?, values(ends[1])?);
        let length = (ends[1] - ends[0]).max(f64::MIN_POSITIVE);
        made.columns.push(high.iter().zip(&low).map(|(b, a)| (b - a) / length).collect());
    }
    Ok(made)
}

/// Fits by the method of Gauss and Newton, damped as by Levenberg and Marquardt, within bounds.
///
/// # Errors
/// `TreeError::Given` when the start is not within the bounds; those of the residuals at the start; and
/// `TreeError::Stopped`.
pub fn fit(
    residuals: &impl Residuals,
    start: &[f64],
    bounds: &[Bounds],
    most: usize,
) -> Result<Fit, TreeError> {
    checked(start, bounds)?;
    let mut at = start.to_vec();
    let mut now = linear(residuals, &at, bounds)?;
    let start_cost = half_square(&now.values);
    // Changes far below the reach of differences say nothing
    let least = residuals.differences().map_or(LEAST, |part| 1e-3 * part);
    let (mut damping, mut steps) = (1e-3, 0);
    while steps < most {
        check()?;
        let normal = Normal::new(&now.columns, &now.values);
        let step = normal.step(damping, &room(&at, bounds));
        let change =
            step.iter().zip(&at).fold(0.0_f64, |a, (by, at)| a.max(by.abs() / at.abs().max(1e-3)));
        let next: Vec<f64> = at
            .iter()
            .zip(&step)
            .zip(bounds)
            .map(|((at, by), one)| (at + by).clamp(one.lower, one.upper))
            .collect();
        steps += 1;
        // A motion that fails is one that is worse
        let tried = linear(residuals, &next, bounds)
            .ok()
            .filter(|one| half_square(&one.values) < half_square(&now.values));
        match tried {
            Some(better) => {
                at = next;
                now = better;
                damping *= 0.2;
            }
            None => damping *= 10.0,
        }
        if change < least || damping > 1e12 {
            break;
        }
    }
    let normal = Normal::new(&now.columns, &now.values);
    Ok(Fit { start_cost, ..finished(&normal, at, &now.values, bounds, steps) })
}
