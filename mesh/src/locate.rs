//! Point location: the cell that holds a point, and its reference coordinates there.
//!
//! A tree of cell boxes finds the candidates; the map of a straight cell is inverted exactly, that
//! of a curved one by Newton's method.

use crate::outline::cross;
use crate::{CellId, Mesh, Point, map_quadratic};

/// A point this far outside (in sizes of the mesh) still counts as on its boundary.
const TOLERANCE: f64 = 1e-9;

/// Levels of the tree of 2^32 cells.
const MOST_LEVELS: usize = 33;

/// Cells in one leaf.
const LEAF: usize = 4;

/// Marks a cell without curved sides.
const STRAIGHT: u32 = u32::MAX;

/// Newton's method has found a point when it misses by this part of the cell's size at most.
const FOUND: f64 = 1e-10;

/// Where a point is in a mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Located<const D: usize> {
    /// The cell.
    pub cell: CellId,
    /// Reference coordinates in it; a little outside the simplex when the point is outside.
    pub reference: [f64; D],
    /// Distance from the point to the cell (m), zero inside.
    pub distance: f64,
}

/// Finds cells; keeps its own copy of the geometry, so the mesh may move on.
#[derive(Debug, Clone)]
pub struct Locator<const D: usize> {
    tree: BoxTree<D>,
    /// Places of the corners of all cells, D + 1 for each.
    corners: Vec<Point<D>>,
    /// Where the nodes of each curved cell start in `quadratic`; [`STRAIGHT`] for the others.
    curved: Vec<u32>,
    /// Places of the P2 nodes of the curved cells.
    quadratic: Vec<Point<D>>,
    tolerance: f64,
}

impl Locator<2> {
    /// Prepares the search in a mesh.
    #[must_use]
    pub fn new(mesh: &Mesh<2>) -> Self {
        let mut boxes = Vec::with_capacity(mesh.n_cells());
        let mut corners = Vec::with_capacity(3 * mesh.n_cells());
        let mut curved = vec![STRAIGHT; mesh.n_cells()];
        let mut quadratic = Vec::new();
        for cell in mesh.cell_ids() {
            let nodes = mesh.cell_nodes(cell);
            let mut bounds =
                (nodes[0].inf(&nodes[1]).inf(&nodes[2]), nodes[0].sup(&nodes[1]).sup(&nodes[2]));
            corners.extend_from_slice(&nodes[..3]);
            if mesh.curved[cell] {
                // A quadratic curve lies within the hull of its control points
                for side in 0..3 {
                    let control =
                        nodes[3 + side] * 2.0 - (nodes[side] + nodes[(side + 1) % 3]) * 0.5;
                    bounds = (bounds.0.inf(&control), bounds.1.sup(&control));
                }
                curved[cell] = quadratic.len() as u32;
                quadratic.extend_from_slice(&nodes);
            }
            boxes.push(bounds);
        }
        let tree = BoxTree::new(&boxes);
        let tolerance = TOLERANCE * tree.extent();
        Self { tree, corners, curved, quadratic, tolerance }
    }

    /// The cell that holds a point, and the reference coordinates there; `None` outside.
    ///
    /// A point outside by rounding (1e-9 of the size of the mesh) is found in the nearest cell.
    #[must_use]
    pub fn locate(&self, point: Point<2>) -> Option<(CellId, [f64; 2])> {
        self.search(point, self.tolerance).map(|found| (found.cell, found.reference))
    }

    /// The cell nearest to a point, however far outside; `None` only for a point that is not
    /// finite or a mesh without cells.
    ///
    /// Points on an exact curve may be outside the quadratic geometry by its fourth-order error:
    /// this finds where fields are to be extrapolated from.
    #[must_use]
    pub fn nearest(&self, point: Point<2>) -> Option<Located<2>> {
        self.search(point, f64::INFINITY)
    }

    fn search(&self, point: Point<2>, reach: f64) -> Option<Located<2>> {
        let mut best: Option<Located<2>> = None;
        self.tree.visit_near(point, reach, |cell, reach| {
            let found = self.place_in(CellId::new(cell), point);
            if found.distance <= *reach && best.is_none_or(|b| found.distance < b.distance) {
                best = Some(found);
                *reach = found.distance;
            }
            found.distance == 0.0
        });
        best
    }

    /// Where a point is with respect to one cell.
    fn place_in(&self, cell: CellId, point: Point<2>) -> Located<2> {
        let [a, b, c] = std::array::from_fn(|i| self.corners[3 * cell.index() + i]);
        let (u, v, w) = (b - a, c - a, point - a);
        let det = cross(u, v);
        let straight = [cross(w, v) / det, cross(u, w) / det];
        let six: Option<[Point<2>; 6]> = (self.curved[cell] != STRAIGHT)
            .then(|| std::array::from_fn(|i| self.quadratic[self.curved[cell] as usize + i]));
        let found = match &six {
            Some(six) => invert_quadratic(six, point, straight, FOUND * (u.norm() + v.norm())),
            None => Some(straight),
        };
        // The simplex itself with a little rounding, so that no point falls between two cells
        const ROUNDING: f64 = 1e-12;
        let reference = found.unwrap_or(straight);
        let [x, y] = reference;
        if found.is_some() && x >= -ROUNDING && y >= -ROUNDING && x + y <= 1.0 + ROUNDING {
            return Located { cell, reference, distance: 0.0 };
        }
        let metric = [u.dot(&u), u.dot(&v), v.dot(&v)];
        let (inside, place) = match &six {
            Some(six) => nearest_in_quadratic(six, point, reference, metric),
            None => {
                let inside = nearest_in_simplex(reference, metric);
                (inside, a + u * inside[0] + v * inside[1])
            }
        };
        let reference = if found.is_some() { reference } else { inside };
        Located { cell, reference, distance: (point - place).norm() }
    }
}

