//! Developed flow through a flat side: the solution of a Poisson problem on it, zero at its rim.
//!
//! The velocity w along the normal has -Laplace w = 1 inside and w = 0 where the side meets walls or given velocities;
//! where it meets planes of symmetry or periodic sides nothing is asked. In the plane, and where a meridian plane
//! stands for a tube, w is a parabola; on a side of a mesh in space it is found with quadratic elements on its facets.

use std::collections::{BTreeMap, BTreeSet};

use alewife_mesh::{BoundaryId, Locator, Mesh, NodeId, Point, Simplex, Topology};
use nalgebra::Vector3;

use crate::algebra::{EllipticSolver, Pattern, SparseMatrix};
use crate::body::in_space;
use crate::case::{BoundaryCondition, Case, Geometry};
use crate::coupling::VelocityProfile;
use crate::run::RunError;
use crate::space::{CellValues, FacetRule, Metric, Tables, p2_values};

/// How much flows through a side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Amount {
    /// Volume in a unit of time (m3/s; m2/s planar), into the domain.
    Flux(f64),
    /// Largest velocity (m/s), into the domain.
    Peak(f64),
}

/// The velocity of a developed flow through a side of a mesh.
///
/// # Errors
/// When the side is not flat, or has no rim that holds the flow.
pub fn developed<const D: usize>(
    case: &Case,
    mesh: &Mesh<D>,
    side: &str,
    amount: Amount,
) -> Result<VelocityProfile<D>, RunError> {
    let refused = |what: &str| RunError::Unsupported(format!("side `{side}` {what}"));
    let boundary = mesh.boundary_named(side).ok_or_else(|| refused("has no facets"))?;
    let shape = mesh.side_shape(boundary);
    if !shape.is_flat {
        return Err(refused("is not flat, and a developed flow is one through a flat side"));
    }
    let inward = shape.inward();
    let rim = Rim::of(case, mesh, boundary);
    let metric =
        if case.geometry == Geometry::Axisymmetric { Metric::Revolved } else { Metric::Cartesian };
    let section: Box<dyn Fn(&Point<D>) -> f64 + Send + Sync> = if D == 2 {
        let ends = rim.ends(mesh, boundary).ok_or_else(|| refused("is not in one piece"))?;
        Box::new(move |place| ends.parabola(place))
    } else {
        let section = Section::new(mesh, boundary, &rim, &inward);
        let section = section.map_err(|what| refused(&what))?;
        Box::new(move |place| section.at(&in_space(place)))
    };
    let Through { flux, peak } = integrals(mesh, boundary, metric, &section);
    let factor = match amount {
        Amount::Flux(wanted) => wanted / flux,
        Amount::Peak(wanted) => wanted / peak,
    };
    if !factor.is_finite() {
        return Err(refused("lets nothing through"));
    }
    let velocity = Point::<D>::from_fn(|axis, _| factor * inward[axis]);
    Ok(Box::new(move |place, _| velocity * section(place)))
}

/// What a profile lets through a side.
struct Through {
    /// Its integral, by its values at the nodes.
    flux: f64,
    /// Its largest value at a node.
    peak: f64,
}

/// What a profile lets through a side of a mesh.
fn integrals<const D: usize>(
    mesh: &Mesh<D>,
    boundary: BoundaryId,
    metric: Metric,
    profile: &dyn Fn(&Point<D>) -> f64,
) -> Through {
    let (rule, mut flux, mut peak) = (FacetRule::new(metric), 0.0, 0.0_f64);
    for facet in mesh.facets.iter().filter(|facet| facet.boundary == boundary) {
        let nodes = mesh.cell(facet.cell);
        let own: BTreeMap<NodeId, f64> =
            mesh.facet_nodes(facet).map(|node| (node, profile(&mesh.nodes[node]))).collect();
        peak = own.values().fold(peak, |peak, value| peak.max(*value));
        rule.for_each_point(mesh, facet, |at| {
            let values = nodes.iter().zip(at.phi);
            let value: f64 = values.filter_map(|(node, phi)| Some(own.get(node)? * phi)).sum();
            flux += value * at.normal_ds.norm();
        });
    }
    Through { flux, peak }
}

/// Nodes of a side where the velocity is zero.
struct Rim(BTreeSet<NodeId>);

impl Rim {
    /// Those that it shares with other sides, but planes of symmetry and periodic ones.
    fn of<const D: usize>(case: &Case, mesh: &Mesh<D>, boundary: BoundaryId) -> Self {
        let holds = |name: &str| {
            !matches!(
                case.boundary.get(name),
                Some(
                    BoundaryCondition::Symmetry
                        | BoundaryCondition::Periodic(_)
                        | BoundaryCondition::Axis
                )
            ) && name != "axis"
        };
        let own: BTreeSet<NodeId> = nodes_of(mesh, boundary).collect();
        let others = mesh.facets.iter().filter(|facet| {
            facet.boundary != boundary && holds(&mesh.boundaries[facet.boundary].name)
        });
        let others = others.flat_map(|facet| mesh.facet_nodes(facet));
        Self(others.filter(|node| own.contains(node)).collect())
    }

