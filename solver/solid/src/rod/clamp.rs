//! The tangent at a clamped end: its direction is held, and its length follows from the rest of its element.
//!
//! A clamp holds a place and a direction, not how far the rod is stretched there. Its tangent is l d, with the direction d that is
//! held, the tangent t at the other end of the element and the way c along it from knot to knot, h long at rest:
//!
//! ```text
//! l = (4 |m| - 2 |t| + 1) / 3,    m = 3 c / 2 h - (t + d) / 4,
//! ```
//!
//! where m is what the tangent in the middle would be without a stretch at the clamp. A rod that keeps its length has |m| = |t| = 1
//! and l = 1, as if its tangent were held whole. Where it is straight l - 1 is the stretch at the clamp of one that is linear along
//! the element, which a force at its tip or a load that is even along it brings about.

use num_dual::DualNum;

/// What the strains of an element depend on besides its coordinates.
#[derive(Debug, Clone, Copy)]
pub struct Element {
    /// Length at rest (m).
    pub length: f64,
    /// Whether it is clamped at the knot nearer to the base, and at the other one.
    pub clamped: [bool; 2],
    /// Dimension of space.
    pub dimension: usize,
}

impl Element {
    /// Whether the length of a tangent follows from what else it has.
    pub fn is_clamped(&self) -> bool {
        self.clamped.contains(&true)
    }

    /// Its coordinates with tangents of the length that they have at clamps.
    pub fn shaped<D: DualNum<Primitive = f64> + Copy, const N: usize>(
        &self,
        coordinates: &[D; N],
    ) -> [D; N] {
        if !self.is_clamped() {
            return *coordinates;
        }
        let tangents = [self.dimension, N / 2 + self.dimension];
        let mut shaped = *coordinates;
        for (first, _) in tangents.iter().zip(self.clamped).filter(|(_, clamped)| *clamped) {
            let length = self.norm(|axis| coordinates[first + axis]);
            (0..self.dimension).for_each(|axis| shaped[first + axis] /= length);
        }
        let at = |first: usize| shaped[first];
        let middle = self.norm(|axis| {
            let [start, end] = tangents.map(|first| at(first + axis));
            (at(N / 2 + axis) - at(axis)) * (1.5 / self.length) - (start + end) * 0.25
        });
        let length = match self.clamped {
            // Of an even stretch
            [true, true] => (middle * 2.0 + 1.0) / 3.0,
            [is_first, _] => {
                let other = tangents[usize::from(is_first)];
                (middle * 4.0 - self.norm(|axis| at(other + axis)) * 2.0 + 1.0) / 3.0
            }
        };
        for (first, _) in tangents.iter().zip(self.clamped).filter(|(_, clamped)| *clamped) {
            (0..self.dimension).for_each(|axis| shaped[first + axis] *= length);
        }
        shaped
    }

    /// Length of a vector.
    fn norm<D: DualNum<Primitive = f64> + Copy>(&self, component: impl Fn(usize) -> D) -> D {
        let squares = (0..self.dimension).map(|axis| component(axis) * component(axis));
        squares.fold(D::from(0.0), |sum, square| sum + square).sqrt()
    }
}
