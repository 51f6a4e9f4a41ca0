//! A quadtree of points that grows: is any point within a radius?

use crate::Point;
use crate::number::index_u32;
use crate::planar::torus::Torus;

/// Points in one leaf before it is split.
const LEAF: usize = 12;

/// Quadtree over a fixed square.
#[derive(Debug, Clone)]
pub struct PointTree {
    nodes: Vec<Node>,
    points: Vec<Point<2>>,
    center: Point<2>,
    half: f64,
    torus: Torus,
    /// To all images of a point that may be near one in the square, itself first (m).
    shifts: Vec<Point<2>>,
}

#[derive(Debug, Clone)]
enum Node {
    Leaf(Vec<u32>),
    /// Index of the first of four children, in order (low, low), (high, low), (low, high), ...
    Branch(u32),
}

/// The square of a node.
struct Square {
    node: usize,
    center: Point<2>,
    half: f64,
}

impl PointTree {
    /// Empty tree over the square around all `points`, or around the box of a torus; the points are then
    /// inserted.
    pub fn new(points: &[Point<2>], torus: Torus) -> Self {
        let (mut min, mut max) = (points[0], points[0]);
        if torus.is_closed() {
            [min, max] = torus.corners();
        }
        for point in points.iter().map(|point| torus.inside(*point)) {
            min = min.inf(&point);
            max = max.sup(&point);
        }
        let half = 0.5 * (max - min).max();
        let mut tree = Self {
            nodes: vec![Node::Leaf(Vec::new())],
            points: Vec::new(),
            center: (min + max) * 0.5,
            half,
            torus,
            shifts: torus.periods().shifts(),
        };
        for point in points {
            tree.insert(*point);
        }
        tree
    }

    /// Adds a point; its index is the number of points before it.
    pub fn insert(&mut self, point: Point<2>) {
        let index = index_u32(self.points.len());
        let point = self.torus.inside(point);
        self.points.push(point);
        let (mut node, mut center, mut half) = (0, self.center, self.half);
        let mut depth = 0;
        while let Node::Branch(first) = self.nodes[node] {
            let child = child_of(center, point);
            half *= 0.5;
            center = child_center(center, half, child);
            node = first as usize + child;
            depth += 1;
        }
        let children = index_u32(self.nodes.len());
        let Node::Leaf(held) = &mut self.nodes[node] else {
            unreachable!("the loop ends at a leaf")
        };
        held.push(index);
        if held.len() <= LEAF || depth > 60 {
            return;
        }
        let held = std::mem::take(held);
        self.nodes[node] = Node::Branch(children);
        let mut parts: [Vec<u32>; 4] = Default::default();
        for i in held {
            parts[child_of(center, self.points[i as usize])].push(i);
        }
        self.nodes.extend(parts.map(Node::Leaf));
    }

    /// Calls `visit` with the points of which an image is within a radius until it returns true; whether it did.
    pub fn any_within(
        &self,
        point: Point<2>,
        radius: f64,
        mut visit: impl FnMut(usize) -> bool,
    ) -> bool {
        let root = Square { node: 0, center: self.center, half: self.half };
        let point = self.torus.inside(point);
        self.shifts.iter().any(|shift| self.any_in(&root, point + shift, radius, &mut visit))
    }

    fn any_in(
        &self,
        square: &Square,
        point: Point<2>,
        radius: f64,
        visit: &mut impl FnMut(usize) -> bool,
    ) -> bool {
        let away = (point - square.center).abs();
        let reach = square.half + radius;
        if away.x > reach || away.y > reach {
            return false;
        }
        match &self.nodes[square.node] {
            Node::Leaf(held) => held.iter().any(|i| {
                let near = (self.points[*i as usize] - point).norm_squared();
                near < radius * radius && visit(*i as usize)
            }),
            Node::Branch(first) => (0..4).rev().any(|child| {
                let half = 0.5 * square.half;
                let center = child_center(square.center, half, child);
                let node = *first as usize + child;
                self.any_in(&Square { node, center, half }, point, radius, visit)
            }),
        }
    }
}

fn child_of(center: Point<2>, point: Point<2>) -> usize {
    usize::from(point.x >= center.x) + 2 * usize::from(point.y >= center.y)
}

fn child_center(center: Point<2>, half: f64, child: usize) -> Point<2> {
    let sign = |bit: usize| if child & bit == 0 { -half } else { half };
    Point::<2>::new(center.x + sign(1), center.y + sign(2))
}
