//! `Rounds`: the loop of optimisation on a model, motion of a robot, and calibration of the model by it.

use std::path::Path;

use alewife_case::soft::search::SearchSettings;
use alewife_case::soft::spec::SoftCase;
use alewife_case::soft::{ParameterKey, SoftFile, check_starts};

use super::evaluate::{Kind, Seeker};
use super::mesh::{Bodies, SolidOf};
use super::model::{Model, TierError};
use super::parameters::Sought;
use crate::search::{Found, Progress, Search, search};
use crate::soft::{Angles, SoftError, Tracks};

/// What moves as it is told, and is seen by its markers: a recorded robot, a model with other numbers, another
/// solver.
pub trait Robot {
    /// Moves as a case tells it: displacements (m) of the markers from rest by frame, marker and axis, the start
    /// included, and what is made large.
    ///
    /// # Errors
    /// Why it did not move.
    fn moves(&mut self, told: &SoftCase) -> Result<Seen, String>;
}

/// What is seen of a robot.
#[derive(Debug, Clone, PartialEq)]
pub struct Seen {
    /// Displacements (m) by frame, marker and axis.
    pub displacements: Vec<Vec<Vec<f64>>>,
    /// What the optimisation makes large.
    pub objective: f64,
}

/// What a round came to.
#[derive(Debug, Clone, PartialEq)]
pub struct Round {
    /// What the model makes of its optimum.
    pub model: f64,
    /// What the robot does.
    pub robot: f64,
    /// The numbers of the calibration after it.
    pub calibrated: Vec<f64>,
    /// Its loss.
    pub loss: f64,
}

/// A model with what is sought of it.
pub struct Rounds<const D: usize> {
    /// The model, whose case has what was found so far.
    pub model: Model<D>,
    optimised: Sought,
    calibrated: Sought,
}

/// The settings of a search.
#[must_use]
pub fn settings(spec: &SearchSettings) -> Search {
    Search {
        max_evaluations: spec.evaluations,
        decrease: spec.decrease,
        slope: spec.slope,
        known: Vec::new(),
    }
}

impl<const D: usize> Rounds<D>
where
    Bodies: SolidOf<D>,
{
    /// The loop of a case.
    ///
    /// # Errors
    /// Those of a model, and where the case has no calibration or no optimisation, or one that cannot start.
    pub fn new(file: &SoftFile) -> Result<Self, TierError> {
        let outside = check_starts(file);
        if !outside.is_empty() {
            return Err(TierError::Case(outside));
        }
        let model = Model::new(file)?;
        let (Some(calibration), Some(optimisation)) =
            (&file.case.calibration, &file.case.optimisation)
        else {
            let message = "the loop needs [calibration] and [optimisation]".to_owned();
            return Err(file.error("", message, "add the one that is missing").into());
        };
        Ok(Self {
            optimised: Sought::new(&file.case, &optimisation.parameter),
            calibrated: Sought::new(&file.case, &calibration.parameter),
            model,
        })
    }

    /// Names of the numbers that are calibrated.
    #[must_use]
    pub fn names(&self) -> Vec<&str> {
        self.calibrated.bounded.iter().map(|one| one.name.as_str()).collect()
    }

    /// One round; its journals are in a directory, by its number.
    ///
    /// # Errors
    /// Why a search or the robot failed.
    pub fn round(
        &mut self,
        number: usize,
        directory: &Path,
        robot: &mut dyn Robot,
        told: &mut dyn FnMut(&str, &Progress),
    ) -> Result<Round, String> {
        let (Some(optimisation), Some(calibration)) =
            (self.model.case.optimisation.clone(), self.model.case.calibration.clone())
        else {
            return Err("the loop needs [calibration] and [optimisation]".to_owned());
        };
        let journal = |what: &str| directory.join(format!("round-{number}-{what}.journal"));
        let kind = Kind::Optimisation(optimisation.objective);
        let at = journal("optimisation");
        let found = self.seek(true, kind, &settings(&optimisation.search), &at, told)?;
        let seen = robot.moves(&self.model.case)?;
        let markers = self.model.markers(seen.displacements);
        let kind = Kind::Calibration(Tracks { markers, angles: Angles::default() });
        let at = journal("calibration");
        let after = self.seek(false, kind, &settings(&calibration.search), &at, told)?;
        Ok(Round {
            model: -found.best.objective,
            robot: seen.objective,
            calibrated: after.best.values,
            loss: after.best.objective,
        })
    }

    /// Seeks from the numbers at hand, and takes over what is found.
    fn seek(
        &mut self,
        is_optimisation: bool,
        kind: Kind,
        settings: &Search,
        journal: &Path,
        told: &mut dyn FnMut(&str, &Progress),
    ) -> Result<Found, String> {
        let mut sought = if is_optimisation { &self.optimised } else { &self.calibrated }.clone();
        for (bounded, keys) in sought.bounded.iter_mut().zip(&sought.keys) {
            let own = keys.first().and_then(|key| key.read(&self.model.case));
            bounded.start = own.unwrap_or(bounded.start).clamp(bounded.lower, bounded.upper);
        }
        let what = if is_optimisation { "optimisation" } else { "calibration" };
        let path = journal.display().to_string();
        let name = format!("alewife {what} in a loop");
        let bounded = sought.bounded.clone();
        let mut seeker = Seeker { model: self.model.clone(), sought, kind };
        let found = search(&bounded, settings, [&path, &name], &mut seeker, &mut |progress| {
            told(what, progress);
        })
        .map_err(|error| error.to_string())?;
        seeker.set(&found.best.values).map_err(|error: SoftError| error.to_string())?;
        self.model = seeker.model;
        Ok(found)
    }
}

