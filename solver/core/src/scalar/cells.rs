//! Matrices and loads of cells: rate, advection and diffusion by Galerkin's method, stabilised by SUPG.
//!
//! With a = u - w the velocity seen from the mesh, R c = a0 c + a . grad c - k lap c and f = s - h, h what older levels give of
//! the rate, a test function v reads int (v (a0 c + a . grad c - f) + k grad v . grad c) dx and, added
//! to it, the sum over cells of int t (a . grad v) (R c - f) dx, with t = ((a0)^2 + (4 |a| / h)^2 + (12 k n)^2)^(-1/2)
//! (Brooks and Hughes 1982), h and n by the gradients of barycentric coordinates. The form is the convective one: a
//! constant solves it to the last bit on any mesh and with any velocity.

use std::ops::Range;

use alewife_mesh::{CellId, Mesh, Point, Simplex};
use nalgebra::SVector;

use super::field::Profile;
use crate::space::{CellValues, Metric, PointValues, Tables, straight_cell};

/// Factor of the diffusive rate in the time scale of SUPG: inverse estimates of quadratic functions.
const DIFFUSIVE: f64 = 12.0;
/// Factor of the convective rate: quadratic functions see half an edge.
const CONVECTIVE: f64 = 2.0;

/// What the equation of a step has in the cells.
#[derive(Clone, Copy)]
pub(super) struct Terms<'a, const D: usize> {
    pub tables: &'a Tables<D>,
    /// The mesh at the new level.
    pub mesh: &'a Mesh<D>,
    /// Velocities at the nodes, seen from the mesh (m/s); empty where nothing is carried.
    pub carrying: &'a [Point<D>],
    /// Diffusivity (m2/s).
    pub diffusivity: f64,
    /// Factor of the new level in the rate (1/s).
    pub rate: f64,
    /// What older levels give of the rate at the nodes; empty where there are none.
    pub history: &'a [f64],
    /// What is made in the fluid.
    pub source: Option<&'a Profile<D>>,
    /// Time (s).
    pub time: f64,
}

/// The straight cell as SUPG sees it.
struct Straight<const D: usize> {
    gradients: Vec<SVector<f64, D>>,
    /// Laplacians of the basis in Cartesian coordinates (1/m2).
    laplacians: Vec<f64>,
    /// (12 k n)^2 of the time scale, and a0^2 (1/s2).
    other_rates: f64,
}

impl<const D: usize> Terms<'_, D> {
    fn straight(&self, cell: CellId) -> Straight<D> {
        let gradients = straight_cell(self.mesh, cell).gradients;
        let at_vertices = gradients.iter().map(|g| 4.0 * g.norm_squared());
        let at_edges =
            Simplex::<D>::EDGES.iter().map(|&[i, j]| 8.0 * gradients[i].dot(&gradients[j]));
        let laplacians = at_vertices.chain(at_edges).collect();
        let size: f64 = gradients.iter().map(SVector::norm_squared).sum();
        let other_rates = self.rate.powi(2) + (DIFFUSIVE * self.diffusivity * size).powi(2);
        Straight { gradients, laplacians, other_rates }
    }

    /// Overwrites the matrix of each of some cells, column by column, and behind it the load.
    pub fn fill(&self, cells: Range<usize>, results: &mut [f64]) {
        let n = Simplex::<D>::N_NODES;
        let mut workspace = CellValues::default();
        let (mut shape, mut tested) = (vec![0.0; n], vec![0.0; n]);
        results.fill(0.0);
        for (cell, result) in cells.map(CellId::new).zip(results.chunks_exact_mut(n * n + n)) {
            let (matrix, load) = result.split_at_mut(n * n);
            let straight = self.straight(cell);
            let nodes = self.mesh.cell(cell);
            workspace.for_each_point(self.tables, self.mesh, cell, |at| {
                let carried = nodes.iter().zip(at.phi);
                let carried = carried.filter(|_| !self.carrying.is_empty());
                let velocity = carried.fold(Point::<D>::zeros(), |sum, (&node, phi)| {
                    sum + self.carrying[node.index()] * *phi
                });
                let scale = stabilisation(&straight, &velocity);
                for (a, gradient) in at.grad_phi.iter().enumerate() {
                    let along = velocity.dot(gradient);
                    shape[a] = self.rate * at.phi[a] + along;
                    tested[a] = scale * along;
                }
                for (b, column) in matrix.chunks_exact_mut(n).enumerate() {
                    let strong = shape[b] - self.diffusivity * self.laplacian(&straight, at, b);
                    for (a, entry) in column.iter_mut().enumerate() {
                        let diffusion = self.diffusivity * at.grad_phi[a].dot(&at.grad_phi[b]);
                        let galerkin = at.phi[a] * shape[b] + diffusion;
                        *entry += (galerkin + tested[a] * strong) * at.dx;
                    }
                }
                let given = self.given(cell, at);
                for (a, sum) in load.iter_mut().enumerate() {
                    *sum += (at.phi[a] + tested[a]) * given * at.dx;
                }
            });
        }
    }

    /// What is made less what older levels give of the rate.
    fn given(&self, cell: CellId, at: &PointValues<'_, D>) -> f64 {
        let made = self.source.map_or(0.0, |source| source(&at.position, self.time));
        if self.history.is_empty() {
            return made;
        }
        let nodes = self.mesh.cell(cell).iter();
        nodes.zip(at.phi).fold(made, |sum, (&node, phi)| sum - phi * self.history[node.index()])
    }

    fn laplacian(&self, straight: &Straight<D>, at: &PointValues<'_, D>, basis: usize) -> f64 {
        let cartesian = straight.laplacians[basis];
        if self.tables.metric().is_revolved() {
            let radial = Metric::RADIAL;
            return cartesian + at.grad_phi[basis][radial] / at.position[radial];
        }
        cartesian
    }
}

/// The time scale of SUPG (s).
fn stabilisation<const D: usize>(straight: &Straight<D>, velocity: &Point<D>) -> f64 {
    let crossing: f64 = straight.gradients.iter().map(|g| velocity.dot(g).abs()).sum();
    let rate = (straight.other_rates + (CONVECTIVE * crossing).powi(2)).sqrt();
    if crossing > 0.0 { 1.0 / rate } else { 0.0 }
}
