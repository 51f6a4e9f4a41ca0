//! Decaying vortices (Taylor and Green 1937), density 1, wave number pi.
//!
//! u = -cos(pi x) sin(pi y) d, v = sin(pi x) cos(pi y) d, p = -(cos(2 pi x) + cos(2 pi y)) d^2 / 4,
//! d = exp(-2 pi^2 nu t).

use std::f64::consts::PI;

use alewife_mesh::Point;

use super::Exact;

/// The vortices in a fluid of a kinematic viscosity.
#[derive(Debug, Clone, Copy)]
pub struct TaylorGreen {
    /// Kinematic viscosity.
    pub viscosity: f64,
}

impl TaylorGreen {
    fn decay(&self, time: f64) -> f64 {
        (-2.0 * PI * PI * self.viscosity * time).exp()
    }
}

impl Exact<2> for TaylorGreen {
    fn velocity(&self, place: &Point<2>, time: f64) -> Point<2> {
        let ((sin_x, cos_x), (sin_y, cos_y)) =
            ((PI * place[0]).sin_cos(), (PI * place[1]).sin_cos());
        Point::<2>::new(-cos_x * sin_y, sin_x * cos_y) * self.decay(time)
    }

    fn pressure(&self, place: &Point<2>, time: f64) -> f64 {
        -((2.0 * PI * place[0]).cos() + (2.0 * PI * place[1]).cos()) / 4.0
            * self.decay(time).powi(2)
    }
}
