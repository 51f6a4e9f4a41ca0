//! `ContactLoads`: force and torque of contact on each body, with every contact and its gap.

use super::{Feature, Law, LeastGap, Partner, Place, Surfaces};
use crate::body::Wrench;

/// A contact with its force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Where, between what, and the gap.
    pub feature: Feature,
    /// Repulsive force along the normal (N; N/m planar). On a ring in axisymmetric problems only
    /// its part along the axis is a load.
    pub force: f64,
}

/// What contact does to the bodies.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ContactLoads {
    /// Force and torque about the centre of mass of each body.
    pub wrenches: Vec<Wrench>,
    /// All contacts within the range.
    pub contacts: Vec<Contact>,
    /// The smallest gap, within the range or not; `None` for one body without walls.
    pub least_gap: Option<LeastGap>,
}

impl ContactLoads {
    /// No contact at all.
    #[must_use]
    pub fn none(n_bodies: usize) -> Self {
        Self { wrenches: vec![Wrench::default(); n_bodies], ..Self::default() }
    }

    /// Loads of a law with bodies at `places`.
    #[must_use]
    pub fn new(surfaces: &Surfaces, law: &Law, places: &[Place]) -> Self {
        let features = surfaces.features(places, law.range());
        let contacts = features
            .into_iter()
            .map(|feature| Contact { feature, force: feature.weight * law.force(feature.at.gap) });
        Self::gather(surfaces.n_bodies(), contacts.collect(), surfaces.least_gap(places))
    }

    /// Sums the loads of contacts.
    pub(super) fn gather(
        n_bodies: usize,
        contacts: Vec<Contact>,
        least_gap: Option<LeastGap>,
    ) -> Self {
        let mut wrenches = vec![Wrench::default(); n_bodies];
        for contact in &contacts {
            let [on_body, on_partner] = contact.feature.loads(contact.force);
            let body = contact.feature.body;
            wrenches[body] = wrenches[body] + on_body;
            if let Partner::Body(other) = contact.feature.partner {
                wrenches[other] = wrenches[other] + on_partner;
            }
        }
        Self { wrenches, contacts, least_gap }
    }
}
