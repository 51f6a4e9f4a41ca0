//! `ContactLoads`: force and torque of contact on each body, with every contact and its gap.

use std::ops::Range;

use nalgebra::Vector3;
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
    /// What friction and damping add on the body (N; N/m planar).
    pub dissipative: Vector3<f64>,
}

/// What contact does to the bodies.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactLoads {
    /// Force and torque about the centre of mass of each body.
    pub wrenches: Vec<Wrench>,
    /// What contact does on the coordinates of all bodies that have some; nothing without contact. It is not saved, as a step
    /// starts from none.
    #[serde(skip)]
    pub on_coordinates: Vec<f64>,
    /// All contacts within the range. They are not saved: a step starts from none.
    #[serde(skip)]
    pub contacts: Vec<ContactForce>,
    /// The smallest gap, within the range or not; `None` for one body without walls.
    pub minimum_gap: Option<MinimumGap>,
    /// Energy stored in contact (J; J/m planar).
    pub energy: f64,
    /// Energy that errors of the steps have made in contact so far, less what they have lost (J; J/m planar).
    pub energy_made: f64,
}

impl ContactLoads {
    /// No contact at all.
    #[must_use]
    pub fn none(n_bodies: usize) -> Self {
        Self { wrenches: vec![Wrench::default(); n_bodies], ..Self::default() }
    }

    /// Loads of a law with bodies in these poses, without what depends on their velocities.
    #[must_use]
    pub fn new(gaps: &dyn Gaps, law: &Law, poses: &[Pose]) -> Self {
        let pairs = gaps.pairs(poses, law.range());
        let contacts = pairs.into_iter().map(|pair| ContactForce {
            pair,
            force: pair.weight * law.force(pair.gap),
            dissipative: Vector3::zeros(),
        });
        let loads = Self::gather(gaps.n_bodies(), contacts.collect(), gaps.minimum_gap(poses));
        let energies = loads.contacts.iter().map(|at| at.pair.weight * law.energy(at.pair.gap));
        Self { energy: energies.sum(), ..loads }
    }

    /// Sums the loads of contacts.
    pub(super) fn gather(
        n_bodies: usize,
        contacts: Vec<ContactForce>,
        minimum_gap: Option<MinimumGap>,
    ) -> Self {
        let mut wrenches = vec![Wrench::default(); n_bodies];
        for contact in &contacts {
            let [mut on_body, mut on_partner] = contact.pair.loads(contact.force);
            if contact.dissipative != Vector3::zeros() {
                let [body, partner] = contact.pair.loads_along(&contact.dissipative);
                on_body = on_body + body;
                on_partner = on_partner + partner;
            }
            let body = contact.pair.body;
            wrenches[body] = wrenches[body] + on_body;
            if let Partner::Body(other) = contact.pair.partner {
                wrenches[other] = wrenches[other] + on_partner;
            }
        }
        Self { wrenches, contacts, minimum_gap, ..Self::default() }
    }

    /// The same with what they are on coordinates, of which each body has these.
    pub(super) fn with_coordinates(self, ranges: &[Range<usize>]) -> Self {
        let mut loads = vec![0.0; ranges.last().map_or(0, |range| range.end)];
        for ContactForce { pair, force, dissipative } in &self.contacts {
            let sides = pair.gradient_along(&(pair.normal * *force + dissipative));
            let partner = match pair.partner {
                Partner::Body(other) => Some(other),
                Partner::Wall(_) => None,
            };
            for ((body, section), load) in
                [Some(pair.body), partner].into_iter().zip(&pair.sections).zip(&sides)
            {
                let (Some(body), Some(section)) = (body, section) else { continue };
                for at in section.on_coordinates(load) {
                    loads[ranges[body].start + at.coordinate] += at.value;
                }
            }
        }
        Self { on_coordinates: loads, ..self }
    }
}
