//! Contact in the flow of a stage of explicit steps: the force at the gaps as they are there.
//!
//! An explicit step is sound as long as contact is not stiff in it: the rates at which contact alone
//! would move the bodies back, the eigenvalues of M K with the mobility M and the stiffness K of
//! the contacts, have to be below a limit over the step. Where they are not, the step is refused,
//! so that it is halved; bodies that are pressed together for long are for BDF2.

use nalgebra::{DMatrix, DVector};

use super::coupled_contact::{changed_loads, loaded_bodies};
use super::loaded_flow::LoadedFlow;
use crate::body::Pose;
use crate::contact::{ContactError, ContactLoads, ContactPair, Gaps, Law, Partner};

/// Largest rate at which contact moves bodies back, times the step; explicit steps are stable up to
/// 2.5, and at 1 what decays by exp(-1) = 0.368 does so by 1/3.
const LARGEST_DECAY: f64 = 1.0;

/// What contact does at the poses of a stage.
pub struct StageContact<'a> {
    law: &'a Law,
    gaps: &'a dyn Gaps,
    /// Pairs within the range.
    pairs: Vec<ContactPair>,
    /// Their loads.
    pub loads: ContactLoads,
}

impl<'a> StageContact<'a> {
    /// Contact of bodies at poses as seen in the mesh.
    ///
    /// # Errors
    /// When bodies overlap there.
    pub fn new(law: &'a Law, gaps: &'a dyn Gaps, seen: &[Pose]) -> Result<Self, ContactError> {
        let pairs = gaps.pairs(seen, law.range());
        if let Some(touching) = pairs.iter().find(|pair| pair.gap <= 0.0) {
            return Err(ContactError::Overlap {
                first: gaps.body_name(touching.body).to_owned(),
                second: gaps.partner_name(touching.partner).to_owned(),
                gap: touching.gap,
            });
        }
        Ok(Self { law, gaps, pairs, loads: ContactLoads::new(gaps, law, seen) })
    }

    /// Adds contact to a flow found without it, as long as it is not stiff in a step of a size (s).
    ///
    /// # Errors
    /// When it is, or the linear system cannot be solved.
    pub fn add_to<E: From<ContactError>>(
        &self,
        flow: &mut dyn LoadedFlow<Error = E>,
        size: f64,
    ) -> Result<(), E> {
        if self.pairs.is_empty() {
            return Ok(());
        }
        let bodies = self.bodies();
        let mobility = flow.mobility(&loaded_bodies(self.gaps, self.law, &bodies), false)?;
        let rate = self.fastest_decay(&bodies, &mobility);
        if rate * size > LARGEST_DECAY {
            return Err(ContactError::Stiff { size, time_scale: 1.0 / rate }.into());
        }
        let none = ContactLoads::none(self.loads.wrenches.len());
        flow.add_loads(&changed_loads(&none, &self.loads), &[], None)
    }

    /// The bodies in contact, ascending.
    fn bodies(&self) -> Vec<usize> {
        let of_pair = |pair: &ContactPair| match pair.partner {
            Partner::Body(other) => vec![pair.body, other],
            Partner::Wall(_) => vec![pair.body],
        };
        let mut bodies: Vec<usize> = self.pairs.iter().flat_map(of_pair).collect();
        bodies.sort_unstable();
        bodies.dedup();
        bodies
    }

    /// The largest rate (1/s) at which contact alone brings the bodies back to where its forces vanish:
    /// the largest eigenvalue of G^T M G, the columns of G being gradients of gaps times the square
    /// roots of their stiffness.
    fn fastest_decay(&self, bodies: &[usize], mobility: &DMatrix<f64>) -> f64 {
        let column = |pair: &ContactPair| {
            let stiffness = -pair.weight * self.law.slope(pair.gap);
            pair.gradient_by(bodies) * stiffness.sqrt()
        };
        let columns: Vec<DVector<f64>> = self.pairs.iter().map(column).collect();
        let gradients = DMatrix::from_columns(&columns);
        let rates = gradients.transpose() * mobility * &gradients;
        rates.symmetric_eigenvalues().max()
    }
}
