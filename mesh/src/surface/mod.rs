//! `Surface`: what is asked of the surface of a body in the plane or in space.

mod surroundings;

pub use surroundings::{Sides, Surroundings};

use crate::box_tree::{Bounds, BoxTree};
use crate::{BoundaryKind, Point};

/// The point of a surface nearest to another point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePoint<const D: usize> {
    /// Where on the surface (m).
    pub point: Point<D>,
    /// Unit normal there, out of the body.
    pub normal: Point<D>,
    /// Signed distance (m), negative inside the body.
    pub gap: f64,
}

/// The closed surface of a body with a pose: a curve in the plane, a surface in space.
pub trait Surface<const D: usize> {
    /// Coordinates on the surface, which belong to a material point.
    type Parameter: Copy;

    /// Position of the origin of the body's own frame (m).
    fn center(&self) -> Point<D>;

    /// Radius of a ball about [`Self::center`] that holds the surface (m).
    fn reach(&self) -> f64;

    /// The point of the surface nearest to another one (m).
    fn nearest_point(&self, point: Point<D>) -> SurfacePoint<D>;

    /// Coordinates of the point of the surface nearest to another one (m): on the surface the
    /// inverse of [`Self::point`].
    fn parameter_of(&self, point: Point<D>) -> Self::Parameter;

    /// The point (m) with given coordinates, and the normal there.
    fn point(&self, parameter: Self::Parameter) -> SurfacePoint<D>;

    /// A lower bound of the gap to a point (m), at no cost.
    fn least_gap(&self, point: Point<D>) -> f64 {
        (point - self.center()).norm() - self.reach()
    }

    /// Whether [`Self::least_gap`] surely exceeds a bound (m), at less cost still.
    fn is_beyond(&self, point: Point<D>, bound: f64) -> bool {
        (point - self.center()).amax() > (bound + self.reach()) * (1.0 + 1e-9)
    }
}

/// A surface that faces a point of a boundary.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facing {
    /// Its boundary in the mesh.
    pub boundary: usize,
    /// Signed gap (m), negative where the surfaces overlap.
    pub gap: f64,
}

/// Surfaces that face each other across the fluid.
pub trait FacingSurfaces<const D: usize> {
    /// The surface that faces a point (m) of boundary `boundary` of a mesh, of kind `kind`, if one
    /// is nearer than `reach` (m).
    #[must_use]
    fn facing(
        &self,
        boundary: usize,
        kind: BoundaryKind,
        point: Point<D>,
        reach: f64,
    ) -> Option<Facing>;
}

/// A surface that is near a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearSurface {
    /// Its index.
    pub surface: usize,
    /// Signed gap to it (m).
    pub gap: f64,
}

/// Part of its size by which the box around a surface is larger, so that rounding leaves none out.
const MARGIN: f64 = 1e-9;

/// Where several surfaces are, to find the nearest of them.
#[derive(Debug, Clone)]
pub(crate) struct SurfaceTree<const D: usize>(BoxTree<D>);

impl<const D: usize> SurfaceTree<D> {
    /// The tree of these surfaces, which are known by their index.
    pub fn new(surfaces: &[impl Surface<D>]) -> Self {
        let bounds = |surface: &_| {
            let (center, reach) = (Surface::center(surface), Surface::reach(surface));
            let half = Point::repeat(reach * (1.0 + MARGIN));
            Bounds { min: center - half, max: center + half }
        };
        Self(BoxTree::new(&surfaces.iter().map(bounds).collect::<Vec<_>>()))
    }

    /// The nearest of the surfaces of this tree within reach of a point (m), the images of all included
    /// and the surface `but` itself left out, though not its images; the first of several as near.
    ///
    /// `images` are the vectors by which a periodic domain repeats (m), zero first.
    pub fn nearest(
        &self,
        surfaces: &[impl Surface<D>],
        images: &[Point<D>],
        point: Point<D>,
        but: Option<usize>,
        reach: f64,
    ) -> Option<NearSurface> {
        let mut nearest: Option<NearSurface> = None;
        for (i, shift) in images.iter().enumerate() {
            let image = point - shift;
            // A point may be inside a surface, its gap negative
            let within = nearest.map_or(reach, |known| known.gap).max(0.0);
            self.0.visit_near(image, within, |index, within| {
                let surface = &surfaces[index];
                let bound = nearest.map_or(reach, |known| known.gap);
                let is_other = i > 0 || but != Some(index);
                if is_other && !surface.is_beyond(image, bound) && surface.least_gap(image) <= bound
                {
                    let gap = surface.nearest_point(image).gap;
                    let is_first = nearest.is_some_and(|known| index < known.surface);
                    if gap < bound || (gap == bound && is_first) {
                        nearest = Some(NearSurface { surface: index, gap });
                        *within = gap.max(0.0);
                    }
                }
                false
            });
        }
        nearest
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Outline, PlacedShape, Shape};

    struct Ball {
        center: Point<3>,
        radius: f64,
    }

    impl Surface<3> for Ball {
        type Parameter = [f64; 2];

        fn center(&self) -> Point<3> {
            self.center
        }

        fn reach(&self) -> f64 {
            self.radius
        }

