//! `ByMobility`: contact with the mobility that the factors of the system give, by Newton's method.

use super::coupled_contact::{CoupledContact, ElasticContact};
use super::coupled_solver::CoupledSolver;
use super::loaded_flow::LoadedFlow;
use crate::body::BodyLoad;
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
        let bodies = contact.candidates_in(flow);
        if bodies.is_empty() {
            return Ok(none);
        }
        match &contact.elastic {
            Some(elastic) => solve_with_coordinates(contact, elastic, &bodies, flow),
            None => solve_by_mobility(contact, &bodies, flow, none),
        }
    }
}

/// Adds the loads of contact to a flow without where bodies have coordinates. What acts on these beside contact is what forces
/// within the bodies change by, beyond what the matrix has of them.
///
/// # Errors
/// When contact forces are not found, or the linear system cannot be solved.
fn solve_with_coordinates<E: From<ContactError>>(
    contact: &CoupledContact<'_>,
    elastic: &ElasticContact<'_>,
    bodies: &[usize],
    flow: &mut dyn LoadedFlow<Error = E>,
) -> Result<ContactLoads, E> {
    if contact.is_free_in(elastic, flow) {
        return Ok(ContactLoads::none(contact.gaps.n_bodies()));
    }
    let mobility = flow.mobility(&contact.loaded(bodies), true)?;
    let found = contact.solve_with_coordinates(elastic, bodies, flow, &mobility)?;
    let ranges = elastic.bodies.ranges();
    // Loads on a body with coordinates act on these
    let on_bodies = found.loads.wrenches.iter().enumerate().filter_map(|(body, wrench)| {
        let load = wrench.to_vector();
        let is_loaded = ranges[body].is_empty() && load.iter().any(|part| *part != 0.0);
        is_loaded.then_some(BodyLoad { body, load })
    });
    let on_coordinates = found.loads.on_coordinates.iter().zip(found.beyond.iter());
    let on_coordinates: Vec<f64> = on_coordinates.map(|(load, beyond)| load - beyond).collect();
    flow.add_loads(&on_bodies.collect::<Vec<_>>(), &on_coordinates, None)?;
    Ok(found.loads)
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
    let mobility = flow.mobility(&contact.loaded(bodies), false)?;
    let next = contact.solve(bodies, flow.twists(), &applied, &mobility)?.loads;
    contact.replace(flow, &mut applied, next, None)?;
    Ok(applied)
}
