//! Residual of one cell: momentum tested with the velocity's basis, divergence with the pressure's.
//!
//! ```text
//! int (rho (a0 u + h + (c . grad) u) - f) . v + (2 mu D(u) - p I) : grad v - q div u
//! ```
//!
//! Axisymmetric problems add the hoop stress times its strain, (2 mu u_r / r - p) v_r / r. A viscosity that is
//! linearised at a strain D0 adds 2 mu' (2 D0 : (D(u) - D0)) 2 D0 to the stress.

use alewife_mesh::{CellId, NodeId};
use pulp::Simd;

use super::lanes::{add_product, add_scaled, multiply_add, product, scaled_rows};
use super::points::{CellPoints, PointTable, gather, nodes_of};
use super::shear::ShearPoints;
use crate::flow::kernel::{CellInput, LocalLayout};
use crate::flow::terms::FlowTerms;
use crate::space::{DofLayout, Metric};

/// Overwrites `residual` with the cell's raw residual.
#[inline(always)]
pub fn cell_residual<S: Simd, const D: usize, const N: usize, const P: usize, const Q: usize>(
    input: CellInput<'_, D>,
    metric: Metric,
    cell: CellId,
    batches: &[PointTable<D, N, P, Q>],
    local: LocalLayout<D>,
    residual: &mut [f64],
) {
    let CellInput { mesh, terms, .. } = input;
    let nodal = NodalValues::new(input, cell);
    let mut momentum = [[0.0; P]; D];
    let mut continuity = [0.0; N];
    for table in batches {
        let points = CellPoints::new::<S, N, P>(table, &nodal.corners, mesh.curved[cell], metric);
        let pressure = table.pressure::<S>(&nodal.pressure);
        // gradient[i][j] = d_j u_i.
        let mut gradient = [[[0.0; Q]; D]; D];
        for i in 0..D {
            gradient[i] = points.gradient::<S, N, P>(table, &nodal.velocity[i]);
        }
        let mut force = nodal.inertia::<S, P, Q>(table, terms, &gradient);
        let mut divergence = [0.0; Q];
        for i in 0..D {
            for q in 0..Q {
                divergence[q] += gradient[i][i][q];
            }
        }
        let nodes: &[NodeId; N] = nodes_of(mesh, cell);
        let shear =
            ShearPoints::of_term::<S, N, P>(&terms.viscosity, table, &points, nodes, metric);
        let viscosity = match (&shear, terms.viscosity.constant()) {
            (Some(shear), _) => shear.value,
            (None, constant) => [constant.unwrap_or_default(); Q],
        };
        let mut stretch = [0.0; Q];
        if metric.is_revolved() {
            let radial = table.velocity::<S>(&nodal.velocity[Metric::RADIAL]);
            for q in 0..Q {
                let radius = points.position[Metric::RADIAL][q];
                stretch[q] = radial[q] / radius;
                divergence[q] += stretch[q];
                force[Metric::RADIAL][q] +=
                    (2.0 * viscosity[q] * stretch[q] - pressure[q]) / radius;
            }
        }
        let tangent = shear
            .as_ref()
            .filter(|shear| shear.has_tangent)
            .map(|shear| (shear, shear.change::<S>(&gradient, &stretch)));
        if let Some((shear, change)) = tangent.filter(|_| metric.is_revolved()) {
            for q in 0..Q {
                let radius = points.position[Metric::RADIAL][q];
                force[Metric::RADIAL][q] += 2.0 * change[q] * shear.hoop[q] / radius;
            }
        }
        let stress = Stress { viscosity, gradient, pressure, tangent };
        for i in 0..D {
            let flux = stress.reference_flux::<S>(&points, i);
            let force = product(&force[i], &points.dx);
            for q in 0..Q {
                add_product::<S, P>(&mut momentum[i], &table.phi[q], force[q]);
                for k in 0..D {
                    add_product::<S, P>(&mut momentum[i], &table.gradients[q][k], flux[k][q]);
                }
            }
        }
        let divergence = product(&divergence, &points.dx);
        for node in 0..PointTable::<D, N, P, Q>::N_PRESSURES {
            let psi = &table.psi_of_node[node];
            for q in 0..Q {
                continuity[node] = multiply_add::<S>(psi[q], divergence[q], continuity[node]);
            }
        }
    }
    for i in 0..D {
        let start = local.velocity(0, i);
        residual[start..start + N].copy_from_slice(&momentum[i][..N]);
    }
    for node in 0..PointTable::<D, N, P, Q>::N_PRESSURES {
        residual[local.pressure(node)] = -continuity[node];
    }
}

