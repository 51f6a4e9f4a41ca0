//! `SolidHole`: what a mesh in space leaves out inside a boundary, as a solid.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::patch::Patch;
use super::triangulated::{Triangulated, enclosed};
use crate::spatial::triangles::{SurfaceFault, TriangleMesh};
use crate::{BoundaryId, Facet, Mesh, NodeId, Point};

/// What a closed boundary of a mesh surrounds.
#[derive(Debug, Clone, PartialEq)]
pub struct SolidHole {
    /// Its surface, the curved facets themselves, in a frame at its centroid.
    pub solid: Arc<Triangulated>,
    /// Its centroid (m).
    pub center: Point<3>,
}

impl SolidHole {
    /// That inside a boundary of a mesh.
    ///
    /// # Errors
    /// Why the boundary is no closed surface seen from the fluid: open, in several shells, around the mesh.
    pub fn new(mesh: &Mesh<3>, boundary: BoundaryId) -> Result<Self, SurfaceFault> {
        let facets: Vec<&Facet> =
            mesh.facets.iter().filter(|facet| facet.boundary == boundary).collect();
        let mut numbers: BTreeMap<NodeId, u32> = BTreeMap::new();
        let mut triangles = TriangleMesh::default();
        for facet in &facets {
            let corners: Vec<u32> = mesh
                .facet_vertices(facet)
                .into_iter()
                .map(|vertex| {
                    *numbers.entry(vertex).or_insert_with(|| {
                        triangles.vertices.push(mesh.nodes[vertex]);
                        u32::try_from(triangles.vertices.len() - 1).unwrap_or(u32::MAX)
                    })
                })
                .collect();
            // Facets are seen counter-clockwise from outside the fluid, triangles from outside the body
            triangles.triangles.push([corners[0], corners[2], corners[1]]);
        }
        triangles.check()?;
        let about = |center: Point<3>| -> Vec<Patch> {
            let patch = |facet: &&Facet| {
                let nodes = mesh.facet_nodes(facet).map(|node| mesh.nodes[node] - center);
                let n: Vec<Point<3>> = nodes.collect();
                Patch::new([n[0], n[1], n[2]], [n[3], n[4], n[5]], [false; 3])
            };
            facets.iter().map(patch).collect()
        };
        let center = enclosed(&about(Point::<3>::zeros())).moments.centroid;
        for vertex in &mut triangles.vertices {
            *vertex -= center;
        }
        let solid = Arc::new(Triangulated::of_patches(triangles, about(center)));
        Ok(Self { solid, center })
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Isometry3, Translation3};

    use super::*;
    use crate::Sizing;
    use crate::spatial::{Body, Domain, Shape, generate};

    #[test]
    fn the_hole_of_a_sphere_has_its_volume_and_inertia() {
        let domain = Domain::walls(Point::<3>::repeat(-2.0), Point::<3>::repeat(2.0));
        let at = Point::<3>::new(0.3, -0.2, 0.1);
        let pose = Isometry3::from_parts(Translation3::from(at), Default::default());
        let sphere = Body::new("b", Shape::Sphere { radius: 0.8 }, pose);
        let mesh = generate(&domain, &[sphere], &Sizing::graded(0.3, 0.4, 0.8)).unwrap();
        let SolidHole { solid, center } = SolidHole::new(&mesh, BoundaryId::new(6)).unwrap();
        let exact = 4.0 / 3.0 * std::f64::consts::PI * 0.8_f64.powi(3);
        let moments = solid.moments();
        assert!((moments.volume / exact - 1.0).abs() < 2e-3, "{}", moments.volume / exact);
        assert!((center - at).norm() < 1e-3 && moments.centroid.norm() < 1e-12, "{center}");
        let inertia = moments.inertia.trace() / 3.0 / (0.4 * exact * 0.64);
        assert!((inertia - 1.0).abs() < 4e-3, "{inertia}");
        // That of the control points of its facets, which lie outside
        assert!((0.8..0.85).contains(&solid.reach()), "{}", solid.reach());
        // A side of the box is open
        assert!(matches!(
            SolidHole::new(&mesh, BoundaryId::new(0)),
            Err(SurfaceFault::Open { .. })
        ));
    }
}
