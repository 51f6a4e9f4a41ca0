//! What tangents at a quadrature point add to the matrix of its cell.

use alewife_mesh::Point;
use nalgebra::SVector;

use super::{At, MAX_NODES, MAX_PLACES, MAX_UNKNOWNS};
use crate::material::{Dyad, Tangent, TangentParts, Tensor};

/// The matrix of a cell, of which the lower triangle is used: by the places of its nodes, and behind them by the
/// pressures at its vertices.
pub(in crate::solid) type CellMatrix = [[f64; MAX_UNKNOWNS]; MAX_UNKNOWNS];

impl<const D: usize> At<'_, D> {
    /// Adds a multiple of the stiffness by a whole tangent.
    pub(in crate::solid) fn add_tangent(
        &self,
        tangent: &Tangent,
        factor: f64,
        matrix: &mut CellMatrix,
    ) {
        let weight = factor * self.weight;
        for (a, slope) in self.gradients.iter().enumerate() {
            for i in 0..D {
                let mut row = SVector::<f64, 9>::zeros();
                for j in 0..D {
                    row += tangent.column(3 * i + j) * (weight * slope[j]);
                }
                if self.curvature > 0.0 && i == 1 {
                    row += tangent.column(8) * (weight * self.shapes[a] * self.curvature);
                }
                let entries = &mut matrix[a * D + i];
                for (b, other) in self.gradients[..=a].iter().enumerate() {
                    for k in 0..D {
                        let sum: f64 = (0..D).map(|l| row[3 * k + l] * other[l]).sum();
                        entries[b * D + k] += sum;
                    }
                    if self.curvature > 0.0 {
                        entries[b * D + 1] += row[8] * self.shapes[b] * self.curvature;
                    }
                }
            }
        }
    }

    /// The same by the parts of a tangent; without an axis.
    pub(in crate::solid) fn add_parts(
        &self,
        parts: &TangentParts,
        factor: f64,
        matrix: &mut CellMatrix,
    ) {
        let weight = factor * self.weight;
        for dyad in parts.dyads.iter().flatten() {
            self.add_dyad(dyad, weight, matrix);
        }
        let space: [[f64; D]; D] =
            std::array::from_fn(|i| std::array::from_fn(|k| parts.space[(i, k)]));
        for (a, slope) in self.gradients.iter().enumerate() {
            let turned = Point::<D>::from_fn(|l, _| {
                weight * (0..D).map(|j| parts.body[(j, l)] * slope[j]).sum::<f64>()
            });
            let scaled = slope * weight;
            for (b, other) in self.gradients[..=a].iter().enumerate() {
                let (product, same) = (scaled.dot(other), turned.dot(other));
                for i in 0..D {
                    let entries = &mut matrix[a * D + i][b * D..(b + 1) * D];
                    for k in 0..D {
                        entries[k] += space[i][k] * product;
                    }
                    entries[i] += same;
                }
            }
        }
    }

    /// The same by a dyad.
    fn add_dyad(&self, dyad: &Dyad, weight: f64, matrix: &mut CellMatrix) {
        let mut moved = [Point::<D>::zeros(); MAX_NODES];
        for (moved, slope) in moved.iter_mut().zip(self.gradients) {
            *moved =
                Point::from_fn(|i, _| (0..D).map(|j| dyad.tensor[(i, j)] * slope[j]).sum::<f64>());
        }
        let (straight, crossed) = (weight * dyad.straight, weight * dyad.crossed);
        for a in 0..self.gradients.len() {
            let (one, across) = (moved[a] * straight, moved[a] * crossed);
            for (b, other) in moved[..=a].iter().enumerate() {
                for i in 0..D {
                    let entries = &mut matrix[a * D + i][b * D..(b + 1) * D];
                    for k in 0..D {
                        entries[k] += one[i] * other[k] + other[i] * across[k];
                    }
                }
            }
        }
    }

    /// Adds a multiple of how the volume changes by the places of the cell, by the pressures at its vertices.
    pub(in crate::solid) fn add_volume(
        &self,
        cofactor: &Tensor,
        factor: f64,
        matrix: &mut CellMatrix,
    ) {
        let mut slopes = [0.0; MAX_PLACES];
        self.add_forces(cofactor, &mut slopes);
        let n = D * self.shapes.len();
        for (entries, share) in matrix[n..].iter_mut().zip(self.shares) {
            for (entry, slope) in entries.iter_mut().zip(&slopes[..n]) {
                *entry -= factor * share * slope;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_a_tangent_add_what_the_whole_of_it_does() {
        let tensor = |k: f64| Tensor::from_fn(|i, j| (k + 3.0 * i as f64 + 1.7 * j as f64).sin());
        let symmetric = |k: f64| tensor(k) + tensor(k).transpose();
        let dyad = |k: f64| Dyad { tensor: tensor(k), straight: 0.7 + k, crossed: 1.3 - k };
        let parts = TangentParts {
            dyads: [Some(dyad(0.2)), Some(dyad(0.9))],
            space: symmetric(0.4),
            body: symmetric(0.6),
        };
        let gradients: Vec<Point<3>> = (0..4)
            .map(|a| Point::from_fn(|i, _| (1.1 * a as f64 + 0.3 * i as f64).cos()))
            .collect();
        let at = At {
            weight: 0.3,
            gradients: &gradients,
            shapes: &[0.25; 4],
            shares: &[0.25; 4],
            curvature: 0.0,
        };
        let mut by_parts = [[0.0; MAX_UNKNOWNS]; MAX_UNKNOWNS];
        let mut by_whole = by_parts;
        at.add_parts(&parts, 2.0, &mut by_parts);
        at.add_tangent(&parts.whole(), 2.0, &mut by_whole);
        for row in 0..12 {
            for column in 0..=row {
                let apart = by_parts[row][column] - by_whole[row][column];
                assert!(apart.abs() < 1e-13, "{row} {column}: {apart}");
            }
        }
    }
}
