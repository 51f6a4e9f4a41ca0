//! `Strips`: a slender link in the plane, with the inertia of its potential flow and drag by strips along it.

use std::f64::consts::PI;

use super::Resistance;
use crate::tree::spatial::{Number, Symmetric, Twist, Wrench, real};

/// Nodes on [-1, 1] and weights of Gauss's rule of five points.
const STRIPS: [[f64; 2]; 5] = [
    [-0.906_179_845_938_664, 0.236_926_885_056_189_1],
    [-0.538_469_310_105_683_1, 0.478_628_670_499_366_5],
    [0.0, 0.568_888_888_888_888_9],
    [0.538_469_310_105_683_1, 0.478_628_670_499_366_5],
    [0.906_179_845_938_664, 0.236_926_885_056_189_1],
];

/// Coefficients without dimension.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StripCoefficients<T: Number> {
    /// Of the masses of the potential flow about an ellipse.
    pub added_mass: T,
    /// `c_n`: force across by viscosity.
    pub normal_linear: T,
    /// `C_n`: force across by the square of the velocity.
    pub normal_quadratic: T,
    /// `c_t`: force along by viscosity.
    pub tangential_linear: T,
    /// `C_t`: force along by the square of the velocity.
    pub tangential_quadratic: T,
}

/// An elliptic cylinder of half length a along x and half width b, of a depth along z (one in the plane), that
/// moves in the plane with the velocities u along itself, v across and w about z. Masses of the potential flow
/// (Lamb, Hydrodynamics, art. 71 and 72) are, a depth,
///
/// ```text
/// m_x = pi rho b^2,  m_y = pi rho a^2,  J = pi rho (a^2 - b^2)^2 / 8,
/// ```
///
/// and the strip of a link of length L = 2 a at the place s resists, a length and a depth, by
///
/// ```text
/// f_y = -(mu/L c_n + rho/2 C_n |v + s w|) (v + s w),    f_x = -(mu/L c_t + rho/2 C_t |u|) u
/// ```
///
/// (the resistive model of undulating bodies: Taylor 1952, Proc. R. Soc. A 214, 158, with the masses beside).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strips<T: Number> {
    /// Half length a (m).
    pub half_length: T,
    /// Half width b (m).
    pub half_width: T,
    /// Depth along z (m); one for loads a depth.
    pub depth: T,
    /// Density of the fluid (kg/m3).
    pub density: T,
    /// Dynamic viscosity (Pa s).
    pub viscosity: T,
    /// Coefficients.
    pub coefficients: StripCoefficients<T>,
}

impl<T: Number> Strips<T> {
    pub(super) fn added_mass(&self) -> Symmetric<T> {
        let (a, b) = (self.half_length, self.half_width);
        let scale = self.density * self.depth * self.coefficients.added_mass * PI;
        let less = a * a - b * b;
        let mut masses = Symmetric::zero();
        masses.linear[(0, 0)] = scale * b * b;
        masses.linear[(1, 1)] = scale * a * a;
        masses.angular[(2, 2)] = scale * less * less / 8.0;
        masses
    }

    pub(super) fn resist(&self, twist: &Twist<T>) -> Resistance<T> {
        let c = &self.coefficients;
        let (mut wrench, mut slope) = (Wrench::zero(), Symmetric::zero());
        // Of a length: the link's weighs one in all
        let linear = self.viscosity * self.depth;
        let square = self.density * self.depth * self.half_length;
        let (along, across) = (twist.linear.x, twist.linear.y);
        let (stokes, drag) = (linear * c.tangential_linear, square * c.tangential_quadratic);
        wrench.force.x = -(stokes + drag * along.abs()) * along;
        slope.linear[(0, 0)] = stokes + drag * along.abs() * 2.0;
        let (stokes, drag) = (linear * c.normal_linear, square * c.normal_quadratic);
        let (mut yy, mut yw, mut ww): (T, T, T) = (real(0.0), real(0.0), real(0.0));
        for [node, weight] in STRIPS {
            let place = self.half_length * node;
            let velocity = across + place * twist.angular.z;
            let half = 0.5 * weight;
            let force = -(stokes + drag * velocity.abs()) * velocity * half;
            wrench.force.y += force;
            wrench.torque.z += force * place;
            let resistance = (stokes + drag * velocity.abs() * 2.0) * half;
            yy += resistance;
            yw += resistance * place;
            ww += resistance * place * place;
        }
        slope.linear[(1, 1)] = yy;
        slope.mixed[(1, 2)] = yw;
        slope.angular[(2, 2)] = ww;
        Resistance { wrench, slope }
    }
}
