//! Volume, moments, area and edges of triangles.

use nalgebra::Matrix3;

use super::TriangleMesh;
use super::edges::edges_of;
use crate::Point;

/// What a closed surface encloses, at unit density.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceMoments {
    /// Volume (m3).
    pub volume: f64,
    /// Centroid (m).
    pub centroid: Point<3>,
    /// Tensor of inertia about the centroid (m5).
    pub inertia: Matrix3<f64>,
}

impl SurfaceMoments {
    /// Those of the integrals of 1, x and x xᵀ (m3, m4, m5).
    pub(crate) fn of(volume: f64, first: Point<3>, second: Matrix3<f64>) -> Self {
        let centroid = first / volume;
        let central = second - centroid * centroid.transpose() * volume;
        let inertia = Matrix3::identity() * central.trace() - central;
        Self { volume, centroid, inertia }
    }

    /// The same with the origin elsewhere (m).
    pub(crate) fn moved(self, by: Point<3>) -> Self {
        Self { centroid: self.centroid + by, ..self }
    }
}

/// Lengths and angles of triangles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceMeasures {
    /// Area of all triangles (m2).
    pub area: f64,
    /// Shortest and longest edge (m).
    pub edges: [f64; 2],
    /// Largest angle by which the surface turns at an edge (rad), and the middle of that edge (m).
    pub sharpest: (f64, Point<3>),
    /// Number of edges with triangles on one side only.
    pub n_open: usize,
    /// Number of shells.
    pub n_shells: usize,
}

impl TriangleMesh {
    /// Volume by the divergence theorem (m3), negative where triangles are seen from inside.
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.moments().volume
    }

    /// Exact moments of the polyhedron: of the tetrahedra between each triangle and a point.
    #[must_use]
    pub fn moments(&self) -> SurfaceMoments {
        let near = self.vertices.first().copied().unwrap_or_default();
        let (mut volume, mut first, mut second) = (0.0, Point::<3>::zeros(), Matrix3::zeros());
        for triangle in 0..self.triangles.len() {
            let [a, b, c] = self.corners(triangle).map(|corner| corner - near);
            let own = a.dot(&b.cross(&c)) / 6.0;
            let sum = a + b + c;
            volume += own;
            first += sum * (own / 4.0);
            let squares = a * a.transpose() + b * b.transpose() + c * c.transpose();
            second += (squares + sum * sum.transpose()) * (own / 20.0);
        }
        SurfaceMoments::of(volume, first, second).moved(near)
    }

    /// Area, edges and shells, whether or not it is closed.
    #[must_use]
    pub fn measures(&self) -> SurfaceMeasures {
        let area = (0..self.triangles.len()).map(|i| 0.5 * self.area_vector(i).norm()).sum();
        let mut measures = SurfaceMeasures {
            area,
            edges: [f64::INFINITY, 0.0],
            sharpest: (0.0, Point::<3>::zeros()),
            n_open: 0,
            n_shells: self.shells().len(),
        };
        for ([a, b], beside) in edges_of(self) {
            let [a, b] = [a, b].map(|vertex| self.vertices[vertex as usize]);
            let length = (a - b).norm();
            measures.edges = [measures.edges[0].min(length), measures.edges[1].max(length)];
            if let [one, other] = beside[..] {
                let angle = self.turn(one.triangle, other.triangle);
                if angle > measures.sharpest.0 {
                    measures.sharpest = (angle, (a + b) * 0.5);
                }
            }
            measures.n_open += usize::from(beside.len() == 1);
        }
        measures
    }

    /// Angle between the normals of two triangles (rad).
    #[must_use]
    pub fn turn(&self, one: usize, other: usize) -> f64 {
        let [m, n] = [one, other].map(|triangle| self.area_vector(triangle));
        m.cross(&n).norm().atan2(m.dot(&n))
    }
}