/// What a cell's residual needs at its nodes, by axis.
struct NodalValues<const D: usize, const N: usize> {
    corners: [[f64; N]; D],
    velocity: [[f64; N]; D],
    /// At the pressure nodes, which come first.
    pressure: [f64; N],
    /// Time derivative a0 u + h (m/s2), if any.
    change: Option<[[f64; N]; D]>,
    /// Convecting velocity, if any.
    convecting: Option<[[f64; N]; D]>,
}

impl<const D: usize, const N: usize> NodalValues<D, N> {
    #[inline(always)]
    fn new(input: CellInput<'_, D>, cell: CellId) -> Self {
        let CellInput { mesh, terms, fields } = input;
        let nodes: &[NodeId; N] = nodes_of(mesh, cell);
        let velocity = gather(fields.velocity, nodes);
        let mut pressure = [0.0; N];
        for (value, &node) in pressure.iter_mut().zip(DofLayout::pressure_nodes(mesh, cell)) {
            *value = fields.pressure[node];
        }
        let (mut change, mut convecting) = (None, None);
        if terms.density != 0.0 {
            // The time derivative is summed at the nodes.
            if terms.rate != 0.0 || !terms.history.is_empty() {
                let mut sum = scaled_rows(&velocity, terms.rate);
                if !terms.history.is_empty() {
                    let history = gather(terms.history, nodes);
                    for i in 0..D {
                        for a in 0..N {
                            sum[i][a] += history[i][a];
                        }
                    }
                }
                change = Some(sum);
            }
            if !terms.convecting_velocity.is_empty() {
                convecting = Some(gather(terms.convecting_velocity, nodes));
            }
        }
        Self { corners: gather(&mesh.nodes, nodes), velocity, pressure, change, convecting }
    }

    /// rho (a0 u + h + (c . grad) u) at the points, by axis.
    #[inline(always)]
    fn inertia<S: Simd, const P: usize, const Q: usize>(
        &self,
        table: &PointTable<D, N, P, Q>,
        terms: &FlowTerms<'_, D>,
        gradient: &[[[f64; Q]; D]; D],
    ) -> [[f64; Q]; D] {
        let mut force = [[0.0; Q]; D];
        if let Some(change) = &self.change {
            for i in 0..D {
                force[i] = table.velocity::<S>(&change[i]);
            }
        }
        if let Some(convecting) = &self.convecting {
            for j in 0..D {
                let convecting = table.velocity::<S>(&convecting[j]);
                for i in 0..D {
                    add_scaled::<S, Q>(&mut force[i], &gradient[i][j], &convecting);
                }
            }
        }
        if self.change.is_some() || self.convecting.is_some() {
            force = scaled_rows(&force, terms.density);
        }
        force
    }
}

/// The stress 2 mu D(u) - p I at the points.
struct Stress<'a, const D: usize, const Q: usize> {
    viscosity: [f64; Q],
    /// gradient\[i\]\[j\] = d_j u_i.
    gradient: [[[f64; Q]; D]; D],
    pressure: [f64; Q],
    /// Where the viscosity is linearised, its points and by how much it differs there (Pa s).
    tangent: Option<(&'a ShearPoints<D, Q>, [f64; Q])>,
}

impl<const D: usize, const Q: usize> Stress<'_, D, Q> {
    /// Row `i` of the stress, weighted and turned to the reference axes.
    #[inline(always)]
    fn reference_flux<S: Simd>(&self, points: &CellPoints<D, Q>, i: usize) -> [[f64; Q]; D] {
        let mut flux = [[0.0; Q]; D];
        for j in 0..D {
            let mut stress = [0.0; Q];
            for q in 0..Q {
                let rate = self.gradient[i][j][q] + self.gradient[j][i][q];
                let level = if i == j { self.pressure[q] } else { 0.0 };
                stress[q] = multiply_add::<S>(self.viscosity[q], rate, -level);
            }
            if let Some((shear, change)) = &self.tangent {
                add_scaled::<S, Q>(&mut stress, &shear.gradient[i][j], change);
                add_scaled::<S, Q>(&mut stress, &shear.gradient[j][i], change);
            }
            let stress = product(&stress, &points.dx);
            for k in 0..D {
                add_scaled::<S, Q>(&mut flux[k], &stress, &points.inverse[k][j]);
            }
        }
        flux
    }
}
