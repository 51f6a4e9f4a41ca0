//! `ContactStep`: contact forces at the gaps at the end of a step, however stiff the law.
//!
//! Fluid and bodies answer a load linearly within a step: U = U* + M f, with U* the velocities
//! without contact and M the mobility, the velocities by unit loads. Poses follow as
//! q = q_p + c (U - U_p), so that the loads f are those of the gaps at the new poses:
//!
//! U - U* - M f(q_p + c (U - U_p)) = 0.
//!
//! Newton's method with the exact derivative of the loads solves it. A filter on the line search,
//! as in incremental potential contact (@li2020), takes no step that closes a gap or goes through
//! a body, and starts where the bodies are known to be apart; `correction.rs` keeps long steps
//! along curved surfaces. The time step is not bound to the stiffness, and the forces of the last
//! iteration meet the equation to rounding even where a gap known to sixteen digits does not
//! determine them.

use nalgebra::{DMatrix, DVector};

use super::placed::Placed;
use crate::body::{Mode, Modes, Pose, Twist};
use crate::contact::{
    ContactError, ContactForce, ContactLoads, ContactPair, ElasticStep, Gaps, Law, LawKind,
    MinimumGap, Partner,
};

/// Most iterations of Newton's method.
const MAX_ITERATIONS: usize = 200;
/// The same of bodies with coordinates, whose shapes take time: a shorter step is soon found.
const MAX_ELASTIC_ITERATIONS: usize = 40;
/// Most halvings of a step.
const MAX_HALVINGS: usize = 60;
/// Change of poses over the size of the numbers they are made of that is rounding.
const ROUNDING: f64 = 4e-15;
/// Change of poses over the smallest gap below which Newton's method has converged.
const TOLERANCE: f64 = 1e-11;
/// The same of bodies with coordinates where it does not fall any more.
const SETTLED: f64 = 1e-6;
/// Residual over the one before above which other directions are tried.
const POOR: f64 = 0.5;
/// Gap over the range below which the quadratic law cannot hold the load.
const CLOSED: f64 = 1e-9;

/// What is known before the contact forces of a step.
#[derive(Clone, Copy)]
pub struct ContactStep<'a> {
    /// Surfaces of bodies and walls.
    pub gaps: &'a dyn Gaps,
    /// The law.
    pub law: &'a Law,
    /// The motions that the mobility has rows for, m of them.
    pub modes: Modes,
    /// The n bodies that may be in contact ([`Gaps::candidate_bodies`]), each once; all others stay
    /// in their predicted poses.
    pub bodies: &'a [usize],
    /// Their velocities without contact (m/s, rad/s).
    pub free_velocities: &'a [Twist],
    /// Velocities (m/s, rad/s) by unit load on each of them, m n x m n: body by body, and of each
    /// body motion by motion; rows of motions that are not free are zero.
    pub mobility: &'a DMatrix<f64>,
    /// Predicted poses of all bodies.
    pub predicted: &'a [Pose],
    /// Velocities of the n bodies the prediction was made with.
    pub predicted_velocities: &'a [Twist],
    /// Change of the displacement by the velocity (s): one over the factor of the new level in the
    /// backward difference.
    pub coefficient: f64,
    /// Poses of all bodies before the step, in which they are apart.
    pub start: &'a [Pose],
    /// Bodies with coordinates, whose rates are further rows of the mobility, all of them; `gaps` is of their coordinates
    /// before the step.
    pub elastic: Option<ElasticStep<'a>>,
}

/// Contact at the end of a step.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactSolution {
    /// Velocities of the n bodies with contact (m/s, rad/s), zero in motions without a row.
    pub velocities: Vec<Twist>,
    /// Poses of all bodies.
    pub poses: Vec<Pose>,
    /// Loads on all bodies, contacts, smallest gap.
    pub loads: ContactLoads,
    /// Forces within bodies with coordinates beyond the linear ones, against their rates.
    pub beyond: DVector<f64>,
    /// Iterations of Newton's method.
    pub iterations: usize,
}

