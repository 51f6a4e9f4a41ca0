//! `Deviation`: how far a calibrated model is from a run or a record, quantity by quantity.

use nalgebra::Vector3;

use super::error::CalibrateError;
use super::kinematics::moved;
use super::loads::{load, sizes};
use super::record::Record;
use super::sought::{Sought, with_found};
use super::tracks::motion;
use crate::reduced::simulate::simulate;
use crate::run::Series;

/// A quantity of a run or a record by the model and as it was.
#[derive(Debug, Clone, PartialEq)]
pub struct Deviation {
    /// The run or record.
    pub record: String,
    /// Whether it was not fitted.
    pub is_held_out: bool,
    /// Name of the quantity.
    pub quantity: String,
    /// By the model.
    pub model: f64,
    /// As it was.
    pub recorded: f64,
    /// Their difference over the size of what was.
    pub relative: f64,
}

/// A track by the model and as it was recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct Overlay {
    /// The run or record.
    pub record: String,
    /// Whether it was not fitted.
    pub is_held_out: bool,
    /// Name of the track.
    pub track: String,
    /// Times (s).
    pub times: Vec<f64>,
    /// By the model (m, rad).
    pub model: Vec<f64>,
    /// As it was (m, rad).
    pub recorded: Vec<f64>,
}

/// The tracks of a record over those of the model.
pub fn overlays(
    record: &Record,
    sought: &Sought,
    found: &[f64],
) -> Result<Vec<Overlay>, CalibrateError> {
    let made = motion(record, |body, own| sought.filled(body, own, found))?;
    let overlay = |(track, model): (&super::record::Track, Vec<f64>)| Overlay {
        record: record.name.clone(),
        is_held_out: record.is_held_out,
        track: track.name.clone(),
        times: record.times.clone(),
        model,
        recorded: track.values.clone(),
    };
    Ok(record.tracks.iter().zip(made).map(overlay).collect())
}

/// All deviations of a record with its tracks over those of the model.
pub fn deviations(
    record: &Record,
    sought: &Sought,
    names: &[String],
    found: &[f64],
    overlays: &[Overlay],
) -> Result<Vec<Deviation>, CalibrateError> {
    let mut all = Vec::new();
    let mut add = |quantity: &str, model: f64, recorded: f64, relative: f64| {
        if relative.is_finite() {
            all.push(Deviation {
                record: record.name.clone(),
                is_held_out: record.is_held_out,
                quantity: quantity.to_owned(),
                model,
                recorded,
                relative,
            });
        }
    };
    for (track, Overlay { model: made, .. }) in record.tracks.iter().zip(overlays) {
        let change = |values: &[f64]| values.last().copied().unwrap_or_default() - values[0];
        let (model, recorded) = (change(made), change(&track.values));
        add(&format!("{} in all", track.name), model, recorded, model / recorded - 1.0);
        let square: f64 = made.iter().zip(&track.values).map(|(a, b)| (a - b) * (a - b)).sum();
        let rms = (square / made.len() as f64).sqrt();
        let most =
            track.values.iter().fold(0.0_f64, |most, one| most.max((one - track.values[0]).abs()));
        add(&format!("{} apart, rms", track.name), rms, 0.0, rms / most);
    }
    if let Some(series) = &record.series {
        let run = model_with(record, names, found);
        let own = simulate(&run)?;
        for swimmer in &record.model.swimmers {
            for Pair { name, model, run: recorded } in of_swimmer(&swimmer.name, &own, series) {
                add(&name, model, recorded, model / recorded - 1.0);
            }
        }
        let moved = moved(record).unwrap_or_default();
        let [force, torque] = sizes(&moved);
        let (mut forces, mut torques) = (0.0, 0.0);
        for one in &moved {
            let part = &record.reduced.parts[one.body];
            let made = load(part, one, &sought.filled(one.body, &part.coefficients, found));
            forces += (made.force - one.load.force).norm_squared();
            torques += (made.torque - one.load.torque).norm_squared();
        }
        let n = moved.len().max(1) as f64;
        let (forces, torques) = ((forces / n).sqrt(), (torques / n).sqrt());
        add("loads of bodies apart, rms", forces, force, forces / force);
        add("torques of bodies apart, rms", torques, torque, torques / torque);
    }
    Ok(all)
}

/// The model of a run with the coefficients that were found.
fn model_with(record: &Record, names: &[String], found: &[f64]) -> crate::case::Model {
    let mut model = record.model.clone();
    model.case.reduced = model.case.reduced.map(|own| with_found(&own, names, found));
    model
}

/// A quantity by the model and in the run.
struct Pair {
    name: String,
    model: f64,
    run: f64,
}

/// Ways, yaws, and averages over the last cycle of a swimmer by the model and in the run.
fn of_swimmer(name: &str, model: &Series, run: &Series) -> Vec<Pair> {
    let mut all = Vec::new();
    let last = |series: &Series, what: &str| {
        let column = series.column(&format!("{name}.{what}"))?;
        column.last().copied().filter(|value| value.is_finite())
    };
    for what in ["cycle.speed", "cycle.power", "cycle.cost_of_transport"] {
        if let (Some(model), Some(run)) = (last(model, what), last(run, what)) {
            all.push(Pair { name: format!("{name}.{what}"), model, run });
        }
    }
    let way = |series: &Series| {
        let mut sum = Vector3::zeros();
        for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
            if let Some(column) = series.column(&format!("{name}.{letter}")) {
                sum[axis] = column.last()? - column.first()?;
            }
        }
        Some(sum.norm())
    };
    if let (Some(model), Some(run)) = (way(model), way(run)) {
        all.push(Pair { name: format!("{name} way"), model, run });
    }
    let yaw = |series: &Series| {
        let column = series.column(&format!("{name}.angle"))?;
        Some(column.last()? - column.first()?)
    };
    if let (Some(model), Some(run)) = (yaw(model), yaw(run)) {
        all.push(Pair { name: format!("{name} yaw"), model, run });
    }
    all
}
