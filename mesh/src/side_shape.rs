//! `SideShape`: area, direction and roundness of one boundary of a mesh.

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Vector3};

use crate::{BoundaryId, Facet, Mesh, NodeId};

/// A side is flat when its facets have one normal to this part.
const FLAT: f64 = 1e-9;

/// Its rim is round when the distances from its centre are the same to this part.
const ROUND: f64 = 1e-5;

/// What one boundary of a mesh looks like; coordinates a mesh does not have are zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SideShape {
    /// Integral of the outward unit normal (m²; m in the plane), curved facets included.
    pub area: Vector3<f64>,
    /// Whether it is flat.
    pub is_flat: bool,
    /// Centre (m) of the circle that is the rim of a flat side, or in the plane of the two ends of a
    /// straight one; `None` of other sides.
    pub circle: Option<Circle>,
}

impl SideShape {
    /// The coordinate axis that a flat side is normal to; `None` of other sides.
    #[must_use]
    pub fn normal_axis(&self) -> Option<usize> {
        let along = self.area.amax() / self.area.norm();
        (self.is_flat && along > 1.0 - FLAT).then(|| self.area.iamax())
    }

    /// The unit normal of a flat side into the domain.
    #[must_use]
    pub fn inward(&self) -> Vector3<f64> {
        -self.area / self.area.norm()
    }
}

/// A circle around the normal of a side; in the plane two points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circle {
    /// Centre (m).
    pub center: Vector3<f64>,
    /// Radius (m); in the plane half the distance.
    pub radius: f64,
}

impl<const D: usize> Mesh<D> {
    /// What a boundary looks like.
    #[must_use]
    pub fn side_shape(&self, boundary: BoundaryId) -> SideShape {
        let facets = || self.facets.iter().filter(move |facet| facet.boundary == boundary);
        let areas = || facets().map(|facet| self.area_of(facet));
        let area: Vector3<f64> = areas().sum();
        let measure: f64 = areas().map(|area| area.norm()).sum();
        // Facets of a flat side have the same normal each; a closed surface has no area
        let normal = area / measure;
        let off = areas().map(|own| (own - normal * own.norm()).norm() / own.norm());
        let is_flat = off.fold(0.0, f64::max) < FLAT.sqrt() && normal.norm() > 1.0 - FLAT;
        let circle = if is_flat { self.circle(facets(), &normal.normalize()) } else { None };
        SideShape { area, is_flat, circle }
    }

    fn in_space(&self, node: NodeId) -> Vector3<f64> {
        let point = &self.nodes[node];
        Vector3::from_fn(|axis, _| point.as_slice().get(axis).copied().unwrap_or_default())
    }

    /// Integral of the outward normal over a facet (m²; m in the plane).
    fn area_of(&self, facet: &Facet) -> Vector3<f64> {
        let nodes: Vec<Vector3<f64>> =
            self.facet_nodes(facet).map(|node| self.in_space(node)).collect();
        if D == 2 {
            // The fluid is on the left
            let along = nodes[1] - nodes[0];
            return Vector3::new(along.y, -along.x, 0.0);
        }
        // ½ ∮ x × dx, each edge by Simpson's rule, which is exact for cubics
        let edge = |i: usize| {
            let (a, b, m) = (nodes[i], nodes[(i + 1) % 3], nodes[3 + i]);
            let at_start = a.cross(&(m * 4.0 - a * 3.0 - b));
            let at_end = b.cross(&(a - m * 4.0 + b * 3.0));
            (at_start + m.cross(&(b - a)) * 4.0 + at_end) / 12.0
        };
        edge(0) + edge(1) + edge(2)
    }

