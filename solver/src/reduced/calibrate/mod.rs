//! Coefficients of a reduced model from runs of the full solver or from records: what `calibrate` does to a tree.

mod both;
mod compare;
mod error;
mod file;
mod kinematics;
mod loads;
mod record;
mod report;
mod sought;
mod standing;
mod tracks;

pub use compare::{Deviation, Overlay};
pub use error::CalibrateError;
pub use record::check_records;

use alewife_interrupt::check_whole;
use alewife_reduced::tree::{Fit, TreeError};

use self::record::{Origin, Record, records};
use self::sought::{Sought, with_found};
use crate::case::{CaseFile, FitBy, LoadLaw, ReducedSpec};

/// What a calibration has found.
#[derive(Debug, Clone)]
pub struct Calibrated {
    /// Names, in the order of the values.
    pub names: Vec<String>,
    /// Values with their uncertainties.
    pub fit: Fit,
    /// Bounds of each.
    pub bounds: Vec<[f64; 2]>,
    /// Whether each changes anything of what is fitted.
    pub has_effect: Vec<bool>,
    /// What is to be said of the fit, if anything is.
    pub remark: Option<String>,
    /// Errors by quantity of all runs and records, those fitted and those held out.
    pub deviations: Vec<Deviation>,
    /// Tracks of all runs and records over those of the model.
    pub overlays: Vec<Overlay>,
    spec: ReducedSpec,
    by: FitBy,
    case: String,
    bodies: Vec<String>,
    origins: Vec<Origin>,
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
/// `CalibrateError` when the case asks for none, a run or a record cannot be read or is of another swimmer, a motion
/// fails, or nothing is fitted.
pub fn calibrate(file: &CaseFile) -> Result<Calibrated, CalibrateError> {
    let case = file.case();
    let Some(spec) = &case.calibration else { return Err(CalibrateError::Nothing) };
    let reduced = case.reduced_model();
    let sought = Sought::new(spec, &reduced, &file.model);
    let records = records(file, spec, &reduced)?;
    let fitted: Vec<&Record> = records.iter().filter(|one| !one.is_held_out).collect();
    let fit = match spec.fits() {
        FitBy::Loads => loads::fitted(&fitted, &sought, is_linear(reduced.loads))?,
        FitBy::Tracks => tracks::fitted(&fitted, &sought, MOST_STEPS)?,
        FitBy::Both => both::fitted(&fitted, &sought, MOST_STEPS)?,
    };
    check_whole().map_err(TreeError::from)?;
    let remark = standing::judged(&fit, &sought.start, &sought.bounds, &spec.fit)?;
    let found = with_found(&reduced, &spec.fit, &fit.parameters);
    let (mut deviations, mut overlays) = (Vec::new(), Vec::new());
    for record in &records {
        let own = compare::overlays(record, &sought, &fit.parameters)?;
        deviations.extend(compare::deviations(record, &sought, &spec.fit, &fit.parameters, &own)?);
        overlays.extend(own);
    }
    Ok(Calibrated {
        names: spec.fit.clone(),
        bounds: spec.fit.iter().map(|name| spec.bounds_of(name)).collect(),
        has_effect: standing::has_effect(&fit, &sought.bounds),
        remark,
        fit,
        deviations,
        overlays,
        spec: found,
        by: spec.fits(),
        case: file.full_name(),
        bodies: file.model.bodies.iter().map(|body| body.name.clone()).collect(),
        origins: records.iter().map(Record::origin).collect(),
    })
}