/// A model with other numbers, which stands for a robot.
#[derive(Debug, Clone)]
pub struct Perturbed<const D: usize> {
    model: Model<D>,
    others: Vec<(ParameterKey, f64)>,
}

impl<const D: usize> Perturbed<D>
where
    Bodies: SolidOf<D>,
{
    /// The robot of a case.
    ///
    /// # Errors
    /// Those of a model, and where the case names no robot.
    pub fn new(file: &SoftFile) -> Result<Self, TierError> {
        let Some(robot) = &file.case.robot else {
            let message = "the loop needs a robot, and the case names none".to_owned();
            let help = "add [robot] with `set`, the numbers in which it differs from the model";
            return Err(file.error("robot", message, help).into());
        };
        let mut others = Vec::new();
        for (key, value) in &robot.set {
            let found = ParameterKey::find(&file.case, key).unwrap_or_default();
            others.extend(found.into_iter().map(|one| (one, *value)));
        }
        Ok(Self { model: Model::new(file)?, others })
    }
}

impl<const D: usize> Robot for Perturbed<D>
where
    Bodies: SolidOf<D>,
{
    fn moves(&mut self, told: &SoftCase) -> Result<Seen, String> {
        self.model.case = told.clone();
        for (key, value) in &self.others {
            key.write(&mut self.model.case, *value);
        }
        self.model.apply().map_err(|error| error.to_string())?;
        let Model { body, plan, nodes, .. } = &self.model;
        let motion = Bodies::simulate(body, plan).map_err(|error| error.to_string())?;
        let rest = body.solid.at_rest();
        let moved = |places: &[f64], node: usize| -> Vec<f64> {
            (D * node..D * (node + 1)).map(|k| places[k] - rest[k]).collect()
        };
        let frames = motion.levels.iter().step_by(plan.substeps);
        let displacements = frames
            .map(|level| nodes.iter().map(|node| moved(&level.places, *node)).collect())
            .collect();
        let Some(optimisation) = told.optimisation.clone() else {
            return Err("the case has no [optimisation]".to_owned());
        };
        let kind = Kind::Optimisation(optimisation.objective);
        let sought = Sought { bounded: Vec::new(), keys: Vec::new() };
        let seeker = Seeker { model: self.model.clone(), sought, kind };
        let objective = seeker.value().map_err(|error| error.to_string())?;
        Ok(Seen { displacements, objective })
    }
}
