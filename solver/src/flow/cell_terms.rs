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
//! and -psi_v d_i phi_a for the pressure, with its transpose. Axisymmetric problems, with axis x
//! and radius y = r, add the hoop stress 2 mu u_r v_r / r^2 and div u = d_x u_x + d_r u_r + u_r / r.

use alewife_mesh::{Mesh, Point};
use nalgebra::SMatrix;

use super::terms::{Convection, Fields, FlowTerms};
use crate::space::{CellValues, PointValues, Tables};

/// Index of the radial component.
const RADIAL: usize = 1;

/// Local numbering of the raw unknowns of a cell: D velocities a node, pressures, then the
/// velocities of the frame where they are unknowns of every cell.
struct LocalLayout<const D: usize, const N: usize>;

impl<const D: usize, const N: usize> LocalLayout<D, N> {
    fn velocity(&self, node: usize, axis: usize) -> usize {
        node * D + axis
    }

    fn pressure(&self, vertex: usize) -> usize {
        N * D + vertex
    }

    fn frame(&self, axis: usize) -> usize {
        N * D + D + 1 + axis
    }
}

/// Fields at one quadrature point.
struct PointFields<const D: usize> {
    velocity: Point<D>,
    /// gradient\[(i, j)\] = d_j u_i.
    gradient: SMatrix<f64, D, D>,
    pressure: f64,
    crossing: Point<D>,
    history: Point<D>,
}

impl<const D: usize> PointFields<D> {
    fn new(
        at: &PointValues<'_, D>,
        nodes: &[u32],
        terms: &FlowTerms<'_, D>,
        fields: &Fields<'_, D>,
    ) -> Self {
        let mut point = Self {
            velocity: Point::zeros(),
            gradient: SMatrix::zeros(),
            pressure: 0.0,
            crossing: Point::zeros(),
            history: Point::zeros(),
        };
        for (a, &node) in nodes.iter().enumerate() {
            let node = node as usize;
            let velocity = &fields.velocity[node];
            point.velocity += velocity * at.phi[a];
            point.gradient += velocity * at.grad_phi[a].transpose();
            if !terms.crossing.is_empty() {
                point.crossing += terms.crossing[node] * at.phi[a];
            }
            if !terms.history.is_empty() {
                point.history += terms.history[node] * at.phi[a];
            }
        }
        for (&node, psi) in nodes[..=D].iter().zip(at.psi) {
            point.pressure += fields.pressure[node as usize] * psi;
        }
        point
    }
}

/// Overwrites `residual` with the cell's raw residual.
pub(super) fn cell_residual<const D: usize, const N: usize>(
    mesh: &Mesh<D>,
    cell: usize,
    tables: &Tables<D>,
    terms: &FlowTerms<'_, D>,
    fields: &Fields<'_, D>,
    values: &mut CellValues<D>,
    residual: &mut [f64],
) {
    let layout = LocalLayout::<D, N>;
    let nodes = mesh.cell(cell);
    residual.fill(0.0);
    values.for_each_point(tables, mesh, cell, |at| {
        let point = PointFields::new(at, nodes, terms, fields);
        let mut force = terms.density
            * (point.velocity * terms.rate + point.history + point.gradient * point.crossing);
        if let Some(body_force) = terms.body_force {
            force -= body_force(&at.position);
        }
        let mut stress = (point.gradient + point.gradient.transpose()) * terms.viscosity;
        let mut divergence = point.gradient.trace();
        for axis in 0..D {
            stress[(axis, axis)] -= point.pressure;
        }
        if tables.is_axisymmetric() {
            let radius = at.position[RADIAL];
            let stretch = point.velocity[RADIAL] / radius;
            divergence += stretch;
            force[RADIAL] += (2.0 * terms.viscosity * stretch - point.pressure) / radius;
        }
        for a in 0..N {
            let row = (force * at.phi[a] + stress * at.grad_phi[a]) * at.dx;
            for axis in 0..D {
                residual[layout.velocity(a, axis)] += row[axis];
            }
        }
        for (vertex, psi) in at.psi.iter().enumerate() {
            residual[layout.pressure(vertex)] -= psi * divergence * at.dx;
        }
    });
}

/// Overwrites the square `matrix`, row by row, with the cell's raw matrix.
pub(super) fn cell_matrix<const D: usize, const N: usize>(
    mesh: &Mesh<D>,
    cell: usize,
    tables: &Tables<D>,
    terms: &FlowTerms<'_, D>,
    fields: &Fields<'_, D>,
    values: &mut CellValues<D>,
    matrix: &mut [f64],
) {
    let size = matrix.len().isqrt();
    let layout = LocalLayout::<D, N>;
    let nodes = mesh.cell(cell);
    let newton = matches!(terms.convection, Convection::Newton | Convection::NewtonInFrame);
    let convects = terms.convection != Convection::None;
    matrix.fill(0.0);
    // What is the same for every component is summed once, as one N x N block.
    let mut shared = [[0.0; N]; N];
    values.for_each_point(tables, mesh, cell, |at| {
        let point = PointFields::new(at, nodes, terms, fields);
        let viscous = terms.viscosity * at.dx;
        let inertia = terms.density * at.dx;
        let radius = at.position[RADIAL];
        for b in 0..N {
            let mut carried = terms.rate * at.phi[b];
            if convects {
                carried += point.crossing.dot(&at.grad_phi[b]);
            }
            let carried = carried * inertia;
            let flux = at.grad_phi[b] * viscous;
            for a in 0..N {
                shared[a][b] += at.phi[a] * carried + at.grad_phi[a].dot(&flux);
                // d_j phi_a d_i phi_b: the transposed gradient in 2 D(u).
                for i in 0..D {
                    let row = layout.velocity(a, i) * size;
                    for j in 0..D {
                        matrix[row + layout.velocity(b, j)] += at.grad_phi[a][j] * flux[i];
                    }
                }
            }
            if newton {
                for a in 0..N {
                    let weight = inertia * at.phi[a] * at.phi[b];
                    for i in 0..D {
                        let row = layout.velocity(a, i) * size;
                        for j in 0..D {
                            matrix[row + layout.velocity(b, j)] += weight * point.gradient[(i, j)];
                        }
                    }
                }
            }
            if tables.is_axisymmetric() {
                let hoop = 2.0 * viscous * at.phi[b] / (radius * radius);
                for a in 0..N {
                    let row = layout.velocity(a, RADIAL) * size;
                    matrix[row + layout.velocity(b, RADIAL)] += hoop * at.phi[a];
                }
            }
            for (vertex, psi) in at.psi.iter().enumerate() {
                for axis in 0..D {
                    let mut divergence = at.grad_phi[b][axis];
                    if axis == RADIAL && tables.is_axisymmetric() {
                        divergence += at.phi[b] / radius;
                    }
                    let entry = psi * divergence * at.dx;
                    let (row, column) = (layout.pressure(vertex), layout.velocity(b, axis));
                    matrix[row * size + column] -= entry;
                    matrix[column * size + row] -= entry;
                }
            }
        }
        if terms.convection == Convection::NewtonInFrame {
            for a in 0..N {
                for i in 0..D {
                    let row = layout.velocity(a, i) * size;
                    for j in 0..D {
                        matrix[row + layout.frame(j)] -=
                            inertia * at.phi[a] * point.gradient[(i, j)];
                    }
                }
            }
        }
    });
    for (a, row) in shared.iter().enumerate() {
        for (b, entry) in row.iter().enumerate() {
            for axis in 0..D {
                matrix[layout.velocity(a, axis) * size + layout.velocity(b, axis)] += entry;
            }
        }
    }
}
