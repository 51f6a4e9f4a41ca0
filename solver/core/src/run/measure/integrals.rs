//! Integrals of the velocity over the fluid.

use alewife_mesh::{CellId, Mesh, Point};
use nalgebra::SMatrix;
use rayon::prelude::*;

use crate::coupling::Problem;
use crate::flow::{Viscosity, squared_shear};
use crate::space::{CellValues, Tables};

/// Cells that are summed up on their own, whatever the number of threads.
const CELLS_PER_TASK: usize = 256;

/// What is integrated, over the fluid or a part of it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Integrals<const D: usize> {
    /// int D : D, for the rate of strain D (m3/s2; m2/s2 planar).
    pub squared_rate: f64,
    /// int 2 mu D : D (W), of a viscosity that depends on the rate of shear only.
    pub dissipation: f64,
    /// Its least viscosity (Pa s).
    pub least_viscosity: f64,
    /// int u^2 (m5/s2; m4/s2 planar).
    pub squared_speed: f64,
    /// int u (m4/s; m3/s planar).
    pub velocity: Point<D>,
    /// int div u (m3/s; m2/s planar).
    pub divergence: f64,
    /// Volume or area (m3, m2).
    pub volume: f64,
}

impl<const D: usize> Integrals<D> {
    /// Of a velocity (m/s) at the nodes of a mesh.
    pub fn over_fluid(
        problem: &Problem<D>,
        mesh: &Mesh<D>,
        velocity: &[Point<D>],
        tables: &Tables<D>,
    ) -> Self {
        let n_tasks = mesh.n_cells().div_ceil(CELLS_PER_TASK);
        let tasks = (0..n_tasks).into_par_iter().map(|task| {
            let first = task * CELLS_PER_TASK;
            let end = (first + CELLS_PER_TASK).min(mesh.n_cells());
            let mut sums = Self::zero();
            let mut workspace = CellValues::default();
            for cell in (first..end).map(CellId::new) {
                let nodes = mesh.cell(cell);
                workspace.for_each_point(tables, mesh, cell, |at| {
                    let mut value = Point::<D>::zeros();
                    let mut gradient = SMatrix::<f64, D, D>::zeros();
                    for (a, &node) in nodes.iter().enumerate() {
                        let nodal = &velocity[node];
                        value += nodal * at.phi[a];
                        gradient += nodal * at.grad_phi[a].transpose();
                    }
                    let rate = (gradient + gradient.transpose()) / 2.0;
                    let stretch = problem.metric.hoop_strain(&value, &at.position);
                    if !problem.viscosity.is_newtonian() {
                        sums.add_shear(
                            &problem.viscosity,
                            squared_shear(&gradient, stretch),
                            at.dx,
                        );
                    }
                    sums.squared_rate += (rate.norm_squared() + stretch * stretch) * at.dx;
                    sums.squared_speed += value.norm_squared() * at.dx;
                    sums.velocity += value * at.dx;
                    sums.divergence += (gradient.trace() + stretch) * at.dx;
                    sums.volume += at.dx;
                });
            }
            sums
        });
        let tasks: Vec<Self> = tasks.collect();
        tasks.iter().fold(Self::zero(), Self::plus)
    }

    /// Adds a point of a square of the rate of shear (1/s2).
    fn add_shear(&mut self, law: &Viscosity, squared_rate: f64, dx: f64) {
        let viscosity = law.at(squared_rate).value;
        self.dissipation += viscosity * squared_rate * dx;
        self.least_viscosity = self.least_viscosity.min(viscosity);
    }

    fn zero() -> Self {
        Self {
            squared_rate: 0.0,
            dissipation: 0.0,
            least_viscosity: f64::INFINITY,
            squared_speed: 0.0,
            velocity: Point::zeros(),
            divergence: 0.0,
            volume: 0.0,
        }
    }

    fn plus(self, other: &Self) -> Self {
        Self {
            squared_rate: self.squared_rate + other.squared_rate,
            dissipation: self.dissipation + other.dissipation,
            least_viscosity: self.least_viscosity.min(other.least_viscosity),
            squared_speed: self.squared_speed + other.squared_speed,
            velocity: self.velocity + other.velocity,
            divergence: self.divergence + other.divergence,
            volume: self.volume + other.volume,
        }
    }
}
