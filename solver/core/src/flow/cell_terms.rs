//! Element matrix and residual of one cell: mass, convection, viscous stress, pressure, divergence.
//!
//! Matrix of test function phi_a e_i and trial function phi_b e_j:
//!
//! ```text
//! int rho (a0 phi_b + c . grad phi_b) phi_a delta_ij
//!   + mu (grad phi_a . grad phi_b delta_ij + d_j phi_a d_i phi_b)   (= 2 mu D(u) : D(v))
//!   + rho phi_a phi_b d_j u0_i                                      (Newton)
//! ```
//!
//! and -psi_v d_i phi_a for the pressure, with its transpose. Axisymmetric problems, with
//! axis x and radius y = r, add the hoop stress 2 mu u_r v_r / r^2 and div u = d_x u_x + d_r u_r + u_r / r.

use alewife_mesh::{CellId, Mesh, NodeId, Point};
use pulp::Simd;

use super::points::{
    CellPoints, PointTable, add_product, add_scaled, gather, multiply_add, nodes_of, product,
    scaled,
};
use super::terms::{Convection, Fields, FlowTerms};
use crate::space::Metric;

const RADIAL: usize = Metric::RADIAL;

/// Local numbering of the raw unknowns of a cell: N velocities along each axis, pressures, then
/// the velocities of the frame where they are unknowns of every cell.
pub(super) struct LocalLayout<const D: usize, const N: usize>;

impl<const D: usize, const N: usize> LocalLayout<D, N> {
    /// Velocities and pressures.
    pub const FLUID: usize = N * D + D + 1;

    pub const fn velocity(node: usize, axis: usize) -> usize {
        axis * N + node
    }

    pub const fn pressure(vertex: usize) -> usize {
        N * D + vertex
    }

    pub const fn frame(axis: usize) -> usize {
        Self::FLUID + axis
    }
}

/// What the terms of one cell are made of: mesh, coefficients, fields.
#[derive(Clone, Copy)]
pub(super) struct Input<'a, const D: usize> {
    pub mesh: &'a Mesh<D>,
    pub metric: Metric,
    pub terms: &'a FlowTerms<'a, D>,
    pub fields: &'a Fields<'a, D>,
}

/// Overwrites `residual` with the cell's raw residual.
#[inline(always)]
pub(super) fn cell_residual<
    S: Simd,
    const D: usize,
    const N: usize,
    const P: usize,
    const Q: usize,
>(
    input: Input<'_, D>,
    cell: CellId,
    table: &PointTable<D, N, P, Q>,
    residual: &mut [f64],
) {
    let Input { mesh, metric, terms, fields } = input;
    let nodes: &[NodeId; N] = nodes_of(mesh, cell);
    let corners = gather(&mesh.nodes, nodes);
    let points = CellPoints::new::<S, N, P>(table, &corners, mesh.curved[cell], metric);
    let velocity = gather(fields.velocity, nodes);
    let mut pressure = [0.0; N];
    for (value, &vertex) in pressure.iter_mut().zip(&nodes[..=D]) {
        *value = fields.pressure[vertex];
    }
    let pressure = table.linear::<S>(&pressure);
    // gradient[i][j] = d_j u_i.
    let mut gradient = [[[0.0; Q]; D]; D];
    for i in 0..D {
        gradient[i] = points.gradient::<S, N, P>(table, &velocity[i]);
    }

    let mut force = [[0.0; Q]; D];
    if terms.density != 0.0 {
        // The time derivative is summed at the nodes.
        if terms.rate != 0.0 || !terms.history.is_empty() {
            let mut change = scaled_rows(&velocity, terms.rate);
            if !terms.history.is_empty() {
                let history = gather(terms.history, nodes);
                for i in 0..D {
                    for a in 0..N {
                        change[i][a] += history[i][a];
                    }
                }
            }
            for i in 0..D {
                force[i] = table.quadratic::<S>(&change[i]);
            }
        }
        if !terms.crossing.is_empty() {
            let crossing = gather(terms.crossing, nodes);
            for j in 0..D {
                let crossing = table.quadratic::<S>(&crossing[j]);
                for i in 0..D {
                    add_scaled::<S, Q>(&mut force[i], &gradient[i][j], &crossing);
                }
            }
        }
        force = scaled_rows(&force, terms.density);
    }
    if let Some(body_force) = terms.body_force {
        for q in 0..Q {
            let place = Point::<D>::from_fn(|axis, _| points.position[axis][q]);
            let given = body_force(&place);
            for i in 0..D {
                force[i][q] -= given[i];
            }
        }
    }
    let mut divergence = [0.0; Q];
    for i in 0..D {
        for q in 0..Q {
            divergence[q] += gradient[i][i][q];
        }
    }
    if metric.is_revolved() {
        let radial = table.quadratic::<S>(&velocity[RADIAL]);
        for q in 0..Q {
            let radius = points.position[RADIAL][q];
            let stretch = radial[q] / radius;
            divergence[q] += stretch;
            force[RADIAL][q] += (2.0 * terms.viscosity * stretch - pressure[q]) / radius;
        }
    }
    for i in 0..D {
        // The stress, weighted and turned to the reference axes.
        let mut flux = [[0.0; Q]; D];
        for j in 0..D {
            let mut stress = [0.0; Q];
            for q in 0..Q {
                let rate = gradient[i][j][q] + gradient[j][i][q];
                let level = if i == j { pressure[q] } else { 0.0 };
                stress[q] = multiply_add::<S>(terms.viscosity, rate, -level) * points.dx[q];
            }
            for k in 0..D {
                add_scaled::<S, Q>(&mut flux[k], &stress, &points.inverse[k][j]);
            }
        }
        let force = product(&force[i], &points.dx);
        let mut rows = [0.0; P];
        for q in 0..Q {
            add_product::<S, P>(&mut rows, &table.phi[q], force[q]);
            for k in 0..D {
                add_product::<S, P>(&mut rows, &table.gradients[q][k], flux[k][q]);
            }
        }
        let start = LocalLayout::<D, N>::velocity(0, i);
        residual[start..start + N].copy_from_slice(&rows[..N]);
    }
    let divergence = product(&divergence, &points.dx);
    for vertex in 0..=D {
        let psi = &table.psi_of_vertex[vertex];
        let mut sum = 0.0;
        for q in 0..Q {
            sum = multiply_add::<S>(psi[q], divergence[q], sum);
        }
        residual[LocalLayout::<D, N>::pressure(vertex)] = -sum;
    }
}

