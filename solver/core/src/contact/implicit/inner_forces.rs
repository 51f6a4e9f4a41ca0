//! Correction for forces within bodies with coordinates: steps along the curved ways on which these keep their length.
//!
//! Newton's step is straight, and rods that hardly stretch allow no straight way: the line search would cut the step down to the
//! width of the way. With the loads of contact as the linear equations have them, the velocities v near those w of the step meet
//!
//! v - w + M (e(v) - e - E (w - u)) = 0,
//!
//! with the forces e beyond the linear ones and their derivatives E at the velocities u that the step starts from.

use nalgebra::{DMatrix, DVector};

use super::step::{ContactStep, Trial};

/// Most iterations of one correction.
const MOST_ITERATIONS: usize = 12;
/// Change of the rates over their size that ends it.
const CONVERGED: f64 = 1e-9;

impl ContactStep<'_> {
    /// Velocities near those of `now` and a part of a step, at which forces within bodies are what the step has of them; the
    /// velocities as they are where that is not found.
    pub(super) fn with_inner_forces(&self, now: &Trial, velocity: DVector<f64>) -> DVector<f64> {
        let Some(elastic) = self.elastic else { return velocity };
        let (first, n) = (self.n_rigid_rows(), elastic.n_coordinates());
        let own = |all: &DVector<f64>| all.rows(first, n).into_owned();
        let (start, to) = (own(&now.velocity), own(&velocity));
        let expected = elastic.forces.beyond_linear(start.as_slice())
            + elastic.forces.tangent(start.as_slice()) * (&to - &start);
        let mobility = self.mobility.view((first, first), (n, n));
        let mut rates = to.clone();
        for _ in 0..MOST_ITERATIONS {
            let beyond = elastic.forces.beyond_linear(rates.as_slice()) - &expected;
            let off = &rates - &to + mobility * &beyond;
            let matrix =
                DMatrix::identity(n, n) + mobility * elastic.forces.tangent(rates.as_slice());
            let Some(change) = matrix.lu().solve(&off) else { return velocity };
            rates -= &change;
            let (size, change) = (rates.amax(), change.amax());
            if !change.is_finite() {
                return velocity;
            }
            if change <= CONVERGED * size {
                let beyond = elastic.forces.beyond_linear(rates.as_slice()) - &expected;
                let moved = self.mobility.columns(first, n) * beyond;
                let mut corrected = velocity - moved;
                corrected.rows_mut(first, n).copy_from(&rates);
                return corrected;
            }
        }
        velocity
    }
}