    /// The two ends of a side in the plane.
    fn ends<const D: usize>(&self, mesh: &Mesh<D>, boundary: BoundaryId) -> Option<Ends<D>> {
        let mut n_facets: BTreeMap<NodeId, usize> = BTreeMap::new();
        for facet in mesh.facets.iter().filter(|facet| facet.boundary == boundary) {
            for vertex in mesh.facet_vertices(facet) {
                *n_facets.entry(vertex).or_default() += 1;
            }
        }
        let ends: Vec<NodeId> =
            n_facets.into_iter().filter(|(_, n)| *n == 1).map(|(node, _)| node).collect();
        let &[start, end] = ends.as_slice() else { return None };
        let is_held = [start, end].map(|node| self.0.contains(&node));
        Some(Ends { places: [start, end].map(|node| mesh.nodes[node]), is_held })
    }
}

fn nodes_of<const D: usize>(
    mesh: &Mesh<D>,
    boundary: BoundaryId,
) -> impl Iterator<Item = NodeId> + '_ {
    let own = mesh.facets.iter().filter(move |facet| facet.boundary == boundary);
    own.flat_map(|facet| mesh.facet_nodes(facet))
}

/// A side in the plane: its ends, and whether they hold the flow.
struct Ends<const D: usize> {
    places: [Point<D>; 2],
    is_held: [bool; 2],
}

impl<const D: usize> Ends<D> {
    /// 1 where the flow is fastest.
    fn parabola(&self, place: &Point<D>) -> f64 {
        let along = self.places[1] - self.places[0];
        let s = (place - self.places[0]).dot(&along) / along.norm_squared();
        match self.is_held {
            [true, true] => 4.0 * s * (1.0 - s),
            [false, true] => 1.0 - s * s,
            [true, false] => 1.0 - (1.0 - s) * (1.0 - s),
            [false, false] => 1.0,
        }
    }
}

/// A flat side in space as a mesh of its own plane, with the velocity at its nodes.
struct Section {
    mesh: Mesh<2>,
    locator: Locator<2>,
    values: Vec<f64>,
    origin: Vector3<f64>,
    axes: [Vector3<f64>; 2],
}

impl Section {
    fn new<const D: usize>(
        mesh: &Mesh<D>,
        boundary: BoundaryId,
        rim: &Rim,
        inward: &Vector3<f64>,
    ) -> Result<Self, String> {
        // From outside facets are seen counter-clockwise, their nodes in the order of a triangle
        let outward = -inward;
        let first = outward.cross(&Vector3::ith(outward.iamin(), 1.0)).normalize();
        let axes = [first, outward.cross(&first)];
        let facets: Vec<_> =
            mesh.facets.iter().filter(|facet| facet.boundary == boundary).collect();
        let corners: BTreeSet<NodeId> =
            facets.iter().flat_map(|facet| mesh.facet_vertices(facet)).collect();
        let inner: BTreeSet<NodeId> =
            facets.iter().flat_map(|facet| mesh.facet_inner_nodes(facet)).collect();
        let all: Vec<NodeId> = corners.iter().chain(&inner).copied().collect();
        let numbers: BTreeMap<NodeId, usize> =
            all.iter().enumerate().map(|(number, node)| (*node, number)).collect();
        let origin = all.first().map_or(Vector3::zeros(), |node| in_space(&mesh.nodes[*node]));
        let flat = |node: &NodeId| {
            let from = in_space(&mesh.nodes[*node]) - origin;
            Point::<2>::new(from.dot(&axes[0]), from.dot(&axes[1]))
        };
        let mut cells = Vec::with_capacity(Simplex::<2>::N_NODES * facets.len());
        for facet in &facets {
            cells.extend(mesh.facet_nodes(facet).map(|node| NodeId::new(numbers[&node])));
        }
        let topology = Topology {
            n_vertices: corners.len(),
            cells,
            curved: vec![true; facets.len()],
            facets: Vec::new(),
            boundaries: Vec::new(),
            periodic: Vec::new(),
        };
        let section = Mesh::new(all.iter().map(flat).collect(), topology);
        let is_held: Vec<bool> = all.iter().map(|node| rim.0.contains(node)).collect();
        let values = poisson(&section, &is_held)?;
        Ok(Self { locator: Locator::new(&section), mesh: section, values, origin, axes })
    }