    /// The circle through the rim of flat facets, if there is one.
    fn circle<'a>(
        &'a self,
        facets: impl Iterator<Item = &'a Facet>,
        normal: &Vector3<f64>,
    ) -> Option<Circle> {
        // Edges of one facet are on the rim; in the plane vertices are
        let mut rim: BTreeMap<Vec<NodeId>, usize> = BTreeMap::new();
        for facet in facets {
            let vertices = self.facet_vertices(facet);
            for (i, vertex) in vertices.iter().enumerate() {
                let mut ends = vec![*vertex, vertices[(i + 1) % D]];
                ends.truncate(D - 1);
                ends.sort_unstable();
                *rim.entry(ends).or_default() += 1;
            }
        }
        let rim = rim.into_iter().filter(|(_, n)| *n == 1);
        let mut points: Vec<NodeId> = rim.flat_map(|(ends, _)| ends).collect();
        points.sort_unstable();
        points.dedup();
        let points: Vec<Vector3<f64>> =
            points.into_iter().map(|node| self.in_space(node)).collect();
        let middle = points.iter().sum::<Vector3<f64>>() / points.len() as f64;
        let center = if D == 2 {
            if points.len() != 2 {
                return None;
            }
            middle
        } else {
            middle + fitted_center(&points, &middle, normal)?
        };
        let distances = || points.iter().map(|point| (point - center).norm());
        let radius = distances().sum::<f64>() / points.len() as f64;
        let off = distances().map(|distance| (distance - radius).abs()).fold(0.0, f64::max);
        (off <= ROUND * radius).then_some(Circle { center, radius })
    }
}

/// The centre of the circle nearest to points of a plane, seen from their middle (m): |x|² = 2 c · x
/// + k by least squares.
fn fitted_center(
    points: &[Vector3<f64>],
    middle: &Vector3<f64>,
    normal: &Vector3<f64>,
) -> Option<Vector3<f64>> {
    let u = normal.cross(&Vector3::ith(normal.iamin(), 1.0)).normalize();
    let v = normal.cross(&u);
    let scale = points.iter().map(|point| (point - middle).norm()).fold(0.0, f64::max);
    let (mut matrix, mut rhs) = (Matrix3::zeros(), Vector3::zeros());
    for point in points {
        let seen = (point - middle) / scale;
        let row = Vector3::new(2.0 * seen.dot(&u), 2.0 * seen.dot(&v), 1.0);
        matrix += row * row.transpose();
        rhs += row * seen.norm_squared();
    }
    let found = matrix.try_inverse()? * rhs;
    Some((u * found.x + v * found.y) * scale)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spatial::{Domain, generate};
    use crate::test_meshes::cube_of_twelve;
    use crate::{Point, Sizing, generate as generate_planar};

    #[test]
    fn the_ends_of_a_tube_are_round_and_its_wall_is_not_flat() {
        let domain = Domain::Cylinder { x: [0.0, 2.0], radius: 1.0 };
        let mesh = generate(&domain, &[], &Sizing::graded(0.4, 0.3, 0.4)).unwrap();
        let [left, right, wall] = [0, 1, 2].map(|i| mesh.side_shape(BoundaryId::new(i)));
        let area = std::f64::consts::PI;
        assert!((left.area.x + area).abs() < 3e-4 && (right.area.x - area).abs() < 3e-4);
        for (side, x) in [(left, 0.0), (right, 2.0)] {
            let circle = side.circle.unwrap();
            assert!((circle.radius - 1.0).abs() < 1e-10, "{circle:?}");
            assert!((circle.center - Vector3::new(x, 0.0, 0.0)).norm() < 1e-10, "{circle:?}");
        }
        assert!(!wall.is_flat && (left.area + right.area + wall.area).norm() < 1e-12);
        let cube = cube_of_twelve().side_shape(BoundaryId::new(0));
        assert!(!cube.is_flat && cube.area.norm() < 1e-14);
    }

    #[test]
    fn a_side_of_a_rectangle_has_its_middle() {
        let (min, max) = (Point::<2>::zeros(), Point::<2>::new(3.0, 1.0));
        let domain = crate::Domain::Box { min, max, periodic_x: false, periodic_y: false };
        let mesh = generate_planar(&domain, &[], &Sizing::graded(0.2, 0.3, 0.2)).unwrap();
        let left = mesh.boundaries.iter().position(|b| b.name == "left").unwrap();
        let left = mesh.side_shape(BoundaryId::new(left));
        assert!((left.area - Vector3::new(-1.0, 0.0, 0.0)).norm() < 1e-14 && left.is_flat);
        let circle = left.circle.unwrap();
        assert!((circle.radius - 0.5).abs() < 1e-14 && (circle.center.y - 0.5).abs() < 1e-14);
    }
}
