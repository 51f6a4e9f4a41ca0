//! `ShearPoints`: a local viscosity at quadrature points of a cell, with the strain it is taken at.

use alewife_mesh::NodeId;
use pulp::Simd;

use super::lanes::add_scaled;
use super::points::{CellPoints, PointTable, gather};
use crate::flow::local_viscosity::ViscosityTerm;
use crate::space::Metric;

/// The viscosity at some points of a cell.
pub struct ShearPoints<const D: usize, const Q: usize> {
    /// mu (Pa s).
    pub value: [f64; Q],
    /// 2 d mu / d(2 D0 : D0) (Pa s3).
    pub slope: [f64; Q],
    /// gradient\[i\]\[j\] = d_j u_i of the velocity it is taken at (1/s).
    pub gradient: [[[f64; Q]; D]; D],
    /// Its rate of stretching of rings (1/s).
    pub hoop: [f64; Q],
    /// 2 D0 : D0 (1/s2).
    squared_rate: [f64; Q],
    /// Whether the stress has a term with the slope.
    pub has_tangent: bool,
}

impl<const D: usize, const Q: usize> ShearPoints<D, Q> {
    /// The points of a cell; none where the viscosity is the same everywhere.
    #[inline(always)]
    pub fn of_term<S: Simd, const N: usize, const P: usize>(
        term: &ViscosityTerm<'_, D>,
        table: &PointTable<D, N, P, Q>,
        points: &CellPoints<D, Q>,
        nodes: &[NodeId; N],
        metric: Metric,
    ) -> Option<Self> {
        let ViscosityTerm::Local(local) = term else { return None };
        let nodal = gather(local.velocity, nodes);
        let mut gradient = [[[0.0; Q]; D]; D];
        for i in 0..D {
            gradient[i] = points.gradient::<S, N, P>(table, &nodal[i]);
        }
        let mut hoop = [0.0; Q];
        if metric.is_revolved() {
            hoop = table.velocity::<S>(&nodal[Metric::RADIAL]);
            for q in 0..Q {
                hoop[q] /= points.position[Metric::RADIAL][q];
            }
        }
        let mut squared_rate = [0.0; Q];
        for i in 0..D {
            add_scaled::<S, Q>(&mut squared_rate, &gradient[i][i], &gradient[i][i]);
        }
        add_scaled::<S, Q>(&mut squared_rate, &hoop, &hoop);
        for q in 0..Q {
            squared_rate[q] *= 2.0;
            for i in 0..D {
                for j in 0..i {
                    let strain = gradient[i][j][q] + gradient[j][i][q];
                    squared_rate[q] += strain * strain;
                }
            }
        }
        let (mut value, mut slope) = ([0.0; Q], [0.0; Q]);
        for q in 0..Q {
            let at = local.law.at(squared_rate[q]);
            (value[q], slope[q]) = (at.value, 2.0 * at.slope);
        }
        Some(Self { value, slope, gradient, hoop, squared_rate, has_tangent: local.has_tangent })
    }

    /// By how much the linearised viscosity differs from that at the points (Pa s) in a flow of this gradient (1/s) and
    /// stretching of rings (1/s).
    #[inline(always)]
    pub fn change<S: Simd>(&self, gradient: &[[[f64; Q]; D]; D], hoop: &[f64; Q]) -> [f64; Q] {
        let mut product = [0.0; Q];
        for q in 0..Q {
            product[q] = 2.0 * self.hoop[q] * hoop[q] - self.squared_rate[q];
        }
        for i in 0..D {
            for j in 0..D {
                let mut strain = [0.0; Q];
                for q in 0..Q {
                    strain[q] = self.gradient[i][j][q] + self.gradient[j][i][q];
                }
                add_scaled::<S, Q>(&mut product, &strain, &gradient[i][j]);
            }
        }
        for q in 0..Q {
            product[q] *= self.slope[q];
        }
        product
    }
}