    /// The velocity at a place (m) by that of the nearest point of the side.
    fn at(&self, place: &Vector3<f64>) -> f64 {
        let from = place - self.origin;
        let flat = Point::<2>::new(from.dot(&self.axes[0]), from.dot(&self.axes[1]));
        let Some(found) = self.locator.nearest(flat) else { return 0.0 };
        let nodes = self.mesh.cell(found.cell).iter();
        let values = nodes.zip(p2_values(&found.reference.into()));
        values.map(|(node, phi)| self.values[node.index()] * phi).sum()
    }
}

/// The solution of -Laplace w = 1 with w = 0 at nodes that are held, by quadratic elements.
fn poisson(mesh: &Mesh<2>, is_held: &[bool]) -> Result<Vec<f64>, String> {
    let mut unknowns = vec![None; mesh.n_nodes()];
    let mut n = 0;
    for (unknown, _) in unknowns.iter_mut().zip(is_held).filter(|(_, is_held)| !**is_held) {
        *unknown = Some(n);
        n += 1;
    }
    if n == 0 || !is_held.contains(&true) {
        return Err("meets no wall that holds a developed flow, or has no node inside".to_owned());
    }
    let mut rows: Vec<BTreeMap<usize, f64>> = vec![BTreeMap::new(); n];
    let mut rhs = vec![0.0; n];
    let tables = Tables::new(Metric::Cartesian);
    let mut values = CellValues::default();
    for cell in mesh.cell_ids() {
        let own: Vec<Option<usize>> =
            mesh.cell(cell).iter().map(|node| unknowns[node.index()]).collect();
        values.for_each_point(&tables, mesh, cell, |at| {
            for (a, row) in own.iter().enumerate().filter_map(|(a, row)| Some((a, (*row)?))) {
                rhs[row] += at.phi[a] * at.dx;
                for (b, column) in own.iter().enumerate().filter_map(|(b, c)| Some((b, (*c)?))) {
                    *rows[row].entry(column).or_default() +=
                        at.grad_phi[a].dot(&at.grad_phi[b]) * at.dx;
                }
            }
        });
    }
    let pattern =
        Pattern::from_rows(rows.iter().map(|row| row.keys().copied().collect::<Vec<_>>()));
    let entries = rows.iter().flat_map(|row| row.values().copied()).collect();
    let solver = EllipticSolver::factorised(&SparseMatrix::new(pattern, entries));
    let solver = solver.map_err(|error| format!("has no developed flow: {error}"))?;
    solver.solve(&mut rhs).map_err(|error| format!("has no developed flow: {error}"))?;
    Ok(unknowns.iter().map(|unknown| unknown.map_or(0.0, |unknown| rhs[unknown])).collect())
}

#[cfg(test)]
mod tests {
    use alewife_mesh::{Domain, Sizing, generate};

    use super::*;

    /// Integral of the solution over a domain, and its largest value.
    fn solved(domain: &Domain, size: f64) -> (f64, f64) {
        let mesh = generate(domain, &[], &Sizing::graded(size, 0.3, size)).unwrap();
        let mut is_held = vec![false; mesh.n_nodes()];
        for facet in &mesh.facets {
            mesh.facet_nodes(facet).for_each(|node| is_held[node] = true);
        }
        let values = poisson(&mesh, &is_held).unwrap();
        let (mut integral, mut cells) = (0.0, CellValues::default());
        for cell in mesh.cell_ids() {
            let nodes = mesh.cell(cell);
            cells.for_each_point(&Tables::new(Metric::Cartesian), &mesh, cell, |at| {
                let own = nodes.iter().zip(at.phi).map(|(node, phi)| values[node.index()] * phi);
                integral += own.sum::<f64>() * at.dx;
            });
        }
        (integral, values.into_iter().fold(0.0, f64::max))
    }

    #[test]
    fn sections_have_their_exact_flux() {
        let pi = std::f64::consts::PI;
        let disc = Domain::Disc { center: Point::<2>::new(0.3, -0.1), radius: 1.2 };
        let (flux, peak) = solved(&disc, 0.2);
        assert!((flux / (pi * 1.2_f64.powi(4) / 8.0) - 1.0).abs() < 1e-4, "{flux}");
        assert!((peak / (1.44 / 4.0) - 1.0).abs() < 2e-3, "{peak}");
        let (min, max) = (Point::<2>::zeros(), Point::<2>::new(1.0, 0.5));
        let rectangle = Domain::Box { min, max, periodic_x: false, periodic_y: false };
        let (a, b) = (0.5_f64, 1.0);
        let odd = (0..20).map(|n| f64::from(2 * n + 1));
        let series: f64 = odd.map(|n| (n * pi * b / (2.0 * a)).tanh() / n.powi(5)).sum();
        let exact = a.powi(3) * b / 12.0 * (1.0 - 192.0 * a / (pi.powi(5) * b) * series);
        let [coarse, fine] =
            [0.2, 0.1].map(|size| (solved(&rectangle, size).0 / exact - 1.0).abs());
        assert!(coarse < 1e-2 && fine < 0.3 * coarse, "{coarse} {fine}");
    }
}
