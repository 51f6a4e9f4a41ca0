//! Whether triangles follow the surface they are to be on.

use super::improve::Improver;
use super::tetrahedra::Face;
use super::tetrahedra::boundary_edges::{INNER, surface_of};
use super::tetrahedra::measure::middle;
use super::tetrahedra::surface_set::SurfaceSet;
use crate::Point;
use crate::interrupt;

/// Twice the area over the sum of squared edges that a face has at least; 0.29 when regular.
const LEAST_SHAPE: f64 = 0.06;

/// Cosine of the angle between the normal of a face and that of the surface at its corners.
const LEAST_AT_CORNERS: f64 = 0.65;

/// The same in its middle.
const LEAST_IN_MIDDLE: f64 = 0.8;

/// Height of a surface over an edge, in lengths of the edge, above which the edge is too long for its
/// curvature: it turns by 52 degrees.
const MOST_BULGE: f64 = 0.115;

/// The same over the angle by which an edge of the length wanted turns: an arc rises over its chord by
/// an eighth of its angle, and edges may be a quarter longer.
const BULGE_OF_TURN: f64 = 1.25 / 8.0;

/// Distance of curved faces from their surface over its radius of curvature, above which they are too
/// large.
const MOST_ERROR: f64 = 1.7e-3;

/// Barycentric coordinates of the points at which that is looked at.
const FACE_POINTS: [[f64; 3]; 4] =
    [[1.0 / 3.0; 3], [0.5, 0.25, 0.25], [0.25, 0.5, 0.25], [0.25, 0.25, 0.5]];

impl Improver<'_> {
    /// Whether a face with its corners at these places (m) follows the surface of its tag.
    pub fn follows_surface(&self, corners: &[Point<3>; 3], tag: u16) -> bool {
        let [a, b, c] = corners;
        let normal = (b - a).cross(&(c - a));
        let area = normal.norm();
        let squares = (a - b).norm_squared() + (b - c).norm_squared() + (c - a).norm_squared();
        if area < LEAST_SHAPE * squares {
            return false;
        }
        let surface = &self.geometry.surfaces[usize::from(surface_of(tag))];
        if surface.is_flat() {
            return true;
        }
        let cosine = |at: Point<3>| (normal.dot(&self.normal_at(surface_of(tag), at)) / area).abs();
        corners.iter().all(|corner| cosine(*corner) > LEAST_AT_CORNERS)
            && cosine((a + b + c) / 3.0) > LEAST_IN_MIDDLE
    }

    /// Height of the curve an edge stands for over its middle, in lengths of the edge.
    fn bulge(&self, a: Point<3>, b: Point<3>, surfaces: SurfaceSet) -> f64 {
        if !self.has_curved(surfaces) {
            return 0.0;
        }
        let straight = middle(a, b);
        (self.project(surfaces, straight) - straight).norm() / (a - b).norm()
    }

    /// Whether an edge is short enough for the curvature of its surfaces.
    pub fn is_short_enough(&self, a: Point<3>, b: Point<3>, surfaces: SurfaceSet) -> bool {
        surfaces.as_slice().first().is_none_or(|surface| {
            let turn = self.geometry.surfaces[usize::from(*surface)].turn;
            self.bulge(a, b, surfaces) <= MOST_BULGE.min(BULGE_OF_TURN * turn)
        })
    }

    /// Whether the edges of a face are short enough for the curvature of the surface of its tag.
    pub fn is_fine_enough(&self, [a, b, c]: &[Point<3>; 3], tag: u16) -> bool {
        let surface = SurfaceSet::of(surface_of(tag));
        [[a, b], [b, c], [c, a]].iter().all(|[a, b]| self.is_short_enough(**a, **b, surface))
    }

    /// Largest distance of a curved face from its surface over the radius of curvature, at four points.
    fn surface_error(&self, vertices: [u32; 3], tag: u16) -> f64 {
        let index = usize::from(surface_of(tag));
        let surface = &self.geometry.surfaces[index];
        let corners = self.mesh.corners(vertices);
        let middles = std::array::from_fn::<_, 3, _>(|i| {
            let next = (i + 1) % 3;
            middle(corners[i], corners[next]) + self.offset_of_node(vertices[i], vertices[next])
        });
        let error = |weights: [f64; 3]| {
            let mut point = Point::<3>::zeros();
            for i in 0..3 {
                let (u, v) = (weights[i], weights[(i + 1) % 3]);
                point += corners[i] * (u * (2.0 * u - 1.0)) + middles[i] * (4.0 * u * v);
            }
            surface.relative_distance(self.geometry.nearest_image(index, point))
        };
        FACE_POINTS.map(error).into_iter().fold(0.0, f64::max)
    }

    /// Splits an edge of each boundary face that is farther from its surface between its nodes than it
    /// should be, the longest that can be split.
    pub fn split_faces_off_surface(&mut self) -> usize {
        let mut faces = Vec::new();
        for cell in self.mesh.cells() {
            if interrupt::is_requested() {
                return 0;
            }
            for (opposite, tag) in self.mesh.tags(cell).into_iter().enumerate() {
                if tag != INNER && self.has_curved(SurfaceSet::of(surface_of(tag))) {
                    let vertices = self.mesh.face_vertices(Face { cell, opposite });
                    if self.surface_error(vertices, tag) > MOST_ERROR {
                        faces.push(vertices);
                    }
                }
            }
        }
        let is_split = |improver: &mut Self, [a, b, c]: [u32; 3]| {
            let mesh = &improver.mesh;
            let length = |[a, b]: &[u32; 2]| mesh.length(*a, *b);
            let mut sides = [[a, b], [b, c], [c, a]];
            sides.sort_by(|a, b| length(b).total_cmp(&length(a)));
            let is_still = sides.iter().all(|[a, b]| !mesh.edge_surfaces(*a, *b).is_empty());
            is_still && sides.into_iter().any(|ends| improver.split_in_two(ends))
        };
        let faces = faces.into_iter().take_while(|_| !interrupt::is_requested());
        faces.filter(|face| is_split(self, *face)).count()
    }
}
