//! Matrix of one cell: inertia, convection, viscous stress, pressure and divergence.
//!
//! Of test function phi_a e_i and trial function phi_b e_j:
//!
//! ```text
//! int rho (a0 phi_b + c . grad phi_b) phi_a delta_ij
//!   + mu (grad phi_a . grad phi_b delta_ij + d_j phi_a d_i phi_b)   (= 2 mu D(u) : D(v))
//!   + rho phi_a phi_b d_j u0_i                                      (Newton)
//!   + 2 mu' (2 D0 e_i . grad phi_a) (2 D0 e_j . grad phi_b)         (linearised viscosity)
//! ```
//!
//! and -psi_v d_i phi_a for the pressure, with its transpose. Axisymmetric problems, with axis x and
//! radius y = r, add the hoop stress 2 mu u_r v_r / r^2 and div u = d_x u_x + d_r u_r + u_r / r.

use alewife_mesh::{CellId, NodeId};
use pulp::Simd;

use super::lanes::{add_product, product, scaled};
use super::points::{CellPoints, PointTable, gather, nodes_of};
use super::shear::ShearPoints;
use crate::flow::kernel::{CellInput, LocalLayout};
use crate::flow::terms::{Convection, FlowTerms};
use crate::space::Metric;

/// Overwrites the square `matrix`, column by column, with the cell's raw matrix.
#[inline(always)]
pub fn cell_matrix<S: Simd, const D: usize, const N: usize, const P: usize, const Q: usize>(
    input: CellInput<'_, D>,
    metric: Metric,
    cell: CellId,
    batches: &[PointTable<D, N, P, Q>],
    local: LocalLayout<D>,
    matrix: &mut [f64],
) {
    let CellInput { mesh, terms, fields } = input;
    let nodes: &[NodeId; N] = nodes_of(mesh, cell);
    let corners = gather(&mesh.nodes, nodes);
    let mut matrix = LocalMatrix { values: matrix, local, is_overwritten: true };
    matrix.clear_pressure_and_frame();
    for (index, table) in batches.iter().enumerate() {
        // Of a straight cell there is one batch only, which the compiler knows.
        matrix.is_overwritten = index == 0;
        let points = CellPoints::new::<S, N, P>(table, &corners, mesh.curved[cell], metric);
        let gradients = points.gradients::<S, N, P>(table);
        let shear =
            ShearPoints::of_term::<S, N, P>(&terms.viscosity, table, &points, nodes, metric);
        let batch = Batch {
            table,
            viscous: match (&shear, terms.viscosity.constant()) {
                (Some(shear), _) => product(&points.dx, &shear.value),
                (None, constant) => scaled(&points.dx, constant.unwrap_or_default()),
            },
            inertia: scaled(&points.dx, terms.density),
            points,
            gradients,
        };
        let carried = batch.carried::<S>(terms, nodes);
        batch.add_momentum::<S>(&carried, &mut matrix);
        let in_frame = terms.convection == Convection::NewtonInFrame;
        if (in_frame || terms.convection == Convection::Newton) && terms.density != 0.0 {
            let velocity = gather(fields.velocity, nodes);
            batch.add_newton::<S>(&velocity, in_frame, &mut matrix);
        }
        let mut inverse_radius = [0.0; Q];
        if metric.is_revolved() {
            for q in 0..Q {
                inverse_radius[q] = 1.0 / batch.points.position[Metric::RADIAL][q];
            }
            batch.add_hoop_stress::<S>(&inverse_radius, &mut matrix);
        }
        if let Some(shear) = shear.as_ref().filter(|shear| shear.has_tangent) {
            batch.add_tangent::<S>(shear, &inverse_radius, &mut matrix);
        }
        batch.add_divergence::<S>(metric, &inverse_radius, &mut matrix);
    }
}

/// The raw matrix of a cell, column by column.
struct LocalMatrix<'a, const D: usize> {
    values: &'a mut [f64],
    local: LocalLayout<D>,
    /// Whether momentum and divergence are the first sums written, not added to others.
    is_overwritten: bool,
}

