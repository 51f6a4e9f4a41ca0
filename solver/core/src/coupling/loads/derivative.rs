//! How the loads of a flow on bodies follow its velocity and the residual of its momentum equation.

use alewife_mesh::{NodeId, Point};

use super::ResidualOnMesh;
use crate::body::{Pose, RigidVector, on_mesh};
use crate::coupling::problem::Problem;

/// What the load and the power of a body count in a sum.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct LoadWeights {
    /// Of force and torque of the fluid (1/N, 1/(N m)).
    pub load: RigidVector,
    /// Of the power (1/W).
    pub power: f64,
}

/// The derivatives of a sum of loads, each by all raw unknowns.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadDerivatives {
    /// By the residual with the velocity kept.
    pub by_residual: Vec<f64>,
    /// By the velocity with the residual kept.
    pub by_solution: Vec<f64>,
}

/// The derivatives of the sum of the loads of all bodies at these poses in the mesh, times weights.
#[must_use]
pub fn load_derivatives<const D: usize>(
    problem: &Problem<D>,
    poses: &[Pose],
    flow: &ResidualOnMesh<'_, D>,
    weights: &[LoadWeights],
) -> LoadDerivatives {
    let zeros = vec![0.0; flow.layout.n_raw()];
    let mut sum = LoadDerivatives { by_residual: zeros.clone(), by_solution: zeros };
    for ((body, pose), weights) in problem.bodies.iter().zip(poses).zip(weights) {
        let center = on_mesh::<D>(&pose.center);
        for &node in flow.boundaries.nodes_on(body.boundary) {
            let copies = flow.boundaries.body_copies().iter();
            let copies = copies.filter(|pair| pair.original == node).map(|pair| pair.copy);
            let lever = flow.mesh.nodes[node] - center;
            let by_force = weight_of_force(problem, &lever, &weights.load);
            for at in std::iter::once(node).chain(copies) {
                sum.add(flow, [node, at], &by_force, weights.power);
            }
        }
    }
    sum
}

/// What the force of the fluid at a node counts, which is `lever` (m) from the centre of its body.
fn weight_of_force<const D: usize>(
    problem: &Problem<D>,
    lever: &Point<D>,
    weights: &RigidVector,
) -> Point<D> {
    Point::<D>::from_fn(|axis, _| {
        let mut unit = Point::<D>::zeros();
        unit[axis] = 1.0;
        let force = problem.metric.total_force(&unit);
        let torque = problem.metric.total_torque(lever, &unit);
        let [of_force, of_torque] = [0, 3].map(|first| weights.fixed_rows::<3>(first).into_owned());
        of_force.dot(&force) + of_torque.dot(&torque)
    })
}

impl LoadDerivatives {
    /// Adds those of the force on a node of a body, or on a periodic copy of it, to which the residual belongs.
    fn add<const D: usize>(
        &mut self,
        flow: &ResidualOnMesh<'_, D>,
        [node, residual_at]: [NodeId; 2],
        by_force: &Point<D>,
        power: f64,
    ) {
        for axis in 0..D {
            let [row, velocity] = [residual_at, node].map(|node| flow.layout.velocity(node, axis));
            self.by_residual[row] += power * flow.velocity[node][axis] - by_force[axis];
            self.by_solution[velocity] += power * flow.residual[row];
        }
    }
}
