//! The quadratic map of a cell: shape functions, Jacobian, and whether a curved cell is folded.
//!
//! x(X) = Σ_a x_a φ_a(X), with φ_a = l_i (2 l_i - 1) at vertex i and 4 l_i l_j inside edge (i, j),
//! where l_0 = 1 - Σ X_k and l_k = X_k are the barycentric coordinates.

use super::simplex::{NodeArray, Simplex};
use crate::{CellId, Mesh, Point};

/// Positions (m) of the nodes of a cell.
pub type CellNodes<const D: usize> = NodeArray<D, Point<D>>;

/// The map of a cell at a reference point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellMap<const D: usize> {
    /// Image of the reference point (m).
    pub position: Point<D>,
    /// Columns dx/dX_k of the Jacobian (m).
    pub columns: [Point<D>; D],
}

impl<const D: usize> CellMap<D> {
    /// det J (m^D).
    #[must_use]
    pub fn det_jacobian(&self) -> f64 {
        determinant(&self.columns)
    }
}

impl<const D: usize> Mesh<D> {
    /// Positions of the nodes of a cell (m).
    #[must_use]
    pub fn cell_nodes(&self, cell: CellId) -> CellNodes<D> {
        let nodes = self.cell(cell);
        NodeArray::from_fn(|local| self.nodes[nodes[local]])
    }
}

impl<const D: usize> Mesh<D> {
    /// Area (m²) or volume (m³), curved facets included.
    #[must_use]
    pub fn measure(&self) -> f64 {
        // The integral of a polynomial over a simplex is the mean of its Bezier coefficients times
        // the measure of the reference simplex, 1 / D!
        let reference: f64 = (1..=D).map(|k| 1.0 / k as f64).product();
        self.cell_ids()
            .map(|cell| {
                let coefficients = jacobian_coefficients(&self.cell_nodes(cell));
                coefficients.iter().sum::<f64>() / coefficients.len() as f64 * reference
            })
            .sum()
    }
}

/// Determinant of a matrix given by its columns.
pub(crate) fn determinant<const D: usize>(columns: &[Point<D>; D]) -> f64 {
    let at = |row: usize, column: usize| columns[column][row];
    if D == 2 {
        return at(0, 0) * at(1, 1) - at(1, 0) * at(0, 1);
    }
    let minor = |i: usize, j: usize| at(i, 1) * at(j, 2) - at(j, 1) * at(i, 2);
    at(0, 0) * minor(1, 2) + at(1, 0) * minor(2, 0) + at(2, 0) * minor(0, 1)
}

/// Barycentric coordinates of a reference point; the first D + 1 entries count.
fn barycentric<const D: usize>(at: [f64; D]) -> [f64; 4] {
    let mut l = [0.0; 4];
    l[0] = at.iter().fold(1.0, |rest, x| rest - x);
    l[1..=D].copy_from_slice(&at);
    l
}

/// Derivative of barycentric coordinate `vertex` along reference axis `axis`.
fn slope(vertex: usize, axis: usize) -> f64 {
    match vertex {
        0 => -1.0,
        _ if vertex == axis + 1 => 1.0,
        _ => 0.0,
    }
}

/// Vertices whose barycentric coordinates make the shape function of a local node: one vertex
/// twice, or the two ends of an edge.
fn pair_of<const D: usize>(node: usize) -> [usize; 2] {
    if node <= D { [node, node] } else { Simplex::<D>::EDGES[node - D - 1] }
}

/// Values of the quadratic shape functions at a reference point.
#[must_use]
pub fn shape_functions<const D: usize>(at: [f64; D]) -> NodeArray<D, f64> {
    let l = barycentric(at);
    NodeArray::from_fn(|node| {
        let [i, j] = pair_of::<D>(node);
        if i == j { l[i] * (2.0 * l[i] - 1.0) } else { 4.0 * l[i] * l[j] }
    })
}

/// Derivative of the shape function of a local node along a reference axis, from the barycentric
/// coordinates of the point.
fn shape_slope<const D: usize>(l: &[f64; 4], node: usize, axis: usize) -> f64 {
    let [i, j] = pair_of::<D>(node);
    if i == j {
        (4.0 * l[i] - 1.0) * slope(i, axis)
    } else {
        4.0 * (l[i] * slope(j, axis) + l[j] * slope(i, axis))
    }
}

