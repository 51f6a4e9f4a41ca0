//! `LocalViscosity`: a viscosity taken at the rate of strain of a given velocity, and the stress linearised there.

use alewife_mesh::{NodeId, Point};
use nalgebra::{SMatrix, SVector};

use super::viscosity::{Viscosity, ViscosityAtRate};
use crate::space::{Metric, PointValues};

/// The viscosity in the terms of a system.
#[derive(Debug, Clone, Copy)]
pub enum ViscosityTerm<'a, const D: usize> {
    /// The same everywhere (Pa s).
    Constant(f64),
    /// Another one at each point.
    Local(LocalViscosity<'a, D>),
}

/// A viscosity linearised about the rate of strain D0 of a given velocity: the stress is
/// 2 mu(D0) D + 8 mu' (D0 : (D - D0)) D0, with mu' = d mu / d(2 D : D). Where the given velocity is the iterate itself, that is
/// the step of Newton's method. Without its tangent the stress is 2 mu(D0) D, which takes energy from any flow.
#[derive(Debug, Clone, Copy)]
pub struct LocalViscosity<'a, const D: usize> {
    /// The law.
    pub law: Viscosity,
    /// The given velocity at the nodes (m/s).
    pub velocity: &'a [Point<D>],
    /// Whether the stress has the term with mu'.
    pub has_tangent: bool,
}

/// The viscosity at a point, with the strain it is taken at.
#[derive(Debug, Clone, Copy)]
pub struct PointViscosity<const D: usize> {
    /// mu (Pa s).
    pub value: f64,
    /// 2 d mu / d(2 D0 : D0) (Pa s3), zero without a tangent.
    pub slope: f64,
    /// gradient\[(i, j)\] = d_j u_i of the given velocity (1/s).
    pub gradient: SMatrix<f64, D, D>,
    /// 2 D0 (1/s) in the coordinates of the mesh.
    pub strain: SMatrix<f64, D, D>,
    /// Rate of stretching of the ring through the point (1/s).
    pub hoop: f64,
    /// 2 D0 : D0 (1/s2).
    pub squared_rate: f64,
}

/// A quadrature point of a cell or of one of its facets.
#[derive(Debug, Clone, Copy)]
pub(super) struct BasisAt<'a, const D: usize> {
    pub metric: Metric,
    pub nodes: &'a [NodeId],
    pub phi: &'a [f64],
    pub grad_phi: &'a [SVector<f64, D>],
    pub position: &'a Point<D>,
}

impl<const D: usize> ViscosityTerm<'_, D> {
    /// The number where it is the same everywhere (Pa s).
    #[must_use]
    pub fn constant(&self) -> Option<f64> {
        if let Self::Constant(value) = self { Some(*value) } else { None }
    }

    /// The viscosity at a point.
    pub(super) fn at(&self, at: BasisAt<'_, D>) -> PointViscosity<D> {
        match self {
            Self::Constant(value) => PointViscosity {
                value: *value,
                slope: 0.0,
                gradient: SMatrix::zeros(),
                strain: SMatrix::zeros(),
                hoop: 0.0,
                squared_rate: 0.0,
            },
            Self::Local(local) => {
                let BasisAt { metric, nodes, phi, grad_phi, position } = at;
                let mut velocity = Point::<D>::zeros();
                let mut gradient = SMatrix::<f64, D, D>::zeros();
                for (a, &node) in nodes.iter().enumerate() {
                    velocity += local.velocity[node] * phi[a];
                    gradient += local.velocity[node] * grad_phi[a].transpose();
                }
                local.at_gradient(&gradient, metric.hoop_strain(&velocity, position))
            }
        }
    }
}

impl<const D: usize> LocalViscosity<'_, D> {
    /// The viscosity (Pa s) at a quadrature point of a cell with these nodes.
    #[must_use]
    pub fn value(&self, metric: Metric, nodes: &[NodeId], at: &PointValues<'_, D>) -> f64 {
        let at =
            BasisAt { metric, nodes, phi: at.phi, grad_phi: at.grad_phi, position: &at.position };
        ViscosityTerm::Local(*self).at(at).value
    }

    /// The viscosity where the velocity has a gradient (1/s) and stretches rings at a rate (1/s).
    fn at_gradient(&self, gradient: &SMatrix<f64, D, D>, hoop: f64) -> PointViscosity<D> {
        let strain = gradient + gradient.transpose();
        let squared_rate = squared_shear(gradient, hoop);
        let ViscosityAtRate { value, slope } = self.law.at(squared_rate);
        let slope = if self.has_tangent { 2.0 * slope } else { 0.0 };
        PointViscosity { value, slope, gradient: *gradient, strain, hoop, squared_rate }
    }
}

/// The square of the rate of shear, 2 D : D (1/s2), of a gradient (1/s) and the rate of stretching of rings (1/s).
#[must_use]
pub fn squared_shear<const D: usize>(gradient: &SMatrix<f64, D, D>, hoop: f64) -> f64 {
    0.5 * (gradient + gradient.transpose()).norm_squared() + 2.0 * hoop * hoop
}

impl<const D: usize> PointViscosity<D> {
    /// 2 D0 : D (1/s2) of the velocity phi e_axis, with the gradient of phi (1/m) and phi / r (1/m) where rings stretch.
    pub(super) fn product(&self, axis: usize, gradient: &SVector<f64, D>, stretch: f64) -> f64 {
        (self.strain * gradient)[axis] + 2.0 * self.hoop * stretch
    }

    /// By how much the linearised viscosity differs from `value` (Pa s) in a flow of this gradient (1/s) and stretching of
    /// rings (1/s).
    pub(super) fn change(&self, gradient: &SMatrix<f64, D, D>, hoop: f64) -> f64 {
        let product = self.strain.dot(gradient) + 2.0 * self.hoop * hoop;
        self.slope * (product - self.squared_rate)
    }
}
