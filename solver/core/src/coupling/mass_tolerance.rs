//! How much volume parts of the fluid may gain or lose by what iterations leave of the continuity equation.

use alewife_mesh::{CellId, Facet, Mesh, NodeId, Point};

use super::problem::{Problem, Side};
use crate::space::straight_cell;

/// Largest sum of the sizes of the residuals of the continuity equation over the flux through the domain.
const TOLERANCE: f64 = 1e-8;
/// Part of the root mean square of the velocity times the cross-section of the domain that is the flux where boundaries are
/// slow: of fluid that is driven by a force, and continues by its inertia.
const INSIDE: f64 = 0.1;

/// Largest sum of the sizes of the residuals of the continuity equation, tested with the functions of the pressures, at a
/// velocity (m/s at the nodes): a part of the flux through the domain (m3/s; m2/s planar). As those functions add up to
/// one, any part of the fluid made up of them gains or loses no more. Infinite at rest.
///
/// The flux is half the integral of the speed over all boundaries but periodic ones: what passes from an inlet to an
/// outlet, or by a body that moves.
pub(super) fn mass_tolerance<const D: usize>(
    problem: &Problem<D>,
    mesh: &Mesh<D>,
    velocity: &[Point<D>],
) -> f64 {
    let is_crossed = |facet: &&Facet| {
        let side = &problem.sides[facet.boundary];
        !matches!(side, Some(Side::Periodic))
    };
    let mean = |nodes: &mut dyn Iterator<Item = NodeId>, of: fn(&Point<D>) -> f64| {
        let (mut sum, mut n) = (0.0, 0.0);
        for node in nodes {
            sum += of(&velocity[node]);
            n += 1.0;
        }
        sum / f64::max(n, 1.0)
    };
    let over_boundary: f64 = mesh
        .facets
        .iter()
        .filter(is_crossed)
        .map(|facet| {
            let ring = problem.metric.ring(&center(mesh, &mesh.facet_vertices(facet)));
            ring * area(mesh, facet) * mean(&mut mesh.facet_nodes(facet), |u| u.norm())
        })
        .sum();
    let of_cell = |cell: CellId| {
        let ring = problem.metric.ring(&center(mesh, mesh.cell_vertices(cell)));
        let volume = ring * straight_cell(mesh, cell).measure;
        let squared = mean(&mut mesh.cell(cell).iter().copied(), |u| u.norm_squared());
        (volume, volume * squared)
    };
    let (volume, squared) = mesh
        .cell_ids()
        .map(of_cell)
        .fold((0.0, 0.0), |sum: (f64, f64), cell| (sum.0 + cell.0, sum.1 + cell.1));
    let dimension = if problem.metric.is_revolved() { 3.0 } else { D as f64 };
    let inside = (squared / volume).sqrt() * volume.powf(1.0 - 1.0 / dimension);
    let flux = (0.5 * over_boundary).max(INSIDE * inside);
    if flux > 0.0 { TOLERANCE * flux } else { f64::INFINITY }
}

/// Mean of some vertices (m).
fn center<const D: usize>(mesh: &Mesh<D>, vertices: &[NodeId]) -> Point<D> {
    let sum = vertices.iter().fold(Point::<D>::zeros(), |sum, &vertex| sum + mesh.nodes[vertex]);
    sum / vertices.len() as f64
}

/// Measure of a facet without its bend (m2; m planar).
fn area<const D: usize>(mesh: &Mesh<D>, facet: &Facet) -> f64 {
    let corners = mesh.facet_vertices(facet).map(|vertex| mesh.nodes[vertex]);
    let first = corners[1] - corners[0];
    if D == 2 {
        return first.norm();
    }
    let second = corners[D - 1] - corners[0];
    let squared = first.norm_squared() * second.norm_squared() - first.dot(&second).powi(2);
    0.5 * squared.max(0.0).sqrt()
}
