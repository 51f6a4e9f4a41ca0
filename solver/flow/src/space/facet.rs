//! Quadrature on the facets of cells: sides of triangles, faces of tetrahedra.
//!
//! A facet is the image of one of the reference simplex under its cell's map x(X). With the tangents
//! t_k = (dx/dX) s_k along its reference edges s_k, the outward normal times the element of area is
//! t_1 turned clockwise in the plane, and t_1 x t_2 in space.

use alewife_mesh::{Facet, Mesh, NodeId, Point, Simplex};
use nalgebra::SVector;

use super::cell::{CellMap, weighted_sum};
use super::element::Element;
use super::metric::Metric;
use super::quadrature::{interval_rule, simplex_rule};

/// A quadrature rule on all facets of the reference simplex.
#[derive(Debug, Clone)]
pub struct FacetRule<const D: usize> {
    metric: Metric,
    sides: Vec<ReferenceFacet<D>>,
}

/// A facet of the reference simplex.
#[derive(Debug, Clone)]
struct ReferenceFacet<const D: usize> {
    /// From its first vertex to the others, D - 1 of them.
    edges: Vec<SVector<f64, D>>,
    points: Vec<ReferencePoint<D>>,
}

/// The bases at a point of a facet of the reference simplex.
#[derive(Debug, Clone)]
struct ReferencePoint<const D: usize> {
    weight: f64,
    phi: Vec<f64>,
    grad_phi: Vec<SVector<f64, D>>,
    psi: Vec<f64>,
}

/// Values at one quadrature point of a facet.
#[derive(Debug, Clone)]
pub struct FacetPoint<'a, const D: usize> {
    /// Basis of the velocity, one value a node of the cell.
    pub phi: &'a [f64],
    /// Basis of the pressure, one value a vertex of the cell.
    pub psi: &'a [f64],
    /// Gradients of the velocity's basis (1/m).
    pub grad_phi: &'a [SVector<f64, D>],
    /// Normal out of the cell times the area of the point's part of the facet (m^(D - 1); m^2 in
    /// axisymmetric problems).
    pub normal_ds: Point<D>,
    /// Position (m).
    pub position: Point<D>,
}

impl<const D: usize> FacetPoint<'_, D> {
    /// What has these values at the nodes, here; the nodes are those of the cell.
    #[must_use]
    pub fn value(&self, nodes: &[NodeId], values: &[Point<D>]) -> Point<D> {
        nodes.iter().zip(self.phi).map(|(&node, phi)| values[node] * *phi).sum()
    }
}

impl<const D: usize> FacetRule<D> {
    /// Exact on straight facets for products of three functions of the velocity's basis.
    #[must_use]
    pub fn new(metric: Metric) -> Self {
        let element = Element::<D>::QUADRATIC;
        let rule = barycentric_rule();
        let sides = (0..=D).map(|side| ReferenceFacet::new(&element, &rule, side)).collect();
        Self { metric, sides }
    }

