//! `Scales`: factors of the equations that make those of momentum, mass, forces and torques weigh the same.

use super::numbering::{Numbering, Place};
use super::vector::{B, Blocks};
use crate::sparse::SparseMatrix;
use crate::sparse::single::single;

/// Factors of rows and columns; those of velocities at nodes and of translations are one.
#[derive(Debug)]
pub(super) struct Scales {
    n_nodes: usize,
    /// The ratio of the velocities' diagonal to the gradient.
    pressure: f64,
    /// The inverse of the radius of resistance, of each body.
    rotations: Vec<f64>,
}

impl Scales {
    /// For a matrix.
    pub fn new(matrix: &SparseMatrix, numbering: &Numbering) -> Self {
        let pattern = matrix.pattern();
        let diagonal = |unknown: u32| {
            let entry = pattern.entry(unknown as usize, unknown as usize);
            entry.map_or(0.0, |entry| matrix.values()[entry].abs())
        };
        let mean = |blocks: &[[Option<u32>; B]]| {
            let unknowns = || blocks.iter().flatten().flatten();
            unknowns().map(|&unknown| diagonal(unknown)).sum::<f64>()
                / unknowns().count().max(1) as f64
        };
        let velocity = mean(&numbering.blocks[..numbering.n_nodes]);
        let largest = |&unknown: &u32| {
            let values = &matrix.values()[pattern.entries(unknown as usize)];
            values.iter().fold(0.0f64, |most, value| most.max(value.abs()))
        };
        let gradient = numbering.pressures.iter().map(largest).sum::<f64>()
            / numbering.pressures.len().max(1) as f64;
        let positive = |value: f64| if value.is_normal() && value > 0.0 { value } else { 1.0 };
        let rotation = |blocks: &[[Option<u32>; B]]| {
            let [translation, turn] = [mean(&blocks[..1]), mean(&blocks[1..])];
            positive((translation / turn).sqrt())
        };
        Self {
            n_nodes: numbering.n_nodes,
            pressure: positive(velocity / gradient),
            rotations: numbering.blocks[numbering.n_nodes..]
                .chunks_exact(2)
                .map(rotation)
                .collect(),
        }
    }

    /// The factor of an unknown.
    pub fn of(&self, place: Place) -> f64 {
        match place {
            Place::Pressure(_) => self.pressure,
            Place::Velocity { row, .. } => match (row as usize).checked_sub(self.n_nodes) {
                Some(row) if row % 2 == 1 => self.rotations[row / 2],
                _ => 1.0,
            },
        }
    }

    /// Multiplies all values by their factors.
    pub fn multiply(&self, vector: &mut Blocks) {
        self.apply(vector, single);
    }

    /// Divides all values by their factors.
    pub fn divide(&self, vector: &mut Blocks) {
        self.apply(vector, |scale| single(1.0 / scale));
    }

    fn apply(&self, vector: &mut Blocks, factor: impl Fn(f64) -> f32) {
        let by = factor(self.pressure);
        vector.pressure.iter_mut().for_each(|value| *value *= by);
        let bodies = vector.velocity[self.n_nodes..].chunks_exact_mut(2);
        for (body, scale) in bodies.zip(&self.rotations) {
            let by = factor(*scale);
            body[1].iter_mut().for_each(|value| *value *= by);
        }
    }
}
