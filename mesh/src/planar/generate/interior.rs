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

/// How far the middle of an edge may be from the outline, of the length of the edge: an arc of a quarter of a circle has
/// 0.21.
const BULGE: f64 = 0.25;

/// Largest part of that way along the edge, of its length: a place farther off is on another part of the outline.
const ALONG: f64 = 0.1;

/// Part of an edge that an outline does not follow to which it is halved at most: a tip of any sharpness ends there.
const SHORTEST: f64 = 1.0 / 64.0;

/// The way (m) of the middle of an edge onto an outline that its ends are on; none where the outline does not follow the
/// edge, as at a tip sharper than it is long.
#[must_use]
pub fn bulge(outline: &Outline, [from, to]: [Point<2>; 2]) -> Option<Point<2>> {
    let (edge, middle) = (to - from, (from + to) * 0.5);
    let way = outline.nearest(middle).point - middle;
    let along = way.dot(&edge).abs();
    let follows = way.norm() <= BULGE * edge.norm() && along <= ALONG * edge.norm_squared();
    follows.then_some(way)
}

/// Points of an outline that are evenly apart, by this size (m) at most, nearer at tips that edges of this size do not
/// follow; of a polygon its corners, and each side divided evenly. Counter-clockwise.
#[must_use]
pub fn points_of_outline(outline: &Outline, size: f64) -> Vec<Point<2>> {
    if outline.is_polygon() {
        let sides = 0..outline.n_pieces();
        return sides.flat_map(|side| points_of_side(outline, side, size)).collect();
    }
    let period = outline.period();
    let at = |k: usize| outline.at(period * k as f64 / FINE as f64)[0];
    let mut lengths = vec![0.0];
    for k in 0..FINE {
        lengths.push(lengths[k] + (at(k + 1) - at(k)).norm());
    }
    let length = lengths[FINE];
    let n = whole((length / size).ceil()).clamp(3, FINE);
    let place = |wanted: f64| at(lengths.partition_point(|way| *way < wanted));
    let step = length / n as f64;
    let mut points = Vec::new();
    for nth in 0..n {
        // By where they begin, as the even ones are, so that these keep their places
        let ends = [nth, nth + 1].map(|nth| length * nth as f64 / n as f64);
        points.push(place(ends[0]));
        halve(outline, &place, ends, SHORTEST * step, &mut points);
    }
    points
}

/// Adds the points between two lengths along an outline that it takes to follow it.
fn halve(
    outline: &Outline,
    place: &dyn Fn(f64) -> Point<2>,
    ends: [f64; 2],
    shortest: f64,
    points: &mut Vec<Point<2>>,
) {
    let [from, to] = ends;
    if bulge(outline, ends.map(place)).is_some() || to - from < 2.0 * shortest {
        return;
    }
    let middle = 0.5 * (from + to);
    halve(outline, place, [from, middle], shortest, points);
    points.push(place(middle));
    halve(outline, place, [middle, to], shortest, points);
}

/// The corner that a side of a polygon begins with, and points that divide it.
fn points_of_side(outline: &Outline, side: usize, size: f64) -> Vec<Point<2>> {
    let [from, to] = [0.0, 1.0].map(|part| outline.evaluate(side, part)[0]);
    let n = whole(((to - from).norm() / size).ceil()).clamp(1, FINE);
    (0..n).map(|nth| from + (to - from) * (nth as f64 / n as f64)).collect()
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
    use crate::{PlacedShape, Shape};

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
    fn points_of_an_outline_keep_corners_and_follow_tips() {
        let outline = |shape: Shape| {
            let center = Point::<2>::zeros();
            let name = "b".to_owned();
            Outline::new(&PlacedShape { name, shape, center, angle: 0.0, size: None }).unwrap()
        };
        let corners = [[0.0, 0.0], [1.0, 0.0], [0.3, 0.3], [0.0, 0.7]];
        let polygon = outline(Shape::Polygon { points: corners.to_vec() });
        for size in [0.13, 0.5, 10.0] {
            let points = points_of_outline(&polygon, size);
            assert!((area(&points) - 0.255).abs() < 1e-15, "{size}: {}", area(&points));
            assert!(corners.iter().all(|corner| points.contains(&Point::<2>::from(*corner))));
        }
        // All edges of an ellipse are followed, however long they are over its tips
        let ellipse = outline(Shape::Ellipse { semi_axes: [0.5, 0.1] });
        for size in [0.05, 0.2, 0.5] {
            let points = points_of_outline(&ellipse, size);
            let edges = points.iter().zip(points.iter().cycle().skip(1));
            assert!(edges.clone().all(|(a, b)| bulge(&ellipse, [*a, *b]).is_some()), "{size}");
            assert!(edges.clone().all(|(a, b)| (b - a).norm() < 1.001 * size), "{size}");
        }
        // Where edges are followed they are even
        assert_eq!(points_of_outline(&Outline::circle(Point::<2>::zeros(), 1.0), 0.4).len(), 16);
    }

    #[test]
    fn polygons_that_cross_themselves_are_refused() {
        let said = filled(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]], 0.3).unwrap_err();
        assert!(matches!(said, MeshError::Boundary { .. }), "{said}");
    }
}
