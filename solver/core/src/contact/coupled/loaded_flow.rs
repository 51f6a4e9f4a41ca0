//! `LoadedFlow`: a flow that loads on its bodies change.

use nalgebra::DMatrix;

use crate::body::{BodyLoad, LoadedBody, Pose, Twist};
use crate::contact::{ContactError, ContactLoads, InnerForces};

/// The flow of one configuration, with the loads that have been added so far.
pub trait LoadedFlow {
    /// Why loads could not be added.
    type Error: From<ContactError>;

    /// Velocities of all bodies (m/s, rad/s).
    fn twists(&self) -> &[Twist];

    /// Rates of the coordinates of all bodies that have some.
    fn rates(&self) -> &[f64];

    /// Forces within bodies with coordinates beyond those that the mobility knows, relative to the flow as it is.
    fn inner_forces(&self) -> Box<dyn InnerForces>;

    /// Coordinates of all bodies at the end of the step with these rates.
    fn reached_coordinates(&self) -> Vec<f64>;

    /// Poses of all bodies at the end of the step with these velocities, as seen in the configuration.
    fn reached(&self) -> Vec<Pose>;

    /// Whether bodies with these velocities and loads of contact end where the flow is solved for, so that no further
    /// iteration for the poses follows.
    fn poses_have_converged(&self, contact: &ContactLoads) -> bool;

    /// How the velocities of some bodies follow from the unknowns they depend on: a row for each motion, body by body, a
    /// column for each unknown.
    fn free_motions(&self, bodies: &[LoadedBody]) -> DMatrix<f64>;

    /// Velocities of some bodies (m/s, rad/s) by unit loads in each of their motions; if `with_coordinates`, the rates of
    /// all coordinates and loads on these after them.
    ///
    /// # Errors
    /// When the linear system cannot be solved.
    fn mobility(
        &mut self,
        bodies: &[LoadedBody],
        with_coordinates: bool,
    ) -> Result<DMatrix<f64>, Self::Error>;

    /// Adds loads, and such on all coordinates if there are any. Where a solution takes iterations, these leave the part `tolerance` of the loads, by default as
    /// much as those of the flow.
    ///
    /// # Errors
    /// When the linear system cannot be solved.
    fn add_loads(
        &mut self,
        loads: &[BodyLoad],
        on_coordinates: &[f64],
        tolerance: Option<f64>,
    ) -> Result<(), Self::Error>;
}
