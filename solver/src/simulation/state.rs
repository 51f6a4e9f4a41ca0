//! `State`: what evolves: mesh, fields, bodies, at the present level and the one before.

use alewife_mesh::Mesh;

use crate::body::{Pose, Twist};
use crate::coupling::{Problem, Solution};
use crate::space::DofLayout;

/// Everything that evolves.
#[derive(Debug, Clone)]
pub struct State {
    /// Number of steps made.
    pub step: usize,
    /// Time (s).
    pub time: f64,
    /// The mesh now.
    pub mesh: Mesh<2>,
    /// Fields and twists now.
    pub now: Solution,
    /// Fields and twists one step before.
    pub previous: Solution,
    /// Poses now.
    pub poses: Vec<Pose>,
    /// Angles now (rad), counted through turns.
    pub angles: Vec<f64>,
    /// Centres and angles one step before (m, rad).
    pub previous_places: Vec<[f64; 3]>,
    /// Rates of change of the twists (m/s2, rad/s2).
    pub accelerations: Vec<Twist>,
}

impl State {
    /// Everything at rest at time zero.
    #[must_use]
    pub fn at_rest(problem: &Problem, mesh: Mesh<2>) -> Self {
        let layout = DofLayout::new(&mesh, problem.bodies.len());
        let at_rest = Solution::at_rest(&layout);
        let poses: Vec<_> = problem.bodies.iter().map(|body| body.pose).collect();
        let angles: Vec<f64> = poses.iter().map(Pose::angle).collect();
        let places =
            poses.iter().zip(&angles).map(|(pose, angle)| [pose.center.x, pose.center.y, *angle]);
        Self {
            step: 0,
            time: 0.0,
            now: at_rest.clone(),
            previous: at_rest,
            previous_places: places.collect(),
            accelerations: vec![Twist::default(); poses.len()],
            poses,
            angles,
            mesh,
        }
    }

    /// Centre and angle of a body now (m, rad).
    #[must_use]
    pub fn place(&self, body: usize) -> [f64; 3] {
        let center = &self.poses[body].center;
        [center.x, center.y, self.angles[body]]
    }
}