/// Velocities with all that follows from them.
pub(super) struct Trial {
    pub velocity: DVector<f64>,
    pub at: Placed,
    pub pairs: Vec<ContactPair>,
    /// U - U* - M f, and its norm with rotations times the reach of the body.
    pub residual: DVector<f64>,
    norm: f64,
}

impl ContactStep<'_> {
    /// Finds the contact forces.
    ///
    /// # Errors
    /// [`ContactError::Overlap`] when bodies are not apart to begin with, [`ContactError::TooWeak`]
    /// when the quadratic law cannot hold the load, [`ContactError::NotConverged`],
    /// [`ContactError::Input`].
    pub fn solve(&self) -> Result<ContactSolution, ContactError> {
        self.check_lengths()?;
        self.check_numbers()?;
        let mut now = self.first_trial()?;
        let (mut change, mut iterations) = (f64::INFINITY, 0);
        let most = if self.elastic.is_some() { MAX_ELASTIC_ITERATIONS } else { MAX_ITERATIONS };
        while iterations < most {
            iterations += 1;
            let exact = self.newton_direction(&now);
            let last = std::mem::replace(&mut change, self.size(&exact));
            if change <= self.tolerance(&now) || self.is_rounding(&now, change, last) {
                return Ok(self.finish(&now, &exact, iterations));
            }
            let mut next = self.search(&now, &exact);
            // Weights of pairs that come and go are known to the finite differences only
            if next.as_ref().is_none_or(|next| next.norm > POOR * now.norm) {
                let others = [
                    self.finite_difference_direction(&now),
                    self.direction_without_curvature(&now),
                ];
                next = others
                    .iter()
                    .filter_map(|direction| self.search(&now, direction))
                    .chain(next)
                    .reduce(|best, other| if other.norm < best.norm { other } else { best });
            }
            let Some(next) = next else { break };
            now = next;
            self.check_strength(&now)?;
        }
        let (first, second, gap) = match now.at.gaps(self.gaps).minimum_gap(&now.at.poses) {
            Some(MinimumGap { body, partner, gap }) => {
                let [first, second] = self.names(body, partner);
                (first, second, gap)
            }
            None => (String::new(), String::new(), f64::INFINITY),
        };
        Err(ContactError::NotConverged { first, second, gap, change, iterations })
    }

    fn check_lengths(&self) -> Result<(), ContactError> {
        let (n, all, rows) = (self.bodies.len(), self.gaps.n_bodies(), self.n_rows());
        let refuse = |what: String| Err(ContactError::Input { what });
        let lengths = [self.free_velocities.len(), self.predicted_velocities.len()];
        if lengths != [n, n] || self.mobility.shape() != (rows, rows) {
            let (found, columns) = self.mobility.shape();
            return refuse(format!(
                "{n} bodies need {n} velocities and a mobility of {rows} x {rows}, not {lengths:?} \
                 and {found} x {columns}",
            ));
        }
        if self.predicted.len() != all || self.start.len() != all {
            let lengths = [self.predicted.len(), self.start.len()];
            return refuse(format!("{all} bodies need {all} poses, not {lengths:?}"));
        }
        let is_new = |(i, body): (usize, &usize)| *body < all && !self.bodies[..i].contains(body);
        if !self.bodies.iter().enumerate().all(is_new) {
            return refuse(format!("the bodies {:?} are not distinct ones of {all}", self.bodies));
        }
        Ok(())
    }

    fn check_numbers(&self) -> Result<(), ContactError> {
        let refuse = |what: String| Err(ContactError::Input { what });
        let mut velocities = self.free_velocities.iter().chain(self.predicted_velocities);
        let mut poses = self.predicted.iter().chain(self.start);
        if !velocities.all(|velocity| are_finite(velocity.to_vector().iter()))
            || !poses.all(|pose| are_finite(pose.center.iter().chain(&pose.rotation().coords)))
            || !are_finite(self.mobility.iter())
        {
            return refuse("a velocity, pose or mobility is not finite".to_owned());
        }
        if !(self.coefficient > 0.0 && self.coefficient.is_finite()) {
            return refuse(format!("the coefficient {} is not positive", self.coefficient));
        }
        Ok(())
    }

    /// Velocities that leave the bodies in the poses before the step.
    fn first_trial(&self) -> Result<Trial, ContactError> {
        let of_body = |index: usize, mode: Mode| {
            let body = self.bodies[index];
            let back = self.start[body].displacement_from(&self.predicted[body]);
            self.predicted_velocities[index].component(mode) + back[mode] / self.coefficient
        };
        let of_coordinate = |at: usize| {
            self.elastic
                .map_or(0.0, |elastic| (elastic.start[at] - elastic.unmoved[at]) / self.coefficient)
        };
        let velocity = self.by_row(of_body, of_coordinate);
        let refuse = || ContactError::Input { what: "a body has no shape at the start".to_owned() };
        let at = self.place(&velocity).ok_or_else(refuse)?;
        let pairs = at.gaps(self.gaps).pairs(&at.poses, self.law.range());
        if let Some(touching) = narrowest(&pairs).filter(|pair| pair.gap <= 0.0) {
            let [first, second] = self.names(touching.body, touching.partner);
            return Err(ContactError::Overlap { first, second, gap: touching.gap });
        }
        Ok(self.trial(velocity, at, pairs))
    }

    /// Velocities without contact, by row.
    fn free(&self) -> DVector<f64> {
        let of_coordinate = |at: usize| self.elastic.map_or(0.0, |elastic| elastic.free_rates[at]);
        self.by_row(|index, mode| self.free_velocities[index].component(mode), of_coordinate)
    }

    fn trial(&self, velocity: DVector<f64>, at: Placed, pairs: Vec<ContactPair>) -> Trial {
        let mut load = self.load(&pairs, &velocity);
        if let Some(elastic) = self.elastic {
            let beyond = elastic.forces.beyond_linear(self.rates(&velocity));
            let mut own = load.rows_mut(self.n_rigid_rows(), elastic.n_coordinates());
            own -= beyond;
        }
        let pushed = self.mobility * load;
        let free = self.free();
        let residual =
            DVector::from_fn(velocity.len(), |row, _| velocity[row] - free[row] - pushed[row]);
        let lengths = self.lengths();
        let weighted = residual.iter().zip(&lengths).map(|(r, length)| (r * length).powi(2));
        let norm = weighted.sum::<f64>().sqrt();
        Trial { velocity, at, pairs, residual, norm }
    }

    /// Sum of the loads of pairs of bodies with these velocities, by row.
    pub(super) fn load(&self, pairs: &[ContactPair], velocity: &DVector<f64>) -> DVector<f64> {
        let mut load = DVector::zeros(self.n_rows());
        for pair in pairs {
            let force = pair.weight * self.law.force(pair.gap);
            self.scatter(pair, &pair.gradient_of_both(), |row, entry| load[row] += force * entry);
        }
        self.add_dissipative_load(&mut load, pairs, velocity);
        load
    }

    /// Whether a change after another one is as small as it gets: stiff bodies with coordinates are found to the rounding of
    /// large forces.
    fn is_rounding(&self, now: &Trial, change: f64, last: f64) -> bool {
        let gap = narrowest(&now.pairs).map_or(self.law.range(), |pair| pair.gap);
        self.elastic.is_some() && change <= SETTLED * gap && change > POOR * last
    }

    fn tolerance(&self, now: &Trial) -> f64 {
        let scale = self
            .bodies
            .iter()
            .map(|&body| now.at.poses[body].center.amax() + self.gaps.reach(body));
        let rounding = ROUNDING * scale.fold(0.0, f64::max);
        let gap = narrowest(&now.pairs).map_or(self.law.range(), |pair| pair.gap);
        rounding.max(TOLERANCE * gap)
    }

    /// The longest of the halved steps that keeps all gaps open and lowers the residual.
    fn search(&self, now: &Trial, step: &DVector<f64>) -> Option<Trial> {
        if !step.iter().all(|number| number.is_finite()) {
            return None;
        }
        let mut fraction = self.max_step_fraction(&now.at, &(&now.velocity + step));
        let at_rounding = 100.0 * self.tolerance(now);
        let displacement = self.size(step);
        for _ in 0..MAX_HALVINGS {
            let velocity = self.second_order_correction(now, step, fraction);
            let velocity = self.with_inner_forces(now, velocity);
            let pairs = |at: &Placed| at.gaps(self.gaps).pairs(&at.poses, self.law.range());
            let placed = self.place(&velocity).map(|at| (pairs(&at), at));
            if let Some((pairs, at)) = placed
                && pairs.iter().all(|pair| pair.gap > 0.0)
            {
                let trial = self.trial(velocity, at, pairs);
                let wanted = (1.0 - 1e-4 * fraction) * now.norm;
                if trial.norm <= wanted || fraction * displacement <= at_rounding {
                    return Some(trial);
                }
            }
            fraction *= 0.5;
        }
        None
    }

    /// The quadratic law is finite at contact: a gap that closes never opens again.
    fn check_strength(&self, now: &Trial) -> Result<(), ContactError> {
        let LawKind::Quadratic { .. } = self.law.kind() else { return Ok(()) };
        match narrowest(&now.pairs) {
            Some(closing) if closing.gap < CLOSED * self.law.range() => {
                let [first, second] = self.names(closing.body, closing.partner);
                let greatest = self.law.force(0.0);
                Err(ContactError::TooWeak { first, second, gap: closing.gap, greatest })
            }
            _ => Ok(()),
        }
    }

    /// The solution after a last step, to first order in it.
    fn finish(&self, now: &Trial, step: &DVector<f64>, iterations: usize) -> ContactSolution {
        let velocity = &now.velocity + step;
        let displacement = self.displacement_rate(&now.velocity, step);
        let dissipative = self.dissipative_forces(now, step);
        let contacts = now.pairs.iter().enumerate().map(|(nth, pair)| {
            let change = self.coefficient * self.gap_change(pair, &displacement);
            let gap = pair.gap;
            let force = pair.weight * (self.law.force(gap) + self.law.slope(gap) * change);
            ContactForce {
                pair: ContactPair { gap: gap + change, ..*pair },
                force: force.max(0.0),
                dissipative: dissipative.get(nth).copied().unwrap_or_default(),
            }
        });
        let placed = self.place(&velocity);
        // A last step is too small to bend a body out of shape
        let at = placed.as_ref().unwrap_or(&now.at);
        let minimum_gap = at.gaps(self.gaps).minimum_gap(&at.poses);
        let loads = ContactLoads::gather(self.gaps.n_bodies(), contacts.collect(), minimum_gap);
        let poses = at.poses.clone();
        let Some(elastic) = self.elastic else {
            let (velocities, beyond) = (self.twists(&velocity), DVector::zeros(0));
            return ContactSolution { velocities, poses, loads, beyond, iterations };
        };
        let loads = loads.with_coordinates(elastic.bodies.ranges());
        let rates = self.rates(&now.velocity);
        let own = step.rows(self.n_rigid_rows(), elastic.n_coordinates());
        let beyond = elastic.forces.beyond_linear(rates) + elastic.forces.tangent(rates) * own;
        ContactSolution { velocities: self.twists(&velocity), poses, loads, beyond, iterations }
    }

    fn names(&self, body: usize, partner: Partner) -> [String; 2] {
        [self.gaps.body_name(body), self.gaps.partner_name(partner)].map(str::to_owned)
    }
}

/// The pair with the smallest gap.
pub(super) fn narrowest(pairs: &[ContactPair]) -> Option<&ContactPair> {
    pairs.iter().reduce(|least, pair| if pair.gap < least.gap { pair } else { least })
}

fn are_finite<'a>(mut numbers: impl Iterator<Item = &'a f64>) -> bool {
    numbers.all(|number| number.is_finite())
}
