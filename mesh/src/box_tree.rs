//! `BoxTree`: axis-parallel boxes in a binary tree, to find those near a point.

use crate::Point;
use crate::number::index_u32;

/// Levels of the tree of 2^32 boxes.
const MAX_LEVELS: usize = 33;

/// Boxes in one leaf.
const LEAF: usize = 4;

/// An axis-parallel box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds<const D: usize> {
    /// Lower corner (m).
    pub min: Point<D>,
    /// Upper corner (m).
    pub max: Point<D>,
}

impl<const D: usize> Bounds<D> {
    /// The box around points; turned inside out without any.
    pub fn around<'a>(points: impl IntoIterator<Item = &'a Point<D>>) -> Self {
        let mut bounds =
            Self { min: Point::repeat(f64::INFINITY), max: Point::repeat(f64::NEG_INFINITY) };
        for point in points {
            bounds.include(point);
        }
        bounds
    }

    /// Extends the box to a point.
    pub fn include(&mut self, point: &Point<D>) {
        self.min = self.min.inf(point);
        self.max = self.max.sup(point);
    }

    /// Square of the distance from a point (m²), zero inside.
    pub fn squared_distance(&self, point: &Point<D>) -> f64 {
        (0..D).fold(0.0, |sum, axis| {
            let below = self.min[axis] - point[axis];
            let above = point[axis] - self.max[axis];
            // Unlike f64::max, the comparison keeps what is not a number
            let outside = if below > 0.0 { below } else { above };
            if outside <= 0.0 { sum } else { sum + outside * outside }
        })
    }
}

/// A tree of axis-parallel boxes.
#[derive(Debug, Clone)]
pub struct BoxTree<const D: usize> {
    nodes: Vec<Node<D>>,
    /// Indices of the boxes in the order of the leaves.
    order: Vec<u32>,
}

#[derive(Debug, Clone, Copy)]
struct Node<const D: usize> {
    bounds: Bounds<D>,
    from: u32,
    to: u32,
    /// Right child, the left one follows its parent; zero in a leaf.
    right: u32,
}

impl<const D: usize> BoxTree<D> {
    /// The tree of these boxes, which are known by their index.
    pub fn new(boxes: &[Bounds<D>]) -> Self {
        let mut tree = Self { nodes: Vec::new(), order: (0..index_u32(boxes.len())).collect() };
        if !boxes.is_empty() {
            tree.split(boxes, 0, boxes.len());
        }
        tree
    }

    fn split(&mut self, boxes: &[Bounds<D>], from: usize, to: usize) {
        let part = &mut self.order[from..to];
        let corners = part.iter().flat_map(|i| [&boxes[*i as usize].min, &boxes[*i as usize].max]);
        let bounds = Bounds::around(corners);
        let index = self.nodes.len();
        self.nodes.push(Node { bounds, from: index_u32(from), to: index_u32(to), right: 0 });
        if part.len() <= LEAF {
            return;
        }
        let axis = (bounds.max - bounds.min).imax();
        let middle = part.len() / 2;
        let key = |i: &u32| boxes[*i as usize].min[axis] + boxes[*i as usize].max[axis];
        part.select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
        self.split(boxes, from, from + middle);
        self.nodes[index].right = index_u32(self.nodes.len());
        self.split(boxes, from + middle, to);
    }

    /// Longest side of the box around all (m).
    pub fn extent(&self) -> f64 {
        self.nodes.first().map_or(0.0, |root| (root.bounds.max - root.bounds.min).max())
    }

    fn gap(&self, node: u32, point: &Point<D>) -> f64 {
        self.nodes[node as usize].bounds.squared_distance(point)
    }

    /// Visits boxes whose branch is within reach of a point (m), near branches first, until `visit`
    /// returns true; `visit` may shorten the reach.
    pub fn visit_near(
        &self,
        point: Point<D>,
        mut reach: f64,
        mut visit: impl FnMut(usize, &mut f64) -> bool,
    ) {
        // Halving leaves at most one box a level waiting, and two at the last
        let mut stack = [(0, 0.0); MAX_LEVELS + 1];
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
