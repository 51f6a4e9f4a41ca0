//! The work that commands put into fibres, with its derivatives.
//!
//! What the work of each frame counts is given by `shares`.

use super::adjoint::Seeds;
use super::body::SoftBody;
use super::motion::{Plan, Trajectory};

/// Derivatives that a multiple of those of the work is added to.
struct Derivatives<'a> {
    factor: f64,
    seeds: &'a mut Seeds,
}

impl<const D: usize> SoftBody<D> {
    /// Work (J) that the commands of a motion put into the fibres: where a stretch is told anew their energy
    /// jumps, while the body is where it is. The fibres are told 1 before the first frame.
    #[must_use]
    pub fn work(&self, plan: &Plan, trajectory: &Trajectory, shares: &[f64]) -> f64 {
        self.add_work(plan, trajectory, shares, None)
    }

    /// The same; a multiple of its derivatives is added to those there are.
    pub fn add_work_seeds(
        &self,
        plan: &Plan,
        trajectory: &Trajectory,
        shares: &[f64],
        factor: f64,
        seeds: &mut Seeds,
    ) -> f64 {
        self.add_work(plan, trajectory, shares, Some(Derivatives { factor, seeds }))
    }

    fn add_work(
        &self,
        plan: &Plan,
        trajectory: &Trajectory,
        shares: &[f64],
        mut derivatives: Option<Derivatives<'_>>,
    ) -> f64 {
        let at_rest = vec![1.0; self.solid.spec().fibres.len()];
        let mut work = 0.0;
        for (frame, (targets, share)) in plan.targets.iter().zip(shares).enumerate() {
            let step = frame * plan.substeps;
            let places = &trajectory.levels[step].places;
            let before = frame.checked_sub(1).map(|before| &plan.targets[before]);
            for (sign, told, number) in [
                (*share, targets, Some(frame)),
                (-share, before.unwrap_or(&at_rest), frame.checked_sub(1)),
            ] {
                let found = self.solid.fibre_energy(places, told);
                work += sign * found.value;
                let Some(Derivatives { factor, seeds }) = &mut derivatives else { continue };
                let factor = sign * *factor;
                let pairs = seeds.places[step].iter_mut().zip(&found.by_places);
                pairs.for_each(|(to, from)| *to += factor * from);
                let pairs = seeds.fibre_stiffness.iter_mut().zip(&found.by_stiffness);
                pairs.for_each(|(to, from)| *to += factor * from);
                if let Some(number) = number {
                    let pairs = seeds.targets[number].iter_mut().zip(&found.by_targets);
                    pairs.for_each(|(to, from)| *to += factor * from);
                }
            }
        }
        work
    }
}
