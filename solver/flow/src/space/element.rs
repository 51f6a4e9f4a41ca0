//! `Element`: the Lagrange bases of velocity and pressure on the reference simplex.

use nalgebra::SVector;

use super::basis::{p1_values, p2_gradients, p2_values};

/// A Taylor-Hood pair: continuous velocity of some degree, continuous pressure of one degree less.
///
/// The map x(X) of a cell has the basis of the velocity.
#[derive(Debug, Clone, Copy)]
pub struct Element<const D: usize> {
    /// Degree of the velocity.
    pub degree: usize,
    /// Values of the velocity's basis at a reference point, by node of the cell.
    pub phi: fn(&SVector<f64, D>) -> Vec<f64>,
    /// Gradients of the velocity's basis in reference coordinates.
    pub grad_phi: fn(&SVector<f64, D>) -> Vec<SVector<f64, D>>,
    /// Values of the pressure's basis at a reference point.
    pub psi: fn(&SVector<f64, D>) -> Vec<f64>,
}

impl<const D: usize> Element<D> {
    /// Quadratic velocity, linear pressure: P2-P1.
    pub const QUADRATIC: Self =
        Self { degree: 2, phi: p2_values, grad_phi: p2_gradients, psi: p1_values };

    /// Degree of the convection term phi phi . grad phi on an affine cell.
    #[must_use]
    pub fn affine_degree(&self) -> usize {
        3 * self.degree - 1
    }

    /// Degree for curved cells, where integrands are rational.
    #[must_use]
    pub fn curved_degree(&self) -> usize {
        4 * self.degree
    }
}

/// Number of Lagrange nodes of a degree on a simplex: binomial(degree + D, D).
#[must_use]
pub const fn n_lagrange_nodes(dimension: usize, degree: usize) -> usize {
    let (mut n, mut axis) = (1, 1);
    while axis <= dimension {
        n = n * (degree + axis) / axis;
        axis += 1;
    }
    n
}

#[cfg(test)]
mod tests {
    use alewife_mesh::Simplex;

    use super::*;

    #[test]
    fn a_basis_has_as_many_functions_as_its_degree_has_nodes() {
        fn check<const D: usize>() {
            let element = Element::<D>::QUADRATIC;
            let xi = SVector::repeat(0.2);
            let n = n_lagrange_nodes(D, element.degree);
            assert_eq!([(element.phi)(&xi).len(), (element.grad_phi)(&xi).len()], [n, n]);
            assert_eq!(n, Simplex::<D>::N_NODES);
            assert_eq!((element.psi)(&xi).len(), n_lagrange_nodes(D, element.degree - 1));
        }
        check::<2>();
        check::<3>();
    }
}