/// Every entry times `factor`.
#[inline(always)]
fn scaled_rows<const D: usize, const L: usize>(rows: &[[f64; L]; D], factor: f64) -> [[f64; L]; D] {
    let mut result = *rows;
    for row in &mut result {
        *row = scaled(row, factor);
    }
    result
}

/// N x N sums: one column a trial function, one lane a test function.
type Block<const N: usize, const P: usize> = [[f64; P]; N];

/// Overwrites the square `matrix`, column by column, with the cell's raw matrix.
#[inline(always)]
pub(super) fn cell_matrix<
    S: Simd,
    const D: usize,
    const N: usize,
    const P: usize,
    const Q: usize,
>(
    input: Input<'_, D>,
    cell: CellId,
    table: &PointTable<D, N, P, Q>,
    with_frame: bool,
    matrix: &mut [f64],
) {
    let Input { mesh, metric, terms, fields } = input;
    let size = LocalLayout::<D, N>::FLUID + if with_frame { D } else { 0 };
    let nodes: &[NodeId; N] = nodes_of(mesh, cell);
    let corners = gather(&mesh.nodes, nodes);
    let points = CellPoints::new::<S, N, P>(table, &corners, mesh.curved[cell], metric);
    let gradients = points.gradients::<S, N, P>(table);
    let viscous = scaled(&points.dx, terms.viscosity);
    let inertia = scaled(&points.dx, terms.density);
    let mut inverse_radius = [0.0; Q];
    if metric.is_revolved() {
        for q in 0..Q {
            inverse_radius[q] = 1.0 / points.position[RADIAL][q];
        }
    }

    // What each trial function carries along: weighted rate and convection.
    let has_convection = terms.convection != Convection::None && !terms.crossing.is_empty();
    let has_inertia = terms.density != 0.0 && (terms.rate != 0.0 || has_convection);
    let mut carried = [[0.0; P]; Q];
    if has_inertia {
        let rate = scaled(&inertia, terms.rate);
        for q in 0..Q {
            carried[q] = scaled(&table.phi[q], rate[q]);
        }
        if has_convection {
            let crossing = gather(terms.crossing, nodes);
            for axis in 0..D {
                let crossing = product(&table.quadratic::<S>(&crossing[axis]), &inertia);
                for q in 0..Q {
                    add_product::<S, P>(&mut carried[q], &gradients[q][axis], crossing[q]);
                }
            }
        }
    }

    // shared: the same for every component. transposed[i][j], j <= i: d_j phi_a d_i phi_b.
    let mut shared: Block<N, P> = [[0.0; P]; N];
    let mut transposed: [[Block<N, P>; D]; D] = [[[[0.0; P]; N]; D]; D];
    for b in 0..N {
        let mut sum = [0.0; P];
        let mut products = [[[0.0; P]; D]; D];
        for q in 0..Q {
            add_product::<S, P>(&mut sum, &table.phi[q], carried[q][b]);
            for i in 0..D {
                let flux = gradients[q][i][b] * viscous[q];
                for j in 0..=i {
                    add_product::<S, P>(&mut products[i][j], &gradients[q][j], flux);
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
    for i in 0..D {
        for j in 0..D {
            for b in 0..N {
                let start = LocalLayout::<D, N>::velocity(b, j) * size
                    + LocalLayout::<D, N>::velocity(0, i);
                let column: &mut [f64; N] = matrix[start..]
                    .first_chunk_mut()
                    .expect("the matrix has rows for all velocities");
                for a in 0..N {
                    column[a] =
                        if j <= i { transposed[i][j][b][a] } else { transposed[j][i][a][b] };
                    if i == j {
                        column[a] += shared[b][a];
                    }
                }
            }
        }
    }
    if with_frame {
        matrix[LocalLayout::<D, N>::frame(0) * size..].fill(0.0);
    }
    let in_frame = terms.convection == Convection::NewtonInFrame;
    if (in_frame || terms.convection == Convection::Newton) && terms.density != 0.0 {
        let velocity = gather(fields.velocity, nodes);
        add_newton::<S, D, N, P, Q>(table, &points, &velocity, &inertia, in_frame, size, matrix);
    }
    if metric.is_revolved() {
        let mut hoop = [[0.0; P]; Q];
        for q in 0..Q {
            let weight = 2.0 * viscous[q] * inverse_radius[q] * inverse_radius[q];
            hoop[q] = scaled(&table.phi[q], weight);
        }
        let sums = tested_with_phi::<S, D, N, P, Q>(table, &hoop);
        add_block::<D, N, P>(&sums, RADIAL, RADIAL, size, matrix);
    }

    for axis in 0..D {
        // [vertex][a] = int psi d_axis phi_a, the hoop's part included.
        let mut divergence = [[0.0; P]; N];
        for vertex in 0..=D {
            let weight = product(&table.psi_of_vertex[vertex], &points.dx);
            for q in 0..Q {
                add_product::<S, P>(&mut divergence[vertex], &gradients[q][axis], weight[q]);
            }
            if metric.is_revolved() && axis == RADIAL {
                let weight = product(&weight, &inverse_radius);
                for q in 0..Q {
                    add_product::<S, P>(&mut divergence[vertex], &table.phi[q], weight[q]);
                }
            }
        }
        for vertex in 0..=D {
            let pressure = LocalLayout::<D, N>::pressure(vertex);
            for a in 0..N {
                let velocity = LocalLayout::<D, N>::velocity(a, axis);
                matrix[pressure * size + velocity] = -divergence[vertex][a];
                matrix[velocity * size + pressure] = -divergence[vertex][a];
            }
        }
    }
    for vertex in 0..=D {
        let start = LocalLayout::<D, N>::pressure(vertex) * size;
        matrix[start + N * D..start + size].fill(0.0);
    }
    if with_frame {
        for velocity in 0..N * D {
            matrix[velocity * size + LocalLayout::<D, N>::FLUID..(velocity + 1) * size].fill(0.0);
        }
    }
}

/// sum_q phi_a trial_b of trial functions that are weighted already.
#[inline(always)]
fn tested_with_phi<S: Simd, const D: usize, const N: usize, const P: usize, const Q: usize>(
    table: &PointTable<D, N, P, Q>,
    trial: &[[f64; P]; Q],
) -> Block<N, P> {
    let mut sums = [[0.0; P]; N];
    for b in 0..N {
        for q in 0..Q {
            add_product::<S, P>(&mut sums[b], &table.phi[q], trial[q][b]);
        }
    }
    sums
}

/// Adds a block for test functions along axis `i` and trial functions along axis `j`.
#[inline(always)]
fn add_block<const D: usize, const N: usize, const P: usize>(
    block: &Block<N, P>,
    i: usize,
    j: usize,
    size: usize,
    matrix: &mut [f64],
) {
    for b in 0..N {
        let start =
            LocalLayout::<D, N>::velocity(b, j) * size + LocalLayout::<D, N>::velocity(0, i);
        for (entry, sum) in matrix[start..start + N].iter_mut().zip(&block[b]) {
            *entry += sum;
        }
    }
}

/// Adds rho phi_a phi_b d_j u_i, and in a frame of unknown velocity the column -rho phi_a d_j u_i.
#[inline(always)]
fn add_newton<S: Simd, const D: usize, const N: usize, const P: usize, const Q: usize>(
    table: &PointTable<D, N, P, Q>,
    points: &CellPoints<D, Q>,
    velocity: &[[f64; N]; D],
    inertia: &[f64; Q],
    in_frame: bool,
    size: usize,
    matrix: &mut [f64],
) {
    for i in 0..D {
        let gradient = points.gradient::<S, N, P>(table, &velocity[i]);
        for j in 0..D {
            let reaction = product(&gradient[j], inertia);
            let mut weighted = [[0.0; P]; Q];
            for q in 0..Q {
                weighted[q] = scaled(&table.phi[q], reaction[q]);
            }
            let sums = tested_with_phi::<S, D, N, P, Q>(table, &weighted);
            add_block::<D, N, P>(&sums, i, j, size, matrix);
            if in_frame {
                let start =
                    LocalLayout::<D, N>::frame(j) * size + LocalLayout::<D, N>::velocity(0, i);
                for point in &weighted {
                    for (entry, value) in matrix[start..start + N].iter_mut().zip(point) {
                        *entry -= value;
                    }
                }
            }
        }
    }
}
