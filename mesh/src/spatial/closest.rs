//! Closest points of bodies in space with each other and with walls, on the exact surfaces.
//!
//! Outside of two convex solids the sum of the distances to both is convex, and least on the way between
//! their closest points: Newton's method finds a point of it, whose feet on both surfaces they are. Each step
//! is across the way between the feet, and then to the middle of it, where the sum is no larger. Where a solid
//! is not convex, the search starts from places all around.

use std::iter;

use nalgebra::{Matrix3, SymmetricEigen};

use super::body_surface::BodySurface;
use super::domain::Domain;
use super::geometry::sides;
use super::surface::SmoothSurface;
use crate::Point;

/// Places around a solid that is not convex from which the search starts.
const STARTS: usize = 60;
/// From one of these places to the next one a gap changes by less than this part of the size of the solid.
const NEIGHBOUR: f64 = 0.5;
/// Steps of Newton's method.
const MOST_STEPS: usize = 60;
/// Halvings of a step.
const MOST_HALVINGS: usize = 40;
/// Sum of both normals at which the search has ended.
const OPPOSITE: f64 = 1e-11;
/// Step of finite differences over the size of the solids.
const DIFFERENCE: f64 = 1e-5;
/// Part of the largest eigenvalue below which the distance does not change in its direction.
const FLAT: f64 = 1e-7;
/// Part of the size of a solid within which two places are one.
const SAME: f64 = 1e-4;

/// Two points of two surfaces, where their distance is smallest nearby.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClosestPoints {
    /// The point on the first surface (m).
    pub first: Point<3>,
    /// The point on the second one (m).
    pub second: Point<3>,
    /// Unit normal from the second to the first.
    pub normal: Point<3>,
    /// Distance along the normal (m); where they overlap, minus the depth.
    pub gap: f64,
    /// Derivatives of the unit normals into the fluid along the surfaces there (1/m).
    pub curvatures: [Matrix3<f64>; 2],
}

/// A side of the domain that is a wall.
#[derive(Debug, Clone)]
pub struct WallSurface(SmoothSurface);

impl WallSurface {
    /// A side of a domain; `None` where it is periodic or a plane of symmetry.
    #[must_use]
    pub fn new(domain: &Domain, side: usize) -> Option<Self> {
        let is_wall = !domain.is_periodic(side) && !domain.is_symmetric(side);
        sides(domain).into_iter().nth(side).filter(|_| is_wall).map(Self)
    }

    /// Signed distance of a point (m), positive in the fluid.
    #[must_use]
    pub fn gap(&self, point: Point<3>) -> f64 {
        self.0.gap(point)
    }
}

/// A place between two surfaces, with the sum of the distances to them.
#[derive(Debug, Clone, Copy)]
struct Between {
    at: Point<3>,
    gap: f64,
}

impl BodySurface {
    /// All close pairs of points with another body whose gaps are below `range` (m), the nearest first;
    /// with `range` infinite the nearest is always among them.
    #[must_use]
    pub fn closest_points(&self, other: &Self, range: f64) -> Vec<ClosestPoints> {
        let mut found = Vec::new();
        for one in self.parts() {
            for two in other.parts() {
                found.extend(facing(one, two, range));
            }
        }
        // Parts of a union end within each other
        let is_outside = |at: &ClosestPoints| self.is_outer(at.first) && other.is_outer(at.second);
        sorted(found.into_iter().filter(is_outside).collect())
    }

    /// All close pairs of points with a wall whose gaps are below `range` (m), the nearest first.
    #[must_use]
    pub fn closest_to_wall(&self, wall: &WallSurface, range: f64) -> Vec<ClosestPoints> {
        let found = self.parts().iter().flat_map(|part| facing(part, &wall.0, range));
        sorted(found.filter(|at| self.is_outer(at.first)).collect())
    }

    /// Width (m) of the body where it is thinnest.
    #[must_use]
    pub fn thickness(&self) -> f64 {
        let radii = self.parts().iter().map(SmoothSurface::inner_radius);
        2.0 * radii.fold(f64::INFINITY, f64::min)
    }

    /// Whether a point on the surface of a part (m) is within no other part.
    fn is_outer(&self, point: Point<3>) -> bool {
        let within = |part: &SmoothSurface| part.gap(point) < -SAME * part.inner_radius();
        !self.parts().iter().any(within)
    }
}

fn sorted(mut all: Vec<ClosestPoints>) -> Vec<ClosestPoints> {
    all.sort_by(|a, b| a.gap.total_cmp(&b.gap));
    all
}

