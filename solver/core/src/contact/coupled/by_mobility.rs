//! `ByMobility`: contact with the mobility that the factors of the system give, by Newton's method.

use super::coupled_contact::CoupledContact;
use super::coupled_solver::CoupledSolver;
use super::loaded_flow::LoadedFlow;
use crate::contact::{ContactError, ContactLoads};

/// Contact by the exact mobility: nothing is to be known of it beforehand.
#[derive(Debug, Clone, Copy, Default)]
pub struct ByMobility;

impl<E: From<ContactError>> CoupledSolver<E> for ByMobility {
    fn first_loads(&mut self, _contact: &CoupledContact<'_>) -> Option<ContactLoads> {
        None
    }

    fn solve(
        &mut self,
        contact: &CoupledContact<'_>,
        flow: &mut dyn LoadedFlow<Error = E>,
    ) -> Result<ContactLoads, E> {
        let none = ContactLoads::none(contact.gaps.n_bodies());
        let bodies = contact.candidate_bodies(&flow.reached(), &none);
        if bodies.is_empty() {
            return Ok(none);
        }
        solve_by_mobility(contact, &bodies, flow, none)
    }
}

/// Replaces the loads in a flow by those of contact with the exact mobility of these bodies.
///
/// # Errors
/// When contact forces are not found, or the linear system cannot be solved.
pub(super) fn solve_by_mobility<E: From<ContactError>>(
    contact: &CoupledContact<'_>,
    bodies: &[usize],
    flow: &mut dyn LoadedFlow<Error = E>,
    mut applied: ContactLoads,
) -> Result<ContactLoads, E> {
    let mobility = flow.mobility(&contact.loaded(bodies))?;
    let next = contact.solve(bodies, flow.twists(), &applied, &mobility)?.loads;
    contact.replace(flow, &mut applied, next, None)?;
    Ok(applied)
}
