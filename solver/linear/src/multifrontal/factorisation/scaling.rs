//! The scale of pressures against velocities, and the size below which pivots count as zero.

use super::super::analysis::Analysis;
use crate::sparse::SparseMatrix;

/// Pivots below this fraction of the scale of their unknown count as zero.
const SINGULAR: f64 = 1e-13;

#[derive(Default)]
struct Mean {
    sum: f64,
    count: usize,
}

impl Mean {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.count += 1;
    }

    /// 0 of no values.
    fn value(&self) -> f64 {
        self.sum / self.count.max(1) as f64
    }
}

/// Sets the size that the pivot of each position has to exceed, and returns the factor of the rows and
/// columns of pressures that makes their entries as large as those of velocities.
pub(super) fn scale_pressures(
    analysis: &Analysis,
    matrix: &SparseMatrix,
    pivot_floors: &mut [f64],
) -> f64 {
    let values = matrix.values();
    let (mut velocity, mut pressure) = (Mean::default(), Mean::default());
    for (position, &unknown) in analysis.unknown_at.iter().enumerate() {
        let diagonal =
            analysis.diagonal[position].map_or(0.0, |entry| values[entry as usize].abs());
        if diagonal > 0.0 {
            pivot_floors[position] = diagonal;
            // Rigid velocities of bodies have another scale, and are few.
            if analysis.dense.binary_search(&unknown).is_err() {
                velocity.add(diagonal);
            }
        } else {
            let row = &values[matrix.pattern().entries(unknown as usize)];
            let largest = row.iter().fold(0.0f64, |most, value| most.max(value.abs()));
            pivot_floors[position] = largest;
            if analysis.is_pressure_at[position] {
                pressure.add(largest);
            }
        }
    }
    let ratio = velocity.value() / pressure.value();
    // A power of two changes no digit.
    let scale = if ratio.is_normal() { ratio.log2().round().exp2() } else { 1.0 };
    for (floor, &is_pressure) in pivot_floors.iter_mut().zip(&analysis.is_pressure_at) {
        if is_pressure {
            // What elimination of the velocities makes of a pressure, b^2 / a, has the size of a.
            *floor *= scale;
        }
        *floor *= SINGULAR;
    }
    scale
}
