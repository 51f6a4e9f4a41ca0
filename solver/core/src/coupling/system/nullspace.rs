//! `TranslationNullspace`: the velocity fluid and bodies have in common where nothing holds them.

use std::collections::HashMap;

use alewife_mesh::{BoundaryKind, Facet, Mesh, NodeId, Point};
use nalgebra::{SMatrix, Vector3};

use super::super::constrain::pinned_node;
use super::super::error::SolveError;
use super::super::mean_flow::CellIntegrals;
use super::super::problem::{MeanFlowAt, Problem};
use super::super::rigid_equations::RigidBodyEquations;
use super::super::solution::Solution;
use crate::body::{Mode, in_space, on_mesh};
use crate::space::Tables;

/// Loads that sum up to less than this part of their sizes are balanced.
const BALANCED: f64 = 1e-9;

/// Takes a common velocity out of fluid and bodies.
#[derive(Debug, Clone)]
pub(in super::super) struct TranslationNullspace<const D: usize> {
    /// Along which coordinates nothing holds them.
    axes: [bool; D],
    /// The node at which the system holds them.
    pinned: NodeId,
    mean: Mean<D>,
}

/// How the mean velocity is found.
#[derive(Debug, Clone)]
enum Mean<const D: usize> {
    /// By integrals over fluid and bodies, wherever the mesh is cut open.
    Integrals(CellIntegrals<D>),
    /// By nodes of one side of each periodic pair, with the weights of their velocity in it.
    Crossings(Vec<NodeWeights<D>>),
}

/// What the velocity of a node counts in the mean velocity.
#[derive(Debug, Clone)]
struct NodeWeights<const D: usize> {
    node: NodeId,
    /// One column for each component of the mean.
    weights: SMatrix<f64, D, D>,
}

impl<const D: usize> TranslationNullspace<D> {
    /// That of a problem on a mesh; `None` where all is held.
    pub fn new(problem: &Problem<D>, mesh: &Mesh<D>, tables: &Tables<D>) -> Option<Self> {
        let axes = problem.free_translations();
        let pinned = axes.contains(&true).then(|| pinned_node(mesh))??;
        let mean = if D == 2 {
            Mean::Integrals(CellIntegrals::new(problem, mesh, tables))
        } else {
            Mean::Crossings(weights(mesh))
        };
        Some(Self { axes, pinned, mean })
    }

    /// The sum of loads along each free axis must be zero.
    ///
    /// # Errors
    /// [`SolveError::Unbalanced`] for the first axis along which it is not.
    pub fn check_balance(
        &self,
        bodies: &RigidBodyEquations,
        mean_flow: &MeanFlowAt<D>,
    ) -> Result<(), SolveError> {
        // A given mean velocity comes with the pressure gradient that balances them
        let is_open = |axis: &usize| self.axes[*axis] && mean_flow.velocity(*axis).is_none();
        for axis in (0..D).filter(is_open) {
            let loads = || bodies.bodies.iter().map(|body| body.external[Mode::along(axis)]);
            let (sum, size): (f64, f64) = (loads().sum(), loads().map(f64::abs).sum());
            if sum.abs() > BALANCED * size {
                return Err(SolveError::Unbalanced { axis: ["x", "y", "z"][axis], sum });
            }
        }
        Ok(())
    }

    /// Moves with the node at which the system holds fluid and bodies.
    pub fn pin(&self, solution: &mut Solution<D>) {
        let velocity = solution.velocity[self.pinned];
        self.subtract(&velocity, solution);
    }

    /// The mean velocity of fluid and bodies (m/s).
    pub fn mean(&self, solution: &Solution<D>) -> Point<D> {
        let weights = match &self.mean {
            Mean::Integrals(cell) => return cell.mean_velocity(solution),
            Mean::Crossings(weights) => weights,
        };
        weights.iter().fold(Point::<D>::zeros(), |sum, NodeWeights { node, weights }| {
            let velocity = &solution.velocity[*node];
            sum + Point::<D>::from_fn(|axis, _| weights.column(axis).dot(velocity))
        })
    }

    /// Takes a velocity (m/s) off fluid and bodies, along the free axes.
    pub fn subtract(&self, velocity: &Point<D>, solution: &mut Solution<D>) {
        let common =
            Point::<D>::from_fn(|axis, _| if self.axes[axis] { velocity[axis] } else { 0.0 });
        for velocity in &mut solution.velocity {
            *velocity -= common;
        }
        for twist in &mut solution.twists {
            twist.linear -= in_space(&common);
        }
    }
}

