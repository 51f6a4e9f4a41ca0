//! What boundaries add: given fluxes and uptake, what the fluid carries through.

use alewife_mesh::{Facet, Mesh, Point, Simplex};

use super::field::Condition;
use crate::space::FacetRule;

/// A boundary facet, with what is known at its cell.
#[derive(Clone, Copy)]
pub(super) struct Surface<'a, const D: usize> {
    pub mesh: &'a Mesh<D>,
    pub facet: &'a Facet,
    pub rule: &'a FacetRule<D>,
    /// Time (s).
    pub time: f64,
}

impl<const D: usize> Surface<'_, D> {
    /// Adds a condition to the matrix of the facet's cell and the load behind it.
    pub fn add(&self, condition: &Condition<D>, cell: &mut [f64]) {
        let n = Simplex::<D>::N_NODES;
        let (matrix, load) = cell.split_at_mut(n * n);
        self.rule.for_each_point(self.mesh, self.facet, |at| {
            let area = at.normal_ds.norm();
            let (rate, influx) = match condition {
                Condition::Value(_) => return,
                Condition::Flux(flux) => (0.0, flux(&at.position, self.time)),
                Condition::Uptake { rate, outside } => {
                    (*rate, rate * outside(&at.position, self.time))
                }
            };
            for (b, column) in matrix.chunks_exact_mut(n).enumerate() {
                for (entry, phi) in column.iter_mut().zip(at.phi) {
                    *entry += rate * phi * at.phi[b] * area;
                }
            }
            for (sum, phi) in load.iter_mut().zip(at.phi) {
                *sum += phi * influx * area;
            }
        });
    }

    /// What comes into the fluid through the facet by a condition, but for one of a value (m3/s; m2/s planar).
    pub fn diffused(&self, condition: &Condition<D>, values: &[f64]) -> f64 {
        let mut influx = 0.0;
        self.rule.for_each_point(self.mesh, self.facet, |at| {
            let area = at.normal_ds.norm();
            influx += match condition {
                Condition::Value(_) => 0.0,
                Condition::Flux(flux) => flux(&at.position, self.time) * area,
                Condition::Uptake { rate, outside } => {
                    let there = self.interpolate(at.phi, values);
                    rate * (outside(&at.position, self.time) - there) * area
                }
            };
        });
        influx
    }

    /// What comes into the fluid through the facet with the fluid (m3/s; m2/s planar).
    pub fn carried(&self, carrying: &[Point<D>], values: &[f64]) -> f64 {
        let mut influx = 0.0;
        let nodes = self.mesh.cell(self.facet.cell);
        self.rule.for_each_point(self.mesh, self.facet, |at| {
            let passing = nodes.iter().zip(at.phi).fold(0.0, |sum, (&node, phi)| {
                sum + phi * carrying[node.index()].dot(&at.normal_ds)
            });
            influx -= passing * self.interpolate(at.phi, values);
        });
        influx
    }

    fn interpolate(&self, phi: &[f64], values: &[f64]) -> f64 {
        let nodes = self.mesh.cell(self.facet.cell).iter();
        nodes.zip(phi).fold(0.0, |sum, (&node, phi)| sum + phi * values[node.index()])
    }
}
