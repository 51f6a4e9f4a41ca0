//! Stokes flow past a held sphere of radius 1 in a uniform stream U, viscosity 1.
//!
//! With R the distance from the centre and n = x / R:
//! u = U - 3/(4R) (U + n n.U) - 1/(4R^3) (U - 3 n n.U), p = -3 n.U / (2 R^2).

use alewife_mesh::Point;

use super::Exact;

/// The flow in space, or in the meridian plane: x along the axis, y the distance from it.
#[derive(Debug, Clone, Copy)]
pub struct StokesSphere<const D: usize> {
    /// Velocity far away; along x in the meridian plane.
    pub stream: Point<D>,
}

impl<const D: usize> Exact<D> for StokesSphere<D> {
    fn velocity(&self, place: &Point<D>, _time: f64) -> Point<D> {
        let distance = place.norm();
        let outward = place / distance;
        let radial = outward * outward.dot(&self.stream);
        self.stream
            - (self.stream + radial) * (0.75 / distance)
            - (self.stream - radial * 3.0) * (0.25 / distance.powi(3))
    }

    fn pressure(&self, place: &Point<D>, _time: f64) -> f64 {
        -1.5 * place.dot(&self.stream) / place.norm().powi(3)
    }
}
