//! `KrylovSpace`: corrections of least residual in single precision, by GCR (@eisenstat1983).
//!
//! Without rounding the residuals are those of FGMRES (@saad1993). Directions and their images stay when the
//! residual is computed again in double precision: what they have of it is taken off, and convergence continues
//! as if nothing had been rounded.

use super::matrix::Blocks;
use super::scaled::Scaled;

/// An image that is smaller than this part of what it was before those of the others were taken off
/// is rounding.
const DEPENDENT: f64 = 1e-5;

/// Directions Z with images A Z = W R, W orthonormal and R upper triangular.
#[derive(Debug, Default)]
pub(super) struct KrylovSpace {
    directions: Vec<Blocks>,
    images: Vec<Blocks>,
    /// The columns of R down to the diagonal.
    columns: Vec<Vec<f64>>,
}

/// The correction that iterations have found.
pub(super) struct Correction {
    pub x: Blocks,
    pub iterations: usize,
}

impl KrylovSpace {
    /// Number of directions.
    pub fn n_directions(&self) -> usize {
        self.directions.len()
    }

    /// A correction for a residual of norm one.
    ///
    /// `continues` is asked before each iteration, with the number of those so far and the norm of the
    /// residual. The space is empty afterwards where it cannot grow any more.
    pub fn correction(
        &mut self,
        system: &mut Scaled<'_>,
        mut residual: Blocks,
        continues: impl Fn(usize, f64) -> bool,
    ) -> Correction {
        let part = |image: &Blocks, residual: &mut Blocks| {
            let part = image.dot(residual);
            residual.add(-part, image);
            part
        };
        let mut parts: Vec<f64> =
            self.images.iter().map(|image| part(image, &mut residual)).collect();
        let mut iterations = 0;
        let mut grows = true;
        while grows && continues(iterations, residual.norm()) {
            let mut direction = residual.zeros_alike();
            system.apply(&residual, &mut direction);
            let mut image = residual.zeros_alike();
            system.multiply(&direction, &mut image);
            iterations += 1;
            grows = self.take(direction, image);
            if grows {
                parts.extend(self.images.last().map(|image| part(image, &mut residual)));
            }
        }
        let x = self.combination(parts, &residual);
        if !grows {
            *self = Self::default();
        }
        Correction { x, iterations }
    }

    /// Takes another direction, unless its image is a combination of those of the others.
    fn take(&mut self, direction: Blocks, mut image: Blocks) -> bool {
        let before = image.norm();
        let mut column = Vec::with_capacity(self.images.len() + 1);
        // Modified Gram-Schmidt
        for other in &self.images {
            let component = other.dot(&image);
            image.add(-component, other);
            column.push(component);
        }
        let size = image.norm();
        let adds = size.is_finite() && size > DEPENDENT * before;
        if adds {
            image.scale(1.0 / size);
            column.push(size);
            self.columns.push(column);
            self.images.push(image);
            self.directions.push(direction);
        }
        adds
    }

    /// Z R^-1 y.
    fn combination(&self, mut y: Vec<f64>, alike: &Blocks) -> Blocks {
        let mut x = alike.zeros_alike();
        for (index, column) in self.columns.iter().enumerate().rev() {
            y[index] /= column[index];
            let weight = y[index];
            for (earlier, entry) in y[..index].iter_mut().zip(column) {
                *earlier -= entry * weight;
            }
            x.add(weight, &self.directions[index]);
        }
        x
    }
}
