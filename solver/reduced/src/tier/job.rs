//! `Job`: a calibration or an optimisation of a soft case from beginning to end.

use std::fmt::Write as _;
use std::path::Path;

use alewife_case::soft::search::SearchSettings;
use alewife_case::soft::spec::{ReferenceOf, SoftCase};
use alewife_case::soft::{SoftFile, check_starts};
use alewife_interrupt::check_whole;
use serde_json::{Value, json};

use super::compare::{Compared, compare};
use super::evaluate::{Kind, Seeker, WayAndWork};
use super::mesh::{Bodies, SolidOf};
use super::model::{Model, TierError};
use super::output::{checksum_of_case, fingerprint, write_case};
use super::parameters::Sought;
use super::rounds::settings;
use crate::search::{
    Bounded, Certainties, Evaluated, Found, Progress, SearchError, Slope, certainties,
    number_lines, numbers_to_json, search, slopes, write_whole,
};

/// The rise of a loss, of that at the start, that counts as one where parameters are called determined.
const RISE: f64 = 0.05;

/// The file of evaluations, by which a search goes on.
const JOURNAL: &str = "search.journal";

/// Which of the searches of a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Which {
    /// `[calibration]`.
    Calibration,
    /// `[optimisation]`.
    Optimisation,
}

impl Which {
    /// Its table.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Calibration => "calibration",
            Self::Optimisation => "optimisation",
        }
    }

    /// The sign of what is made small in what is told: a loss, or an objective that is made large.
    fn sign(self) -> f64 {
        if self == Self::Calibration { 1.0 } else { -1.0 }
    }
}

/// A search of a case.
pub struct Job<'a, const D: usize> {
    file: &'a SoftFile,
    which: Which,
    search: SearchSettings,
    seeker: Seeker<D>,
}

/// What a search came to.
#[derive(Debug, Clone)]
pub struct JobResult {
    /// What was found.
    pub found: Found,
    /// The numbers that were sought.
    pub bounded: Vec<Bounded>,
    /// How well each is determined; why that is not known, where it is not.
    pub certainties: Certainties,
    /// Way and work at the best, of an optimisation.
    pub way_and_work: Option<WayAndWork>,
    /// The case with what was found.
    pub case: SoftCase,
    /// References beside what was found.
    pub compared: Vec<Compared>,
}