/// The closest points of two smooth surfaces with gaps below `range` (m).
pub(super) fn facing(one: &SmoothSurface, two: &SmoothSurface, range: f64) -> Vec<ClosestPoints> {
    let is_far = if two.is_given() {
        two.gap(one.origin()) - one.reach() >= range
    } else {
        one.least_gap(two.origin()) - two.reach() >= range
    };
    if is_far {
        return Vec::new();
    }
    let size = one.scale().min(two.scale());
    let mut places: Vec<Between> = Vec::new();
    let starts = if two.is_given() { starts_at_given(one, two, range) } else { starts(one, two) };
    let searched = starts.into_iter().filter_map(|start| search(one, two, start, size));
    for place in searched.filter(|place| place.gap < range) {
        let foot = one.foot(place.at).point;
        let is_same = |known: &Between| (one.foot(known.at).point - foot).norm() < SAME * size;
        match places.iter_mut().find(|known| is_same(known)) {
            Some(known) if place.gap < known.gap => *known = place,
            Some(_) => {}
            None => places.push(place),
        }
    }
    places.into_iter().map(|place| at_feet(one, two, place.at)).collect()
}

/// The feet on two surfaces of a place between them.
fn at_feet(one: &SmoothSurface, two: &SmoothSurface, at: Point<3>) -> ClosestPoints {
    let (first, second) = (one.foot(at), two.foot(at));
    ClosestPoints {
        first: first.point,
        second: second.point,
        normal: (second.normal - first.normal).normalize(),
        gap: first.gap + second.gap,
        curvatures: [one.curvature(first.point), two.curvature(second.point)],
    }
}

/// Places between two surfaces from which the closest points are sought.
fn starts(one: &SmoothSurface, two: &SmoothSurface) -> Vec<Point<3>> {
    // From the middle of a ball it is one step
    if one.radius_of_sphere().is_some() {
        return vec![one.foot(two.foot(one.origin()).point).point];
    }
    if two.radius_of_sphere().is_some() {
        return vec![two.foot(one.foot(two.origin()).point).point];
    }
    let between = |on_one: Point<3>| (on_one + two.foot(on_one).point) * 0.5;
    if one.is_convex() && two.is_convex() {
        return vec![between(one.foot(two.foot(one.origin()).point).point)];
    }
    let places = one.nearest_to_plane(two).unwrap_or_else(|| one.places(STARTS));
    places.into_iter().map(between).collect()
}

/// Places between a surface and a side of a given mesh, which may face it in many places: the nearest, and
/// from all around it those from which a gap below `range` (m) can be found, or the smallest one where that is
/// infinite.
fn starts_at_given(one: &SmoothSurface, side: &SmoothSurface, range: f64) -> Vec<Point<3>> {
    let toward = one.foot(side.foot(one.origin()).point).point;
    let around = one.places(STARTS).into_iter();
    let places: Vec<Between> =
        iter::once(toward).chain(around).map(|at| Between { at, gap: side.gap(at) }).collect();
    let least = places.iter().map(|place| place.gap).fold(f64::INFINITY, f64::min);
    let bound = if range.is_finite() { range } else { least } + NEIGHBOUR * one.reach();
    let near = places.into_iter().filter(|place| place.gap < bound);
    near.map(|place| (place.at + side.foot(place.at).point) * 0.5).collect()
}

/// The place near a start where the sum of the distances to two surfaces is least; `None` where none is found.
fn search(one: &SmoothSurface, two: &SmoothSurface, start: Point<3>, size: f64) -> Option<Between> {
    let gradient = |at: Point<3>| one.foot(at).normal + two.foot(at).normal;
    let gap = |at: Point<3>| one.gap(at) + two.gap(at);
    let middle = |at: Point<3>| {
        let center = (one.foot(at).point + two.foot(at).point) * 0.5;
        [center, at].map(|at| Between { at, gap: gap(at) })
    };
    let nearer = |[one, other]: [Between; 2]| if one.gap <= other.gap { one } else { other };
    let mut place = nearer(middle(start));
    for _ in 0..MOST_STEPS {
        let slope = gradient(place.at);
        if slope.norm() <= OPPOSITE {
            return Some(place);
        }
        let mut bend = Matrix3::<f64>::zeros();
        let step = DIFFERENCE * size;
        for axis in 0..3 {
            let way = Point::<3>::ith(axis, step);
            let change = gradient(place.at + way) - gradient(place.at - way);
            bend.set_column(axis, &(change / (2.0 * step)));
        }
        let along = (two.foot(place.at).normal - one.foot(place.at).normal).normalize();
        let across = Matrix3::identity() - along * along.transpose();
        let mut way = downhill(across * bend * across, across * slope, size);
        let mut is_better = false;
        for _ in 0..MOST_HALVINGS {
            let next = nearer(middle(place.at + way));
            if next.gap < place.gap || gradient(next.at).norm() < 0.5 * slope.norm() {
                (place, is_better) = (next, true);
                break;
            }
            way *= 0.5;
        }
        if !is_better {
            break;
        }
    }
    // As near as rounding lets it come
    (gradient(place.at).norm() < OPPOSITE.sqrt()).then_some(place)
}

