//! `Dissipation`: what contact takes of the energy: normal damping by a coefficient of restitution, and Coulomb friction.

use nalgebra::{Matrix3, Vector3};

use super::ContactError;

/// Forces that go with the normal force N of the law, for surfaces with a relative velocity v: with its parts v_n
/// along the normal, positive where the gap opens, and v_t across it, and s(v) = v / sqrt(v^2 + v_s^2),
///
/// N ((rho - 1) n - mu s(v_t)), rho = (1 + e^2) / 2 - (1 - e^2) / 2 s(v_n).
///
/// So bodies that part get e^2 of the energy that was stored, whatever the law and the speed: e is the coefficient of restitution
/// (the hysteresis of @walton1986). Friction is Coulomb's law, regularised.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dissipation {
    /// Coefficient of restitution e, from 0 to 1.
    pub restitution: f64,
    /// Coefficient of friction mu.
    pub friction: f64,
    /// Speed v_s far above which both are what they are (m/s).
    pub slip: f64,
}

/// A force over the normal one, with its derivative by the relative velocity.
pub(super) struct DissipativeForce {
    /// The force over N.
    pub factor: Vector3<f64>,
    /// Its derivative (s/m).
    pub slope: Matrix3<f64>,
}

impl Dissipation {
    /// Checks the numbers.
    ///
    /// # Errors
    /// [`ContactError::Law`] when one is not what it can be.
    pub fn checked(self) -> Result<Self, ContactError> {
        let Self { restitution, friction, slip } = self;
        for (what, value, is_valid) in [
            ("restitution", restitution, (0.0..=1.0).contains(&restitution)),
            ("friction", friction, friction >= 0.0 && friction.is_finite()),
            ("slip", slip, slip > 0.0 && slip.is_finite()),
        ] {
            if !is_valid {
                return Err(ContactError::Law { what, value });
            }
        }
        Ok(self)
    }

    /// The force at a relative velocity (m/s) of surfaces with a normal.
    pub(super) fn force(&self, normal: &Vector3<f64>, velocity: &Vector3<f64>) -> DissipativeForce {
        let Self { restitution, friction, slip } = self;
        let opening = normal.dot(velocity);
        let across = velocity - normal * opening;
        let [along_size, across_size] =
            [opening.abs(), across.norm()].map(|speed| speed.hypot(*slip));
        let lost = 0.5 * (1.0 - restitution * restitution);
        let part = opening / along_size;
        let direction = across / across_size;
        let outer = normal * normal.transpose();
        let normal_slope = -lost * (1.0 - part * part) / along_size;
        let tangents = Matrix3::identity() - outer - direction * direction.transpose();
        DissipativeForce {
            factor: -normal * (lost * (1.0 + part)) - direction * *friction,
            slope: outer * normal_slope - tangents * (friction / across_size),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dissipation() -> Dissipation {
        Dissipation { restitution: 0.5, friction: 0.3, slip: 1e-3 }
    }

    #[test]
    fn the_slope_is_the_derivative_of_the_force() {
        let normal = Vector3::new(0.6, 0.0, 0.8);
        for scale in [1e-4, 1e-3, 1e-2] {
            let velocity = Vector3::new(0.3, -0.5, 0.7) * scale;
            let found = dissipation().force(&normal, &velocity);
            let h = 1e-5 * scale;
            for axis in 0..3 {
                let mut change = Vector3::zeros();
                change[axis] = h;
                let [more, less] = [velocity + change, velocity - change]
                    .map(|velocity| dissipation().force(&normal, &velocity).factor);
                let error = ((more - less) / (2.0 * h) - found.slope.column(axis)).norm();
                assert!(error < 1e-6 * found.slope.norm(), "{scale} {axis} {error}");
            }
        }
    }

    #[test]
    fn bodies_that_part_keep_the_square_of_the_restitution_and_those_that_near_all() {
        let normal = Vector3::y();
        let along =
            |speed: f64| 1.0 + normal.dot(&dissipation().force(&normal, &(normal * speed)).factor);
        assert!((along(-1.0) - 1.0).abs() < 1e-5 && (along(1.0) - 0.25).abs() < 1e-5);
        let sliding = dissipation().force(&normal, &Vector3::new(2.0, -1.0, 0.0)).factor;
        assert!((sliding.x + 0.3).abs() < 1e-6 && sliding.y.abs() < 1e-6, "{sliding}");
    }

    #[test]
    fn numbers_that_cannot_be_are_refused() {
        let refused = |dissipation: Dissipation, name: &str| matches!(dissipation.checked(), Err(ContactError::Law { what, .. }) if what == name);
        assert!(refused(Dissipation { restitution: 1.1, ..dissipation() }, "restitution"));
        assert!(refused(Dissipation { friction: -0.1, ..dissipation() }, "friction"));
        assert!(refused(Dissipation { slip: 0.0, ..dissipation() }, "slip"));
        assert!(dissipation().checked().is_ok());
    }
}
