//! Loads on the fluid that are given: forces per volume, and tractions on open sides.

use alewife_mesh::{BoundaryId, Mesh, NodeId, Point};

use super::{Configuration, FluidSystem};
use crate::coupling::problem::Problem;
use crate::coupling::solution::Solution;
use crate::space::CellValues;

impl<const D: usize> FluidSystem<D> {
    /// Subtracts given loads, tested with the functions of the velocity, from a raw residual. They do not depend on the
    /// flow, so that the matrix has no part of them.
    pub(super) fn subtract_given_loads(&self, at: &Configuration<'_, D>, raw: &mut [f64]) {
        if !at.problem.has_given_loads() {
            return;
        }
        self.subtract_tractions(at.problem, at.mesh, at.mean_flow.time, raw);
        self.subtract_force(at.problem, at.mesh, at.mean_flow.time, raw);
    }

    /// Work of given forces and tractions on a flow at a time (W).
    #[must_use]
    pub fn power_of_given_loads(
        &self,
        problem: &Problem<D>,
        mesh: &Mesh<D>,
        solution: &Solution<D>,
        time: f64,
    ) -> f64 {
        if !problem.has_given_loads() {
            return 0.0;
        }
        let mut raw = vec![0.0; self.layout.n_raw()];
        self.subtract_tractions(problem, mesh, time, &mut raw);
        self.subtract_force(problem, mesh, time, &mut raw);
        let of_node = |node: NodeId| -> f64 {
            let along = |axis: usize| raw[self.layout.velocity(node, axis)];
            (0..D).map(|axis| -along(axis) * solution.velocity[node][axis]).sum()
        };
        self.layout.nodes().map(of_node).sum()
    }

    fn subtract_tractions(&self, problem: &Problem<D>, mesh: &Mesh<D>, time: f64, raw: &mut [f64]) {
        for (boundary, side) in problem.sides.iter().enumerate() {
            let Some(side) = side else { continue };
            for &facet in self.boundaries.facets_on(BoundaryId::new(boundary)) {
                let facet = &mesh.facets[facet];
                let nodes = mesh.cell(facet.cell);
                self.facet_rule.for_each_point(mesh, facet, |at| {
                    let area = at.normal_ds.norm();
                    // On the axis there is none
                    let normal = if area > 0.0 { at.normal_ds / area } else { Point::zeros() };
                    let Some(traction) = side.given_traction(&at.position, &normal, time) else {
                        return;
                    };
                    for (&node, phi) in nodes.iter().zip(at.phi) {
                        for axis in 0..D {
                            raw[self.layout.velocity(node, axis)] -= traction[axis] * area * phi;
                        }
                    }
                });
            }
        }
    }

    fn subtract_force(&self, problem: &Problem<D>, mesh: &Mesh<D>, time: f64, raw: &mut [f64]) {
        let Some(force) = &problem.force else { return };
        let mut values = CellValues::default();
        for cell in mesh.cell_ids() {
            let nodes = mesh.cell(cell);
            values.for_each_point(self.assembly.tables(), mesh, cell, |at| {
                let force = force(&at.position, time) * at.dx;
                for (&node, phi) in nodes.iter().zip(at.phi) {
                    for axis in 0..D {
                        raw[self.layout.velocity(node, axis)] -= force[axis] * phi;
                    }
                }
            });
        }
    }
}
