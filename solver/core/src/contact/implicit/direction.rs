//! Directions of Newton's method for a step with contact.

use nalgebra::{DMatrix, DVector};

use super::step::{ContactStep, Trial, narrowest};
use crate::body::RigidVector;

/// Displacement over the smallest gap of finite differences.
const DIFFERENCE: f64 = 1e-5;

impl ContactStep<'_> {
    /// Newton's step.
    pub(super) fn newton_direction(&self, now: &Trial) -> DVector<f64> {
        self.direction(now, self.stiffness(now, true))
    }

    /// Newton's step with the surfaces taken for flat: it always exists, but converges slower.
    pub(super) fn direction_without_curvature(&self, now: &Trial) -> DVector<f64> {
        self.direction(now, self.stiffness(now, false))
    }

    /// Newton's step with finite differences of the loads for their derivative.
    pub(super) fn finite_difference_direction(&self, now: &Trial) -> DVector<f64> {
        let n = now.velocity.len();
        if self.elastic.is_some() {
            // Each of many coordinates would take a shape: there is no such direction
            return DVector::from_element(n, f64::NAN);
        }
        let gap = narrowest(&now.pairs).map_or(self.law.range(), |pair| pair.gap);
        let mut stiffness = DMatrix::<f64>::zeros(n, n);
        for (row, (index, mode)) in self.rows().enumerate() {
            let body = self.bodies[index];
            let distance = DIFFERENCE * gap.min(self.gaps.reach(body));
            let size = distance / self.length(index, mode);
            let loads = [1.0, -1.0].map(|sign| {
                let mut poses = now.at.poses.clone();
                let mut displacement = RigidVector::zeros();
                displacement[mode] = sign * size;
                poses[body] = poses[body].displaced(&displacement);
                self.load(&self.gaps.pairs(&poses, self.law.range()), &now.velocity)
            });
            stiffness.set_column(row, &((&loads[0] - &loads[1]) / (2.0 * size)));
        }
        self.direction(now, stiffness)
    }

    /// Derivative of the loads by displacements, with or without the curvature of the surfaces.
    fn stiffness(&self, now: &Trial, is_exact: bool) -> DMatrix<f64> {
        let n = now.velocity.len();
        let mut stiffness = DMatrix::<f64>::zeros(n, n);
        for pair in &now.pairs {
            let gradient = pair.gradient_of_both();
            let mut block = gradient * gradient.transpose() * self.law.slope(pair.gap);
            if is_exact {
                block += pair.gradient_derivative() * self.law.force(pair.gap);
            }
            block *= pair.weight;
            self.add_block(&mut stiffness, pair, &block);
        }
        self.add_dissipative_stiffness(&mut stiffness, now);
        stiffness
    }

    /// Newton's step for a derivative of the loads by displacements.
    fn direction(&self, now: &Trial, stiffness: DMatrix<f64>) -> DVector<f64> {
        let n = now.velocity.len();
        let by_velocity = match self.rotation_jacobian(&now.velocity) {
            Some(jacobian) => stiffness * jacobian,
            None => stiffness,
        };
        let mut matrix = DMatrix::identity(n, n) - self.mobility * by_velocity * self.coefficient;
        if let Some(damping) = self.damping(now) {
            matrix -= self.mobility * damping;
        }
        if let Some(elastic) = self.elastic {
            let (first, own) = (self.n_rigid_rows(), elastic.n_coordinates());
            let tangent = elastic.forces.tangent(self.rates(&now.velocity));
            let mut columns = matrix.columns_mut(first, own);
            columns += self.mobility.columns(first, own) * tangent;
        }
        let solved = matrix.lu().solve(&now.residual);
        // A singular matrix gives no direction, which the caller sees as a step that is not finite
        solved.map_or_else(|| DVector::from_element(n, f64::NAN), |step| -step)
    }
}
