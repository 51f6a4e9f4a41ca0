//! `ForceAgreement`: whether two evaluations of the force on a body agree, as they do where cells resolve the flow.

use nalgebra::Vector3;

/// Force over the integral of the size of the viscous stress below which it is a difference of larger ones, as of bodies
/// that swim: nothing follows from its error.
const NO_FORCE: f64 = 0.25;

/// Forces on a body, so far.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::run) struct ForceAgreement {
    /// Sum of the squares of the force by the residual (N2).
    force: f64,
    /// The same of its difference from that by the stress.
    difference: f64,
    /// The same of the integral of the size of the viscous stress.
    friction: f64,
}

impl ForceAgreement {
    /// Adds the force by the residual and by the stress, and the integral of the size of the viscous stress (N).
    pub fn add(&mut self, force: &Vector3<f64>, by_stress: &Vector3<f64>, friction: f64) {
        self.force += force.norm_squared();
        self.difference += (force - by_stress).norm_squared();
        self.friction += friction * friction;
    }

    /// The difference over the force; none where there is no force to speak of.
    pub fn part(self) -> Option<f64> {
        let is_notable = self.force > NO_FORCE * NO_FORCE * self.friction;
        (is_notable && self.force > 0.0).then(|| (self.difference / self.force).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_that_differ_show_unless_they_are_differences_themselves() {
        let part = |force: f64, by_stress: f64, friction: f64| {
            let mut forces = ForceAgreement::default();
            for _ in 0..3 {
                forces.add(&Vector3::x().scale(force), &Vector3::x().scale(by_stress), friction);
            }
            forces.part()
        };
        assert!((part(2.0, 1.0, 1.0).unwrap() - 0.5).abs() < 1e-15);
        assert_eq!(part(0.1, 0.2, 1.0), None, "as of a swimmer");
        assert_eq!(part(0.0, 0.0, 0.0), None);
    }
}
