//! Coefficients of a reduced model from runs of the full solver or from records: what `calibrate` does to a tree.

mod both;
mod compare;
mod error;
mod file;
mod kinematics;
mod loads;
mod reading;
mod record;
mod report;
mod search;
mod sought;
mod standing;
mod tracks;

pub use compare::{Deviation, Overlay};
pub use error::CalibrateError;
pub use reading::check_records;
pub use report::RUN;
pub use search::{JOURNAL, Tally};

use std::path::Path;

use alewife_interrupt::check_whole;
use alewife_reduced::tree::{Fit, Residuals, TreeError, fit};

use self::both::Both;
use self::loads::Loads;
use self::reading::{records, written_in};
use self::record::{Origin, Record};
use self::search::{Desk, Searched, directory_of, searched};
use self::sought::{Sought, with_found};
use self::tracks::Swims;
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
    /// Whether each changes anything of what is fitted.
    pub has_effect: Vec<bool>,
    /// What became of proposals, where a search found it.
    pub tally: Option<Tally>,
    /// What is to be said of the fit, if anything is.
    pub remark: Option<String>,
    /// Errors by quantity of all runs and records, those fitted and those held out.
    pub deviations: Vec<Deviation>,
    /// Tracks of all runs and records over those of the model.
    pub overlays: Vec<Overlay>,
    spec: ReducedSpec,
    /// The case with all that was found, where other numbers than coefficients were.
    run: Option<String>,
    by: FitBy,
    case: String,
    bodies: Vec<String>,
    origins: Vec<Origin>,
}

/// Steps of Gauss and Newton at most.
const MOST_STEPS: usize = 200;

/// Whether loads depend on coefficients linearly.
fn is_linear(law: LoadLaw) -> bool {
    matches!(law, LoadLaw::Links | LoadLaw::Ebt | LoadLaw::Resistive | LoadLaw::Fossen)
}

/// What is fitted, and how.
struct Fits<'a> {
    records: &'a [&'a Record],
    sought: &'a Sought,
    spec: &'a CalibrationSpec,
    law: LoadLaw,
}

/// A fit, and what became of proposals where a search made it.
struct Found {
    fit: Fit,
    tally: Option<Tally>,
}

impl Fits<'_> {
    fn found(&self, desk: &mut Desk<'_>) -> Result<Found, CalibrateError> {
        let Self { records, sought, .. } = *self;
        match self.spec.fits() {
            FitBy::Loads => {
                let loads = Loads::new(records, sought)?;
                if self.spec.search.is_some() {
                    return self.by(&loads, desk);
                }
                let fit = loads::fitted(&loads, sought, is_linear(self.law))?;
                Ok(Found { fit, tally: None })
            }
            FitBy::Tracks => self.by(&Swims { records, sought }, desk),
            FitBy::Both => {
                let loads = Loads::new(records, sought)?;
                self.by(&Both { loads, records, sought }, desk)
            }
        }
    }

    /// By a search where one is asked for, else by the method of Gauss and Newton.
    fn by(&self, residuals: &impl Residuals, desk: &mut Desk<'_>) -> Result<Found, CalibrateError> {
        let Sought { start, bounds, .. } = self.sought;
        let Some(search) = &self.spec.search else {
            return Ok(Found { fit: fit(residuals, start, bounds, MOST_STEPS)?, tally: None });
        };
        let Searched { fit, tally } = searched(residuals, self.sought, search, desk)?;
        Ok(Found { fit, tally: Some(tally) })
    }
}

/// The case with all that was found, where that is more than coefficients, as a text.
fn run_of(
    file: &CaseFile,
    sought: &Sought,
    law: &ReducedSpec,
    found: &[f64],
) -> Result<Option<String>, CalibrateError> {
    if !sought.has_numbers() {
        return Ok(None);
    }
    let wrong = |what: String| CalibrateError::Tree(TreeError::Given(what));
    let numbers = sought.numbers(file, found).map_err(|error| wrong(error.to_string()))?;
    let changed = file.with_numbers(&numbers).map_err(|error| wrong(error.to_string()))?;
    let mut case = changed.case().clone();
    let own = case.reduced_model();
    case.reduced = Some(ReducedSpec {
        coefficients: law.coefficients.clone(),
        body: law.body.clone(),
        calibrated: None,
        ..own
    });
    case.calibration = None;
    case.to_toml().map(Some).map_err(|error| wrong(error.to_string()))
}

/// Finds the coefficients that a case asks for; a search among them leaves no journal.
///
/// # Errors
/// Those of [`calibrate_in`].
pub fn calibrate(file: &CaseFile) -> Result<Calibrated, CalibrateError> {
    calibrate_in(file, None, &mut |_| ())
}

/// Which search it is: the case but for how long it goes on, and what it is fitted to.
fn search_name(file: &CaseFile, records: &[Record]) -> String {
    let mut case = file.case().clone();
    if let Some(search) = case.calibration.as_mut().and_then(|own| own.search.as_mut()) {
        search.evaluations = 0;
    }
    let mut text = case.to_toml().unwrap_or_default();
    for record in records {
        text.push_str(&record.origin().hash);
    }
    format!("proposals {}", file::hash(text.as_bytes()))
}

/// Finds the coefficients that a case asks for. A search has its journal in a directory, from which it is taken up again
/// with the same bits, and `told` is called with a line after each of its motions.
///
/// # Errors
/// `CalibrateError` when the case asks for none, a run or a record cannot be read or is of another swimmer, a motion
/// fails, or nothing is fitted.
pub fn calibrate_in(
    file: &CaseFile,
    directory: Option<&Path>,
    told: &mut dyn FnMut(&str),
) -> Result<Calibrated, CalibrateError> {
    let case = file.case();
    let Some(spec) = &case.calibration else { return Err(CalibrateError::Nothing) };
    let reduced = case.reduced_model();
    let sought = Sought::new(spec, &reduced, file);
    let records = records(file, spec, &reduced)?;
    let fitted: Vec<&Record> = records.iter().filter(|one| !one.is_held_out).collect();
    let desk = &mut Desk {
        directory: directory.map(Path::to_path_buf),
        case_directory: directory_of(&written_in(file, "calibration.search.command")),
        name: search_name(file, &records),
        told,
    };
    let fits = Fits { records: &fitted, sought: &sought, spec, law: reduced.loads };
    let Found { fit, tally } = fits.found(desk)?;
    check_whole().map_err(TreeError::from)?;
    let remark = standing::judged(&fit, &sought.start, &sought.bounds, &sought.names)?;
    let found = with_found(&reduced, &spec.fit, &fit.parameters);
    let run = run_of(file, &sought, &found, &fit.parameters)?;
    let (mut deviations, mut overlays) = (Vec::new(), Vec::new());
    for record in &records {
        let record = &*record.at(&sought, &fit.parameters)?;
        let own = compare::overlays(record, &sought, &fit.parameters)?;
        deviations.extend(compare::deviations(record, &sought, &spec.fit, &fit.parameters, &own)?);
        overlays.extend(own);
    }
    Ok(Calibrated {
        names: sought.names.clone(),
        bounds: sought.bounds.iter().map(|one| [one.lower, one.upper]).collect(),
        has_effect: standing::has_effect(&fit, &sought.bounds),
        remark,
        tally,
        fit,
        deviations,
        overlays,
        spec: found,
        run,
        by: spec.fits(),
        case: file.full_name(),
        bodies: file.model.bodies.iter().map(|body| body.name.clone()).collect(),
        origins: records.iter().map(Record::origin).collect(),
    })
}
