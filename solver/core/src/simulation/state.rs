//! `State`: what evolves: mesh, fields, bodies, at the present level and the one before.

use alewife_mesh::{Mesh, Point};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::energy::EnergyBalance;
use super::momentum::MomentumBalance;
use super::propulsion_history::{PropulsionHistory, PropulsionStep};
use crate::body::{Pose, Twist, on_mesh};
use crate::contact::ContactLoads;
use crate::coupling::{
    BodyLoads, LoadedBodies, Problem, PropulsionPower, Solution, SurfaceStress, propulsion_power,
};
use crate::space::DofLayout;

/// A piece of a step.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Piece {
    /// Its size (s).
    pub size: f64,
    /// Whether rates jump at its beginning, so that what was before does not count.
    pub is_restart: bool,
}

/// Everything that evolves.
#[derive(Debug, Clone)]
pub struct State<const D: usize> {
    /// Number of steps made.
    pub step: usize,
    /// Time (s).
    pub time: f64,
    /// The last step (s), zero before the first and where rates jump.
    pub last_step: f64,
    /// The step proposed by the step-size control (s), none before the first or with fixed steps.
    pub proposed_step: Option<f64>,
    /// Pieces of the present step that are still to be made, the next one last.
    pub pieces: Vec<Piece>,
    /// Meshes generated since the first.
    pub remeshes: usize,
    /// The mesh at present, in the laboratory.
    pub mesh: Mesh<D>,
    /// Where the frame of reference is at present (m).
    pub origin: Vector3<f64>,
    /// Positions of the nodes at present, seen from the frame (m).
    pub nodes: Vec<Point<D>>,
    /// Positions of the same nodes one step before, seen from the frame (m).
    pub nodes_before: Vec<Point<D>>,
    /// Fields and rigid velocities at present.
    pub now: Solution<D>,
    /// Fields and rigid velocities one step before.
    pub previous: Solution<D>,
    /// Poses of the bodies at present, in the laboratory.
    pub poses: Vec<Pose>,
    /// Poses of the bodies one step before.
    pub previous_poses: Vec<Pose>,
    /// What is added to the centre of a body for where it is in the mesh (m): whole periods.
    pub image_shifts: Vec<Vector3<f64>>,
    /// Rates of change of the velocities at the nodes (m/s2).
    pub rates: Vec<Point<D>>,
    /// Rates of change of the rigid velocities (m/s2, rad/s2).
    pub accelerations: Vec<Twist>,
    /// The largest speed so far (m/s).
    pub top_speed: f64,
    /// The largest speed of a boundary so far (m/s).
    pub boundary_speed: f64,
    /// Loads of contact, and the smallest gap.
    pub contact: ContactLoads,
    /// What each group of bodies does and has done.
    pub propulsion: Vec<PropulsionHistory>,
    /// Where the work of the bodies went so far.
    pub energy: EnergyBalance,
    /// Impulses and momenta so far.
    pub momentum: MomentumBalance,
}

/// The level a step leads to.
#[derive(Debug, Clone)]
pub struct NewLevel<const D: usize> {
    /// Time (s).
    pub time: f64,
    /// Size of the step (s).
    pub step: f64,
    /// Fields and rigid velocities.
    pub solution: Solution<D>,
    /// Poses of the bodies, in the laboratory.
    pub poses: Vec<Pose>,
    /// Positions of the nodes, seen from the frame (m).
    pub nodes: Vec<Point<D>>,
    /// Rates of change of the velocities at the nodes (m/s2); `None` leaves those before.
    pub rates: Option<Vec<Point<D>>>,
    /// Rates of change of the rigid velocities (m/s2, rad/s2).
    pub accelerations: Vec<Twist>,
    /// Loads of contact, and the smallest gap.
    pub contact: ContactLoads,
    /// What each group of bodies did in the step.
    pub propulsion: Vec<PropulsionStep>,
}

impl<const D: usize> State<D> {
    /// Everything at rest at time zero.
    #[must_use]
    pub fn at_rest(problem: &Problem<D>, mesh: Mesh<D>) -> Self {
        let n_bodies = problem.bodies.len();
        let at_rest = Solution::at_rest(&DofLayout::new(&mesh, n_bodies, problem.modes().len()));
        let poses: Vec<Pose> = problem.bodies.iter().map(|body| body.pose).collect();
        Self {
            step: 0,
            time: 0.0,
            last_step: 0.0,
            proposed_step: None,
            pieces: Vec::new(),
            remeshes: 0,
            origin: Vector3::zeros(),
            nodes: mesh.nodes.clone(),
            nodes_before: mesh.nodes.clone(),
            now: at_rest.clone(),
            previous: at_rest,
            previous_poses: poses.clone(),
            image_shifts: vec![Vector3::zeros(); n_bodies],
            rates: vec![Point::<D>::zeros(); mesh.n_nodes()],
            accelerations: vec![Twist::default(); n_bodies],
            top_speed: 0.0,
            boundary_speed: 0.0,
            contact: ContactLoads::none(n_bodies),
            propulsion: vec![PropulsionHistory::default(); problem.groups.len()],
            energy: EnergyBalance::default(),
            momentum: MomentumBalance::default(),
            poses,
            mesh,
        }
    }