impl<const D: usize> LocalMatrix<'_, D> {
    /// Entries of one column in the rows of the velocities along axis `i`.
    #[inline(always)]
    fn velocity_rows<const N: usize>(&mut self, column: usize, i: usize) -> &mut [f64; N] {
        let start = column * self.local.n_local() + self.local.velocity(0, i);
        self.values[start..].first_chunk_mut().expect("the matrix has rows for all velocities")
    }

    /// Zero where a pressure meets a pressure, and in the rows and columns of the frame.
    #[inline(always)]
    fn clear_pressure_and_frame(&mut self) {
        let size = self.local.n_local();
        let n_velocities = self.local.pressure(0);
        for column in n_velocities..size {
            let first = if column < self.local.n_fluid() { n_velocities } else { 0 };
            self.values[column * size + first..(column + 1) * size].fill(0.0);
        }
        if self.local.n_frame > 0 {
            for column in 0..n_velocities {
                self.values[column * size + self.local.n_fluid()..(column + 1) * size].fill(0.0);
            }
        }
    }

    /// Adds a block for test functions along axis `i` and trial functions along axis `j`.
    #[inline(always)]
    fn add_block<const N: usize, const P: usize>(
        &mut self,
        block: &Block<N, P>,
        i: usize,
        j: usize,
    ) {
        for b in 0..N {
            let rows: &mut [f64; N] = self.velocity_rows(self.local.velocity(b, j), i);
            for a in 0..N {
                rows[a] += block[b][a];
            }
        }
    }
}

/// N x N sums: one column a trial function, one lane a test function.
type Block<const N: usize, const P: usize> = [[f64; P]; N];

/// The bases at some quadrature points of a cell, with weights of the terms.
struct Batch<'a, const D: usize, const N: usize, const P: usize, const Q: usize> {
    table: &'a PointTable<D, N, P, Q>,
    points: CellPoints<D, Q>,
    /// Physical gradients of the velocity's basis: by point, axis, node.
    gradients: [[[f64; P]; D]; Q],
    /// mu dx.
    viscous: [f64; Q],
    /// rho dx.
    inertia: [f64; Q],
}

