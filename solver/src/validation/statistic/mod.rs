//! How a time series becomes one number: the statistics of `[[reference]]`.

mod curve;
mod error;
#[cfg(test)]
mod tests;

use self::curve::Curve;
pub use self::error::StatisticError;
use super::morison::{self, Oscillation};
use crate::case::{Case, ForceComponent, Statistic, StatisticKind};
use crate::run::Series;

/// A statistic of a run.
///
/// # Errors
/// [`StatisticError`] when the run does not hold what the statistic needs.
pub fn measured_value(
    series: &Series,
    case: &Case,
    statistic: &Statistic,
) -> Result<f64, StatisticError> {
    let whole = compared(series, statistic)?;
    let window = || whole.whole_window(case.statistics.window);
    let mean = |curve: &Curve| {
        if case.statistics.whole_periods { curve.mean() } else { curve.average_of_all() }
    };
    Ok(match statistic.kind {
        StatisticKind::Final => whole.last(),
        StatisticKind::At => {
            let time = statistic.at.ok_or(StatisticError::Missing("a time, `at`"))?;
            whole.value_at(time)?
        }
        StatisticKind::Max => window()?.extremum(1.0).value,
        StatisticKind::Min => window()?.extremum(-1.0).value,
        StatisticKind::Mean => mean(&window()?),
        StatisticKind::Rms => mean(&window()?.squared()).sqrt(),
        StatisticKind::Strouhal => {
            let scales = case.scales.ok_or(StatisticError::Missing("[scales]"))?;
            scales.length / (scales.velocity * window()?.period(&statistic.formula())?)
        }
        StatisticKind::HalfPeriodAfterMax => {
            let name = case.statistics.phase_of.as_deref();
            let name = name.ok_or(StatisticError::Missing("statistics.phase_of"))?;
            let phase = Curve::of(series, name)?.whole_window(case.statistics.window)?;
            let half_period = 0.5 * phase.period(name)?;
            let last = whole.times.last().copied().unwrap_or(0.0) - half_period;
            let peak = phase.until(last)?.extremum(1.0);
            whole.value_at(peak.time + half_period)?
        }
        StatisticKind::Crossing => {
            let level = statistic.level.ok_or(StatisticError::Missing("a value, `level`"))?;
            whole.time_of(level, case.statistics.window, &statistic.formula())?
        }
        StatisticKind::When => {
            let level = statistic.level.ok_or(StatisticError::Missing("a value, `level`"))?;
            let of = statistic.of.as_deref();
            let of = of.ok_or(StatisticError::Missing("a quantity, `of`"))?;
            let time = Curve::of(series, of)?.time_of(level, case.statistics.window, of)?;
            whole.value_at(time)?
        }
        StatisticKind::Range => {
            let window = window()?;
            window.extremum(1.0).value - window.extremum(-1.0).value
        }
        StatisticKind::MorisonDrag => morison_fit(series, case, statistic)?[0],
        StatisticKind::MorisonInertia => morison_fit(series, case, statistic)?[1],
    })
}

/// A statistic of a run without a flow, over the whole of its series: the last value where it is none of the largest
/// and least one, the range, the mean over time and the root of that of the squares.
///
/// # Errors
/// [`StatisticError`] when the run does not have the quantity.
pub fn measured_in_whole(series: &Series, statistic: &Statistic) -> Result<f64, StatisticError> {
    let curve = compared(series, statistic)?;
    Ok(match statistic.kind {
        StatisticKind::Max => curve.extremum(1.0).value,
        StatisticKind::Min => curve.extremum(-1.0).value,
        StatisticKind::Range => curve.extremum(1.0).value - curve.extremum(-1.0).value,
        StatisticKind::Mean => curve.average_of_all(),
        StatisticKind::Rms => curve.squared().average_of_all().sqrt(),
        _ => curve.last(),
    })
}

/// The quantity of a statistic, less the one that is subtracted.
fn compared(series: &Series, statistic: &Statistic) -> Result<Curve, StatisticError> {
    let mut whole = Curve::of(series, &statistic.quantity)?;
    if let Some(minus) = &statistic.minus {
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
    statistic: &Statistic,
) -> Result<[f64; 2], StatisticError> {
    let scales = case.scales.ok_or(StatisticError::Missing("[scales]"))?;
    let ForceComponent { body, axis } =
        statistic.force_of().ok_or(StatisticError::Missing("a force on a body"))?;
    let column = |name: &str| Curve::of(series, name)?.whole_window(case.statistics.window);
    let force = column(&statistic.quantity)?;
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
