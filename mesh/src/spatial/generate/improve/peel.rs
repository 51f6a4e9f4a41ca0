//! The removal of a flat cell with two or three faces on one surface.

use super::improver::{Improver, Pending};
use crate::spatial::generate::tetrahedra::Face;
use crate::spatial::generate::tetrahedra::boundary_edges::{INNER, surface_of};
use crate::spatial::generate::tetrahedra::surface_set::SurfaceSet;

impl Improver<'_> {
    /// Takes a cell away that has two or three faces on one surface and none on others, where its other
    /// faces follow the surface as well, and the cells behind them stay better than it.
    pub fn peel(&mut self, cell: u32) -> bool {
        let (vertices, tags) = (self.mesh.cell(cell), self.mesh.tags(cell));
        let (on_boundary, inner): (Vec<usize>, Vec<usize>) =
            (0..4).partition(|local| tags[*local] != INNER);
        if !(2..=3).contains(&on_boundary.len()) {
            return false;
        }
        let tag = tags[on_boundary[0]];
        let surface = SurfaceSet::of(surface_of(tag));
        if self.is_fixed(surface) || on_boundary.iter().any(|local| tags[*local] != tag) {
            return false;
        }
        let mut behind = Vec::new();
        for &opposite in &inner {
            let face = self.mesh.face_vertices(Face { cell, opposite });
            let is_on = |vertex: &u32| self.mesh.surfaces(*vertex).contains(surface_of(tag));
            let corners = self.mesh.corners(face);
            if !face.iter().all(is_on) || !self.follows_surface(&corners, tag) {
                return false;
            }
            let Some(across) = self.mesh.across(face, cell) else {
                return false;
            };
            behind.push(across);
        }
        let is_possible = if let [one, other] = inner[..] {
            let new_edge = [vertices[on_boundary[0]], vertices[on_boundary[1]]];
            self.can_open(cell, [vertices[one], vertices[other]], new_edge, tag)
        } else {
            self.mesh.surfaces(vertices[inner[0]]).len() == 1
        };
        if !is_possible {
            return false;
        }
        self.mesh.delete_cell(cell);
        for face in behind {
            self.mesh.set_tag(face, tag);
            for vertex in self.mesh.face_vertices(face) {
                self.mesh.forget_around(vertex);
            }
        }
        true
    }

    /// Whether a cell with two boundary faces at the edge `old` can go, so that the edge `new` comes to
    /// the boundary.
    fn can_open(&mut self, cell: u32, old: [u32; 2], new: [u32; 2], tag: u16) -> bool {
        let mut shell = Vec::new();
        self.mesh.shell(old[0], old[1], &mut shell);
        if shell.len() != 1 || !self.mesh.edge_surfaces(new[0], new[1]).is_empty() {
            return false;
        }
        let before = self.quality(cell);
        let pending = Pending::NewEdge { ends: new, surfaces: SurfaceSet::of(surface_of(tag)) };
        self.mesh.shell(new[0], new[1], &mut shell);
        shell.iter().filter(|other| **other != cell).all(|&other| {
            let vertices = self.mesh.cell(other);
            self.quality_of(vertices, &self.mesh.corners(vertices), &pending) > before
        })
    }
}