impl<'a, const D: usize> Job<'a, D>
where
    Bodies: SolidOf<D>,
{
    /// Makes a search of a case ready.
    ///
    /// # Errors
    /// Those of a model, and where the case has no such search, or one that cannot start at its numbers.
    pub fn new(file: &'a SoftFile, which: Which) -> Result<Self, TierError> {
        let mut outside = check_starts(file);
        outside.retain(|one| one.key.starts_with(which.name()));
        if !outside.is_empty() {
            return Err(TierError::Case(outside));
        }
        let model = Model::new(file)?;
        let absent = |what: &str, help: &str| {
            TierError::from(file.error("", format!("the case has no {what}"), help))
        };
        let (parameters, search, kind) = match which {
            Which::Calibration => {
                let help = "add [calibration] with the numbers that are sought";
                let Some(own) = &file.case.calibration else {
                    return Err(absent("[calibration]", help));
                };
                let Some(recorded) = &model.recorded else {
                    return Err(absent("[record]", "add the file of a recorded motion"));
                };
                (&own.parameter, own.search, Kind::Calibration(model.tracks(recorded)))
            }
            Which::Optimisation => {
                let help = "add [optimisation] with the numbers that are sought";
                let Some(own) = &file.case.optimisation else {
                    return Err(absent("[optimisation]", help));
                };
                (&own.parameter, own.search, Kind::Optimisation(own.objective.clone()))
            }
        };
        let sought = Sought::new(&file.case, parameters);
        Ok(Self { file, which, search, seeker: Seeker { model, sought, kind } })
    }

    /// Seeks, with the journal of the search in a directory: where there is one of this search already, it goes
    /// on from there with the same bits.
    ///
    /// # Errors
    /// Those of [`search`].
    pub fn seek(
        mut self,
        directory: &Path,
        told: &mut dyn FnMut(&Progress),
    ) -> Result<JobResult, SearchError> {
        let journal = directory.join(JOURNAL).display().to_string();
        let name = format!(
            "alewife {} of {}, version {}",
            self.which.name(),
            fingerprint(self.file),
            env!("CARGO_PKG_VERSION")
        );
        let bounded = self.seeker.sought.bounded.clone();
        let settings = settings(&self.search);
        let found = search(&bounded, &settings, [&journal, &name], &mut self.seeker, told)?;
        let first = found.all.first().map_or(0.0, |first| first.objective.abs());
        let certainties = certainties(&bounded, &found.best, RISE * first, &mut self.seeker);
        check_whole()?;
        let case = {
            let mut case = self.file.case.clone();
            self.seeker.sought.write(&mut case, &found.best.values);
            case
        };
        let way_and_work = self.way_and_work(&found.best);
        let value = |quantity: &str| self.value(&found.best, way_and_work, quantity);
        let of = match self.which {
            Which::Calibration => ReferenceOf::Calibration,
            Which::Optimisation => ReferenceOf::Optimisation,
        };
        let compared = compare(&self.file.case, of, &value);
        Ok(JobResult { found, bounded, certainties, way_and_work, case, compared })
    }

    /// Way and work at values, of an optimisation.
    fn way_and_work(&mut self, best: &Evaluated) -> Option<WayAndWork> {
        let Kind::Optimisation(objective) = self.seeker.kind.clone() else { return None };
        self.seeker.set(&best.values).ok()?;
        let Model { body, plan, .. } = &self.seeker.model;
        let motion = Bodies::simulate(body, plan).ok()?;
        Some(self.seeker.way_and_work(&objective, &motion))
    }

    /// A quantity of what was found.
    fn value(&self, best: &Evaluated, of: Option<WayAndWork>, quantity: &str) -> Option<f64> {
        match (quantity, self.which) {
            ("loss", Which::Calibration) => Some(best.objective),
            ("objective", Which::Optimisation) => Some(-best.objective),
            ("way", _) => of.map(|of| of.way),
            ("work", _) => of.map(|of| of.work),
            (name, _) => {
                let parameters = &self.seeker.sought.bounded;
                let at = parameters.iter().position(|one| one.name == name)?;
                Some(best.values[at])
            }
        }
    }
}

impl JobResult {
    /// The slopes at the best, of the loss or of what was made large.
    fn slopes(&self, which: Which) -> Vec<Slope> {
        let slopes = slopes(&self.bounded, &self.found.best, which.sign());
        slopes.into_iter().map(|own| Slope { own, with_held: None }).collect()
    }

    /// The report, as it is printed.
    #[must_use]
    pub fn text(&self, which: Which) -> String {
        let Found { best, all, ended } = &self.found;
        let sign = which.sign();
        let what = if which == Which::Calibration { "loss" } else { "objective" };
        let first = all.first().map_or(f64::NAN, |first| first.objective);
        let mut text = format!(
            "{} after {} evaluations: {what} {:.6e}, {:.6e} at the start; {}\n",
            which.name(),
            all.len(),
            sign * best.objective,
            sign * first,
            ended.text()
        );
        if let Some(WayAndWork { way, work }) = self.way_and_work {
            let _ = writeln!(text, "way {way:.6e}, work {work:.6e}");
        }
        text += &number_lines(&self.bounded, &self.found, &self.certainties, &self.slopes(which));
        text
    }

    /// The report as JSON.
    #[must_use]
    pub fn to_json(&self, which: Which) -> Value {
        let Found { best, all, ended } = &self.found;
        let (sign, slopes) = (which.sign(), self.slopes(which));
        json!({
            "search": which.name(),
            "objective": sign * best.objective,
            "start": all.first().map(|first| sign * first.objective),
            "evaluations": all.len(),
            "ended": ended.word(),
            "parameters": numbers_to_json(&self.bounded, &self.found, &self.certainties, &slopes),
            "comparison": self.compared.iter().map(Compared::to_json).collect::<Vec<_>>(),
        })
    }

    /// Writes `case.toml`, a case that runs with what was found, and `report.json`.
    ///
    /// # Errors
    /// What the file system reports.
    pub fn write(&self, directory: &Path, file: &SoftFile, which: Which) -> std::io::Result<()> {
        write_case(directory, file, &self.case)?;
        let mut report = self.to_json(which);
        report["case"] = json!(checksum_of_case(directory)?);
        let report = format!("{report:#}\n");
        write_whole(&directory.join("report.json"), report)
    }
}
