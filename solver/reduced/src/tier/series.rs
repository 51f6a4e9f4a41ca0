//! The series of a motion: places and velocities of its markers, angles, energies and work, frame by frame.

use std::fmt::Write as _;

use alewife_case::soft::search::ObjectiveSpec;

use super::evaluate::{WayAndWork, made_large};
use super::mesh::{Bodies, SolidOf};
use super::model::Model;
use crate::soft::{SoftError, Trajectory, Travel};

/// Columns over time, one row a frame and one at the start.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Names of the columns, the first of which is the time.
    pub names: Vec<String>,
    /// Rows.
    pub rows: Vec<Vec<f64>>,
}

impl Series {
    /// The last value of a column.
    #[must_use]
    pub fn last(&self, name: &str) -> Option<f64> {
        let column = self.names.iter().position(|own| own == name)?;
        self.rows.last()?.get(column).copied()
    }

    /// As comma-separated values, with the digits to read the same numbers back.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let mut text = self.names.join(",") + "\n";
        for row in &self.rows {
            let cells: Vec<String> = row.iter().map(|value| format!("{value:?}")).collect();
            let _ = writeln!(text, "{}", cells.join(","));
        }
        text
    }
}

/// The series of a motion.
///
/// # Errors
/// [`SoftError::Solid`] where a cell is turned over.
pub fn series<const D: usize>(model: &Model<D>, motion: &Trajectory) -> Result<Series, SoftError>
where
    Bodies: SolidOf<D>,
{
    let Model { case, body, plan, nodes, .. } = model;
    let bends = model.bends();
    let names = ["time".to_owned()].into_iter().chain(case.quantities()).collect();
    let at_rest = vec![1.0; body.solid.spec().fibres.len()];
    let mut rows = Vec::new();
    let mut work = 0.0;
    let mut told = &at_rest;
    let mut so_far = case.optimisation.as_ref().map(|own| SoFar::new(model, &own.objective));
    for frame in 0..=plan.targets.len() {
        let level = &motion.levels[frame * plan.substeps];
        let time = frame as f64 * plan.frame;
        let mut row = vec![time];
        for node in nodes {
            row.extend_from_slice(&level.places[D * node..D * (node + 1)]);
            row.extend_from_slice(&level.velocities[D * node..D * (node + 1)]);
        }
        row.extend(bends.iter().map(|bend| bend.angle(&level.places)));
        let momentum = body.solid.times_mass(&level.velocities);
        row.push(0.5 * momentum.iter().zip(&level.velocities).map(|(p, v)| p * v).sum::<f64>());
        row.push(body.solid.elastic_energy(&level.places, told)?);
        row.push(work);
        row.extend(so_far.iter().map(|sum| sum.value(time)));
        rows.push(row);
        if let Some(next) = plan.targets.get(frame) {
            let energy = |told: &[f64]| body.solid.fibre_energy(&level.places, told).value;
            let put_in = energy(next) - energy(told);
            work += put_in;
            told = next;
            if let Some(sum) = &mut so_far {
                let end = &motion.levels[(frame + 1) * plan.substeps];
                sum.add(frame, &level.places, &end.places, put_in);
            }
        }
    }
    Ok(Series { names, rows })
}

/// What an optimisation makes large, as far as a motion has come.
struct SoFar<'a> {
    objective: &'a ObjectiveSpec,
    travel: Travel,
    sum: WayAndWork,
}

impl<'a> SoFar<'a> {
    fn new<const D: usize>(model: &Model<D>, objective: &'a ObjectiveSpec) -> Self
    where
        Bodies: SolidOf<D>,
    {
        let travel = model.travel(objective);
        Self { objective, travel, sum: WayAndWork { way: 0.0, work: 0.0 } }
    }

    /// Adds the way and the work (J) of a frame.
    fn add(&mut self, frame: usize, from: &[f64], to: &[f64], work: f64) {
        let share = self.travel.shares[frame];
        self.sum.way += share * self.travel.way(from, to);
        self.sum.work += share * work;
    }

    /// The objective up to a time (s): 0 before anything counts, not a number where it has no value.
    fn value(&self, time: f64) -> f64 {
        let counted = (time - self.objective.after().unwrap_or(0.0)).max(0.0);
        if self.sum.way == 0.0 && self.sum.work == 0.0 {
            return 0.0;
        }
        made_large(self.objective, counted, self.sum).map_or(f64::NAN, |found| found.value)
    }
}
