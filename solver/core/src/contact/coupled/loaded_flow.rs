//! `LoadedFlow`: a flow that loads on its bodies change.

use nalgebra::DMatrix;

use crate::body::{BodyLoad, LoadedBody, Pose, Twist};
use crate::contact::{ContactError, ContactLoads};

/// The flow of one configuration, with the loads that have been added so far.
pub trait LoadedFlow {
    /// Why loads could not be added.
    type Error: From<ContactError>;

    /// Velocities of all bodies (m/s, rad/s).
    fn twists(&self) -> &[Twist];

    /// Poses of all bodies at the end of the step with these velocities, as seen in the configuration.
    fn reached(&self) -> Vec<Pose>;

    /// Whether bodies with these velocities and loads of contact end where the flow is solved for, so that no further
    /// iteration for the poses follows.
    fn poses_have_converged(&self, contact: &ContactLoads) -> bool;

    /// How the velocities of some bodies follow from the unknowns they depend on: a row for each motion, body by body, a
    /// column for each unknown.
    fn free_motions(&self, bodies: &[LoadedBody]) -> DMatrix<f64>;

    /// Velocities of some bodies (m/s, rad/s) by unit loads in each of their motions.
    ///
    /// # Errors
    /// When the linear system cannot be solved.
    fn mobility(&mut self, bodies: &[LoadedBody]) -> Result<DMatrix<f64>, Self::Error>;

    /// Adds loads. Where a solution takes iterations, these leave the part `tolerance` of the loads, by default as
    /// much as those of the flow.
    ///
    /// # Errors
    /// When the linear system cannot be solved.
    fn add_loads(&mut self, loads: &[BodyLoad], tolerance: Option<f64>) -> Result<(), Self::Error>;
}
