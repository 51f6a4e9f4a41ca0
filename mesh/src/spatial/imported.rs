//! `Imported`: the region that a given mesh fills, whose sides stay as they are.

use std::sync::Arc;

use super::surface::{Facets, SmoothSurface};
use crate::mesh::jacobian_coefficients;
use crate::quality::smallest_angle;
use crate::{BoundaryId, Bounds, Locator, Mesh, Point};

/// The region of a given mesh of tetrahedra.
#[derive(Debug, Clone)]
pub struct Imported(Arc<Contents>);

#[derive(Debug)]
struct Contents {
    mesh: Mesh<3>,
    sides: Vec<Arc<Facets>>,
    bounds: Bounds<3>,
    locator: Locator<3>,
}

impl PartialEq for Imported {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.0.mesh == other.0.mesh
    }
}

impl Imported {
    /// The region of a mesh, whose boundaries are its sides.
    #[must_use]
    pub fn new(mesh: Mesh<3>) -> Self {
        let numbers = (0..mesh.boundaries.len()).map(BoundaryId::new);
        let sides = numbers.map(|side| Arc::new(Facets::of(&mesh, side))).collect();
        let bounds = Bounds::around(&mesh.nodes);
        let locator = Locator::new(&mesh);
        Self(Arc::new(Contents { mesh, sides, bounds, locator }))
    }

    /// The same region without the sides that are surfaces of bodies in it: no distance is one to these.
    #[must_use]
    pub fn without_sides(&self, bodies: &[&str]) -> Self {
        let mut mesh = self.0.mesh.clone();
        let is_kept: Vec<bool> =
            mesh.boundaries.iter().map(|side| !bodies.contains(&side.name.as_str())).collect();
        let mut numbers = Vec::with_capacity(is_kept.len());
        let mut n = 0;
        for is_kept in &is_kept {
            numbers.push(BoundaryId::new(n));
            n += usize::from(*is_kept);
        }
        let topology = mesh.topology_mut();
        topology.facets.retain(|facet| is_kept[facet.boundary.index()]);
        for facet in &mut topology.facets {
            facet.boundary = numbers[facet.boundary.index()];
        }
        topology.boundaries.retain(|side| !bodies.contains(&side.name.as_str()));
        Self::new(mesh)
    }

    /// The mesh.
    #[must_use]
    pub fn mesh(&self) -> &Mesh<3> {
        &self.0.mesh
    }

    /// Corners of the box around it (m).
    pub(super) fn corners(&self) -> [Point<3>; 2] {
        [self.0.bounds.min, self.0.bounds.max]
    }

    /// The facets of a side.
    pub(super) fn side(&self, side: usize) -> &Facets {
        &self.0.sides[side]
    }

    /// The sides as surfaces.
    pub(super) fn surfaces(&self) -> Vec<SmoothSurface> {
        self.0.sides.iter().map(|facets| SmoothSurface::of_facets(Arc::clone(facets))).collect()
    }

    /// Whether a point (m) is in the region.
    #[must_use]
    pub fn contains(&self, point: Point<3>) -> bool {
        self.0.locator.locate(point).is_some()
    }

    /// Smallest dihedral angle of the mesh (degrees).
    pub(super) fn smallest_angle(&self) -> f64 {
        let mesh = self.mesh();
        let angles = mesh.cell_ids().map(|cell| {
            let corners: Vec<Point<3>> =
                mesh.cell_vertices(cell).iter().map(|vertex| mesh.nodes[*vertex]).collect();
            smallest_angle(&corners).to_degrees()
        });
        angles.fold(180.0, f64::min)
    }

    /// Least Bezier coefficient of det J over their mean in its curved cells.
    pub(super) fn least_coefficient(&self) -> f64 {
        let mesh = self.mesh();
        let curved = mesh.cell_ids().filter(|cell| mesh.curved[*cell]);
        let coefficients = curved.map(|cell| {
            let all = jacobian_coefficients(&mesh.cell_nodes(cell));
            let mean = all.iter().sum::<f64>() / all.len() as f64;
            all.into_iter().fold(f64::INFINITY, f64::min) / mean
        });
        coefficients.fold(1.0, f64::min)
    }
}
