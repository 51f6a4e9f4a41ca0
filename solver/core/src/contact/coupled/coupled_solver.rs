//! `CoupledSolver`: how contact is found in the flow of a step.

use super::coupled_contact::CoupledContact;
use super::loaded_flow::LoadedFlow;
use crate::contact::ContactLoads;

/// A method for contact in the flow of a step; it lasts for all iterations for the poses.
pub trait CoupledSolver<E> {
    /// Loads with which the flow of an iteration is best solved at first; none where the flow without contact does as
    /// well.
    fn first_loads(&mut self, contact: &CoupledContact<'_>) -> Option<ContactLoads>;

    /// Replaces the first loads in a flow by those that belong to the gaps at the end of the step, and returns them.
    ///
    /// # Errors
    /// When contact forces are not found, or the linear system cannot be solved.
    fn solve(
        &mut self,
        contact: &CoupledContact<'_>,
        flow: &mut dyn LoadedFlow<Error = E>,
    ) -> Result<ContactLoads, E>;
}
