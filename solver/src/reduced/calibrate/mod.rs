//! Coefficients of a reduced model from runs of the full solver or from records: what `calibrate` does to a tree.

mod both;
mod compare;
mod error;
mod file;
mod kinematics;
mod loads;
mod record;
mod report;
mod tracks;

pub use compare::Deviation;
pub use error::CalibrateError;

use alewife_reduced::tree::{Bounds, Fit};

use self::record::{Record, records};
use crate::case::{CalibrationSpec, CaseFile, FitBy, LoadLaw, ReducedSpec};

/// What a calibration has found.
#[derive(Debug, Clone)]
pub struct Calibrated {
    /// Names, in the order of the values.
    pub names: Vec<String>,
    /// Values with their uncertainties.
    pub fit: Fit,
    /// Bounds of each.
    pub bounds: Vec<[f64; 2]>,
    /// Errors by quantity of all runs and records, those fitted and those held out.
    pub deviations: Vec<Deviation>,
    spec: ReducedSpec,
    by: FitBy,
    case: String,
    bodies: Vec<String>,
    origins: Vec<Origin>,
}

/// Where a run or record is from.
#[derive(Debug, Clone)]
struct Origin {
    name: String,
    hash: String,
    is_held_out: bool,
    rows: usize,
    periods: Vec<f64>,
    amplitudes: Vec<f64>,
    viscosity: f64,
}

/// Which coefficients of a law are found, by their numbers.
pub(super) struct Sought {
    numbers: Vec<usize>,
    bounds: Vec<Bounds>,
    start: Vec<f64>,
}

impl Sought {
    fn new(spec: &CalibrationSpec, reduced: &ReducedSpec) -> Self {
        let all = reduced.loads.coefficients();
        let number = |name: &String| all.iter().position(|one| one.name == name);
        let numbers: Vec<usize> = spec.fit.iter().filter_map(number).collect();
        let own = reduced.coefficients_of("");
        let bound = |name: &String| {
            let [lower, upper] = spec.bounds_of(name);
            Bounds { lower, upper }
        };
        let bounds = spec.fit.iter().map(bound).collect();
        let start = numbers.iter().map(|number| own[*number]).collect();
        Self { numbers, bounds, start }
    }

    /// All coefficients of a body with those that are found at other values.
    fn filled<T: alewife_reduced::tree::Number>(&self, own: &[f64], found: &[T]) -> Vec<T> {
        let mut all: Vec<T> = own.iter().map(|value| alewife_reduced::tree::real(*value)).collect();
        for (number, value) in self.numbers.iter().zip(found) {
            all[*number] = *value;
        }
        all
    }
}

/// Steps of Gauss and Newton at most.
const MOST_STEPS: usize = 200;

/// Whether loads depend on coefficients linearly.
fn is_linear(law: LoadLaw) -> bool {
    matches!(law, LoadLaw::Links | LoadLaw::Resistive | LoadLaw::Fossen)
}

/// Finds the coefficients that a case asks for.
///
/// # Errors
/// `CalibrateError` when the case asks for none, a run or a record cannot be read or is of another swimmer, or a motion
/// fails.
pub fn calibrate(file: &CaseFile) -> Result<Calibrated, CalibrateError> {
    let case = file.case();
    let Some(spec) = &case.calibration else { return Err(CalibrateError::Nothing) };
    let reduced = case.reduced_model();
    let sought = Sought::new(spec, &reduced);
    let records = records(file, spec, &reduced)?;
    let fitted: Vec<&Record> = records.iter().filter(|one| !one.is_held_out).collect();
    let fit = match spec.fits() {
        FitBy::Loads => loads::fitted(&fitted, &sought, is_linear(reduced.loads))?,
        FitBy::Tracks => tracks::fitted(&fitted, &sought, MOST_STEPS)?,
        FitBy::Both => both::fitted(&fitted, &sought, MOST_STEPS)?,
    };
    let mut found = reduced.clone();
    for (name, value) in spec.fit.iter().zip(&fit.parameters) {
        found.coefficients.insert(name.clone(), *value);
    }
    let mut deviations = Vec::new();
    for record in &records {
        deviations.extend(compare::deviations(record, &sought, &fit.parameters)?);
    }
    Ok(Calibrated {
        names: spec.fit.clone(),
        bounds: spec.fit.iter().map(|name| spec.bounds_of(name)).collect(),
        fit,
        deviations,
        spec: found,
        by: spec.fits(),
        case: file.full_name(),
        bodies: file.model.bodies.iter().map(|body| body.name.clone()).collect(),
        origins: records.iter().map(Record::origin).collect(),
    })
}
