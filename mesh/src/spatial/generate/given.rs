//! A given mesh in the place of the lattice: its sides stay, with the nodes of their bent edges.

use super::improve::{GivenPart, Improver};
use super::tetrahedra::Face;
use super::tetrahedra::boundary_edges::{INNER, tag_of};
use super::tetrahedra::surface_set::SurfaceSet;
use crate::number::index_u32;
use crate::spatial::surface::is_bent;
use crate::{Mesh, Simplex};

impl Improver<'_> {
    /// Fills the mesh with a given one, whose boundaries are the first surfaces.
    pub fn fill_with_mesh(&mut self, given: &Mesh<3>) {
        let mut surfaces = vec![SurfaceSet::EMPTY; given.n_vertices];
        for facet in &given.facets {
            let surface = u16::from(facet.boundary);
            for vertex in given.facet_vertices(facet) {
                let set = &mut surfaces[vertex];
                *set = set.with(surface).unwrap_or(*set);
            }
        }
        for vertex in given.vertex_ids() {
            self.add_vertex(given.nodes[vertex], surfaces[vertex]);
        }
        for cell in given.cell_ids() {
            let vertices: [u32; 4] = std::array::from_fn(|local| given.cell(cell)[local].into());
            self.mesh.add_cell(vertices, [INNER; 4]);
        }
        for facet in &given.facets {
            let own = Simplex::<3>::facet_vertices(usize::from(facet.side));
            if let Some(opposite) = (0..4).find(|local| !own.contains(local)) {
                let face = Face { cell: index_u32(facet.cell.index()), opposite };
                self.mesh.set_tag(face, tag_of(u16::from(facet.boundary)));
            }
            let nodes: Vec<_> = given.facet_nodes(facet).collect();
            for edge in 0..3 {
                let ends = [nodes[edge], nodes[(edge + 1) % 3]];
                let [a, b] = ends.map(|end| given.nodes[end]);
                let node = given.nodes[nodes[3 + edge]];
                if is_bent(&a, &b, &node) {
                    let [a, b] = ends.map(u32::from);
                    self.given.add(a, &[GivenPart { end: b, node }]);
                }
            }
        }
    }

    /// Nodes in the edges that come of an edge on given sides, and of the bent faces of some cells at
    /// it, when it is divided at its node: those of the same curve and faces, in their halves.
    pub fn given_parts(&self, ends: [u32; 2], shell: &[u32]) -> Vec<GivenPart> {
        let mut parts = Vec::new();
        let [a, b] = ends.map(|end| self.mesh.point(end));
        if let Some(node) = self.given.of(ends) {
            // At a quarter and at three quarters of the curve
            parts.push(GivenPart { end: ends[0], node: a * 0.375 + node * 0.75 - b * 0.125 });
            parts.push(GivenPart { end: ends[1], node: b * 0.375 + node * 0.75 - a * 0.125 });
        }
        for &cell in shell {
            for (opposite, tag) in self.mesh.tags(cell).into_iter().enumerate() {
                let face = self.mesh.face_vertices(Face { cell, opposite });
                let third = face.into_iter().find(|vertex| !ends.contains(vertex));
                let (Some(third), true) = (third, tag != INNER && has_both(face, ends)) else {
                    continue;
                };
                let edges = [ends, [ends[1], third], [third, ends[0]]];
                if edges.iter().any(|edge| self.given.of(*edge).is_some()) {
                    let [along, one, other] =
                        edges.map(|[u, v]| self.mesh.middle([u, v]) + self.offset_of_node(u, v));
                    // Half way from the node of the edge to the third vertex
                    let node = (one + other) * 0.5 + along * 0.25 - (a + b) * 0.125;
                    parts.push(GivenPart { end: third, node });
                }
            }
        }
        parts
    }
}

fn has_both(face: [u32; 3], ends: [u32; 2]) -> bool {
    ends.iter().all(|end| face.contains(end))
}
