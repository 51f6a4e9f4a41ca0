//! Bodies that leave through an open side, where a run may end.

use crate::case::{Unsteady, Until};
use crate::contact::Partner;
use crate::coupling::{Drive, RigidBody, Side};
use crate::run::RunError;
use crate::run::run::Run;

impl<const D: usize> Run<'_, D> {
    /// Whether bodies have left, so that the run is over before its end.
    pub(in crate::run) fn is_over(&mut self, settings: &Unsteady) -> Result<bool, RunError> {
        let Some(until) = settings.until else { return Ok(false) };
        let leaving = self.leaving(until.distance())?;
        for (body, side) in leaving.iter().enumerate() {
            let Some(side) = side.as_ref().filter(|_| !self.warned.has_left(body)) else {
                continue;
            };
            self.warned.left.push(body);
            let name = &self.simulation.problem.bodies[body].name;
            let time = self.simulation.state.time;
            tracing::info!("`{name}` leaves through `{side}` at t = {time:.6}");
        }
        let problem = &self.simulation.problem;
        let mut free = leaving.iter().zip(&problem.bodies).filter(|(_, body)| is_free(body));
        Ok(match until {
            Until::OneLeaves(_) => free.any(|(side, _)| side.is_some()),
            Until::AllLeave(_) => free.all(|(side, _)| side.is_some()),
        })
    }

    /// The open side each body is nearer to than a distance (m), by its name.
    fn leaving(&self, distance: f64) -> Result<Vec<Option<String>>, RunError> {
        let crate::run::Simulation { problem, state, moving_mesh, .. } = &self.simulation;
        let mut leaving = vec![None; problem.bodies.len()];
        let Some(moving) = moving_mesh else { return Ok(leaving) };
        let gaps = moving.present_gaps(problem, state)?;
        let mut nearest = vec![distance; problem.bodies.len()];
        for pair in gaps.pairs(distance) {
            let Partner::Wall(side) = pair.partner else { continue };
            let is_open = problem.sides[side].as_ref().is_some_and(Side::is_open);
            if is_open && pair.gap < nearest[pair.body] {
                nearest[pair.body] = pair.gap;
                leaving[pair.body] = Some(gaps.partner_name(pair.partner).to_owned());
            }
        }
        Ok(leaving)
    }
}

/// Whether a body goes where the fluid takes it, by itself.
fn is_free(body: &RigidBody) -> bool {
    body.joint.is_none() && body.drives.iter().any(|drive| matches!(drive, Drive::Free))
}
