//! Where bodies in contact get to: velocities that are extrapolated know nothing of how contact changes in the step.
//!
//! Contact is solved for as after the flow, with a mobility that is estimated, and all other loads on the bodies stay as they
//! are. With the mass matrix M, the resistance R and the acceleration a of the present level, the load that extrapolated
//! velocities V imply beside those is
//!
//! f + (M rate + R) (V - U) + M (rate U + h - a),
//!
//! with velocities U and loads f of contact at present, and h the older part of the rate of velocities.

use nalgebra::DMatrix;

use super::coupled_contact::CoupledContact;
use super::drag_mobility::DragMobility;
use crate::body::{LoadedBody, RigidVector, Twist};
use crate::contact::ContactLoads;

/// What contact is predicted from; vectors are of all bodies.
pub struct ContactPrediction<'a> {
    /// Contact with bodies where extrapolated velocities lead.
    pub contact: CoupledContact<'a>,
    /// Extrapolated velocities (m/s, rad/s).
    pub extrapolated: &'a [Twist],
    /// Velocities at present.
    pub velocities: &'a [Twist],
    /// Rates of change of the velocities at present (m/s2, rad/s2).
    pub accelerations: &'a [Twist],
    /// Older part of their rates at the new time.
    pub older: Vec<RigidVector>,
    /// Loads of contact at present.
    pub loads: &'a ContactLoads,
}

impl ContactPrediction<'_> {
    /// Velocities at the new time, changed where there may be contact; none where there is none, or where it is not found.
    /// `free_motions` gives the velocities of some bodies by the unknowns they depend on, as
    /// [`LoadedFlow::free_motions`](super::LoadedFlow::free_motions).
    pub fn velocities(
        &self,
        free_motions: impl FnOnce(&[LoadedBody]) -> DMatrix<f64>,
    ) -> Option<Vec<Twist>> {
        let CoupledContact { gaps, law, predicted, dynamics, .. } = &self.contact;
        let bodies = self.contact.candidate_bodies(predicted, self.loads);
        if bodies.is_empty() {
            return None;
        }
        let rows = self.contact.rows(&bodies);
        let motions = free_motions(&self.contact.loaded(&bodies));
        let drag = DragMobility { gaps: *gaps, law, bodies: &bodies, motions, dynamics };
        let mut twists = self.extrapolated.to_vec();
        let [now, then] = [self.velocities, &twists].map(|twists| rows.of_twists(twists));
        let older = rows.of(|body| self.older[body]);
        let rates = &now * dynamics.rate + older - rows.of_twists(self.accelerations);
        let loads = self.contact.loads(&bodies, self.loads);
        let resistance = drag.resistance_at(predicted);
        let implied = loads + &resistance * (&then - now) + drag.inertia() * rates;
        let mobility = drag.mobility(&resistance);
        let pushed = &mobility * implied;
        let free = then - &pushed;
        let found = self.contact.solve_without_loads(&bodies, &free, &mobility).ok()?;
        let change = mobility * self.contact.loads(&bodies, &found.loads) - pushed;
        for (&body, change) in bodies.iter().zip(rows.twists(&change)) {
            twists[body] = Twist::from_vector(&(twists[body].to_vector() + change.to_vector()));
        }
        Some(twists)
    }
}
