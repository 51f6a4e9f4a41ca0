//! The swap of a face for an edge: two cells become three.

use super::improver::{Improver, Pending};
use crate::spatial::generate::tetrahedra::Face;
use crate::spatial::generate::tetrahedra::boundary_edges::INNER;
use crate::spatial::generate::tetrahedra::measure::six_volumes;

/// A change must raise the quality by this.
pub const LEAST_GAIN: f64 = 1e-9;

impl Improver<'_> {
    /// Replaces a face by an edge between the vertices on its two sides, where that raises the worst
    /// quality and the edge is not longer than `longest` wanted lengths.
    pub fn swap_face(&mut self, face: Face, longest: f64) -> bool {
        if self.mesh.tags(face.cell)[face.opposite] != INNER {
            return false;
        }
        let ring = self.mesh.face_vertices(face);
        let Some(across) = self.mesh.across(ring, face.cell) else {
            return false;
        };
        let above = self.mesh.cell(face.cell)[face.opposite];
        let below = self.mesh.cell(across.cell)[across.opposite];
        if self.mesh.relative_length(above, below) > longest {
            return false;
        }
        let before = self.quality(face.cell).min(self.quality(across.cell));
        let mut new = [[0; 4]; 3];
        let mut n_positive = 0;
        for i in 0..3 {
            let mut vertices = [above, ring[i], ring[(i + 1) % 3], below];
            if six_volumes(&self.mesh.corners(vertices)) > 0.0 {
                n_positive += 1;
            } else {
                vertices.swap(1, 2);
            }
            let quality =
                self.quality_of(vertices, &self.mesh.corners(vertices), &Pending::Nothing);
            if quality <= before + LEAST_GAIN {
                return false;
            }
            new[i] = vertices;
        }
        // The edge passes through the face
        if n_positive != 0 && n_positive != 3 {
            return false;
        }
        self.mesh.replace(&[face.cell, across.cell], &new, &[]);
        true
    }
}
