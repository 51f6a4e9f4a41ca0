//! Splits of edges.

use super::improver::{Improver, LEAST_CLEARANCE};
use crate::Point;
use crate::spatial::generate::tetrahedra::boundary_edges::INNER;
use crate::spatial::generate::tetrahedra::measure::volume_length;
use crate::spatial::generate::tetrahedra::surface_set::SurfaceSet;

/// Least measure of volume and edge lengths of the halves of a cell.
const LEAST_HALF: f64 = 0.02;

/// An edge that is to be split, and where.
#[derive(Debug, Clone, Copy)]
pub struct Split {
    /// Its ends.
    pub ends: [u32; 2],
    /// Place of the new vertex (m).
    pub point: Point<3>,
    /// The surfaces the new vertex is on.
    pub surfaces: SurfaceSet,
    /// Measure of volume and edge lengths that the new cells must exceed.
    pub least_quality: f64,
}

impl Improver<'_> {
    /// The split of an edge in its middle, on its surfaces.
    pub fn split_in_middle(&self, ends: [u32; 2], least_quality: f64) -> Split {
        let [a, b] = ends;
        let surfaces = self.mesh.edge_surfaces(a, b);
        let point = self.project(surfaces, self.mesh.middle(ends));
        Split { ends, point, surfaces, least_quality }
    }

    /// Splits an edge with these cells around it, unless a new cell would be too poor; gives the new
    /// vertex.
    pub fn split(&mut self, split: &Split, shell: &[u32]) -> Option<u32> {
        let Split { ends: [a, b], point, surfaces, least_quality } = *split;
        for &cell in shell {
            let vertices = self.mesh.cell(cell);
            let corners = self.mesh.corners_beside(vertices, point);
            for end in [a, b] {
                let at = vertices.iter().position(|vertex| *vertex == end)?;
                let mut half = corners;
                half[at] = point;
                if volume_length(&half) <= least_quality {
                    return None;
                }
            }
        }
        let vertex = self.add_vertex(point, surfaces);
        for &cell in shell {
            let (vertices, tags) = (self.mesh.cell(cell), self.mesh.tags(cell));
            self.mesh.delete_cell(cell);
            for [kept, replaced] in [[a, b], [b, a]] {
                let (mut half, mut half_tags) = (vertices, tags);
                for local in 0..4 {
                    if vertices[local] == replaced {
                        half[local] = vertex;
                    } else if vertices[local] == kept {
                        // The face between the halves
                        half_tags[local] = INNER;
                    }
                }
                self.mesh.add_cell(half, half_tags);
            }
        }
        Some(vertex)
    }

    /// Splits an edge in its middle, where it still is and its halves are not too poor.
    pub fn split_in_two(&mut self, ends: [u32; 2]) -> bool {
        let mut shell = Vec::new();
        self.mesh.shell(ends[0], ends[1], &mut shell);
        if shell.is_empty() {
            return false;
        }
        let split = self.split_in_middle(ends, LEAST_HALF);
        self.may_split(&split) && self.split(&split, &shell).is_some()
    }

    /// Whether the point of a split is far enough from all surfaces, or on one that may change.
    pub fn may_split(&self, split: &Split) -> bool {
        let [a, b] = split.ends;
        let distance = LEAST_CLEARANCE * self.mesh.length(a, b);
        if split.surfaces.is_empty() {
            self.is_in_fluid(split.point, distance)
        } else {
            !self.is_fixed(split.surfaces)
        }
    }
}