/// The quadratic map of a cell with these nodes at a reference point.
#[must_use]
pub fn map_quadratic<const D: usize>(nodes: &[Point<D>], at: [f64; D]) -> CellMap<D> {
    let (phi, l) = (shape_functions(at), barycentric(at));
    let mut map = CellMap { position: Point::zeros(), columns: [Point::zeros(); D] };
    for (local, (node, phi)) in nodes.iter().zip(phi.iter()).enumerate() {
        map.position += node * *phi;
        for axis in 0..D {
            map.columns[axis] += node * shape_slope::<D>(&l, local, axis);
        }
    }
    map
}

/// Bezier coefficients of det J of a quadratic cell (m^D): those of the vertices, then of the
/// edges, then of the faces of a tetrahedron.
///
/// det J is a polynomial of degree D in the reference coordinates; it is positive everywhere when
/// all its coefficients are.
///
/// # Source
/// @johnen2013, geometrical validity of curvilinear elements.
#[must_use]
pub fn jacobian_coefficients<const D: usize>(nodes: &[Point<D>]) -> Vec<f64> {
    let det = |weights: &[(usize, f64)]| {
        let mut at = [0.0; D];
        for &(vertex, weight) in weights.iter().filter(|(vertex, _)| *vertex > 0) {
            at[vertex - 1] = weight;
        }
        map_quadratic(nodes, at).det_jacobian()
    };
    let f: Vec<f64> = (0..=D).map(|vertex| det(&[(vertex, 1.0)])).collect();
    let mut coefficients = f.clone();
    if D == 2 {
        // f_m = (f_i + f_j) / 4 + b / 2 in the middle of an edge
        for &[i, j] in Simplex::<D>::EDGES {
            coefficients.push(2.0 * det(&[(i, 0.5), (j, 0.5)]) - 0.5 * (f[i] + f[j]));
        }
        return coefficients;
    }
    const THIRD: f64 = 1.0 / 3.0;
    let mut near = [[0.0; 4]; 4];
    for &[i, j] in Simplex::<D>::EDGES {
        // The cubic along an edge from its values at thirds
        let p = det(&[(i, 2.0 * THIRD), (j, THIRD)]);
        let q = det(&[(i, THIRD), (j, 2.0 * THIRD)]);
        near[i][j] = (-5.0 * f[i] + 18.0 * p - 9.0 * q + 2.0 * f[j]) / 6.0;
        near[j][i] = (-5.0 * f[j] + 18.0 * q - 9.0 * p + 2.0 * f[i]) / 6.0;
        coefficients.extend([near[i][j], near[j][i]]);
    }
    for side in 0..=D {
        // 27 f = Σ corners + 3 Σ edges + 6 b in the centre of a face
        let corners = &Simplex::<D>::FACETS[side][..D];
        let center: Vec<(usize, f64)> = corners.iter().map(|&vertex| (vertex, THIRD)).collect();
        let at_corners: f64 = corners.iter().map(|&i| f[i]).sum();
        let pairs = corners.iter().flat_map(|&i| corners.iter().map(move |&j| (i, j)));
        let at_edges: f64 = pairs.filter(|(i, j)| i != j).map(|(i, j)| near[i][j]).sum();
        coefficients.push((27.0 * det(&center) - at_corners - 3.0 * at_edges) / 6.0);
    }
    coefficients
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quadrature::integrate;
    use crate::test_meshes::{bulged_cube, cube_of_five, cube_of_twelve};

    fn bulged(height: f64) -> [Point<2>; 6] {
        [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, height], [0.5, 0.5], [0.0, 0.5]]
            .map(Point::<2>::from)
    }

    /// The reference tetrahedron with the inner node of its first edge moved into it.
    fn dented(depth: f64) -> Vec<Point<3>> {
        let vertex = |i: usize| Point::<3>::from_fn(|axis, _| f64::from(u8::from(axis + 1 == i)));
        let edges = Simplex::<3>::EDGES.iter().map(|&[i, j]| (vertex(i) + vertex(j)) * 0.5);
        let mut nodes: Vec<Point<3>> = (0..4).map(vertex).chain(edges).collect();
        nodes[4] += Point::<3>::new(0.0, depth, depth);
        nodes
    }

    #[test]
    fn a_straight_cell_has_its_determinant_everywhere() {
        for c in jacobian_coefficients(&bulged(0.0)) {
            assert!((c - 1.0).abs() < 1e-15);
        }
        let coefficients = jacobian_coefficients(&dented(0.0));
        assert_eq!(coefficients.len(), 20);
        for c in coefficients {
            assert!((c - 1.0).abs() < 1e-14);
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
                    least = least.min(map_quadratic(&nodes, at).det_jacobian());
                }
            }
            assert!(lowest <= least + 1e-14);
            assert_eq!(least < 0.0, height > 0.25, "height {height}");
        }
    }

    /// Along an edge whose inner node is moved off it, det J falls linearly with the distance.
    #[test]
    fn the_coefficients_of_a_tetrahedron_bound_its_determinant() {
        for depth in [0.05, 0.1, 0.2, 0.4] {
            let nodes = dented(depth);
            let lowest = jacobian_coefficients(&nodes).into_iter().fold(f64::INFINITY, f64::min);
            let mut least = f64::INFINITY;
            for i in 0..=12 {
                for j in 0..=12 - i {
                    for k in 0..=12 - i - j {
                        let at = [i, j, k].map(|n| f64::from(n) / 12.0);
                        least = least.min(map_quadratic(&nodes, at).det_jacobian());
                    }
                }
            }
            assert!(lowest <= least + 1e-13, "depth {depth}: {lowest} {least}");
            assert!(lowest > least - 0.5, "depth {depth}: {lowest} {least}");
        }
    }

    /// A polynomial of degree D is the sum of its coefficients times Bernstein polynomials.
    #[test]
    fn the_coefficients_of_a_tetrahedron_give_the_determinant_back() {
        let nodes = dented(0.17);
        let b = jacobian_coefficients(&nodes);
        for at in [[0.1, 0.2, 0.3], [0.6, 0.1, 0.05], [0.25, 0.25, 0.25]] {
            let l = barycentric(at);
            let mut sum: f64 = (0..4).map(|i| b[i] * l[i].powi(3)).sum();
            for (edge, &[i, j]) in Simplex::<3>::EDGES.iter().enumerate() {
                sum += 3.0 * b[4 + 2 * edge] * l[i] * l[i] * l[j];
                sum += 3.0 * b[5 + 2 * edge] * l[j] * l[j] * l[i];
            }
            for (side, vertices) in Simplex::<3>::FACETS.iter().enumerate() {
                sum += 6.0 * b[16 + side] * vertices[..3].iter().map(|&v| l[v]).product::<f64>();
            }
            assert!((sum - map_quadratic(&nodes, at).det_jacobian()).abs() < 1e-13);
        }
    }

    #[test]
    fn columns_are_derivatives_of_the_position() {
        let nodes = dented(0.1);
        let (at, step) = ([0.2, 0.3, 0.1], 1e-6);
        let map = map_quadratic(&nodes, at);
        for axis in 0..3 {
            let moved = |by: f64| {
                let mut there = at;
                there[axis] += by;
                map_quadratic(&nodes, there).position
            };
            let slope = (moved(step) - moved(-step)) / (2.0 * step);
            assert!((slope - map.columns[axis]).norm() < 1e-9);
        }
    }

    #[test]
    fn the_volume_of_a_cube_is_that_of_its_tetrahedra() {
        for mesh in [cube_of_five(), cube_of_twelve()] {
            assert!((mesh.measure() - 1.0).abs() < 1e-14, "{}", mesh.measure());
        }
        let mesh = bulged_cube(0.2);
        let integrals = mesh.cell_ids().map(|cell| {
            let nodes = mesh.cell_nodes(cell);
            integrate(0.0, 1.0, |x| {
                integrate(0.0, 1.0 - x, |y| {
                    integrate(0.0, 1.0 - x - y, |z| map_quadratic(&nodes, [x, y, z]).det_jacobian())
                })
            })
        });
        let volume: f64 = integrals.sum();
        assert!(volume > 1.1 && (mesh.measure() - volume).abs() < 1e-12, "{volume}");
    }
}
