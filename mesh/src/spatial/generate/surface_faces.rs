//! Whether triangles follow the surface they are to be on.

use super::boundary_edges::surface_of;
use super::improver::Improver;
use super::measure::middle;
use super::surface_set::SurfaceSet;
use crate::Point;

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
/// an eighth of its angle, and edges may be half as long again.
const BULGE_OF_TURN: f64 = 1.5 / 8.0;

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
        let cosine = |at: Point<3>| (normal.dot(&surface.foot(at).normal) / area).abs();
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
}
