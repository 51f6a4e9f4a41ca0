//! Means over the cells of a state: volume ratios, strains and pressures, for pictures and checks.

use super::build::Solid;
use crate::material::{Tensor, green};

impl<const D: usize> Solid<D> {
    /// The mean volume ratio of each cell in a state.
    #[must_use]
    pub fn volume_ratios(&self, places: &[f64]) -> Vec<f64> {
        self.means(places, &Tensor::determinant)
    }

    /// The mean equivalent strain of each cell in a state, sqrt(2/3 e : e) of the part e of Green's strain that leaves
    /// the volume alone.
    #[must_use]
    pub fn equivalent_strains(&self, places: &[f64]) -> Vec<f64> {
        self.means(places, &|deformation| {
            let strain = green(deformation);
            let shear = strain - Tensor::identity() * (strain.trace() / 3.0);
            (shear.norm_squared() * 2.0 / 3.0).sqrt()
        })
    }

    /// Means over each cell of what follows from deformations.
    fn means(&self, places: &[f64], of: &dyn Fn(&Tensor) -> f64) -> Vec<f64> {
        let n = self.points.n_points;
        let deformations = self.deformations(places);
        let cells = deformations.chunks_exact(n).zip(self.points.weights.chunks_exact(n));
        cells
            .map(|(deformations, weights)| {
                let pairs = deformations.iter().zip(weights);
                let sum: f64 = pairs.map(|(f, weight)| of(f) * weight).sum();
                sum / weights.iter().sum::<f64>()
            })
            .collect()
    }

    /// The mean pressure (Pa) of each cell in a state; 0 where it can be compressed.
    #[must_use]
    pub fn pressures(&self, state: &[f64]) -> Vec<f64> {
        let share = [1.0 / (D as f64 + 1.0); 4];
        let mean = |cell| self.pressures.at(cell, &share, state).unwrap_or(0.0);
        (0..self.spec.mesh.n_cells()).map(mean).collect()
    }
}
