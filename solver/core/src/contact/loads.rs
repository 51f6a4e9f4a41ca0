//! `ContactLoads`: force and torque of contact on each body, with every contact and its gap.

use serde::{Deserialize, Serialize};

use super::{ContactPair, Gaps, Law, MinimumGap, Partner};
use crate::body::{Pose, Wrench};

/// A pair of points with its force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactForce {
    /// Where, between what, and the gap.
    pub pair: ContactPair,
    /// Repulsive force along the normal (N; N/m planar). On a ring in axisymmetric problems only
    /// its part along the axis is a load.
    pub force: f64,
}

/// What contact does to the bodies.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactLoads {
    /// Force and torque about the centre of mass of each body.
    pub wrenches: Vec<Wrench>,
    /// All contacts within the range. They are not saved: a step starts from none.
    #[serde(skip)]
    pub contacts: Vec<ContactForce>,
    /// The smallest gap, within the range or not; `None` for one body without walls.
    pub minimum_gap: Option<MinimumGap>,
}

impl ContactLoads {
    /// No contact at all.
    #[must_use]
    pub fn none(n_bodies: usize) -> Self {
        Self { wrenches: vec![Wrench::default(); n_bodies], ..Self::default() }
    }

    /// Loads of a law with bodies in these poses.
    #[must_use]
    pub fn new(gaps: &dyn Gaps, law: &Law, poses: &[Pose]) -> Self {
        let pairs = gaps.pairs(poses, law.range());
        let contacts = pairs
            .into_iter()
            .map(|pair| ContactForce { pair, force: pair.weight * law.force(pair.gap) });
        Self::gather(gaps.n_bodies(), contacts.collect(), gaps.minimum_gap(poses))
    }

    /// Sums the loads of contacts.
    pub(super) fn gather(
        n_bodies: usize,
        contacts: Vec<ContactForce>,
        minimum_gap: Option<MinimumGap>,
    ) -> Self {
        let mut wrenches = vec![Wrench::default(); n_bodies];
        for contact in &contacts {
            let [on_body, on_partner] = contact.pair.loads(contact.force);
            let body = contact.pair.body;
            wrenches[body] = wrenches[body] + on_body;
            if let Partner::Body(other) = contact.pair.partner {
                wrenches[other] = wrenches[other] + on_partner;
            }
        }
        Self { wrenches, contacts, minimum_gap }
    }
}
