//! `NewLevel` and `TransferredState`: what a step leads to, and what a new mesh begins with.

use alewife_mesh::{Mesh, Point};
use nalgebra::Vector3;

use super::propulsion_history::PropulsionStep;
use crate::body::{Pose, Twist};
use crate::contact::ContactLoads;
use crate::coupling::Solution;
use crate::scalar::ScalarField;

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
    /// Coordinates of all bodies.
    pub coordinates: Vec<f64>,
    /// Rates of change of their rates.
    pub coordinate_accelerations: Vec<f64>,
    /// Positions of the nodes, seen from the frame (m).
    pub nodes: Vec<Point<D>>,
    /// Rates of change of the velocities at the nodes (m/s2); `None` leaves those before.
    pub rates: Option<Vec<Point<D>>>,
    /// Rates of change of the momenta of the bodies, over their inertia (m/s2, rad/s2).
    pub accelerations: Vec<Twist>,
    /// Rates of change of their velocities (m/s2, rad/s2).
    pub twist_rates: Vec<Twist>,
    /// Loads of contact, and the smallest gap.
    pub contact: ContactLoads,
    /// What each group of bodies did in the step.
    pub propulsion: Vec<PropulsionStep>,
}

/// A state on another mesh.
#[derive(Debug, Clone)]
pub struct TransferredState<const D: usize> {
    /// The mesh, seen from the frame.
    pub mesh: Mesh<D>,
    /// Positions of its nodes one step before, seen from the frame (m).
    pub nodes_before: Vec<Point<D>>,
    /// Fields and rigid velocities at present.
    pub now: Solution<D>,
    /// Fields and rigid velocities one step before.
    pub previous: Solution<D>,
    /// Rates of change of the velocities at the nodes (m/s2).
    pub rates: Vec<Point<D>>,
    /// Whole periods from each body to its image in the mesh (m).
    pub image_shifts: Vec<Vector3<f64>>,
    /// What the flow carries and what diffuses.
    pub scalars: Vec<ScalarField>,
}
