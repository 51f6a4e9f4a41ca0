//! `Mass`: the mass matrix of a solid, the same for each component of a place.

use std::collections::BTreeMap;

use alewife_mesh::Point;

use super::geometry::CellPoints;
use super::mesh::{Order, SolidMesh};
use super::pattern::Pattern;
use super::rigid::pose::Pose;

/// Masses (kg) by pairs of nodes: lumped for linear cells, consistent for quadratic ones, whose vertices would
/// have none.
#[derive(Debug, Clone)]
pub(super) struct Mass<const D: usize> {
    /// Where the row of each node starts, and where the last ends.
    starts: Vec<usize>,
    /// Nodes of all entries.
    nodes: Vec<usize>,
    /// Their masses.
    values: Vec<f64>,
    /// Places in the pattern of the entries of the lower triangle, D for each.
    places: Vec<[u32; D]>,
}

impl<const D: usize> Mass<D> {
    /// The masses of cells with these densities.
    pub(super) fn new(
        mesh: &SolidMesh<D>,
        points: &CellPoints<D>,
        density: impl Fn(usize) -> f64,
        pattern: &Pattern,
    ) -> Self {
        let mut rows: Vec<BTreeMap<usize, f64>> = vec![BTreeMap::new(); mesh.nodes.len()];
        for (number, cell) in mesh.cells.chunks_exact(points.n_local).enumerate() {
            for k in 0..points.n_points {
                let at = points.at(number, k);
                let mass = at.weight * density(number);
                for (a, shape) in cell.iter().zip(at.shapes) {
                    if mesh.order == Order::Linear {
                        *rows[*a].entry(*a).or_insert(0.0) += mass * shape;
                        continue;
                    }
                    for (b, other) in cell.iter().zip(at.shapes) {
                        *rows[*a].entry(*b).or_insert(0.0) += mass * shape * other;
                    }
                }
            }
        }
        let mut mass =
            Self { starts: vec![0], nodes: Vec::new(), values: Vec::new(), places: Vec::new() };
        for (a, row) in rows.into_iter().enumerate() {
            for (b, value) in row {
                mass.nodes.push(b);
                mass.values.push(value);
                let place = |i| pattern.place(a * D + i, b * D + i);
                // Entries of the upper triangle are those of the lower one
                mass.places.push(if b <= a { std::array::from_fn(place) } else { [u32::MAX; D] });
            }
            mass.starts.push(mass.nodes.len());
        }
        mass
    }

    /// Gives each node this mass (kg), where it is lumped.
    pub(super) fn fill(&mut self, mass: f64) {
        self.values.fill(mass);
    }

    /// Mass times a list of all components.
    pub(super) fn times(&self, all: &[f64]) -> Vec<f64> {
        // Pressures have no mass
        let mut product = vec![0.0; all.len()];
        for node in 0..self.starts.len() - 1 {
            let mut sum = Point::<D>::zeros();
            for entry in self.starts[node]..self.starts[node + 1] {
                let at = self.nodes[entry] * D;
                sum += Point::<D>::from_column_slice(&all[at..at + D]) * self.values[entry];
            }
            product[node * D..(node + 1) * D].copy_from_slice(sum.as_slice());
        }
        product
    }

    /// Adds a multiple of what rigid parts have of it to a matrix.
    pub(super) fn add_tied(
        &self,
        factor: f64,
        pose: &Pose<'_, D>,
        pattern: &Pattern,
        values: &mut [f64],
    ) {
        for a in 0..self.starts.len() - 1 {
            for entry in self.starts[a]..self.starts[a + 1] {
                let b = self.nodes[entry];
                if b <= a {
                    let mass = factor * self.values[entry];
                    let add = |i| pose.add_entry(pattern, [a * D + i, b * D + i], mass, values);
                    (0..D).for_each(add);
                }
            }
        }
    }

    /// Adds a multiple of it to a matrix, of components that are free.
    pub(super) fn add(&self, factor: f64, pattern: &Pattern, values: &mut [f64]) {
        for (places, mass) in self.places.iter().zip(&self.values) {
            for place in places {
                pattern.add(*place, values, factor * mass);
            }
        }
    }
}
