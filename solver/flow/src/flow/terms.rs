//! Which terms of the equations are present in a system, and the fields they are taken at.
//!
//! R(u, p; v, q) = int rho (a0 u + h + (c . grad) u) . v + sigma : grad v - q div u,
//! sigma = -p I + 2 mu D(u), with a0 u + h the time derivative and c = u - w what convects.

use alewife_mesh::Point;

use super::local_viscosity::ViscosityTerm;

/// How the convection enters the matrix.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Convection {
    /// Not at all.
    None,
    /// rho (c . grad) u with c given.
    Oseen,
    /// Newton: rho (c . grad) u + rho (u . grad) u0.
    Newton,
    /// Newton in a frame that travels with an unknown velocity U:
    /// rho (c . grad) u + rho ((u - U) . grad) u0.
    NewtonInFrame,
}

/// Coefficients and given fields of a system.
#[derive(Clone, Copy)]
pub struct FlowTerms<'a, const D: usize> {
    /// Dynamic viscosity (Pa s).
    pub viscosity: ViscosityTerm<'a, D>,
    /// Density (kg/m3), 0 without inertia.
    pub density: f64,
    /// Factor a0 of the new velocity in its time derivative (1/s), 0 when steady.
    pub rate: f64,
    /// The older levels' part h of the time derivative at the nodes (m/s2); empty when steady.
    pub history: &'a [Point<D>],
    /// Convecting velocity c at the nodes (m/s); empty without convection.
    pub convecting_velocity: &'a [Point<D>],
    /// How the convection enters the matrix.
    pub convection: Convection,
}

/// The fields at which a residual is taken.
#[derive(Debug, Clone, Copy)]
pub struct Fields<'a, const D: usize> {
    /// Velocity at the nodes (m/s).
    pub velocity: &'a [Point<D>],
    /// Pressure at the vertices (Pa).
    pub pressure: &'a [f64],
}
