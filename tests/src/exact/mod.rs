//! Exact solutions of the Navier-Stokes equations, and manufactured ones with their forces.

mod ethier_steinman;
mod kovasznay;
mod stokes_sphere;
mod swirling_cells;
mod taylor_green;

pub use ethier_steinman::EthierSteinman;
pub use kovasznay::Kovasznay;
pub use stokes_sphere::StokesSphere;
pub use swirling_cells::SwirlingCells;
pub use taylor_green::TaylorGreen;

use alewife_mesh::Point;

/// A velocity and pressure known everywhere.
pub trait Exact<const D: usize>: Sync {
    /// Velocity at a place and time.
    fn velocity(&self, place: &Point<D>, time: f64) -> Point<D>;
    /// Pressure at a place and time.
    fn pressure(&self, place: &Point<D>, time: f64) -> f64;
}