    /// Time of the level before (s).
    #[must_use]
    pub fn time_before(&self) -> f64 {
        self.time - self.last_step
    }

    /// The one place where a state moves on in time.
    pub fn accept(&mut self, problem: &Problem<D>, level: NewLevel<D>) {
        self.top_speed = self.top_speed.max(level.solution.top_speed());
        self.origin = self.origin_at(problem, &level.poses);
        let origin = on_mesh::<D>(&self.origin);
        for (node, seen) in self.mesh.nodes.iter_mut().zip(&level.nodes) {
            *node = seen + origin;
        }
        for (history, step) in self.propulsion.iter_mut().zip(&level.propulsion) {
            history.add_step(level.step, step);
        }
        self.nodes_before = std::mem::replace(&mut self.nodes, level.nodes);
        self.previous_poses = std::mem::replace(&mut self.poses, level.poses);
        self.previous = std::mem::replace(&mut self.now, level.solution);
        if let Some(rates) = level.rates {
            self.rates = rates;
        }
        (self.accelerations, self.contact) = (level.accelerations, level.contact);
        self.step += 1;
        (self.time, self.last_step) = (level.time, level.step);
    }

    /// Poses where bodies would be in the mesh.
    #[must_use]
    pub fn in_mesh(&self, poses: &[Pose]) -> Vec<Pose> {
        seen_from(&Vector3::zeros(), poses, &self.image_shifts)
    }

    /// Poses where bodies would be in the mesh, seen from a frame at `origin` (m).
    #[must_use]
    pub fn in_frame(&self, origin: &Vector3<f64>, poses: &[Pose]) -> Vec<Pose> {
        seen_from(origin, poses, &self.image_shifts)
    }

    /// Poses where bodies would be in the mesh, seen from the frame that goes with them.
    #[must_use]
    pub fn in_own_frame(&self, problem: &Problem<D>, poses: &[Pose]) -> Vec<Pose> {
        self.in_frame(&self.origin_at(problem, poses), poses)
    }

    /// Puts the state on another mesh, seen from the frame, whose nodes were at `before` (m) one step
    /// before.
    pub(super) fn put_on_mesh(&mut self, mesh: Mesh<D>, before: Vec<Point<D>>) {
        self.nodes.clone_from(&mesh.nodes);
        self.nodes_before = before;
        self.mesh = mesh;
        let origin = on_mesh::<D>(&self.origin);
        for node in &mut self.mesh.nodes {
            *node += origin;
        }
    }

    /// The mesh at present, seen from the frame.
    #[must_use]
    pub fn mesh_in_frame(&self) -> Mesh<D> {
        self.mesh.with_nodes(self.nodes.clone())
    }

    /// What the groups do in a flow, with bodies at these poses in the laboratory.
    #[must_use]
    pub fn propulsion_powers(
        &self,
        problem: &Problem<D>,
        poses: &[Pose],
        twists: &[Twist],
        loads: &[BodyLoads],
        stress: &SurfaceStress<'_, D>,
    ) -> Vec<PropulsionPower> {
        let bodies = LoadedBodies { poses, image_shifts: &self.image_shifts, twists, loads };
        let groups = problem.groups.iter();
        groups.map(|group| propulsion_power(problem, group, &bodies, stress)).collect()
    }

    /// Where the frame is with bodies at these poses (m).
    #[must_use]
    pub fn origin_at(&self, problem: &Problem<D>, poses: &[Pose]) -> Vector3<f64> {
        problem
            .frame
            .map_or(Vector3::zeros(), |body| poses[body].center - problem.bodies[body].pose.center)
    }
}

/// Poses, `image_shifts` added to their centres, seen from a frame at `origin` (m).
pub(super) fn seen_from(
    origin: &Vector3<f64>,
    poses: &[Pose],
    image_shifts: &[Vector3<f64>],
) -> Vec<Pose> {
    let pairs = poses.iter().zip(image_shifts);
    pairs.map(|(pose, shift)| Pose { center: pose.center + shift - origin, ..*pose }).collect()
}
