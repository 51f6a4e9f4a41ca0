//! The series of a motion: places and velocities of its markers, energies and work, frame by frame.

use std::fmt::Write as _;

use super::mesh::{Bodies, SolidOf};
use super::model::Model;
use crate::soft::{SoftError, Trajectory};

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
    let names = ["time".to_owned()].into_iter().chain(case.quantities()).collect();
    let at_rest = vec![1.0; body.solid.spec().fibres.len()];
    let mut rows = Vec::new();
    let mut work = 0.0;
    let mut told = &at_rest;
    for frame in 0..=plan.targets.len() {
        let level = &motion.levels[frame * plan.substeps];
        let mut row = vec![frame as f64 * plan.frame];
        for node in nodes {
            row.extend_from_slice(&level.places[D * node..D * (node + 1)]);
            row.extend_from_slice(&level.velocities[D * node..D * (node + 1)]);
        }
        let momentum = body.solid.times_mass(&level.velocities);
        row.push(0.5 * momentum.iter().zip(&level.velocities).map(|(p, v)| p * v).sum::<f64>());
        row.push(body.solid.elastic_energy(&level.places, told)?);
        row.push(work);
        rows.push(row);
        if let Some(next) = plan.targets.get(frame) {
            let energy = |told: &[f64]| body.solid.fibre_energy(&level.places, told).value;
            work += energy(next) - energy(told);
            told = next;
        }
    }
    Ok(Series { names, rows })
}
