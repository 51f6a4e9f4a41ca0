//! Brings the gaps after a step back to what Newton's method expected of them.
//!
//! A stiff law holds gaps within a narrow window, and Newton's step is along the tangent of
//! surfaces that are curved: bodies that slide by s leave the window by s^2 / 2 R, and the line
//! search would cut the step down to the width of the window. Moving them back along the normals
//! by the loads of the contacts keeps long steps; in constrained optimisation this is the second-
//! order correction (@nocedal2006).

use nalgebra::{DMatrix, DVector};

use super::implicit::ContactStep;
use super::{Feature, Place};

/// Most corrections of one trial.
const MAX_CORRECTIONS: usize = 6;
/// Error of a gap over its distance from the range that is small enough.
const SMALL: f64 = 1e-6;
/// Least part of a gap a step may aim at.
const LEAST: f64 = 0.1;

/// A contact that a step is expected to keep, and the gap it should have then (m).
struct Aim {
    feature: Feature,
    gap: f64,
}

impl ContactStep<'_> {
    /// Velocities near `velocity` at which the contacts of `now`, which stay closed in a step of
    /// this part of `step`, have the gaps they have to first order.
    pub(super) fn retract(
        &self,
        now: &[Feature],
        from: &[Place],
        step: &DVector<f64>,
        part: f64,
        mut velocity: DVector<f64>,
    ) -> DVector<f64> {
        let aims = self.aims(now, step, part);
        if aims.is_empty() {
            return velocity;
        }
        for _ in 0..MAX_CORRECTIONS {
            let places = self.places(&velocity);
            let ways = self.bodies.iter().map(|&b| self.surfaces.way(b, &from[b], &places[b]));
            // A contact that has opened too far is still to be found
            let range = self.law.range() + ways.fold(0.0, f64::max);
            let found = self.surfaces.features(&places, range);
            let met: Vec<(&Aim, &Feature)> = aims
                .iter()
                .filter_map(|aim| Some((aim, same(&aim.feature, &found, from, &places)?)))
                .collect();
            let errors = DVector::from_fn(met.len(), |i, _| met[i].0.gap - met[i].1.at.gap);
            let is_met = |(error, (aim, _)): (&f64, &(&Aim, &Feature))| {
                error.abs() <= SMALL * (self.law.range() - aim.gap)
            };
            if errors.iter().zip(&met).all(is_met) {
                break;
            }
            let mut gradients = DMatrix::zeros(velocity.len(), met.len());
            for (column, (_, feature)) in met.iter().enumerate() {
                let gradient = feature.gradient();
                self.scatter(feature, |row, g| gradients[(row, column)] += g, &gradient);
            }
            let answer = self.mobility * &gradients;
            let gaps = gradients.transpose() * &answer * self.coefficient;
            // Contacts of bodies that are not free, or more contacts than motions: least squares
            let svd = gaps.svd(true, true);
            let largest = svd.singular_values.max();
            let Ok(loads) = svd.solve(&errors, 1e-10 * largest) else { break };
            velocity += answer * loads;
        }
        velocity
    }

    fn aims(&self, now: &[Feature], step: &DVector<f64>, part: f64) -> Vec<Aim> {
        let closed = now.iter().filter(|feature| feature.at.gap < self.law.range());
        let expected = closed.map(|feature| {
            let mut change = 0.0;
            self.scatter(feature, |row, g| change += g * step[row], &feature.gradient());
            let gap = feature.at.gap;
            Aim {
                feature: *feature,
                gap: (gap + part * self.coefficient * change).max(LEAST * gap),
            }
        });
        expected.filter(|aim| aim.gap < self.law.range()).collect()
    }
}

/// The feature among `found` that a feature has become as the bodies moved.
fn same<'a>(
    before: &Feature,
    found: &'a [Feature],
    from: &[Place],
    to: &[Place],
) -> Option<&'a Feature> {
    let (old, new) = (from[before.body], to[before.body]);
    let moved = nalgebra::Rotation2::new(new[2] - old[2]) * before.levers[0];
    let alike = found
        .iter()
        .filter(|other| other.body == before.body && other.partner == before.partner)
        .map(|other| (other, (other.levers[0] - moved).norm()));
    alike.reduce(|best, next| if next.1 < best.1 { next } else { best }).map(|(other, _)| other)
}
