//! Stokes flow past a held sphere of radius 1 in a uniform stream of speed 1 along x, viscosity 1.
//!
//! With R the distance from the centre and c = x / R:
//! u_R = c (1 - 3/(2R) + 1/(2R^3)), u_theta = -s (1 - 3/(4R) - 1/(4R^3)), p = -3 c / (2 R^2).

use alewife_mesh::Point;

use super::Exact;

/// The flow in the meridian plane: x along the axis, y the distance from it.
#[derive(Debug, Clone, Copy)]
pub struct StokesSphere;

impl Exact for StokesSphere {
    fn velocity(&self, place: &Point<2>, _time: f64) -> Point<2> {
        let distance = place.norm();
        let outward = place / distance;
        let along = Point::<2>::new(-outward[1], outward[0]);
        let inverse = 1.0 / distance;
        let radial = outward[0] * (1.0 - 1.5 * inverse + 0.5 * inverse.powi(3));
        let tangential = -outward[1] * (1.0 - 0.75 * inverse - 0.25 * inverse.powi(3));
        outward * radial + along * tangential
    }

    fn pressure(&self, place: &Point<2>, _time: f64) -> f64 {
        -1.5 * place[0] / place.norm().powi(3)
    }
}