/// Reference coordinates of a point in a curved cell, by Newton's method from those of the
/// straight one; `None` when the map degenerates on the way, as it may far outside the cell.
fn invert_quadratic(
    nodes: &[Point<2>; 6],
    point: Point<2>,
    start: [f64; 2],
    tolerance: f64,
) -> Option<[f64; 2]> {
    let mut at = start.map(|x| x.clamp(-0.5, 1.5));
    for _ in 0..30 {
        let (place, [first, second]) = map_quadratic(nodes, at);
        let (miss, det) = (point - place, cross(first, second));
        if det <= 0.0 {
            return None;
        }
        let step = [cross(miss, second) / det, cross(first, miss) / det];
        let length = step[0].hypot(step[1]);
        let damping = (0.5 / length).min(1.0);
        at = [at[0] + damping * step[0], at[1] + damping * step[1]];
        if length < 1e-15 {
            break;
        }
    }
    let miss = (point - map_quadratic(nodes, at).0).norm();
    (miss <= tolerance).then_some(at)
}

/// Nearest point of a curved cell to a point outside: reference coordinates and place.
///
/// Steps along the sides in the metric of the Jacobian there, from the nearest point of the
/// straight cell; a few suffice, as a side turns little.
fn nearest_in_quadratic(
    nodes: &[Point<2>; 6],
    point: Point<2>,
    start: [f64; 2],
    metric: [f64; 3],
) -> ([f64; 2], Point<2>) {
    let mut best = nearest_in_simplex(start, metric);
    let mut place = map_quadratic(nodes, best).0;
    for _ in 0..4 {
        let (at, [u, v]) = map_quadratic(nodes, best);
        let (det, miss) = (cross(u, v), point - at);
        if det <= 0.0 {
            break;
        }
        let wanted = [best[0] + cross(miss, v) / det, best[1] + cross(u, miss) / det];
        let next = nearest_in_simplex(wanted, [u.dot(&u), u.dot(&v), v.dot(&v)]);
        let there = map_quadratic(nodes, next).0;
        if (point - there).norm() >= (point - place).norm() {
            break;
        }
        (best, place) = (next, there);
    }
    (best, place)
}

/// Nearest point of the reference triangle in the metric [uu, uv, vv] of the physical one.
fn nearest_in_simplex([x, y]: [f64; 2], [uu, uv, vv]: [f64; 3]) -> [f64; 2] {
    let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    let dot = |a: [f64; 2], b: [f64; 2]| {
        uu * a[0] * b[0] + uv * (a[0] * b[1] + a[1] * b[0]) + vv * a[1] * b[1]
    };
    let mut best = (f64::INFINITY, [0.0; 2]);
    for side in 0..3 {
        let (a, b) = (corners[side], corners[(side + 1) % 3]);
        let along = [b[0] - a[0], b[1] - a[1]];
        let t = (dot([x - a[0], y - a[1]], along) / dot(along, along)).clamp(0.0, 1.0);
        let place = [a[0] + t * along[0], a[1] + t * along[1]];
        let miss = [x - place[0], y - place[1]];
        let gap = dot(miss, miss);
        if gap < best.0 {
            best = (gap, place);
        }
    }
    best.1
}

/// A tree of axis-parallel boxes.
#[derive(Debug, Clone)]
struct BoxTree<const D: usize> {
    nodes: Vec<BoxNode<D>>,
    /// Indices of the boxes in the order of the leaves.
    order: Vec<u32>,
}

#[derive(Debug, Clone, Copy)]
struct BoxNode<const D: usize> {
    min: Point<D>,
    max: Point<D>,
    from: u32,
    to: u32,
    /// Right child, the left one follows its parent; zero in a leaf.
    right: u32,
}

impl<const D: usize> BoxTree<D> {
    fn new(boxes: &[(Point<D>, Point<D>)]) -> Self {
        let mut tree = Self { nodes: Vec::new(), order: (0..boxes.len() as u32).collect() };
        if !boxes.is_empty() {
            tree.split(boxes, 0, boxes.len());
        }
        tree
    }

