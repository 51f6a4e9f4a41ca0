//! Force, torque and power of each body from the residual of the discrete momentum equation.
//!
//! The residual tested with a function that is 1 on the body is minus the fluid's force on it;
//! for P2-P1 it converges about twice as fast as an integral of the stress (@babuska1984).

mod derivative;
mod flexible_loads;
mod joint_loads;
mod propulsion;
mod side_loads;
mod surface_load;

use std::collections::HashMap;

use alewife_mesh::{BoundaryId, Mesh, NodeId, Point};
use nalgebra::Vector3;

pub use self::derivative::{LoadDerivatives, LoadWeights, load_derivatives};
pub use self::flexible_loads::{BaseReport, FlexibleReport, FlexibleStates, flexible_report};
pub use self::joint_loads::{BodyStates, JointReport, joint_reports};
pub use self::propulsion::{
    LoadedBodies, MeanMotion, PropulsionPower, group_load, mean_motion, propulsion_power,
};
pub use self::side_loads::side_loads;
pub use self::surface_load::{SideFlow, SidesAt, SurfaceStress};
use super::boundaries::{Boundaries, BoundaryNode};
use super::problem::{Problem, Side};
use crate::body::{Pose, Wrench, on_mesh};
use crate::space::DofLayout;

/// What the fluid does to a body, and the body to the fluid.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BodyLoads {
    /// Force and torque of the fluid on the body.
    pub load: Wrench,
    /// Rate of work of the body's surface on the fluid (W).
    pub power: f64,
}

/// What the fluid and its boundary do to each other.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SurfaceLoads {
    /// Of each body.
    pub bodies: Vec<BodyLoads>,
    /// Rate of work of the sides with a given velocity on the fluid (W).
    pub sides_power: f64,
    /// Force of the sides on the fluid (N).
    pub sides_force: Vector3<f64>,
    /// Force of sides and bodies on the fluid (N), but for that of a mean flow.
    pub boundary_force: Vector3<f64>,
    /// Of the fluid on each side, by its boundary, the torque about the origin; empty where they are not asked for.
    pub sides: Vec<Wrench>,
}

impl SurfaceLoads {
    /// No loads on so many bodies.
    #[must_use]
    pub fn none(n_bodies: usize) -> Self {
        Self { bodies: vec![BodyLoads::default(); n_bodies], ..Self::default() }
    }

    /// Rate of work of bodies and sides on the fluid (W).
    #[must_use]
    pub fn power(&self) -> f64 {
        self.bodies.iter().map(|load| load.power).sum::<f64>() + self.sides_power
    }
}

/// A flow on a mesh with the raw residual of the fluid's equations at it.
#[derive(Debug, Clone, Copy)]
pub struct ResidualOnMesh<'a, const D: usize> {
    /// The mesh.
    pub mesh: &'a Mesh<D>,
    /// Numbering of the residual.
    pub layout: &'a DofLayout<D>,
    /// Its boundaries.
    pub boundaries: &'a Boundaries,
    /// Velocity at the nodes (m/s).
    pub velocity: &'a [Point<D>],
    /// The residual.
    pub residual: &'a [f64],
}

impl<const D: usize> ResidualOnMesh<'_, D> {
    /// The residual of a node (N): the force on the fluid there.
    fn force_at(&self, node: NodeId) -> Point<D> {
        Point::<D>::from_fn(|axis, _| self.residual[self.layout.velocity(node, axis)])
    }
}

/// Loads of all bodies at these poses in the mesh, and the work of the sides.
#[must_use]
pub fn surface_loads<const D: usize>(
    problem: &Problem<D>,
    poses: &[Pose],
    flow: &ResidualOnMesh<'_, D>,
) -> SurfaceLoads {
    let mut sides_force = boundary_force(problem, flow, |node| node.body.is_none());
    for pair in flow.boundaries.body_copies() {
        sides_force -= problem.metric.total_force(&flow.force_at(pair.copy));
    }
    SurfaceLoads {
        bodies: body_loads(problem, poses, flow),
        sides_power: sides_power(problem, flow),
        sides_force,
        boundary_force: boundary_force(problem, flow, |_| true),
        sides: Vec::new(),
    }
}

/// Force of some nodes of the boundary on the fluid, each counted once.
fn boundary_force<const D: usize>(
    problem: &Problem<D>,
    flow: &ResidualOnMesh<'_, D>,
    counts: impl Fn(&BoundaryNode) -> bool,
) -> Vector3<f64> {
    let forces = flow
        .boundaries
        .nodes()
        .filter(counts)
        .map(|BoundaryNode { node, .. }| problem.metric.total_force(&flow.force_at(node)));
    forces.sum()
}

fn body_loads<const D: usize>(
    problem: &Problem<D>,
    poses: &[Pose],
    flow: &ResidualOnMesh<'_, D>,
) -> Vec<BodyLoads> {
    // What cells that are shown periods away from a body do to it
    let mut copies: HashMap<NodeId, Point<D>> = HashMap::new();
    for pair in flow.boundaries.body_copies() {
        *copies.entry(pair.original).or_insert_with(Point::<D>::zeros) += flow.force_at(pair.copy);
    }
    let loads = problem.bodies.iter().zip(poses).map(|(body, pose)| {
        let center = on_mesh::<D>(&pose.center);
        let mut loads = BodyLoads::default();
        for &node in flow.boundaries.nodes_on(body.boundary) {
            let mut force = -flow.force_at(node);
            force -= copies.get(&node).copied().unwrap_or_else(Point::<D>::zeros);
            let lever = flow.mesh.nodes[node] - center;
            loads.power -= force.dot(&flow.velocity[node]);
            loads.load.force += problem.metric.total_force(&force);
            loads.load.torque += problem.metric.total_torque(&lever, &force);
        }
        loads
    });
    loads.collect()
}

/// Work of the sides with a given velocity, each node once.
fn sides_power<const D: usize>(problem: &Problem<D>, flow: &ResidualOnMesh<'_, D>) -> f64 {
    let is_given =
        |boundary: BoundaryId| matches!(problem.sides[boundary], Some(Side::Velocity { .. }));
    let nodes = flow.boundaries.nodes();
    nodes
        .filter(|node| node.boundaries.iter().any(|&boundary| is_given(boundary)))
        .map(|BoundaryNode { node, .. }| flow.force_at(node).dot(&flow.velocity[node]))
        .sum()
}
