//! A manufactured axisymmetric flow with convection: toroidal cells in a cylinder.
//!
//! Stream function psi = r^2 (1 - r^2) sin(pi x) / 2, so u_x = (1/r) d psi/dr = (1 - 2 r^2) sin(pi x),
//! u_r = -(1/r) d psi/dx = -(pi/2) r (1 - r^2) cos(pi x); p = cos(pi x) r^2. The force follows from
//! rho (u . grad) u - mu lap u + grad p, with the derivatives worked out by hand.

use std::f64::consts::PI;

use alewife_mesh::Point;

use super::Exact;

/// The cells in a fluid of density `density` and viscosity `viscosity`.
#[derive(Debug, Clone, Copy)]
pub struct SwirlingCells {
    /// Density.
    pub density: f64,
    /// Dynamic viscosity.
    pub viscosity: f64,
}

impl SwirlingCells {
    /// The force per unit volume that drives the flow.
    #[must_use]
    pub fn force(&self, place: &Point<2>) -> Point<2> {
        let (x, r) = (place[0], place[1]);
        let (sin, cos) = (PI * x).sin_cos();
        let velocity = self.velocity(place, 0.0);
        // Gradients of both components.
        let ux = Point::<2>::new(PI * (1.0 - 2.0 * r * r) * cos, -4.0 * r * sin);
        let ur = Point::<2>::new(
            PI * PI / 2.0 * r * (1.0 - r * r) * sin,
            -PI / 2.0 * (1.0 - 3.0 * r * r) * cos,
        );
        // lap u_x = d_xx + d_rr + d_r / r; lap u_r has - u_r / r^2 besides.
        let laplacian_x = -PI * PI * (1.0 - 2.0 * r * r) * sin - 8.0 * sin;
        let profile = -PI / 2.0 * r * (1.0 - r * r);
        // d_rr f + d_r f / r - f / r^2 of f = -(pi/2)(r - r^3) is 4 pi r.
        let laplacian_r = -PI * PI * profile * cos + 4.0 * PI * r * cos;
        let pressure = Point::<2>::new(-PI * sin * r * r, 2.0 * r * cos);
        Point::<2>::new(
            self.density * velocity.dot(&ux) - self.viscosity * laplacian_x + pressure[0],
            self.density * velocity.dot(&ur) - self.viscosity * laplacian_r + pressure[1],
        )
    }
}

impl Exact<2> for SwirlingCells {
    fn velocity(&self, place: &Point<2>, _time: f64) -> Point<2> {
        let (x, r) = (place[0], place[1]);
        let (sin, cos) = (PI * x).sin_cos();
        Point::<2>::new((1.0 - 2.0 * r * r) * sin, -PI / 2.0 * r * (1.0 - r * r) * cos)
    }

    fn pressure(&self, place: &Point<2>, _time: f64) -> f64 {
        (PI * place[0]).cos() * place[1] * place[1]
    }
}
