//! `ByQuasiNewton`: contact where each solution for loads takes iterations, by a multisecant quasi-Newton method.
//!
//! The flow is solved with loads of contact that are nearly right: those of the law where bodies are predicted, or
//! those of the iteration before. Only a small correction is left to be solved for, by an estimate of the mobility
//! that each solution improves by a secant pair (`secant_mobility.rs`). Where that does not converge, the exact mobility is
//! solved for, column by column.

use nalgebra::{DMatrix, DVector};

use super::by_mobility::solve_by_mobility;
use super::coupled_contact::CoupledContact;
use super::coupled_solver::CoupledSolver;
use super::drag_mobility::DragMobility;
use super::loaded_flow::LoadedFlow;
use super::secant_mobility::SecantMobility;
use crate::body::{Twist, Wrench};
use crate::contact::{ContactError, ContactLoads};

/// Largest displacement error at convergence over the smallest gap, or the range where that is less.
const TOLERANCE: f64 = 1e-6;
/// The same where another iteration for the poses follows.
const TOLERANCE_IN_BETWEEN: f64 = 1e-4;
/// Most secant pairs.
const MAX_SECANTS: usize = 16;
/// Largest relative residual of a linear solve.
const LARGEST_FORCING: f64 = 1e-2;
/// Accuracy of the solutions for loads, relative to the largest load: the flow is solved to 1e-6 of what changes it.
const ACCURACY: f64 = 1e-7;

/// Contact by secants, with what the iterations for the poses of a step have given so far.
#[derive(Debug, Clone, Default)]
pub struct ByQuasiNewton {
    /// Loads of the iteration before, or those the flow was solved with at first.
    loads: Option<ContactLoads>,
    mobility: Option<KnownMobility>,
}

/// The mobility that the iteration before has ended with.
#[derive(Debug, Clone)]
struct KnownMobility {
    /// Of these bodies, ascending.
    bodies: Vec<usize>,
    matrix: DMatrix<f64>,
}

impl<E: From<ContactError>> CoupledSolver<E> for ByQuasiNewton {
    fn first_loads(&mut self, contact: &CoupledContact<'_>) -> Option<ContactLoads> {
        Some(self.loads.get_or_insert_with(|| loads_where_predicted(contact)).clone())
    }

    fn solve(
        &mut self,
        contact: &CoupledContact<'_>,
        flow: &mut dyn LoadedFlow<Error = E>,
    ) -> Result<ContactLoads, E> {
        let none = || ContactLoads::none(contact.gaps.n_bodies());
        let mut applied = self.loads.take().unwrap_or_else(none);
        let bodies = contact.candidate_bodies(&flow.reached(), &applied);
        if !bodies.is_empty() && !self.iterate(contact, &bodies, flow, &mut applied)? {
            applied = solve_by_mobility(contact, &bodies, flow, applied)?;
        }
        self.loads = Some(applied.clone());
        Ok(applied)
    }
}

impl ByQuasiNewton {
    /// Replaces loads in a flow until they are those at the gaps. Whether that was reached, or nearly where another iteration
    /// for the poses follows.
    fn iterate<E: From<ContactError>>(
        &mut self,
        contact: &CoupledContact<'_>,
        bodies: &[usize],
        flow: &mut dyn LoadedFlow<Error = E>,
        applied: &mut ContactLoads,
    ) -> Result<bool, E> {
        let mut mobility = self.first_mobility(contact, bodies, flow);
        let rows = contact.rows(bodies);
        let error = |off: DVector<f64>, mobility: &SecantMobility| {
            let off = mobility.free_part(off) / contact.dynamics.rate;
            contact.gaps.largest_displacement(bodies, rows.modes, &off)
        };
        let is_enough_for_now =
            |error: f64, flow: &dyn LoadedFlow<Error = E>, loads: &ContactLoads| {
                error <= TOLERANCE_IN_BETWEEN && !flow.poses_have_converged(loads)
            };
        let range = contact.law.range();
        let mut largest = mobility.size(&contact.loads(bodies, applied));
        let mut has_converged = false;
        for secant in 0..MAX_SECANTS {
            let found = contact.solve(bodies, flow.twists(), applied, mobility.matrix());
            let Ok(found) = found else { break };
            let change = contact.loads(bodies, &found.loads) - contact.loads(bodies, applied);
            let size = mobility.size(&change);
            largest = largest.max(size);
            let expected = rows.of_each(found.velocities.iter().map(Twist::to_vector));
            let before = rows.of_twists(flow.twists());
            let gap = found.loads.minimum_gap.map_or(range, |least| least.gap.min(range));
            let off = error(&expected - &before, &mobility) / gap;
            let is_unchanged = size <= TOLERANCE * largest && off <= TOLERANCE;
            if is_unchanged || is_enough_for_now(off, flow, applied) {
                tracing::debug!(secant, size, off, gap, "loads of contact stay");
                has_converged = true;
                break;
            }
            let forcing = (ACCURACY * largest / size).min(LARGEST_FORCING);
            contact.replace(flow, applied, found.loads, Some(forcing))?;
            let now = rows.of_twists(flow.twists());
            mobility.update(change, &now - before);
            let off = error(now - expected, &mobility) / gap;
            tracing::debug!(secant, size, off, gap, bodies = bodies.len(), "contact");
            if off <= TOLERANCE || is_enough_for_now(off, flow, applied) {
                has_converged = true;
                break;
            }
        }
        self.mobility =
            Some(KnownMobility { bodies: bodies.to_vec(), matrix: mobility.into_matrix() });
        Ok(has_converged)
    }

    /// The mobility before the first secant pair of this configuration.
    fn first_mobility<E: From<ContactError>>(
        &mut self,
        contact: &CoupledContact<'_>,
        bodies: &[usize],
        flow: &dyn LoadedFlow<Error = E>,
    ) -> SecantMobility {
        let CoupledContact { gaps, law, dynamics, .. } = contact;
        let motions = flow.free_motions(&contact.loaded(bodies));
        let drag = DragMobility { gaps: *gaps, law, bodies, motions, dynamics };
        let estimate = drag.estimate(&contact.predicted);
        match self.mobility.take().filter(|known| known.bodies == bodies) {
            Some(known) => estimate.starting_from(known.matrix),
            None => estimate,
        }
    }
}

/// Loads of the law with bodies where they are predicted, if they are apart there.
fn loads_where_predicted(contact: &CoupledContact<'_>) -> ContactLoads {
    let loads = ContactLoads::new(contact.gaps, contact.law, &contact.predicted);
    let is_finite = |wrench: &Wrench| wrench.to_vector().iter().all(|part| part.is_finite());
    let are_apart = loads.contacts.iter().all(|contact| contact.pair.gap > 0.0);
    if are_apart && loads.wrenches.iter().all(is_finite) {
        loads
    } else {
        ContactLoads::none(contact.gaps.n_bodies())
    }
}
