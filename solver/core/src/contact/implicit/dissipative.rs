//! What contact takes of the energy, in the equation of a step: forces that depend on the velocities, too.

use nalgebra::{DMatrix, DVector, Vector3};

use super::step::{ContactStep, Trial};
use crate::contact::dissipation::DissipativeForce;
use crate::contact::{ContactPair, PairVector};

/// A pair with its dissipative force over the normal one.
struct Sliding<'a> {
    pair: &'a ContactPair,
    force: DissipativeForce,
    /// How the relative velocity follows from the velocities, by axis.
    axes: [PairVector; 3],
}

impl Sliding<'_> {
    /// The load of a force.
    fn load(&self, force: &Vector3<f64>) -> PairVector {
        self.axes.iter().zip(force.iter()).map(|(axis, force)| axis * *force).sum()
    }
}

impl ContactStep<'_> {
    /// Pairs with their dissipative forces; none where the law has no dissipation.
    fn sliding<'b>(
        &self,
        pairs: &'b [ContactPair],
        velocity: &DVector<f64>,
    ) -> impl Iterator<Item = Sliding<'b>> {
        let with = |pair: &'b ContactPair| {
            let dissipation = self.law.dissipation()?;
            let axes = [Vector3::x(), Vector3::y(), Vector3::z()]
                .map(|axis| pair.gradient_along_both(&axis));
            let relative = axes.map(|axis| self.along(pair, &axis, velocity));
            let force = dissipation.force(&pair.normal, &Vector3::from(relative));
            Some(Sliding { pair, force, axes })
        };
        pairs.iter().filter_map(with).collect::<Vec<_>>().into_iter()
    }

    /// A vector over both sides of a pair times one by row.
    fn along(&self, pair: &ContactPair, vector: &PairVector, rows: &DVector<f64>) -> f64 {
        let mut sum = 0.0;
        self.scatter(pair, vector, |row, entry| sum += entry * rows[row]);
        sum
    }

    /// Adds the dissipative loads of pairs at these velocities.
    pub(super) fn add_dissipative_load(
        &self,
        load: &mut DVector<f64>,
        pairs: &[ContactPair],
        velocity: &DVector<f64>,
    ) {
        for sliding in self.sliding(pairs, velocity) {
            let Sliding { pair, force, .. } = &sliding;
            let normal_force = pair.weight * self.law.force(pair.gap);
            let entries = sliding.load(&(force.factor * normal_force));
            self.scatter(pair, &entries, |row, entry| load[row] += entry);
        }
    }

    /// Adds the derivatives of the dissipative loads by displacements, as far as the normal force changes.
    pub(super) fn add_dissipative_stiffness(&self, stiffness: &mut DMatrix<f64>, now: &Trial) {
        for sliding in self.sliding(&now.pairs, &now.velocity) {
            let Sliding { pair, force, .. } = &sliding;
            let rate = pair.weight * self.law.slope(pair.gap);
            let block = sliding.load(&(force.factor * rate)) * pair.gradient_of_both().transpose();
            self.add_block(stiffness, pair, &block);
        }
    }

    /// Derivative of the dissipative loads by velocities; `None` where there is no dissipation.
    pub(super) fn damping(&self, now: &Trial) -> Option<DMatrix<f64>> {
        self.law.dissipation()?;
        let mut damping = DMatrix::zeros(now.velocity.len(), now.velocity.len());
        for sliding in self.sliding(&now.pairs, &now.velocity) {
            let Sliding { pair, force, axes } = &sliding;
            let slope = force.slope * (pair.weight * self.law.force(pair.gap));
            for (axis, column) in axes.iter().zip(slope.column_iter()) {
                let block = sliding.load(&column.into_owned()) * axis.transpose();
                self.add_block(&mut damping, pair, &block);
            }
        }
        Some(damping)
    }

    /// The dissipative force on the body of each pair (N) after a last step, to first order in it.
    pub(super) fn dissipative_forces(&self, now: &Trial, step: &DVector<f64>) -> Vec<Vector3<f64>> {
        let displacement = self.displacement_rate(&now.velocity, step) * self.coefficient;
        let sliding = self.sliding(&now.pairs, &now.velocity);
        let force = |Sliding { pair, force, axes }: Sliding<'_>| {
            let change = Vector3::from(axes.map(|axis| self.along(pair, &axis, step)));
            let closing = self.law.slope(pair.gap) * self.gap_change(pair, &displacement);
            let normal_force = self.law.force(pair.gap);
            (force.factor * (normal_force + closing) + force.slope * change * normal_force)
                * pair.weight
        };
        sliding.map(force).collect()
    }
}