    /// Calls `visit` at each quadrature point of a boundary facet.
    pub fn for_each_point(
        &self,
        mesh: &Mesh<D>,
        facet: &Facet,
        mut visit: impl FnMut(&FacetPoint<'_, D>),
    ) {
        let ReferenceFacet { edges, points } = &self.sides[usize::from(facet.side)];
        let nodes: Vec<_> = mesh.cell(facet.cell).iter().map(|&node| mesh.nodes[node]).collect();
        let mut tangents = vec![Point::zeros(); edges.len()];
        let mut grad_phi = Vec::with_capacity(nodes.len());
        for ReferencePoint { weight, phi, grad_phi: reference, psi } in points {
            let map = CellMap::new(&nodes, reference);
            grad_phi.clear();
            grad_phi.extend(reference.iter().map(|gradient| map.gradient(gradient)));
            for (tangent, edge) in tangents.iter_mut().zip(edges) {
                *tangent = map.jacobian * edge;
            }
            let position = weighted_sum(&nodes, phi);
            let area = weight * self.metric.ring(&position);
            let normal_ds = normal(&tangents) * area;
            visit(&FacetPoint { phi, psi, grad_phi: &grad_phi, normal_ds, position });
        }
    }
}

impl<const D: usize> ReferenceFacet<D> {
    fn new(element: &Element<D>, rule: &[BarycentricPoint<D>], side: usize) -> Self {
        let vertices = Simplex::<D>::facet_vertices(side).map(reference_vertex::<D>);
        let point = |at: &BarycentricPoint<D>| {
            let xi = weighted_sum(&vertices, &at.coordinates);
            ReferencePoint {
                weight: at.weight,
                phi: (element.phi)(&xi),
                grad_phi: (element.grad_phi)(&xi),
                psi: (element.psi)(&xi),
            }
        };
        Self {
            edges: vertices[1..].iter().map(|vertex| vertex - vertices[0]).collect(),
            points: rule.iter().map(point).collect(),
        }
    }
}

/// A point of a rule on a simplex with D vertices.
struct BarycentricPoint<const D: usize> {
    coordinates: [f64; D],
    weight: f64,
}

/// The rule of facets: Gauss with 4 points on an interval, of degree 8 on a triangle.
fn barycentric_rule<const D: usize>() -> Vec<BarycentricPoint<D>> {
    fn from<const D: usize>(point: &[f64], weight: f64) -> BarycentricPoint<D> {
        let first = 1.0 - point.iter().sum::<f64>();
        let coordinates = std::array::from_fn(|i| if i == 0 { first } else { point[i - 1] });
        BarycentricPoint { coordinates, weight }
    }
    if D == 2 {
        let rule = interval_rule();
        rule.points.iter().zip(rule.weights).map(|(at, w)| from(at.as_slice(), w)).collect()
    } else {
        let rule = simplex_rule::<2>(8);
        rule.points.iter().zip(rule.weights).map(|(at, w)| from(at.as_slice(), w)).collect()
    }
}

/// Reference coordinates of a vertex.
fn reference_vertex<const D: usize>(vertex: usize) -> SVector<f64, D> {
    SVector::from_fn(|axis, _| if axis + 1 == vertex { 1.0 } else { 0.0 })
}

/// The normal on D - 1 tangents that are in the order of outward facets, as long as their span is
/// large.
fn normal<const D: usize>(tangents: &[Point<D>]) -> Point<D> {
    let t = tangents[0];
    if D == 2 {
        return Point::from_fn(|axis, _| if axis == 0 { t[1] } else { -t[0] });
    }
    let s = tangents[1];
    Point::from_fn(|axis, _| {
        let (j, k) = ((axis + 1) % D, (axis + 2) % D);
        t[j] * s[k] - t[k] * s[j]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::sample_mesh::{bent, one_simplex};
    use crate::space::{CellValues, Tables};

    /// A cubic field and its divergence in the mesh's coordinates.
    struct Cubic<const D: usize>;

    impl<const D: usize> Cubic<D> {
        fn value(x: &Point<D>) -> Point<D> {
            Point::from_fn(|i, _| {
                let (own, next) = (x[i], x[(i + 1) % D]);
                own * own * next - 0.7 * next.powi(3) + 1.3 * own + 0.4
            })
        }

        fn divergence(x: &Point<D>) -> f64 {
            (0..D).map(|i| 2.0 * x[i] * x[(i + 1) % D] + 1.3).sum()
        }
    }

    /// int div F = int F . n over the facets; polynomials, and so exact on curved cells, too.
    fn check_divergence_theorem<const D: usize>(mesh: &Mesh<D>, metric: Metric) {
        let (tables, rule) = (Tables::new(metric), FacetRule::new(metric));
        let mut inside = 0.0;
        for cell in mesh.cell_ids() {
            CellValues::default().for_each_point(&tables, mesh, cell, |at| {
                let hoop = metric.hoop_strain(&Cubic::value(&at.position), &at.position);
                inside += (Cubic::divergence(&at.position) + hoop) * at.dx;
            });
        }
        let mut outside = 0.0;
        for facet in &mesh.facets {
            rule.for_each_point(mesh, facet, |at| {
                outside += Cubic::value(&at.position).dot(&at.normal_ds);
            });
        }
        assert!((inside - outside).abs() < 1e-13 * inside.abs(), "{inside} {outside}");
    }

    #[test]
    fn the_divergence_theorem_holds_on_triangles_and_tetrahedra() {
        // Revolved, a cubic field on a curved side is of degree 9, beyond the rule
        check_divergence_theorem(&one_simplex::<2>(), Metric::Revolved);
        for bend in [0.0, 0.15] {
            check_divergence_theorem(&bent(one_simplex::<2>(), bend), Metric::Cartesian);
            check_divergence_theorem(&bent(one_simplex::<3>(), bend), Metric::Cartesian);
        }
    }

    /// The bases on a facet are those of the cell: they give back a field and its gradient.
    fn check_bases<const D: usize>(mesh: &Mesh<D>) {
        let value = |x: &Point<D>| x.iter().enumerate().map(|(i, x)| (i as f64 - 0.6) * x).sum();
        let gradient = Point::<D>::from_fn(|i, _| i as f64 - 0.6);
        let nodal: Vec<f64> = mesh.nodes.iter().map(value).collect();
        for facet in &mesh.facets {
            let nodes = mesh.cell(facet.cell);
            FacetRule::new(Metric::Cartesian).for_each_point(mesh, facet, |at| {
                let found: f64 =
                    nodes.iter().zip(at.phi).map(|(&node, phi)| nodal[node] * phi).sum();
                assert!((found - value(&at.position)).abs() < 1e-14);
                let slope = nodes
                    .iter()
                    .zip(at.grad_phi)
                    .fold(Point::<D>::zeros(), |sum, (&node, grad)| sum + grad * nodal[node]);
                assert!((slope - gradient).norm() < 1e-13);
                assert!((at.psi.iter().sum::<f64>() - 1.0).abs() < 1e-15);
                let off: f64 = (0..=D)
                    .filter(|vertex| {
                        !Simplex::<D>::facet_vertices(usize::from(facet.side)).contains(vertex)
                    })
                    .map(|vertex| at.psi[vertex].abs())
                    .sum();
                assert!(off < 1e-15);
            });
        }
    }

    #[test]
    fn fields_on_facets_are_those_of_the_cell() {
        check_bases(&bent(one_simplex::<2>(), 0.15));
        check_bases(&bent(one_simplex::<3>(), 0.15));
    }
}
