//! Quadratic geometry: mid nodes on the exact boundary, and whether a curved cell is folded.

use crate::outline::cross;
use crate::{CellId, Mesh, Point};

impl Mesh<2> {
    /// Places of the six nodes of a cell (m).
    #[must_use]
    pub fn cell_nodes(&self, cell: CellId) -> [Point<2>; 6] {
        let nodes = self.cell(cell);
        std::array::from_fn(|i| self.nodes[nodes[i]])
    }

    /// Area (m²), curved sides included.
    #[must_use]
    pub fn area(&self) -> f64 {
        // det J is quadratic, for which the mean over the middles of the sides is exact
        let middle = [[0.5, 0.0], [0.5, 0.5], [0.0, 0.5]];
        self.cell_ids()
            .map(|cell| {
                let nodes = self.cell_nodes(cell);
                middle.into_iter().map(|at| det_jacobian(&nodes, at)).sum::<f64>() / 6.0
            })
            .sum()
    }
}

/// Bezier coefficients of det J of a quadratic triangle with nodes in mesh order (m²).
///
/// det J is itself quadratic in the reference coordinates; it is positive everywhere when all its
/// coefficients are. With values f at corners i, j and the middle m of a side, the coefficient of
/// the side is 2 f_m - (f_i + f_j) / 2.
///
/// # Source
/// @johnen2013, geometrical validity of curvilinear elements.
#[must_use]
pub fn jacobian_coefficients(nodes: &[Point<2>; 6]) -> [f64; 6] {
    let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    let middle = [[0.5, 0.0], [0.5, 0.5], [0.0, 0.5]];
    let f = corners.map(|at| det_jacobian(nodes, at));
    let m = middle.map(|at| det_jacobian(nodes, at));
    let side = |s: usize| 2.0 * m[s] - 0.5 * (f[s] + f[(s + 1) % 3]);
    [f[0], f[1], f[2], side(0), side(1), side(2)]
}

/// Shape functions of the quadratic triangle at a reference point, in mesh order.
#[must_use]
pub fn shape_functions([x, y]: [f64; 2]) -> [f64; 6] {
    let z = 1.0 - x - y;
    [
        z * (2.0 * z - 1.0),
        x * (2.0 * x - 1.0),
        y * (2.0 * y - 1.0),
        4.0 * z * x,
        4.0 * x * y,
        4.0 * y * z,
    ]
}

/// Derivatives of the shape functions along the two reference coordinates.
#[must_use]
pub fn shape_gradients([x, y]: [f64; 2]) -> [[f64; 2]; 6] {
    let z = 1.0 - x - y;
    [
        [1.0 - 4.0 * z, 1.0 - 4.0 * z],
        [4.0 * x - 1.0, 0.0],
        [0.0, 4.0 * y - 1.0],
        [4.0 * (z - x), -4.0 * x],
        [4.0 * y, 4.0 * x],
        [-4.0 * y, 4.0 * (z - y)],
    ]
}

/// Place (m) of a reference point and the two columns of the Jacobian (m).
#[must_use]
pub fn map_quadratic(nodes: &[Point<2>; 6], at: [f64; 2]) -> (Point<2>, [Point<2>; 2]) {
    let (phi, gradients) = (shape_functions(at), shape_gradients(at));
    let mut place = Point::<2>::zeros();
    let mut columns = [Point::<2>::zeros(); 2];
    for i in 0..6 {
        place += nodes[i] * phi[i];
        columns[0] += nodes[i] * gradients[i][0];
        columns[1] += nodes[i] * gradients[i][1];
    }
    (place, columns)
}

/// det J of the quadratic map at a reference point (m²).
#[must_use]
pub fn det_jacobian(nodes: &[Point<2>; 6], at: [f64; 2]) -> f64 {
    let (_, [first, second]) = map_quadratic(nodes, at);
    cross(first, second)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bulged(height: f64) -> [Point<2>; 6] {
        [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, height], [0.5, 0.5], [0.0, 0.5]]
            .map(Point::<2>::from)
    }

    #[test]
    fn a_straight_cell_has_twice_its_area_everywhere() {
        for c in jacobian_coefficients(&bulged(0.0)) {
            assert!((c - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn the_coefficients_bound_the_determinant_and_see_a_fold() {
        for height in [0.1, 0.2, 0.3] {
            let nodes = bulged(height);
            let lowest = jacobian_coefficients(&nodes).into_iter().fold(f64::INFINITY, f64::min);
            let mut least = f64::INFINITY;
            for i in 0..=20 {
                for j in 0..=20 - i {
                    let at = [f64::from(i) / 20.0, f64::from(j) / 20.0];
                    least = least.min(det_jacobian(&nodes, at));
                }
            }
            assert!(lowest <= least + 1e-14);
            assert_eq!(least < 0.0, height > 0.25, "height {height}");
        }
    }
}