    fn split(&mut self, boxes: &[(Point<D>, Point<D>)], from: usize, to: usize) {
        let part = &mut self.order[from..to];
        let (mut min, mut max) = boxes[part[0] as usize];
        for i in part.iter() {
            min = min.inf(&boxes[*i as usize].0);
            max = max.sup(&boxes[*i as usize].1);
        }
        let index = self.nodes.len();
        self.nodes.push(BoxNode { min, max, from: from as u32, to: to as u32, right: 0 });
        if part.len() <= LEAF {
            return;
        }
        let axis = (max - min).imax();
        let middle = part.len() / 2;
        let key = |i: &u32| boxes[*i as usize].0[axis] + boxes[*i as usize].1[axis];
        part.select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
        self.split(boxes, from, from + middle);
        self.nodes[index].right = self.nodes.len() as u32;
        self.split(boxes, from + middle, to);
    }

    /// Longest side of the box around all.
    fn extent(&self) -> f64 {
        self.nodes.first().map_or(0.0, |root| (root.max - root.min).max())
    }

    /// Square of the distance from a point to a box.
    fn gap(&self, node: u32, point: &Point<D>) -> f64 {
        let node = &self.nodes[node as usize];
        (0..D).fold(0.0, |sum, axis| {
            let below = node.min[axis] - point[axis];
            let above = point[axis] - node.max[axis];
            // Unlike f64::max, the comparison keeps what is not a number
            let outside = if below > 0.0 { below } else { above };
            if outside <= 0.0 { sum } else { sum + outside * outside }
        })
    }

    /// Visits boxes within reach of a point, near ones first, until `visit` returns true; `visit`
    /// may shorten the reach.
    fn visit_near(
        &self,
        point: Point<D>,
        mut reach: f64,
        mut visit: impl FnMut(usize, &mut f64) -> bool,
    ) {
        // Halving leaves at most one box a level waiting, and two at the last
        let mut stack = [(0, 0.0); MOST_LEVELS + 1];
        let mut waiting = usize::from(!self.nodes.is_empty());
        if waiting > 0 {
            stack[0].1 = self.gap(0, &point);
        }
        while waiting > 0 {
            waiting -= 1;
            let (index, gap) = stack[waiting];
            // Also refuses a gap that is not a number
            if gap.is_nan() || gap > reach * reach {
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.right == 0 {
                for cell in &self.order[node.from as usize..node.to as usize] {
                    if visit(*cell as usize, &mut reach) {
                        return;
                    }
                }
                continue;
            }
            let left = (index + 1, self.gap(index + 1, &point));
            let right = (node.right, self.gap(node.right, &point));
            let (near, far) = if left.1 <= right.1 { (left, right) } else { (right, left) };
            for child in [far, near] {
                if child.1 <= reach * reach {
                    stack[waiting] = child;
                    waiting += 1;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Domain, PlacedShape, Shape, Sizing, generate};

    fn channel() -> Mesh<2> {
        let domain = Domain::Box {
            min: Point::<2>::zeros(),
            max: Point::<2>::new(2.2, 0.41),
            periodic_x: false,
            periodic_y: false,
        };
        let disc = PlacedShape {
            name: "disc".into(),
            shape: Shape::Disc { radius: 0.05 },
            center: Point::<2>::new(0.2, 0.2),
            angle: 0.0,
            size: None,
        };
        generate(&domain, &[disc], &Sizing::graded(0.02, 0.2, 0.08)).unwrap()
    }

    #[test]
    fn the_image_of_a_reference_point_is_found_there() {
        let mesh = channel();
        let locator = Locator::new(&mesh);
        for cell in mesh.cell_ids() {
            let nodes = mesh.cell_nodes(cell);
            for at in [[0.3, 0.3], [0.05, 0.9], [0.5, 0.02], [0.02, 0.02]] {
                let (place, _) = map_quadratic(&nodes, at);
                let (found, reference) = locator.locate(place).unwrap();
                assert_eq!(found, cell);
                assert!((reference[0] - at[0]).hypot(reference[1] - at[1]) < 1e-12);
            }
        }
    }

    #[test]
    fn every_node_is_found_and_points_outside_are_not() {
        let mesh = channel();
        let locator = Locator::new(&mesh);
        for node in &mesh.nodes {
            let (cell, at) = locator.locate(*node).expect("nodes are in the mesh");
            let (place, _) = map_quadratic(&mesh.cell_nodes(cell), at);
            assert!((place - node).norm() < 1e-13);
        }
        for (x, y) in [(0.2, 0.2), (0.2, 0.2 + 0.0499), (-1e-6, 0.2), (1.0, 0.42), (f64::NAN, 0.0)]
        {
            assert!(locator.locate(Point::<2>::new(x, y)).is_none(), "({x}, {y})");
        }
        assert!(locator.locate(Point::<2>::new(-1e-10, 0.2)).is_some());
    }

    #[test]
    fn points_just_inside_the_body_are_nearest_to_its_surface() {
        let mesh = channel();
        let locator = Locator::new(&mesh);
        for i in 0..100 {
            let (sin, cos) = (0.0628 * f64::from(i)).sin_cos();
            let point = Point::<2>::new(0.2 + 0.045 * cos, 0.2 + 0.045 * sin);
            let found = locator.nearest(point).unwrap();
            assert!((found.distance - 0.005).abs() < 1e-4, "{}", found.distance);
        }
    }
}