/// Newton's step by second derivatives, downhill in all directions, and no longer than a length (m).
fn downhill(bend: Matrix3<f64>, slope: Point<3>, longest: f64) -> Point<3> {
    let eigen = SymmetricEigen::new((bend + bend.transpose()) * 0.5);
    let largest = eigen.eigenvalues.amax();
    let mut way = Point::<3>::zeros();
    for (axis, value) in eigen.eigenvectors.column_iter().zip(&eigen.eigenvalues) {
        let along = axis.dot(&slope);
        let least = (FLAT * largest).max(along.abs() / longest);
        way -= axis * (along / value.abs().max(least).max(f64::MIN_POSITIVE));
    }
    let length = way.norm();
    if length > longest { way * (longest / length) } else { way }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spatial::surface::directions;
    use crate::spatial::{Body, Shape};
    use nalgebra::{Isometry3, Translation3, UnitQuaternion};

    fn placed(shape: Shape, at: [f64; 3], angles: [f64; 3]) -> BodySurface {
        let turn = UnitQuaternion::from_euler_angles(angles[0], angles[1], angles[2]);
        let pose = Isometry3::from_parts(Translation3::from(Point::<3>::from(at)), turn);
        BodySurface::new(&Body::new("a", shape, pose)).unwrap()
    }

    /// The smallest distance found from many places of one surface to the other.
    fn by_sampling(one: &BodySurface, two: &BodySurface) -> f64 {
        use crate::Surface;
        let far = 2.0 * one.reach();
        let on = directions(40_000).map(|to| one.nearest_point(one.center() + to * far).point);
        on.map(|point| two.nearest_point(point).gap).fold(f64::INFINITY, f64::min)
    }

    fn check_points(found: &ClosestPoints) {
        let way = found.first - found.second;
        assert!((way - found.normal * found.gap).norm() < 1e-9, "{found:?}");
        for curvature in found.curvatures {
            assert!((curvature * found.normal).norm() < 1e-7, "{found:?}");
        }
    }

    #[test]
    fn balls_and_walls_are_as_far_apart_as_their_centres_say() {
        let ball = |x: f64, radius: f64| placed(Shape::Sphere { radius }, [x, 0.3, 0.4], [0.0; 3]);
        let found = ball(0.0, 1.0).closest_points(&ball(2.5, 0.5), 9.0);
        assert_eq!(found.len(), 1);
        check_points(&found[0]);
        assert!((found[0].gap - 1.0).abs() < 1e-12);
        assert!((found[0].curvatures[1][(1, 1)] - 2.0).abs() < 1e-9);
        // Overlapping
        let found = ball(0.0, 1.0).closest_points(&ball(1.3, 0.5), 9.0);
        assert!((found[0].gap + 0.2).abs() < 1e-12);
        assert!(ball(0.0, 1.0).closest_points(&ball(2.5, 0.5), 0.9).is_empty());
        let tube = Domain::Cylinder { x: [-5.0, 5.0], radius: 2.0 };
        let wall = WallSurface::new(&tube, 2).unwrap();
        let found = ball(0.0, 1.0).closest_to_wall(&wall, 9.0);
        check_points(&found[0]);
        assert!((found[0].gap - 0.5).abs() < 1e-12);
        // A container is concave across its axis and straight along it
        assert!((found[0].curvatures[1].trace() + 0.5).abs() < 1e-6);
        assert!(WallSurface::new(&tube, 0).is_some());
    }

    #[test]
    fn ellipsoids_and_capsules_at_all_angles_have_the_gap_found_by_sampling() {
        let shapes = [
            Shape::Ellipsoid { semi_axes: [1.0, 0.5, 0.3] },
            Shape::Capsule { radius: 0.3, length: 1.2 },
            Shape::Ellipsoid { semi_axes: [0.2, 0.8, 0.8] },
        ];
        for seed in 0..12_u8 {
            let part = |k: f64| (0.618_034 * k * f64::from(seed + 1)).fract();
            let angles = [6.0 * part(1.0), 3.0 * part(2.0), 6.0 * part(3.0)];
            let one = placed(shapes[usize::from(seed) % 3].clone(), [0.0; 3], angles);
            let angles = [6.0 * part(4.0), 3.0 * part(5.0), 6.0 * part(7.0)];
            let at = [1.8, 0.6 * part(11.0), 0.6 * part(13.0)];
            let two = placed(shapes[usize::from(seed / 3) % 3].clone(), at, angles);
            let found = one.closest_points(&two, f64::INFINITY);
            assert_eq!(found.len(), 1, "{seed}");
            let sampled = by_sampling(&one, &two);
            let gap = found[0].gap;
            if sampled > 0.0 {
                check_points(&found[0]);
                assert!(gap <= sampled + 1e-12 && gap > sampled - 3e-3, "{seed}: {gap} {sampled}");
            } else {
                assert!(gap <= 1e-9, "{seed}: {gap}");
            }
            let back = two.closest_points(&one, f64::INFINITY);
            assert!((back[0].gap - gap).abs() < 1e-9, "{seed}");
        }
    }

    #[test]
    fn sides_of_a_given_mesh_are_met_as_the_surfaces_they_are_of() {
        let tube = Domain::Cylinder { x: [-1.5, 1.5], radius: 1.0 };
        let mesh = crate::spatial::generate(&tube, &[], &crate::Sizing::graded(0.5, 0.5, 0.5));
        let given = Domain::Imported(crate::spatial::Imported::new(mesh.unwrap()));
        let walls = |domain: &Domain| [1, 2].map(|side| WallSurface::new(domain, side).unwrap());
        let (exact, given) = (walls(&tube), walls(&given));
        let shapes = [
            Shape::Sphere { radius: 0.3 },
            Shape::Ellipsoid { semi_axes: [0.5, 0.2, 0.3] },
            Shape::Capsule { radius: 0.15, length: 0.5 },
        ];
        for seed in 0..12_u8 {
            let part = |k: f64| (0.618_034 * k * f64::from(seed + 1)).fract();
            let angles = [6.0 * part(1.0), 3.0 * part(2.0), 6.0 * part(3.0)];
            // Also through the wall
            let at = [part(7.0) - 0.5, 0.4 + 0.3 * part(11.0), 0.3];
            let body = placed(shapes[usize::from(seed) % 3].clone(), at, angles);
            for (exact, given) in exact.iter().zip(&given) {
                let exact = body.closest_to_wall(exact, 5.0)[0];
                let found = body.closest_to_wall(given, 5.0)[0];
                check_points(&found);
                let nearest = body.closest_to_wall(given, f64::INFINITY)[0];
                assert!((nearest.gap - found.gap).abs() < 1e-12, "{nearest:?} {found:?}");
                // Quadratic edges of half the radius are off it a little, and their normals turned
                assert!((found.gap - exact.gap).abs() < 1e-3, "{seed}: {found:?} {exact:?}");
                assert!((found.normal - exact.normal).norm() < 0.03, "{found:?} {exact:?}");
                let [_, bend] = found.curvatures;
                assert!((bend - exact.curvatures[1]).amax() < 0.15, "{seed}: {bend}");
            }
        }
    }

    #[test]
    fn a_thin_gap_between_ellipsoids_is_exact() {
        // Along their longest axes, which face each other
        for gap in [0.1, 1e-3, 1e-6] {
            let shape = Shape::Ellipsoid { semi_axes: [1.0, 0.5, 0.4] };
            let one = placed(shape.clone(), [0.0; 3], [0.0; 3]);
            let two = placed(shape, [2.0 + gap, 0.0, 0.0], [0.0; 3]);
            let found = one.closest_points(&two, 1.0);
            assert!((found[0].gap - gap).abs() < 1e-10, "{gap}: {:?}", found[0]);
            // a / b^2 and a / c^2
            assert!((found[0].curvatures[0][(1, 1)] - 4.0).abs() < 1e-4);
            assert!((found[0].curvatures[0][(2, 2)] - 6.25).abs() < 1e-4);
        }
    }
}
