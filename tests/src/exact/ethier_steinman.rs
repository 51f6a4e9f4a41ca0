//! A flow in space that fills all terms of the equations (@ethier1994), density 1.
//!
//! With a = pi / 4 and d = pi / 2, and the other two components by turning x, y, z around:
//! u = -a (e^(ax) sin(ay + dz) + e^(az) cos(ax + dy)) e^(-nu d^2 t). The vorticity is d u, so that the
//! convection is grad(u . u / 2), p = -u . u / 2, and the viscous force -nu d^2 u.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use alewife_mesh::Point;

use super::Exact;

/// The flow of a fluid of a kinematic viscosity.
#[derive(Debug, Clone, Copy)]
pub struct EthierSteinman {
    /// Kinematic viscosity.
    pub viscosity: f64,
}

impl EthierSteinman {
    /// The force per unit volume that keeps the flow as it is at time zero.
    #[must_use]
    pub fn sustaining_force(&self, place: &Point<3>) -> Point<3> {
        self.velocity(place, 0.0) * (self.viscosity * FRAC_PI_2.powi(2))
    }
}

impl Exact<3> for EthierSteinman {
    fn velocity(&self, place: &Point<3>, time: f64) -> Point<3> {
        let (a, d) = (FRAC_PI_4, FRAC_PI_2);
        let decay = (-self.viscosity * d * d * time).exp();
        Point::<3>::from_fn(|axis, _| {
            let [x, y, z] = [0, 1, 2].map(|turn| place[(axis + turn) % 3]);
            let sum = (a * x).exp() * (a * y + d * z).sin() + (a * z).exp() * (a * x + d * y).cos();
            -a * sum * decay
        })
    }

    fn pressure(&self, place: &Point<3>, time: f64) -> f64 {
        -self.velocity(place, time).norm_squared() / 2.0
    }
}