impl<const D: usize, const N: usize, const P: usize, const Q: usize> Batch<'_, D, N, P, Q> {
    /// What each trial function carries along, a0 phi_b + c . grad phi_b, times rho dx.
    #[inline(always)]
    fn carried<S: Simd>(&self, terms: &FlowTerms<'_, D>, nodes: &[NodeId; N]) -> [[f64; P]; Q] {
        let has_convection =
            terms.convection != Convection::None && !terms.convecting_velocity.is_empty();
        let mut carried = [[0.0; P]; Q];
        if terms.density == 0.0 || (terms.rate == 0.0 && !has_convection) {
            return carried;
        }
        let rate = scaled(&self.inertia, terms.rate);
        for q in 0..Q {
            carried[q] = scaled(&self.table.phi[q], rate[q]);
        }
        if has_convection {
            let convecting = gather(terms.convecting_velocity, nodes);
            for axis in 0..D {
                let nodal = &convecting[axis];
                let convecting = product(&self.table.velocity::<S>(nodal), &self.inertia);
                for q in 0..Q {
                    add_product::<S, P>(&mut carried[q], &self.gradients[q][axis], convecting[q]);
                }
            }
        }
        carried
    }

    /// Inertia, convection and viscous stress.
    #[inline(always)]
    fn add_momentum<S: Simd>(&self, carried: &[[f64; P]; Q], matrix: &mut LocalMatrix<'_, D>) {
        // shared: the same for every component. transposed[i][j], j <= i: d_j phi_a d_i phi_b.
        let mut shared: Block<N, P> = [[0.0; P]; N];
        let mut transposed: [[Block<N, P>; D]; D] = [[[[0.0; P]; N]; D]; D];
        for b in 0..N {
            let mut sum = [0.0; P];
            let mut products = [[[0.0; P]; D]; D];
            for q in 0..Q {
                add_product::<S, P>(&mut sum, &self.table.phi[q], carried[q][b]);
                for i in 0..D {
                    let flux = self.gradients[q][i][b] * self.viscous[q];
                    for j in 0..=i {
                        add_product::<S, P>(&mut products[i][j], &self.gradients[q][j], flux);
                    }
                }
            }
            for i in 0..D {
                for a in 0..P {
                    sum[a] += products[i][i][a];
                }
                for j in 0..=i {
                    transposed[i][j][b] = products[i][j];
                }
            }
            shared[b] = sum;
        }
        let is_overwritten = matrix.is_overwritten;
        for i in 0..D {
            for j in 0..D {
                for b in 0..N {
                    let column = matrix.local.velocity(b, j);
                    let rows: &mut [f64; N] = matrix.velocity_rows(column, i);
                    for a in 0..N {
                        let mut sum =
                            if j <= i { transposed[i][j][b][a] } else { transposed[j][i][a][b] };
                        if i == j {
                            sum += shared[b][a];
                        }
                        rows[a] = if is_overwritten { sum } else { rows[a] + sum };
                    }
                }
            }
        }
    }

    /// rho phi_a phi_b d_j u_i, and in a frame of unknown velocity the column -rho phi_a d_j u_i.
    #[inline(always)]
    fn add_newton<S: Simd>(
        &self,
        velocity: &[[f64; N]; D],
        in_frame: bool,
        matrix: &mut LocalMatrix<'_, D>,
    ) {
        for i in 0..D {
            let gradient = self.points.gradient::<S, N, P>(self.table, &velocity[i]);
            for j in 0..D {
                let reaction = product(&gradient[j], &self.inertia);
                let mut weighted = [[0.0; P]; Q];
                for q in 0..Q {
                    weighted[q] = scaled(&self.table.phi[q], reaction[q]);
                }
                matrix.add_block(&self.tested_with_phi::<S>(&weighted), i, j);
                if in_frame && j < matrix.local.n_frame {
                    let rows: &mut [f64; N] = matrix.velocity_rows(matrix.local.frame(j), i);
                    for point in &weighted {
                        for a in 0..N {
                            rows[a] -= point[a];
                        }
                    }
                }
            }
        }
    }

    /// 2 mu u_r v_r / r^2.
    #[inline(always)]
    fn add_hoop_stress<S: Simd>(&self, inverse_radius: &[f64; Q], matrix: &mut LocalMatrix<'_, D>) {
        let mut hoop = [[0.0; P]; Q];
        for q in 0..Q {
            let weight = 2.0 * self.viscous[q] * inverse_radius[q] * inverse_radius[q];
            hoop[q] = scaled(&self.table.phi[q], weight);
        }
        matrix.add_block(&self.tested_with_phi::<S>(&hoop), Metric::RADIAL, Metric::RADIAL);
    }

    /// What the viscosity changes with the strain: of test and trial functions 2 D0 : D, which rings add to by
    /// 2 h0 phi / r.
    #[inline(always)]
    fn add_tangent<S: Simd>(
        &self,
        shear: &ShearPoints<D, Q>,
        inverse_radius: &[f64; Q],
        matrix: &mut LocalMatrix<'_, D>,
    ) {
        let slope = product(&shear.slope, &self.points.dx);
        let mut tested = [[[0.0; P]; Q]; D];
        let mut tried = [[[0.0; P]; Q]; D];
        for i in 0..D {
            for q in 0..Q {
                for k in 0..D {
                    let strain = shear.gradient[i][k][q] + shear.gradient[k][i][q];
                    add_product::<S, P>(&mut tested[i][q], &self.gradients[q][k], strain);
                }
                if i == Metric::RADIAL {
                    let hoop = 2.0 * shear.hoop[q] * inverse_radius[q];
                    add_product::<S, P>(&mut tested[i][q], &self.table.phi[q], hoop);
                }
                tried[i][q] = scaled(&tested[i][q], slope[q]);
            }
        }
        for i in 0..D {
            for j in 0..D {
                let mut block = [[0.0; P]; N];
                for b in 0..N {
                    for q in 0..Q {
                        add_product::<S, P>(&mut block[b], &tested[i][q], tried[j][q][b]);
                    }
                }
                matrix.add_block(&block, i, j);
            }
        }
    }

    /// -psi_v d_i phi_a and its transpose, the hoop's part included.
    #[inline(always)]
    fn add_divergence<S: Simd>(
        &self,
        metric: Metric,
        inverse_radius: &[f64; Q],
        matrix: &mut LocalMatrix<'_, D>,
    ) {
        let (size, is_overwritten) = (matrix.local.n_local(), matrix.is_overwritten);
        for axis in 0..D {
            for node in 0..PointTable::<D, N, P, Q>::N_PRESSURES {
                let weight = product(&self.table.psi_of_node[node], &self.points.dx);
                let mut divergence = [0.0; P];
                for q in 0..Q {
                    add_product::<S, P>(&mut divergence, &self.gradients[q][axis], weight[q]);
                }
                if metric.is_revolved() && axis == Metric::RADIAL {
                    let weight = product(&weight, inverse_radius);
                    for q in 0..Q {
                        add_product::<S, P>(&mut divergence, &self.table.phi[q], weight[q]);
                    }
                }
                let pressure = matrix.local.pressure(node);
                for a in 0..N {
                    let velocity = matrix.local.velocity(a, axis);
                    for entry in [pressure * size + velocity, velocity * size + pressure] {
                        let value = &mut matrix.values[entry];
                        *value = if is_overwritten { 0.0 } else { *value } - divergence[a];
                    }
                }
            }
        }
    }

    /// sum_q phi_a trial_b of trial functions that are weighted already.
    #[inline(always)]
    fn tested_with_phi<S: Simd>(&self, trial: &[[f64; P]; Q]) -> Block<N, P> {
        let mut sums = [[0.0; P]; N];
        for b in 0..N {
            for q in 0..Q {
                add_product::<S, P>(&mut sums[b], &self.table.phi[q], trial[q][b]);
            }
        }
        sums
    }
}
