//! Triangles inside a polygon or an outline, for elastic bodies (spade's refinement after Ruppert).

use spade::{
    AngleLimit, ConstrainedDelaunayTriangulation, HasPosition as _, Point2, RefinementParameters,
    Triangulation as _,
};

use crate::number::whole;
use crate::{MeshError, Outline, Point};

/// Smallest angle of a triangle that is aimed at (degrees).
const ANGLE: f64 = 25.0;

/// Points of an outline by which its length is measured.
const FINE: usize = 4096;

/// Vertices inside of a boundary at most, of what fits in.
const MOST: f64 = 20.0;

/// Triangles.
#[derive(Debug, Clone, PartialEq)]
pub struct Triangles {
    /// Their vertices (m).
    pub points: Vec<Point<2>>,
    /// Three vertices each, counter-clockwise.
    pub cells: Vec<[usize; 3]>,
}

/// Points of an outline that are evenly apart, by this size (m) at most; counter-clockwise.
#[must_use]
pub fn points_of_outline(outline: &Outline, size: f64) -> Vec<Point<2>> {
    let period = outline.period();
    let at = |k: usize| outline.at(period * k as f64 / FINE as f64)[0];
    let mut lengths = vec![0.0];
    for k in 0..FINE {
        lengths.push(lengths[k] + (at(k + 1) - at(k)).norm());
    }
    let length = lengths[FINE];
    let n = whole((length / size).ceil()).clamp(3, FINE);
    (0..n)
        .map(|point| {
            let wanted = length * point as f64 / n as f64;
            at(lengths.partition_point(|way| *way < wanted))
        })
        .collect()
}

/// Triangles of about this size (m) inside a polygon, whose sides are divided; a corner stays one.
///
/// # Errors
/// [`MeshError::Boundary`] where its sides cross or corners coincide, or where it cannot be filled.
pub fn triangulate_inside(corners: &[Point<2>], size: f64) -> Result<Triangles, MeshError> {
    let n = corners.len();
    let mut boundary: Vec<Point<2>> = Vec::new();
    for (k, from) in corners.iter().enumerate() {
        let way = corners[(k + 1) % n] - from;
        let pieces = (way.norm() / size).ceil().max(1.0);
        for piece in 0..whole(pieces) {
            boundary.push(from + way * (piece as f64 / pieces));
        }
    }
    let n = boundary.len();
    let refuse = |vertex: usize, reason| {
        let at = boundary[vertex.min(n - 1)];
        MeshError::Boundary { x: at[0], y: at[1], reason }
    };
    let vertices = boundary.iter().map(|x| Point2::new(x[0], x[1])).collect();
    let sides = (0..n).map(|k| [k, (k + 1) % n]).collect();
    let mut crossing = None;
    let mut cdt = ConstrainedDelaunayTriangulation::<Point2<f64>>::try_bulk_load_cdt(
        vertices,
        sides,
        |side| crossing = crossing.or(Some(side[0])),
    )
    .map_err(|_| refuse(0, "a coordinate is not finite, or too large"))?;
    if let Some(vertex) = crossing {
        return Err(refuse(vertex, "boundary edges cross"));
    }
    if cdt.num_vertices() != n {
        return Err(refuse(0, "two vertices coincide"));
    }
    let area = area(&boundary).abs();
    let most = MOST * (area / (size * size) + n as f64) + 1e3;
    let parameters = RefinementParameters::new()
        .exclude_outer_faces(true)
        .with_angle_limit(AngleLimit::from_deg(ANGLE))
        .with_max_allowed_area(0.6 * size * size)
        .with_max_additional_vertices(whole(most));
    let refined = cdt.refine(parameters);
    let outer: std::collections::BTreeSet<usize> =
        refined.excluded_faces.iter().map(|face| face.index()).collect();
    let points: Vec<Point<2>> = cdt
        .vertices()
        .map(|vertex| {
            let at = vertex.data().position();
            Point::<2>::new(at.x, at.y)
        })
        .collect();
    let cells: Vec<[usize; 3]> = cdt
        .inner_faces()
        .filter(|face| !outer.contains(&face.fix().index()))
        .map(|face| face.vertices().map(|vertex| vertex.fix().index()))
        .collect();
    if cells.is_empty() {
        return Err(refuse(0, "the boundary has no inside"));
    }
    Ok(used(&points, &cells))
}

/// The same without vertices that no cell has.
fn used(points: &[Point<2>], cells: &[[usize; 3]]) -> Triangles {
    let mut number = vec![usize::MAX; points.len()];
    cells.iter().flatten().for_each(|vertex| number[*vertex] = 0);
    let mut kept = Vec::new();
    for (vertex, place) in number.iter_mut().enumerate().filter(|(_, place)| **place == 0) {
        *place = kept.len();
        kept.push(points[vertex]);
    }
    let cells = cells.iter().map(|cell| cell.map(|vertex| number[vertex])).collect();
    Triangles { points: kept, cells }
}

/// Area of a polygon (m2), positive where it is counter-clockwise.
fn area(corners: &[Point<2>]) -> f64 {
    let pairs = corners.iter().zip(corners.iter().cycle().skip(1));
    pairs.map(|(a, b)| 0.5 * (a[0] * b[1] - a[1] * b[0])).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filled(corners: &[[f64; 2]], size: f64) -> Result<Triangles, MeshError> {
        let corners: Vec<Point<2>> = corners.iter().map(|x| Point::<2>::from(*x)).collect();
        triangulate_inside(&corners, size)
    }

    fn area_of(found: &Triangles) -> f64 {
        found.cells.iter().map(|cell| area(&cell.map(|vertex| found.points[vertex]))).sum()
    }

    #[test]
    fn polygons_are_filled_whichever_way_round_and_with_the_same_bits() {
        let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 0.4], [0.0, 1.0]];
        let found = filled(&corners, 0.1).unwrap();
        assert!((area_of(&found) - 1.4).abs() < 1e-12);
        assert!(found.cells.len() > 200 && found.cells.len() < 1500, "{}", found.cells.len());
        let turned: Vec<[f64; 2]> = corners.iter().rev().copied().collect();
        assert!((area_of(&filled(&turned, 0.1).unwrap()) - 1.4).abs() < 1e-12);
        assert_eq!(filled(&corners, 0.1).unwrap(), found);
    }

    #[test]
    fn polygons_that_cross_themselves_are_refused() {
        let said = filled(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]], 0.3).unwrap_err();
        assert!(matches!(said, MeshError::Boundary { .. }), "{said}");
    }
}
