//! Force, torque and power of each body from the residual of the discrete momentum equation.
//!
//! The residual tested with a function that is 1 on the body is minus the fluid's force on it;
//! for P2-P1 it converges about twice as fast as an integral of the stress (@babuska1984).

use alewife_mesh::{Mesh, Point};

use super::constrain::NodeSides;
use super::problem::Problem;
use crate::body::{Pose, Wrench};
use crate::space::DofLayout;

/// What the fluid does to a body, and the body to the fluid.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BodyLoads {
    /// Force and torque of the fluid on the body.
    pub load: Wrench,
    /// Rate of work of the body's surface on the fluid (W).
    pub power: f64,
}

/// Loads of all bodies from the raw residual at a solution.
#[must_use]
pub fn body_loads(
    problem: &Problem,
    mesh: &Mesh<2>,
    layout: &DofLayout<2>,
    sides: &NodeSides,
    poses: &[Pose],
    residual: &[f64],
    velocity: &[Point<2>],
) -> Vec<BodyLoads> {
    problem
        .bodies
        .iter()
        .zip(poses)
        .map(|(body, pose)| {
            let mut loads = BodyLoads::default();
            for node in sides.nodes_on(body.boundary) {
                let force = -Point::<2>::new(
                    residual[layout.velocity(node, 0)],
                    residual[layout.velocity(node, 1)],
                );
                let lever = mesh.nodes[node] - Point::<2>::new(pose.center.x, pose.center.y);
                loads.power -= force.dot(&velocity[node]);
                loads.load.force += problem.metric.total_force(&force);
                loads.load.torque += problem.metric.total_torque(&lever, &force);
            }
            loads
        })
        .collect()
}
