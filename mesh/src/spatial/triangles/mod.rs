//! Triangles in space: read from files, checked, repaired, measured.

mod check;
mod edges;
mod fault;
mod lines;
mod measure;
mod named;
mod obj;
mod ply;
mod read;
mod repair;
mod stl;
mod stored;

pub use fault::SurfaceFault;
pub use measure::{SurfaceMeasures, SurfaceMoments};
pub use named::{NamedTriangles, TriangleGroup};
pub use repair::{Repaired, Repairs};

pub(super) use edges::{Groups, edges_of};
use fault::at_most;

use crate::{Bounds, Point};

/// Triangles between points, each seen counter-clockwise from outside.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TriangleMesh {
    /// Places of the vertices (m).
    pub vertices: Vec<Point<3>>,
    /// Vertices of each triangle.
    pub triangles: Vec<[u32; 3]>,
}

impl TriangleMesh {
    /// The corners of a triangle (m).
    #[must_use]
    pub fn corners(&self, triangle: usize) -> [Point<3>; 3] {
        self.triangles[triangle].map(|vertex| self.vertices[vertex as usize])
    }

    /// Twice the area of a triangle times its unit normal (m2).
    #[must_use]
    pub fn area_vector(&self, triangle: usize) -> Point<3> {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(&(c - a))
    }

    /// The box around its vertices.
    #[must_use]
    pub fn bounds(&self) -> Bounds<3> {
        Bounds::around(&self.vertices)
    }

    /// Longest side of the box around it (m).
    #[must_use]
    pub fn extent(&self) -> f64 {
        let Bounds { min, max } = self.bounds();
        if self.vertices.is_empty() { 0.0 } else { (max - min).max() }
    }

    /// The same with all lengths multiplied by a factor.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let vertices = self.vertices.iter().map(|vertex| vertex * factor).collect();
        Self { vertices, triangles: self.triangles.clone() }
    }
}

#[cfg(test)]
pub(super) mod tests;
