//! Second-order correction: brings the gaps after a step to what Newton's method expects of them.
//!
//! A stiff law holds gaps within a narrow window, and Newton's step is along the tangent of
//! surfaces that are curved: bodies that slide by s leave the window by s^2 / 2 R, and the line
//! search would cut the step down to the width of the window. Moving them back along the normals
//! by the loads of the contacts keeps long steps; in constrained optimisation this is the second-
//! order correction (@nocedal2006).

use nalgebra::{DMatrix, DVector, UnitQuaternion, Vector3};

use super::step::{ContactStep, Trial};
use crate::body::{Orientation, Pose};
use crate::contact::ContactPair;

/// Most corrections of one trial.
const MAX_CORRECTIONS: usize = 6;
/// Error of a gap over its distance from the range that is small enough.
const SMALL: f64 = 1e-6;
/// Least fraction of a gap a step may aim at.
const LEAST: f64 = 0.1;

/// A contact that a step is expected to keep, and the gap it should have then (m).
struct Target {
    pair: ContactPair,
    gap: f64,
}

/// A target and the pair that stands for it after a step.
struct Match<'a> {
    target: &'a Target,
    pair: &'a ContactPair,
}

impl ContactStep<'_> {
    /// Velocities near those of `now` and this fraction of `step`, at which the contacts that stay
    /// closed have the gaps they have to first order.
    pub(super) fn second_order_correction(
        &self,
        now: &Trial,
        step: &DVector<f64>,
        fraction: f64,
    ) -> DVector<f64> {
        let mut velocity = &now.velocity + step * fraction;
        let targets = self.targets(now, step, fraction);
        if targets.is_empty() {
            return velocity;
        }
        for _ in 0..MAX_CORRECTIONS {
            let Some(at) = self.place(&velocity) else { break };
            let (gaps, poses) = (at.gaps(self.gaps), &at.poses);
            let bounds = self
                .bodies
                .iter()
                .map(|&body| gaps.displacement_bound(body, &now.at.poses[body], &poses[body]));
            // A contact that has opened too far is still to be found
            let range = self.law.range() + bounds.fold(0.0, f64::max);
            let found = gaps.pairs(poses, range);
            let matches: Vec<Match<'_>> = targets
                .iter()
                .filter_map(|target| {
                    let pair = successor(&target.pair, &found, &now.at.poses, poses)?;
                    Some(Match { target, pair })
                })
                .collect();
            let errors = DVector::from_iterator(
                matches.len(),
                matches.iter().map(|both| both.target.gap - both.pair.gap),
            );
            let is_met = |(error, both): (&f64, &Match<'_>)| {
                error.abs() <= SMALL * (self.law.range() - both.target.gap)
            };
            if errors.iter().zip(&matches).all(is_met) {
                break;
            }
            let Some(change) = self.change_of_gaps(&velocity, &matches, &errors) else { break };
            velocity += change;
        }
        velocity
    }

    /// Velocities by contact loads that change gaps by these lengths (m), to first order.
    fn change_of_gaps(
        &self,
        velocity: &DVector<f64>,
        matches: &[Match<'_>],
        changes: &DVector<f64>,
    ) -> Option<DVector<f64>> {
        let mut gradients = DMatrix::zeros(velocity.len(), matches.len());
        for (column, Match { pair, .. }) in matches.iter().enumerate() {
            let gradient = pair.gradient_of_both();
            self.scatter(pair, &gradient, |row, g| gradients[(row, column)] += g);
        }
        let response = self.mobility * &gradients;
        let by_velocity = match self.rotation_jacobian(velocity) {
            Some(jacobian) => gradients.transpose() * jacobian,
            None => gradients.transpose(),
        };
        let gaps = by_velocity * &response * self.coefficient;
        // Contacts of bodies that are not free, or more contacts than motions: least squares
        let svd = gaps.svd(true, true);
        let largest = svd.singular_values.max();
        let loads = svd.solve(changes, 1e-10 * largest).ok()?;
        Some(response * loads)
    }

    fn targets(&self, now: &Trial, step: &DVector<f64>, fraction: f64) -> Vec<Target> {
        let displacement = self.displacement_rate(&now.velocity, step);
        let closed = now.pairs.iter().filter(|pair| pair.gap < self.law.range());
        let expected = closed.map(|pair| {
            let change = self.gap_change(pair, &displacement);
            let gap = (pair.gap + fraction * self.coefficient * change).max(LEAST * pair.gap);
            Target { pair: *pair, gap }
        });
        expected.filter(|target| target.gap < self.law.range()).collect()
    }
}

/// The pair among `found` that a pair has become as the bodies moved.
fn successor<'a>(
    before: &ContactPair,
    found: &'a [ContactPair],
    from: &[Pose],
    to: &[Pose],
) -> Option<&'a ContactPair> {
    let lever = carried(&before.levers[0], &from[before.body], &to[before.body]);
    found
        .iter()
        .filter(|other| other.body == before.body && other.partner == before.partner)
        .map(|other| (other, (other.levers[0] - lever).norm()))
        .reduce(|best, next| if next.1 < best.1 { next } else { best })
        .map(|(other, _)| other)
}

/// A vector fixed to a body after the body has moved from one pose to another.
fn carried(vector: &Vector3<f64>, from: &Pose, to: &Pose) -> Vector3<f64> {
    let orientation = match from.orientation {
        Orientation::Planar(_) => Orientation::Planar(0.0),
        Orientation::Spatial(_) => Orientation::Spatial(UnitQuaternion::identity()),
    };
    let unmoved = Pose { center: Vector3::zeros(), orientation };
    unmoved.displaced(&to.displacement_from(from)).to_world(vector)
}
