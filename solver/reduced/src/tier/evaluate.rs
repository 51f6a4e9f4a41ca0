//! `Seeker`: what a calibration or an optimisation of a soft case makes small, with its gradient.

use crate::search::{Evaluated, Sought as Objective};
use crate::soft::{Markers, Seeds, SoftError, Trajectory};

use super::mesh::{Bodies, SolidOf};
use super::model::Model;
use super::parameters::Sought;
use alewife_case::soft::search::ObjectiveSpec;

/// What is sought.
#[derive(Debug, Clone, PartialEq)]
pub enum Kind {
    /// Markers that move as these did.
    Calibration(Markers),
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
struct MadeLarge {
    value: f64,
    by_way: f64,
    by_work: f64,
}

fn made_large(spec: &ObjectiveSpec, WayAndWork { way, work }: WayAndWork) -> MadeLarge {
    match spec {
        ObjectiveSpec::Travel { cost_of_work, .. } => {
            MadeLarge { value: way - cost_of_work * work, by_way: 1.0, by_work: -cost_of_work }
        }
        ObjectiveSpec::WayPerWork { .. } => {
            MadeLarge { value: way / work, by_way: 1.0 / work, by_work: -way / (work * work) }
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
    pub fn way_and_work(&self, direction: &[f64], motion: &Trajectory) -> WayAndWork {
        let Model { body, plan, .. } = &self.model;
        let way = -body.value(motion, &self.model.travel(direction));
        WayAndWork { way, work: Bodies::work(body, plan, motion) }
    }

    /// The objective of the model as it is: a loss, or what is made large.
    ///
    /// # Errors
    /// Those of a motion.
    pub fn value(&self) -> Result<f64, SoftError> {
        let Model { body, plan, .. } = &self.model;
        let motion = Bodies::simulate(body, plan)?;
        Ok(match &self.kind {
            Kind::Calibration(markers) => body.value(&motion, markers),
            Kind::Optimisation(objective) => {
                made_large(objective, self.way_and_work(objective.direction(), &motion)).value
            }
        })
    }

    /// The objective as it is made small, and what its gradient begins from.
    fn seeds(&self, motion: &Trajectory) -> Begun {
        let Model { body, plan, .. } = &self.model;
        let mut seeds = body.no_seeds(plan);
        match &self.kind {
            Kind::Calibration(markers) => {
                let objective = body.add_seeds(motion, markers, 1.0, &mut seeds);
                Begun { objective, seeds }
            }
            Kind::Optimisation(objective) => {
                let direction = objective.direction();
                let MadeLarge { value, by_way, by_work } =
                    made_large(objective, self.way_and_work(direction, motion));
                // Travel is the way with its sign turned, and what is made small the objective with its
                body.add_seeds(motion, &self.model.travel(direction), by_way, &mut seeds);
                Bodies::add_work_seeds(body, plan, motion, -by_work, &mut seeds);
                Begun { objective: -value, seeds }
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
        let Begun { objective, seeds } = self.seeds(&motion);
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
