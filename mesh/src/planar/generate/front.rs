//! Interior points: a front that starts at the boundary and lays equilateral triangles of size h.

use std::collections::VecDeque;
use std::f64::consts::FRAC_PI_3;

use super::edges::BoundaryEdges;
use super::point_tree::PointTree;
use crate::number::index_u32;
use crate::planar::torus::Torus;
use crate::planar::vector::cross;
use crate::{MeshError, Point, SizeField, interrupt};

/// Largest number of interior points.
const MOST_POINTS: usize = 10_000_000;

/// A point is laid only where no other is nearer than this many h.
const CLEARANCE: f64 = 0.72;

/// A point keeps this distance from boundary edges, in h.
const STANDOFF: f64 = 0.5;

/// Points with the size wanted there.
#[derive(Debug, Clone, Default)]
pub struct SizedPoints {
    /// Places (m).
    pub points: Vec<Point<2>>,
    /// Wanted edge lengths (m).
    pub sizes: Vec<f64>,
}

/// Points for the inside of the domain, about h(x) from each other and from the boundary.
///
/// Every boundary edge proposes the apex of its equilateral triangle; every accepted point then
/// proposes its six neighbours in the directions of its parent, first come first served.
///
/// # Errors
/// [`MeshError::TooManyCells`].
pub fn advance_front(
    boundary: &BoundaryEdges,
    sizes: &SizeField,
    torus: Torus,
) -> Result<SizedPoints, MeshError> {
    let mut front = Front {
        guard: BoundaryGuard::new(boundary, torus),
        tree: PointTree::new(&boundary.points, torus),
        laid: SizedPoints::default(),
        waiting: VecDeque::new(),
    };
    for edge in &boundary.edges {
        let [a, b] = edge.vertices.map(|v| boundary.points[v as usize]);
        let b = torus.beside(b, a);
        let (middle, length) = ((a + b) * 0.5, (b - a).norm());
        let along = (b - a) / length;
        let inward = Point::<2>::new(-along.y, along.x);
        let h = 0.5 * (length + sizes.at(middle + inward * length));
        let place = middle + inward * (0.5 * 3.0_f64.sqrt() * h);
        front.try_insert(place, h, along);
    }
    // Nothing nearer than this can be accepted, whatever the size turns out to be
    let growth = sizes.growth();
    let surely_taken = (CLEARANCE * (1.0 - growth) - 0.5 * growth).max(0.2);
    while let Some((from, h, direction)) = front.waiting.pop_front() {
        if interrupt::is_requested() {
            return Err(MeshError::Stopped);
        }
        for k in 0..6 {
            let (sin, cos) = (FRAC_PI_3 * f64::from(k)).sin_cos();
            let way = Point::<2>::new(
                cos * direction.x - sin * direction.y,
                sin * direction.x + cos * direction.y,
            );
            let guess = from + way * h;
            if front.tree.any_within(guess, surely_taken * h, |_| true) {
                continue;
            }
            // A step is as long as the mean of the sizes at its ends
            let step = 0.5 * (h + sizes.at_from(guess, from, h));
            let size = sizes.at_from(from + way * step, from, h);
            front.try_insert(from + way * (0.5 * (h + size)), size, way);
            if front.laid.points.len() > MOST_POINTS {
                return Err(MeshError::TooManyCells {
                    what: "interior points",
                    limit: MOST_POINTS,
                    smallest: sizes.smallest(),
                });
            }
        }
    }
    Ok(front.laid)
}

/// The points laid so far and those that still have to propose their neighbours.
struct Front<'a> {
    guard: BoundaryGuard<'a>,
    tree: PointTree,
    laid: SizedPoints,
    /// Place, size and direction.
    waiting: VecDeque<(Point<2>, f64, Point<2>)>,
}

impl Front<'_> {
    /// Lays a point if nothing is too near.
    fn try_insert(&mut self, place: Point<2>, h: f64, direction: Point<2>) {
        let place = self.guard.torus.inside(place);
        if self.tree.any_within(place, CLEARANCE * h, |_| true) || !self.guard.is_clear(place, h) {
            return;
        }
        self.tree.insert(place);
        self.laid.points.push(place);
        self.laid.sizes.push(h);
        self.waiting.push_back((place, h, direction));
    }
}

/// The boundary edges, to keep points inside and off them.
struct BoundaryGuard<'a> {
    boundary: &'a BoundaryEdges,
    torus: Torus,
    tree: PointTree,
    /// Edges that end and start at each vertex.
    around: Vec<[u32; 2]>,
}

impl<'a> BoundaryGuard<'a> {
    fn new(boundary: &'a BoundaryEdges, torus: Torus) -> Self {
        let mut around = vec![[0; 2]; boundary.points.len()];
        for (i, edge) in boundary.edges.iter().enumerate() {
            around[edge.vertices[1] as usize][0] = index_u32(i);
            around[edge.vertices[0] as usize][1] = index_u32(i);
        }
        Self { boundary, torus, tree: PointTree::new(&boundary.points, torus), around }
    }

    /// Whether a point about h from a point inside is itself inside and off the boundary edges.
    fn is_clear(&self, place: Point<2>, h: f64) -> bool {
        // Edges are at most a little longer than h, so the one crossed has an end in this radius
        let mut nearest = (f64::INFINITY, 0.0_f64);
        self.tree.any_within(place, 2.5 * h, |vertex| {
            for edge in self.around[vertex] {
                let [a, b] = self.boundary.edges[edge as usize]
                    .vertices
                    .map(|v| self.boundary.points[v as usize]);
                let a = self.torus.beside(a, place);
                let along = self.torus.beside(b, a) - a;
                let t = ((place - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
                let gap = (place - a - along * t).norm();
                let side = cross(along, place - a) / along.norm();
                // At a shared end the edge seen more from its face decides about the side
                let tie = (gap - nearest.0).abs() <= 1e-12 * h;
                if (!tie && gap < nearest.0) || (tie && side.abs() > nearest.1.abs()) {
                    nearest = (gap, side);
                }
            }
            false
        });
        nearest.0 == f64::INFINITY || (nearest.1 > 0.0 && nearest.0 > STANDOFF * h)
    }
}