        fn nearest_point(&self, point: Point<3>) -> SurfacePoint<3> {
            let normal = (point - self.center).normalize();
            let gap = (point - self.center).norm() - self.radius;
            SurfacePoint { point: self.center + normal * self.radius, normal, gap }
        }

        fn parameter_of(&self, point: Point<3>) -> [f64; 2] {
            let off = point - self.center;
            [off.y.atan2(off.x), (off.z / off.norm()).acos()]
        }

        fn point(&self, [azimuth, polar]: [f64; 2]) -> SurfacePoint<3> {
            let [(s, c), (sin, cos)] = [azimuth, polar].map(f64::sin_cos);
            let normal = Point::<3>::new(sin * c, sin * s, cos);
            SurfacePoint { point: self.center + normal * self.radius, normal, gap: 0.0 }
        }
    }

    #[test]
    fn the_nearest_of_balls_and_their_images_is_found() {
        let ball = |x: f64| Ball { center: Point::<3>::new(x, 0.0, 0.0), radius: 1.0 };
        let balls = [ball(0.0), ball(4.0)];
        let images = [0.0, 10.0, -10.0].map(|x| Point::<3>::new(x, 0.0, 0.0));
        let find = |x: f64, but, reach| {
            let point = Point::<3>::new(x, 0.0, 0.0);
            SurfaceTree::new(&balls).nearest(&balls, &images, point, but, reach)
        };
        assert_eq!(find(1.5, None, 9.0), Some(NearSurface { surface: 0, gap: 0.5 }));
        assert_eq!(find(1.5, Some(0), 9.0), Some(NearSurface { surface: 1, gap: 1.5 }));
        assert_eq!(find(1.5, Some(0), 1.0), None);
        // The image of the first ball at 10
        assert_eq!(find(8.0, Some(0), 9.0), Some(NearSurface { surface: 0, gap: 1.0 }));
        assert_eq!(find(0.5, None, 9.0), Some(NearSurface { surface: 0, gap: -0.5 }));
        // As far from both
        assert_eq!(find(2.0, None, 9.0), Some(NearSurface { surface: 0, gap: 1.0 }));
    }

    #[test]
    fn the_tree_finds_what_a_look_at_all_balls_and_images_finds() {
        let part = |i: usize, k: f64| (0.618_034 * k * (i + 1) as f64).fract();
        let ball = |i: usize| Ball {
            center: Point::<3>::new(part(i, 1.0), part(i, 7.0), part(i, 31.0)) * 10.0,
            radius: 0.3 + 0.5 * part(i, 3.0),
        };
        let balls: Vec<Ball> = (0..60).map(ball).collect();
        let images = [0.0, 10.0, -10.0].map(|x| Point::<3>::new(x, 0.0, 0.0));
        let tree = SurfaceTree::new(&balls);
        for i in 0..200 {
            let point = Point::<3>::new(part(i, 11.0), part(i, 5.0), part(i, 17.0)) * 12.0;
            let (but, reach) = (Some(i % 60), [0.4, 2.0, f64::INFINITY][i % 3]);
            let gaps = images.iter().enumerate().flat_map(|(nth, shift)| {
                let others = (0..60).filter(move |ball| nth > 0 || Some(*ball) != but);
                others
                    .map(|ball| (balls[ball].nearest_point(point - shift).gap, ball))
                    .collect::<Vec<_>>()
            });
            let least =
                gaps.filter(|(gap, _)| *gap < reach).min_by(|a, b| a.partial_cmp(b).unwrap());
            let expected = least.map(|(gap, surface)| NearSurface { surface, gap });
            assert_eq!(tree.nearest(&balls, &images, point, but, reach), expected);
        }
    }

    /// Coordinates and points are inverse to each other, and normals point out of the body.
    fn check_parameters<const D: usize, S: Surface<D>>(surface: &S, outside: &[Point<D>]) {
        for from in outside {
            let near = surface.nearest_point(*from);
            let on = surface.point(surface.parameter_of(*from));
            assert!((on.point - near.point).norm() < 1e-12 && on.gap == 0.0);
            assert!((on.normal - near.normal).norm() < 1e-12);
            assert!((near.point + near.normal * near.gap - from).norm() < 1e-12);
            assert!(surface.least_gap(*from) <= near.gap);
            assert!(!surface.is_beyond(*from, near.gap));
            assert!(surface.is_beyond(*from, near.gap - 4.0 * surface.reach()));
        }
    }

    #[test]
    fn outlines_and_balls_are_surfaces() {
        let outline = Outline::new(&PlacedShape {
            name: "ellipse".into(),
            shape: Shape::Ellipse { semi_axes: [2.0, 1.0] },
            center: Point::<2>::new(0.3, -0.2),
            angle: 0.7,
            size: None,
        });
        let outline = outline.expect("an ellipse has an outline");
        let points = [[5.0, 1.0], [-3.0, 2.0], [0.1, -4.0]].map(Point::<2>::from);
        check_parameters(&outline, &points);
        let ball = Ball { center: Point::<3>::new(0.1, 0.2, 0.3), radius: 0.5 };
        let points = [[1.0, 2.0, 0.5], [-1.0, 0.4, -2.0]].map(Point::<3>::from);
        check_parameters(&ball, &points);
    }
}