/// The mean of a solenoidal velocity over fluid and bodies is the sum over periodic pairs of sides of
/// the way between them times the flux across, over the volume: int u_i = int div(x_i u), in which
/// surfaces of bodies between fluid and body cancel.
fn weights<const D: usize>(mesh: &Mesh<D>) -> Vec<NodeWeights<D>> {
    let [at_vertices, at_inner] = basis_means::<D>();
    let mut volume = Point::<D>::zeros();
    let mut all: Vec<NodeWeights<D>> = Vec::new();
    for Crossing { facet, way } in crossings(mesh) {
        let mut inner = mesh.facet_inner_nodes(facet);
        let vertices = mesh.facet_vertices(facet);
        let outward = vector_area(&vertices.map(|vertex| mesh.nodes[vertex]));
        let mut add = |node: NodeId, mean: f64| {
            let weights = SMatrix::from_fn(|i, axis| outward[i] * (mean * way[axis]));
            all.push(NodeWeights { node, weights });
        };
        add(vertices[0], at_vertices);
        inner.by_ref().for_each(|node| add(node, at_inner));
        vertices[1..].iter().for_each(|&vertex| add(vertex, at_vertices));
        volume += way.component_mul(&outward);
    }
    for NodeWeights { weights, .. } in &mut all {
        for axis in 0..D {
            let volume = if volume[axis] == 0.0 { 1.0 } else { volume[axis] };
            weights.column_mut(axis).iter_mut().for_each(|weight| *weight /= volume);
        }
    }
    all
}

/// A facet through which the fluid continues elsewhere.
struct Crossing<'a, const D: usize> {
    facet: &'a Facet,
    /// The way to it from its image (m).
    way: Point<D>,
}

/// One facet of each pair of periodic facets.
fn crossings<const D: usize>(mesh: &Mesh<D>) -> Vec<Crossing<'_, D>> {
    let mut original: Vec<NodeId> = mesh.node_ids().collect();
    let mut is_paired = vec![false; mesh.n_nodes()];
    for pair in &mesh.periodic {
        original[pair.copy] = pair.original;
        is_paired[pair.copy] = true;
        is_paired[pair.original] = true;
    }
    // By the originals of all its nodes, of which those inside it are no other facet's
    let key = |facet: &Facet| {
        let mut nodes: Vec<NodeId> = mesh.facet_nodes(facet).map(|node| original[node]).collect();
        nodes.sort_unstable();
        nodes
    };
    let is_side = |facet: &&Facet| mesh.boundaries[facet.boundary].kind == BoundaryKind::Side;
    let is_periodic = |facet: &&Facet| mesh.facet_inner_nodes(facet).all(|node| is_paired[node]);
    let mut open: HashMap<Vec<NodeId>, &Facet> = HashMap::new();
    let mut ways = Vec::new();
    for facet in mesh.facets.iter().filter(is_side).filter(is_periodic) {
        let Some(first) = open.remove(&key(facet)) else {
            open.insert(key(facet), facet);
            continue;
        };
        let is_copy =
            |facet: &Facet| mesh.facet_inner_nodes(facet).all(|node| original[node] != node);
        let [one, other] = if is_copy(facet) { [facet, first] } else { [first, facet] };
        let node_of =
            |facet: &Facet, of: NodeId| mesh.facet_nodes(facet).find(|node| original[*node] == of);
        let Some(from) = mesh.facet_nodes(one).next() else { continue };
        let Some(to) = node_of(other, original[from]) else { continue };
        ways.push(Crossing { facet: one, way: mesh.nodes[from] - mesh.nodes[to] });
    }
    ways
}

/// Means over a facet of the quadratic basis functions of its vertices and of its inner nodes.
fn basis_means<const D: usize>() -> [f64; 2] {
    if D == 2 { [1.0 / 6.0, 4.0 / 6.0] } else { [0.0, 1.0 / 3.0] }
}

/// Normal of a straight facet out of its cell times its measure (m^(D-1)).
fn vector_area<const D: usize>(corners: &[Point<D>; D]) -> Point<D> {
    let [first, second] = [corners[0], corners[1]];
    let along = in_space(&(second - first));
    let normal = if D == 2 {
        Vector3::new(along.y, -along.x, 0.0)
    } else {
        along.cross(&in_space(&(corners[D - 1] - first))) * 0.5
    };
    on_mesh(&normal)
}
