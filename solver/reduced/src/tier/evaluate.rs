//! `Seeker`: what a calibration or an optimisation of a soft case makes small, with its gradient.

use crate::search::{Evaluated, Sought as Objective};
use crate::soft::{Plan, Seeds, SoftError, Tracks, Trajectory};

use super::mesh::{Bodies, SolidOf};
use super::model::Model;
use super::parameters::Sought;
use alewife_case::soft::search::ObjectiveSpec;

/// What is sought.
#[derive(Debug, Clone, PartialEq)]
pub enum Kind {
    /// A motion whose tracks are these.
    Calibration(Tracks),
    /// An objective that is made large.
    Optimisation(ObjectiveSpec),
}

/// A model, the numbers of it that are sought, and what for.
#[derive(Debug, Clone)]
pub struct Seeker<const D: usize> {
    /// The model.
    pub model: Model<D>,
    /// The numbers.
    pub sought: Sought,
    /// What for.
    pub kind: Kind,
}

/// What an optimisation is about (m, J).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WayAndWork {
    /// How far the markers got along the direction.
    pub way: f64,
    /// Work put into the fibres.
    pub work: f64,
}

/// What is made large, and its derivatives.
pub(super) struct MadeLarge {
    pub(super) value: f64,
    by_way: f64,
    by_work: f64,
}

/// What is made large by way and work in a time (s).
///
/// # Errors
/// [`SoftError::NoWork`]: a way over no work has no value.
pub(super) fn made_large(
    spec: &ObjectiveSpec,
    time: f64,
    WayAndWork { way, work }: WayAndWork,
) -> Result<MadeLarge, SoftError> {
    match spec {
        ObjectiveSpec::Travel { cost_of_work, .. } => {
            Ok(MadeLarge { value: way - cost_of_work * work, by_way: 1.0, by_work: -cost_of_work })
        }
        ObjectiveSpec::WayPerWork { standing_power, .. } => {
            let standing = standing_power * time;
            let all = work + standing;
            if all <= 0.0 {
                // Without the sign of a zero
                let [way, work] = [way, work].map(|value| value + 0.0);
                return Err(SoftError::NoWork { way, work, standing });
            }
            Ok(MadeLarge { value: way / all, by_way: 1.0 / all, by_work: -way / (all * all) })
        }
    }
}

/// The objective as it is made small, and what its gradient begins from.
struct Begun {
    objective: f64,
    seeds: Seeds,
}

impl<const D: usize> Seeker<D>
where
    Bodies: SolidOf<D>,
{
    /// Way and work of a motion.
    #[must_use]
    pub fn way_and_work(&self, objective: &ObjectiveSpec, motion: &Trajectory) -> WayAndWork {
        let Model { body, plan, .. } = &self.model;
        let way = -body.value(motion, &self.model.travel(objective));
        WayAndWork { way, work: Bodies::work(body, plan, motion, &self.model.shares(objective)) }
    }

    /// What is made large, of a motion, and its derivatives by way and work.
    fn made_large(
        &self,
        objective: &ObjectiveSpec,
        motion: &Trajectory,
    ) -> Result<MadeLarge, SoftError> {
        let Plan { frame, targets, .. } = &self.model.plan;
        let time = frame * targets.len() as f64 - objective.after().unwrap_or(0.0);
        made_large(objective, time, self.way_and_work(objective, motion))
    }

    /// The objective of the model as it is: a loss, or what is made large.
    ///
    /// # Errors
    /// Those of a motion, and where the objective has no value.
    pub fn value(&self) -> Result<f64, SoftError> {
        let Model { body, plan, .. } = &self.model;
        let motion = Bodies::simulate(body, plan)?;
        Ok(match &self.kind {
            Kind::Calibration(tracks) => body.value(&motion, tracks),
            Kind::Optimisation(objective) => self.made_large(objective, &motion)?.value,
        })
    }

    /// The objective as it is made small, and what its gradient begins from.
    fn seeds(&self, motion: &Trajectory) -> Result<Begun, SoftError> {
        let Model { body, plan, .. } = &self.model;
        let mut seeds = body.no_seeds(plan);
        match &self.kind {
            Kind::Calibration(tracks) => {
                let objective = body.add_seeds(motion, tracks, 1.0, &mut seeds);
                Ok(Begun { objective, seeds })
            }
            Kind::Optimisation(objective) => {
                let MadeLarge { value, by_way, by_work } = self.made_large(objective, motion)?;
                // Travel is the way with its sign turned, and what is made small the objective with its
                body.add_seeds(motion, &self.model.travel(objective), by_way, &mut seeds);
                let shares = self.model.shares(objective);
                Bodies::add_work_seeds(body, plan, motion, &shares, -by_work, &mut seeds);
                Ok(Begun { objective: -value, seeds })
            }
        }
    }

    /// Takes over values of the numbers that are sought.
    ///
    /// # Errors
    /// For numbers that no body can have.
    pub fn set(&mut self, values: &[f64]) -> Result<(), SoftError> {
        self.sought.write(&mut self.model.case, values);
        self.model.apply()
    }

    fn try_evaluate(&mut self, values: &[f64]) -> Result<Evaluated, SoftError> {
        self.set(values)?;
        let Model { body, plan, .. } = &self.model;
        let motion = Bodies::simulate(body, plan)?;
        let Begun { objective, seeds } = self.seeds(&motion)?;
        let gradient = Bodies::gradient(body, plan, &motion, seeds)?;
        let slope = |keys: &Vec<_>| keys.iter().map(|key| self.model.slope(&gradient, *key)).sum();
        let slopes = self.sought.keys.iter().map(slope).collect();
        Ok(Evaluated { values: values.to_vec(), objective, slopes })
    }
}

impl<const D: usize> Objective for Seeker<D>
where
    Bodies: SolidOf<D>,
{
    fn evaluate(&mut self, values: &[f64]) -> Result<Evaluated, String> {
        self.try_evaluate(values).map_err(|error| error.to_string())
    }
}
