//! How a time series becomes one number: the statistics of `[[reference]]`.

mod curve;
mod error;
#[cfg(test)]
mod tests;

use self::curve::Curve;
pub use self::error::StatisticError;
use super::morison::{self, Oscillation};
use crate::case::{Case, ForceComponent, Reference, Statistic};
use crate::run::Series;

/// The number that is compared with a reference: its statistic of the run, divided by `per`.
///
/// # Errors
/// [`StatisticError`] when the run does not hold what the statistic needs.
pub fn measured_value(
    series: &Series,
    case: &Case,
    reference: &Reference,
) -> Result<f64, StatisticError> {
    let whole = compared(series, reference)?;
    let window = || whole.whole_window(case.statistics.window);
    let mean = |curve: &Curve| {
        if case.statistics.whole_periods { curve.mean() } else { curve.average_of_all() }
    };
    let value = match reference.statistic {
        Statistic::Final => whole.last(),
        Statistic::At => {
            let time = reference.at.ok_or(StatisticError::Missing("a time, `at`"))?;
            whole.value_at(time)?
        }
        Statistic::Max => window()?.extremum(1.0).value,
        Statistic::Min => window()?.extremum(-1.0).value,
        Statistic::Mean => mean(&window()?),
        Statistic::Rms => mean(&window()?.squared()).sqrt(),
        Statistic::Strouhal => {
            let scales = case.scales.ok_or(StatisticError::Missing("[scales]"))?;
            scales.length / (scales.velocity * window()?.period(&reference.formula())?)
        }
        Statistic::HalfPeriodAfterMax => {
            let name = case.statistics.phase_of.as_deref();
            let name = name.ok_or(StatisticError::Missing("statistics.phase_of"))?;
            let phase = Curve::of(series, name)?.whole_window(case.statistics.window)?;
            let half_period = 0.5 * phase.period(name)?;
            let last = whole.times.last().copied().unwrap_or(0.0) - half_period;
            let peak = phase.until(last)?.extremum(1.0);
            whole.value_at(peak.time + half_period)?
        }
        Statistic::Crossing => {
            let level = reference.level.ok_or(StatisticError::Missing("a value, `level`"))?;
            whole.time_of(level, case.statistics.window, &reference.formula())?
        }
        Statistic::When => {
            let level = reference.level.ok_or(StatisticError::Missing("a value, `level`"))?;
            let of = reference.of.as_deref();
            let of = of.ok_or(StatisticError::Missing("a quantity, `of`"))?;
            let time = Curve::of(series, of)?.time_of(level, case.statistics.window, of)?;
            whole.value_at(time)?
        }
        Statistic::Range => {
            let window = window()?;
            window.extremum(1.0).value - window.extremum(-1.0).value
        }
        Statistic::MorisonDrag => morison_fit(series, case, reference)?[0],
        Statistic::MorisonInertia => morison_fit(series, case, reference)?[1],
    };
    Ok(value / reference.per)
}

/// The quantity of a reference, less the one that is subtracted.
fn compared(series: &Series, reference: &Reference) -> Result<Curve, StatisticError> {
    let mut whole = Curve::of(series, &reference.quantity)?;
    if let Some(minus) = &reference.minus {
        for (value, less) in whole.values.iter_mut().zip(Curve::of(series, minus)?.values) {
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
    let ForceComponent { body, axis } =
        reference.force_of().ok_or(StatisticError::Missing("a force on a body"))?;
    let column = |name: &str| Curve::of(series, name)?.whole_window(case.statistics.window);
    let force = column(&reference.quantity)?;
    let velocity = column(&format!("{body}.velocity.{axis}"))?;
    let acceleration = column(&format!("{body}.acceleration.{axis}"))?;
    let oscillation = Oscillation {
        times: &force.times,
        force: &force.values,
        velocity: &velocity.values,
        acceleration: &acceleration.values,
    };
    morison::fit(oscillation, case.fluid.density, scales.length).ok_or_else(|| {
        StatisticError::NoOscillation { body: body.to_owned(), axis: axis.to_owned() }
    })
}
