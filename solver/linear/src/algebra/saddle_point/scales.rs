//! `Scales`: factors of the equations that make those of momentum, mass, forces and torques weigh the same.

use std::ops::Range;

use super::matrix::SaddleMatrix;
use super::numbering::{Numbering, Place};
use super::vector::Blocks;
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
    pub fn new(matrix: &SaddleMatrix) -> Self {
        let Numbering { blocks, n_nodes, pressures, .. } = matrix.numbering();
        let diagonal = |row: usize| matrix.velocity().diagonal(row);
        let mean = |rows: Range<usize>| {
            let (mut sum, mut count) = (0.0, 0);
            for row in rows {
                let free = blocks[row].iter().zip(diagonal(row));
                for (_, value) in free.filter(|(unknown, _)| unknown.is_some()) {
                    sum += f64::from(value.abs());
                    count += 1;
                }
            }
            sum / f64::from(count.max(1))
        };
        let velocity = mean(0..*n_nodes);
        let gradient = matrix.gradient();
        let mut largest = vec![0.0f32; pressures.len()];
        for (&pressure, values) in gradient.pressures().iter().zip(gradient.values()) {
            let most = &mut largest[pressure as usize];
            *most = values.iter().fold(*most, |most, value| most.max(value.abs()));
        }
        let gradient = largest.iter().map(|value| f64::from(*value)).sum::<f64>()
            / largest.len().max(1) as f64;
        let positive = |value: f64| if value.is_normal() && value > 0.0 { value } else { 1.0 };
        let rotation = |body: usize| {
            let row = n_nodes + 2 * body;
            positive((mean(row..row + 1) / mean(row + 1..row + 2)).sqrt())
        };
        Self {
            n_nodes: *n_nodes,
            pressure: positive(velocity / gradient),
            rotations: (0..matrix.numbering().n_bodies).map(rotation).collect(),
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
