//! The net flux of bodies with coordinates in an enclosed fluid.
//!
//! Surfaces that are interpolated carry a small net flux, which the continuity equation gets back as a source that is spread
//! over the fluid. Where the motion of surfaces is given, so is the source; the rates of coordinates change it, by one number
//! more that is unknown.

use alewife_mesh::{CellId, Mesh, NodeId, Point};

use super::super::error::SolveError;
use super::super::solution::Solution;
use super::{Configuration, FluidSystem};
use crate::space::CellValues;
use crate::timing::Timing;

impl<const D: usize> FluidSystem<D> {
    /// Gives free unknowns, after a step of Newton's method from a solution, the net flux that their source is of.
    ///
    /// # Errors
    /// When the matrix is singular.
    pub(super) fn balance_net_flux(
        &mut self,
        at: &Configuration<'_, D>,
        solution: &Solution<D>,
        free: &mut [f64],
        timing: &mut Timing,
    ) -> Result<(), SolveError> {
        if !at.problem.is_enclosed() || self.layout.n_coordinates == 0 {
            return Ok(());
        }
        let answer = match self.rate_response.source() {
            Some(source) => source.to_vec(),
            None => {
                let mut answer = at.constraints.restrict(&self.unit_source());
                self.linear.solve(&mut answer, None, timing)?;
                answer
            }
        };
        let weights = self.flux_weights(at.mesh);
        let flux = |velocity: &dyn Fn(usize) -> f64| -> f64 {
            let of_node = |(node, weight): &(NodeId, Point<D>)| -> f64 {
                let raw = |axis: usize| self.layout.velocity(*node, axis);
                (0..D).map(|axis| weight[axis] * velocity(raw(axis))).sum()
            };
            weights.iter().map(of_node).sum()
        };
        let sum = |values: &[f64], raw: usize| -> f64 {
            let terms = at.constraints.row(raw).iter();
            terms.map(|term| term.weight * values[term.unknown as usize]).sum()
        };
        let given = flux(&|raw| solution.velocity[raw / D][raw % D]);
        let found = flux(&|raw| at.constraints.value(raw) + sum(free, raw));
        let by_source = flux(&|raw| sum(&answer, raw));
        let part = (found - given) / (1.0 - by_source);
        free.iter_mut().zip(&answer).for_each(|(free, answer)| *free += part * answer);
        Ok(())
    }

    /// Weights of the velocities of nodes on bodies with coordinates in the sum of the continuity equations (m2; m planar).
    fn flux_weights(&self, mesh: &Mesh<D>) -> Vec<(NodeId, Point<D>)> {
        let tables = self.assembly.tables();
        let mut weights: Vec<Option<Point<D>>> = vec![None; mesh.n_nodes()];
        for node in self.rest_places.keys() {
            weights[node.index()] = Some(Point::<D>::zeros());
        }
        let mut workspace = CellValues::default();
        for cell in (0..mesh.n_cells()).map(CellId::new) {
            let nodes = mesh.cell(cell);
            if nodes.iter().all(|node| weights[node.index()].is_none()) {
                continue;
            }
            workspace.for_each_point(tables, mesh, cell, |at| {
                for (node, (gradient, value)) in nodes.iter().zip(at.grad_phi.iter().zip(at.phi)) {
                    let Some(weight) = &mut weights[node.index()] else { continue };
                    for axis in 0..D {
                        let mut alone = Point::<D>::zeros();
                        alone[axis] = *value;
                        let divergence =
                            gradient[axis] + tables.metric().hoop_strain(&alone, &at.position);
                        weight[axis] -= divergence * at.dx;
                    }
                }
            });
        }
        let all = weights.into_iter().enumerate();
        all.filter_map(|(node, weight)| Some((NodeId::new(node), weight?))).collect()
    }

    /// A source of one, spread over the fluid as a net flux is, in the rows of the raw residual.
    pub(super) fn unit_source(&self) -> Vec<f64> {
        let mut raw = vec![0.0; self.layout.n_raw()];
        let pressures = self.layout.pressures();
        raw[pressures.start] = 1.0;
        self.pressure.make_compatible(&mut raw[pressures.clone()]);
        raw[pressures.clone()].iter_mut().for_each(|value| *value = -*value);
        raw[pressures.start] += 1.0;
        raw
    }
}
