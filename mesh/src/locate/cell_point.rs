//! `CellPoint`: reference coordinates of a point in a cell, and the point of a cell nearest to it.

use crate::mesh::{determinant, map_quadratic};
use crate::{Point, Simplex};

/// A point of a cell.
#[derive(Debug, Clone, Copy)]
pub struct CellPoint<const D: usize> {
    /// Reference coordinates.
    pub reference: [f64; D],
    /// Where it is (m).
    pub position: Point<D>,
}

/// Newton's step (reference coordinates) after which only rounding is left.
const CONVERGED: f64 = 1e-9;

/// Solution of Σ x_k column_k = right, by Cramer's rule.
pub fn solve<const D: usize>(columns: &[Point<D>; D], right: Point<D>, det: f64) -> [f64; D] {
    std::array::from_fn(|k| {
        let mut replaced = *columns;
        replaced[k] = right;
        determinant(&replaced) / det
    })
}

/// Reference coordinates of a point in a curved cell, by Newton's method from those of the
/// straight one; `None` when the map degenerates on the way, as it may far outside the cell.
pub fn invert_quadratic<const D: usize>(
    nodes: &[Point<D>],
    point: Point<D>,
    start: [f64; D],
    tolerance: f64,
) -> Option<[f64; D]> {
    let mut at = start.map(|x| x.clamp(-0.5, 1.5));
    for _ in 0..30 {
        let map = map_quadratic(nodes, at);
        let det = map.det_jacobian();
        if det <= 0.0 {
            return None;
        }
        let step = solve(&map.columns, point - map.position, det);
        let length = step.iter().map(|x| x * x).sum::<f64>().sqrt();
        let damping = (0.5 / length).min(1.0);
        for (x, step) in at.iter_mut().zip(step) {
            *x += damping * step;
        }
        // The next step has the size of the square of this one
        if length < CONVERGED {
            break;
        }
    }
    let miss = (point - map_quadratic(nodes, at).position).norm();
    (miss <= tolerance).then_some(at)
}

/// Nearest point of a curved cell to a point outside.
///
/// Steps along the sides in the metric of the Jacobian there, from the nearest point of the
/// straight cell, whose Jacobian has these columns; a few suffice, as a side turns little.
pub fn nearest_in_quadratic<const D: usize>(
    nodes: &[Point<D>],
    point: Point<D>,
    start: [f64; D],
    columns: &[Point<D>; D],
) -> CellPoint<D> {
    let at =
        |reference| CellPoint { reference, position: map_quadratic(nodes, reference).position };
    let mut best = at(nearest_in_simplex(start, columns));
    for _ in 0..4 {
        let map = map_quadratic(nodes, best.reference);
        let det = map.det_jacobian();
        if det <= 0.0 {
            break;
        }
        let step = solve(&map.columns, point - map.position, det);
        let wanted = std::array::from_fn(|k| best.reference[k] + step[k]);
        let next = at(nearest_in_simplex(wanted, &map.columns));
        if (point - next.position).norm() >= (point - best.position).norm() {
            break;
        }
        best = next;
    }
    best
}

/// Nearest point on the boundary of the reference simplex in the metric of a Jacobian with these
/// columns.
pub fn nearest_in_simplex<const D: usize>(point: [f64; D], columns: &[Point<D>; D]) -> [f64; D] {
    let vertex = |i: usize| std::array::from_fn(|axis| f64::from(u8::from(axis + 1 == i)));
    let minus = |a: [f64; D], b: [f64; D]| std::array::from_fn(|k| a[k] - b[k]);
    let dot = |a: [f64; D], b: [f64; D]| {
        let mut sum = 0.0;
        for i in 0..D {
            sum += columns[i].dot(&columns[i]) * a[i] * b[i];
            for j in i + 1..D {
                sum += columns[i].dot(&columns[j]) * (a[i] * b[j] + a[j] * b[i]);
            }
        }
        sum
    };
    let mut best = (f64::INFINITY, [0.0; D]);
    let mut offer = |at: [f64; D]| {
        let miss = minus(point, at);
        let gap = dot(miss, miss);
        if gap < best.0 {
            best = (gap, at);
        }
    };
    for &[i, j] in Simplex::<D>::EDGES {
        let (a, b): ([f64; D], [f64; D]) = (vertex(i), vertex(j));
        let along = minus(b, a);
        let t = (dot(minus(point, a), along) / dot(along, along)).clamp(0.0, 1.0);
        offer(std::array::from_fn(|k| a[k] + t * along[k]));
    }
    if D == 3 {
        for face in Simplex::<D>::FACETS {
            let [a, b, c]: [[f64; D]; 3] = [0, 1, 2].map(|i| vertex(face[i]));
            let (u, v, w) = (minus(b, a), minus(c, a), minus(point, a));
            // The foot of the perpendicular in the plane of the face, where it is in the face
            let (uu, uv, vv) = (dot(u, u), dot(u, v), dot(v, v));
            let (uw, vw) = (dot(u, w), dot(v, w));
            let det = uu * vv - uv * uv;
            let (s, t) = ((vv * uw - uv * vw) / det, (uu * vw - uv * uw) / det);
            if s >= 0.0 && t >= 0.0 && s + t <= 1.0 {
                offer(std::array::from_fn(|k| a[k] + s * u[k] + t * v[k]));
            }
        }
    }
    best.1
}
