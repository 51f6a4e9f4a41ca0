//! `Facets`: a side of a given mesh as triangles, and the distance to it.

use super::Foot;
use crate::{BoundaryId, Bounds, BoxTree, Mesh, Point};

/// Triangles, in a tree of the boxes around them.
#[derive(Debug, Clone)]
pub struct Facets {
    triangles: Vec<[Point<3>; 3]>,
    tree: BoxTree<3>,
    is_curved: bool,
}

impl PartialEq for Facets {
    fn eq(&self, other: &Self) -> bool {
        self.triangles == other.triangles
    }
}

impl Facets {
    /// Those of one boundary of a mesh; curved ones as four triangles each.
    #[must_use]
    pub fn of(mesh: &Mesh<3>, side: BoundaryId) -> Self {
        let mut triangles = Vec::new();
        let mut is_curved = false;
        for facet in mesh.facets.iter().filter(|facet| facet.boundary == side) {
            let n: Vec<Point<3>> = mesh.facet_nodes(facet).map(|node| mesh.nodes[node]).collect();
            if (0..3).any(|i| is_bent(&n[i], &n[(i + 1) % 3], &n[3 + i])) {
                is_curved = true;
                triangles.extend([[n[0], n[3], n[5]], [n[1], n[4], n[3]], [n[2], n[5], n[4]]]);
                triangles.push([n[3], n[4], n[5]]);
            } else {
                triangles.push([n[0], n[1], n[2]]);
            }
        }
        let boxes: Vec<Bounds<3>> = triangles.iter().map(Bounds::around).collect();
        Self { tree: BoxTree::new(&boxes), triangles, is_curved }
    }

    /// Whether edges on it may be bent.
    #[must_use]
    pub fn is_curved(&self) -> bool {
        self.is_curved
    }

    /// Corners of its triangles (m), each at least once.
    pub fn points(&self) -> impl Iterator<Item = Point<3>> + '_ {
        self.triangles.iter().flatten().copied()
    }

    /// The nearest point to another one, its gap never negative.
    #[must_use]
    pub fn foot(&self, point: Point<3>) -> Foot {
        let mut nearest = point;
        let mut inward = Point::<3>::zeros();
        let mut least = f64::INFINITY;
        self.tree.visit_near(point, f64::INFINITY, |index, reach| {
            let triangle = &self.triangles[index];
            let on = nearest_on_triangle(triangle, &point);
            let distance = (point - on).norm();
            if distance < least {
                (least, nearest) = (distance, on);
                let [a, b, c] = triangle;
                inward = -(b - a).cross(&(c - a)).normalize();
                *reach = distance;
            }
            false
        });
        let normal = if least > 0.0 { (point - nearest) / least } else { inward };
        Foot { point: nearest, normal, gap: least }
    }
}

/// Distance of a node from the middle of its edge, in lengths of the edge, below which it is there.
const STRAIGHT: f64 = 1e-9;

/// Whether the edge between two points is bent to a node.
pub fn is_bent(a: &Point<3>, b: &Point<3>, node: &Point<3>) -> bool {
    (node - (a + b) * 0.5).norm() > STRAIGHT * (b - a).norm()
}

/// The point of a triangle nearest to another one.
///
/// On its plane, where that is over it, else on the nearest of its sides.
fn nearest_on_triangle([a, b, c]: &[Point<3>; 3], point: &Point<3>) -> Point<3> {
    let normal = (b - a).cross(&(c - a));
    let square = normal.norm_squared();
    let over = |from: &Point<3>, to: &Point<3>| (to - from).cross(&(point - from)).dot(&normal);
    let weights = [over(b, c), over(c, a), over(a, b)];
    if square > 0.0 && weights.iter().all(|weight| *weight >= 0.0) {
        return (a * weights[0] + b * weights[1] + c * weights[2]) / square;
    }
    let on_side = |from: &Point<3>, to: &Point<3>| {
        let along = to - from;
        let part = (point - from).dot(&along) / along.norm_squared();
        from + along * part.clamp(0.0, 1.0)
    };
    let distance = |on: &Point<3>| (point - on).norm_squared();
    let sides = [on_side(a, b), on_side(b, c), on_side(c, a)];
    sides.into_iter().min_by(|p, q| distance(p).total_cmp(&distance(q))).unwrap_or(*a)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_meshes::cube_of_twelve;

    #[test]
    fn distances_are_those_to_a_cube() {
        let mesh = cube_of_twelve();
        let facets = Facets::of(&mesh, BoundaryId::new(0));
        for (point, nearest, gap) in [
            ([0.5, 0.4, 0.1], [0.5, 0.4, 0.0], 0.1),
            ([2.0, 0.5, 0.3], [1.0, 0.5, 0.3], 1.0),
            ([2.0, 2.0, 0.5], [1.0, 1.0, 0.5], 2.0_f64.sqrt()),
            ([-1.0, -1.0, -1.0], [0.0, 0.0, 0.0], 3.0_f64.sqrt()),
            ([0.0, 0.2, 0.7], [0.0, 0.2, 0.7], 0.0),
        ] {
            let foot = facets.foot(point.into());
            assert!((foot.gap - gap).abs() < 1e-14, "{foot:?}");
            assert!((foot.point - Point::from(nearest)).norm() < 1e-14, "{foot:?}");
            assert!((foot.normal.norm() - 1.0).abs() < 1e-14);
        }
    }
}
