//! Measures of straight tetrahedra, and the Bezier coefficients of det J of curved ones.

use crate::Point;

/// Vertices of the face opposite each vertex, counter-clockwise from outside a positive cell.
pub const FACES: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// Vertices at the ends of each edge.
pub const EDGES: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

/// Sine of the dihedral angles of a regular tetrahedron, √8 / 3.
const REGULAR_SINE: f64 = 0.942_809_041_582_063_4;

/// Middle of two points.
pub fn middle(a: Point<3>, b: Point<3>) -> Point<3> {
    (a + b) * 0.5
}

/// Six times the signed volume.
pub fn six_volumes([a, b, c, d]: &[Point<3>; 4]) -> f64 {
    (b - a).dot(&(c - a).cross(&(d - a)))
}

/// Volume over the mean squared edge length to the power 3/2, one for a regular tetrahedron
/// (@parthasarathy1994).
pub fn volume_length(p: &[Point<3>; 4]) -> f64 {
    let [a, b, c, d] = p;
    let squares = (a - b).norm_squared()
        + (a - c).norm_squared()
        + (a - d).norm_squared()
        + (b - c).norm_squared()
        + (b - d).norm_squared()
        + (c - d).norm_squared();
    let mean = squares / 6.0;
    std::f64::consts::SQRT_2 * six_volumes(p) / (mean * mean.sqrt())
}

/// Smallest sine of the dihedral angles, with the sign of the volume, one for a regular tetrahedron.
pub fn least_sine(p: &[Point<3>; 4]) -> f64 {
    let volume = six_volumes(p);
    let square = |[i, j, k]: [usize; 3]| (p[j] - p[i]).cross(&(p[k] - p[i])).norm_squared();
    let squares = FACES.map(square);
    let mut least = f64::INFINITY;
    // At an edge meet the faces opposite the two other vertices
    for (edge, [i, j]) in EDGES.into_iter().enumerate() {
        let [k, l] = EDGES[5 - edge];
        let areas = (squares[k] * squares[l]).max(f64::MIN_POSITIVE);
        let ratio = (p[i] - p[j]).norm_squared() / areas;
        least = least.min(ratio);
    }
    volume * least.sqrt() / REGULAR_SINE
}

/// Smallest Bezier coefficient of det J over their mean, from vertices and the offsets of the nodes
/// in the edges from their middles.
///
/// With the columns of the Jacobian linear in the barycentric coordinates, x_j(l) = Σ_i l_i c_ij, the
/// coefficient of l_i l_j l_k is the mean of the determinants over all orders of i, j and k
/// (@johnen2013).
pub fn least_coefficient(p: &[Point<3>; 4], offsets: &[Point<3>; 6]) -> f64 {
    // Control points of the quadratic map
    let mut control = [[Point::<3>::zeros(); 4]; 4];
    for i in 0..4 {
        control[i][i] = p[i];
    }
    for (edge, [i, j]) in EDGES.into_iter().enumerate() {
        let point = middle(p[i], p[j]) + offsets[edge] * 2.0;
        control[i][j] = point;
        control[j][i] = point;
    }
    let column = |i: usize, j: usize| control[i][j] - control[i][0];
    let mut first = [Point::<3>::zeros(); 4];
    let mut crosses = [[Point::<3>::zeros(); 4]; 4];
    for i in 0..4 {
        first[i] = column(i, 1);
        for j in 0..4 {
            crosses[i][j] = column(i, 2).cross(&column(j, 3));
        }
    }
    let pair = |i: usize, j: usize| crosses[i][j] + crosses[j][i];
    let (mut least, mut sum) = (f64::INFINITY, 0.0);
    for i in 0..4 {
        for j in i..4 {
            for k in j..4 {
                let of = first[i].dot(&pair(j, k))
                    + first[j].dot(&pair(i, k))
                    + first[k].dot(&pair(i, j));
                least = least.min(of / 6.0);
                sum += of / 6.0;
            }
        }
    }
    // The integral of every Bernstein polynomial is the same
    least / (sum / 20.0).abs()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::jacobian_coefficients;
    use crate::{Simplex, map_quadratic};

    fn sample() -> [Point<3>; 4] {
        [[0.0, 0.1, 0.0], [1.0, 0.0, 0.2], [0.1, 0.9, 0.0], [0.2, 0.3, 0.8]].map(Point::from)
    }

    #[test]
    fn regular_tetrahedra_have_measure_one_and_mirror_images_minus_one() {
        let mut p = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]]
            .map(Point::<3>::from);
        for sign in [-1.0, 1.0] {
            assert!((volume_length(&p) - sign).abs() < 1e-14);
            assert!((least_sine(&p) - sign).abs() < 1e-14);
            p.swap(0, 1);
        }
    }

    #[test]
    fn faces_are_seen_from_outside() {
        let p = sample();
        for (opposite, [i, j, k]) in FACES.into_iter().enumerate() {
            let normal = (p[j] - p[i]).cross(&(p[k] - p[i]));
            assert!(normal.dot(&(p[opposite] - p[i])) < 0.0);
        }
    }

    #[test]
    fn the_least_coefficient_agrees_with_that_of_the_mesh() {
        let p = sample();
        let offsets: [Point<3>; 6] = std::array::from_fn(|edge| {
            let part = |k: f64| (0.618_034 * k * (edge + 1) as f64).fract() - 0.5;
            Point::<3>::new(part(1.0), part(5.0), part(11.0)) * 0.15
        });
        let mut nodes = p.to_vec();
        for ends in Simplex::<3>::EDGES {
            let edge = EDGES.iter().position(|own| ends.iter().all(|v| own.contains(v))).unwrap();
            nodes.push(middle(p[ends[0]], p[ends[1]]) + offsets[edge]);
        }
        let all = jacobian_coefficients::<3>(&nodes);
        let least = all.iter().copied().fold(f64::INFINITY, f64::min);
        let mean = all.iter().sum::<f64>() / 20.0;
        assert!((least_coefficient(&p, &offsets) - least / mean).abs() < 1e-12);
        assert!(map_quadratic(&nodes, [0.25; 3]).det_jacobian() > 0.0);
    }
}
