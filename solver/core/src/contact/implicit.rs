//! `ContactStep`: contact forces at the gaps at the end of a step, however stiff the law.
//!
//! Fluid and bodies answer a load linearly within a step: U = U* + M f, with U* the velocities
//! without contact and M the mobility, the velocities by unit loads. Places follow as
//! q = q_p + c (U - U_p), so that the loads f are those of the gaps at the new places:
//!
//! U - U* - M f(q_p + c (U - U_p)) = 0.
//!
//! Newton's method with the exact derivative of the gaps solves it. A filter on the line search,
//! as in incremental potential contact (@li2020), takes no step that closes a gap or goes through
//! a body, and starts where the bodies are known to be apart; `retract.rs` keeps long steps along
//! curved surfaces. The time step is not bound to the stiffness, and the forces of the last
//! iteration meet the equation to rounding even where a gap known to sixteen digits does not
//! determine them.

use nalgebra::{DMatrix, DVector, Vector6};

use super::loads::{Contact, ContactLoads};
use super::{ContactError, Feature, Law, LawKind, LeastGap, Partner, Place, Surfaces};

/// Most iterations of Newton's method.
const MAX_ITERATIONS: usize = 200;
/// Most halvings of a step.
const MAX_HALVINGS: usize = 60;
/// Change of places over the size of the numbers they are made of that is rounding.
const ROUNDING: f64 = 4e-15;
/// Change of places over the smallest gap below which Newton's method has converged.
const TOLERANCE: f64 = 1e-11;
/// Way over the smallest gap by which places differ for measured derivatives.
const DIFFERENCE: f64 = 1e-5;
/// Residual over the one before that is not good enough for a first choice of direction.
const POOR: f64 = 0.5;
/// Gap over the range at which the quadratic law has lost.
const CLOSED: f64 = 1e-9;

/// What is known before the contact forces of a step.
#[derive(Debug, Clone, Copy)]
pub struct ContactStep<'a> {
    /// Outlines and walls.
    pub surfaces: &'a Surfaces,
    /// The law.
    pub law: &'a Law,
    /// The n bodies that may be in contact ([`Surfaces::involved`]), each once; all others stay
    /// where they are predicted.
    pub bodies: &'a [usize],
    /// Their velocities without contact (m/s, m/s, rad/s).
    pub free_velocities: &'a [[f64; 3]],
    /// Velocities (m/s, m/s, rad/s) by unit force along x, along y and unit torque on each of them,
    /// 3 n x 3 n; rows of motions that are not free are zero.
    pub mobility: &'a DMatrix<f64>,
    /// Predicted places of all bodies.
    pub predicted: &'a [Place],
    /// Velocities of the n bodies the prediction was made with.
    pub predicted_velocities: &'a [[f64; 3]],
    /// Change of a new place by the new velocity (s): one over the factor of the new level in the
    /// backward difference.
    pub coefficient: f64,
    /// Places of all bodies at which they are apart, such as those before the step.
    pub apart: &'a [Place],
}

/// Contact at the end of a step.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactSolution {
    /// Velocities of the n bodies with contact (m/s, m/s, rad/s).
    pub velocities: Vec<[f64; 3]>,
    /// Places of all bodies.
    pub places: Vec<Place>,
    /// Loads on all bodies, contacts, smallest gap.
    pub loads: ContactLoads,
    /// Iterations of Newton's method.
    pub iterations: usize,
}

/// Velocities with all that follows from them.
struct Trial {
    velocity: DVector<f64>,
    places: Vec<Place>,
    features: Vec<Feature>,
    /// U - U* - M f, and its norm with turns weighted by the reach of the body.
    residual: DVector<f64>,
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
        self.check()?;
        let mut now = self.start()?;
        let (mut change, mut iterations) = (f64::INFINITY, 0);
        while iterations < MAX_ITERATIONS {
            iterations += 1;
            let exact = self.direction(&now, true);
            change = self.size(&exact);
            if change <= self.tolerance(&now) {
                return Ok(self.finish(&now, &exact, iterations));
            }
            let mut next = self.search(&now, &exact);
            // Weights of features that come and go are known to the measured derivative only
            if next.as_ref().is_none_or(|next| next.norm > POOR * now.norm) {
                let others = [self.measured_direction(&now), self.direction(&now, false)];
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
        let (first, second, gap) = self.narrowest(&now);
        Err(ContactError::NotConverged { first, second, gap, change, iterations })
    }

    fn check(&self) -> Result<(), ContactError> {
        let (n, all) = (self.bodies.len(), self.surfaces.n_bodies());
        let refuse = |what: String| Err(ContactError::Input { what });
        let lengths = [self.free_velocities.len(), self.predicted_velocities.len()];
        if lengths != [n, n] || self.mobility.shape() != (3 * n, 3 * n) {
            let (rows, columns) = self.mobility.shape();
            return refuse(format!(
                "{n} bodies need {n} velocities and a mobility of {} x {}, not {lengths:?} and \
                 {rows} x {columns}",
                3 * n,
                3 * n
            ));
        }
        if self.predicted.len() != all || self.apart.len() != all {
            let lengths = [self.predicted.len(), self.apart.len()];
            return refuse(format!("{all} bodies need {all} places, not {lengths:?}"));
        }
        let is_new = |(i, body): (usize, &usize)| *body < all && !self.bodies[..i].contains(body);
        if !self.bodies.iter().enumerate().all(is_new) {
            return refuse(format!("the bodies {:?} are not distinct ones of {all}", self.bodies));
        }
        let numbers = self.free_velocities.iter().chain(self.predicted_velocities);
        let numbers = numbers.chain(self.predicted).chain(self.apart).flatten();
        if !numbers.chain(self.mobility.iter()).all(|number| number.is_finite()) {
            return refuse("a velocity, place or mobility is not finite".to_owned());
        }
        if !(self.coefficient > 0.0 && self.coefficient.is_finite()) {
            return refuse(format!("the coefficient {} is not positive", self.coefficient));
        }
        Ok(())
    }

    /// Velocities that lead to the places at which bodies are apart.
    fn start(&self) -> Result<Trial, ContactError> {
        let velocity = DVector::from_fn(3 * self.bodies.len(), |row, _| {
            let (body, mode) = (row / 3, row % 3);
            let (to, from) = (self.apart[self.bodies[body]], self.predicted[self.bodies[body]]);
            self.predicted_velocities[body][mode] + (to[mode] - from[mode]) / self.coefficient
        });
        let places = self.places(&velocity);
        let features = self.surfaces.features(&places, self.law.range());
        if let Some(touching) = narrowest(&features).filter(|feature| feature.at.gap <= 0.0) {
            let (first, second, gap) = self.named(touching);
            return Err(ContactError::Overlap { first, second, gap });
        }
        Ok(self.trial(velocity, places, features))
    }

    pub(super) fn places(&self, velocity: &DVector<f64>) -> Vec<Place> {
        let mut places = self.predicted.to_vec();
        for (index, &body) in self.bodies.iter().enumerate() {
            for mode in 0..3 {
                let change = velocity[3 * index + mode] - self.predicted_velocities[index][mode];
                places[body][mode] += self.coefficient * change;
            }
        }
        places
    }

    fn trial(&self, velocity: DVector<f64>, places: Vec<Place>, features: Vec<Feature>) -> Trial {
        let load = self.load(&features);
        let pushed = self.mobility * load;
        let free = |row: usize| self.free_velocities[row / 3][row % 3];
        let residual =
            DVector::from_fn(velocity.len(), |row, _| velocity[row] - free(row) - pushed[row]);
        let weighted = residual.iter().enumerate().map(|(row, r)| (r * self.weight(row)).powi(2));
        let norm = weighted.sum::<f64>().sqrt();
        Trial { velocity, places, features, residual, norm }
    }

    /// Sum of the loads of features, by row.
    fn load(&self, features: &[Feature]) -> DVector<f64> {
        let mut load = DVector::zeros(3 * self.bodies.len());
        for feature in features {
            let force = feature.weight * self.law.force(feature.at.gap);
            self.scatter(feature, |row, entry| load[row] += force * entry, &feature.gradient());
        }
        load
    }

    /// Gives the entries of a vector over both sides of a feature to the rows they belong to.
    pub(super) fn scatter(
        &self,
        feature: &Feature,
        mut add: impl FnMut(usize, f64),
        entries: &Vector6<f64>,
    ) {
        for (entry, row) in self.rows(feature).into_iter().enumerate() {
            if let Some(row) = row {
                add(row, entries[entry]);
            }
        }
    }

    /// Rows of x, y, angle of both sides of a feature among the unknowns.
    fn rows(&self, feature: &Feature) -> [Option<usize>; 6] {
        let index = |body: usize| self.bodies.iter().position(|known| *known == body);
        let first = index(feature.body);
        let second = match feature.partner {
            Partner::Body(other) => index(other),
            Partner::Wall(_) => None,
        };
        [0, 1, 2, 3, 4, 5].map(|entry| {
            let side = if entry < 3 { first } else { second };
            side.map(|index| 3 * index + entry % 3)
        })
    }

    /// Length by which a turn counts as a way (m); one for motions along x and y.
    fn weight(&self, row: usize) -> f64 {
        if row % 3 == 2 { self.surfaces.reach(self.bodies[row / 3]) } else { 1.0 }
    }

    /// Largest way a change of velocities takes a point of a body (m), by coordinate.
    fn size(&self, step: &DVector<f64>) -> f64 {
        let ways = step.iter().enumerate();
        ways.map(|(row, change)| (change * self.weight(row) * self.coefficient).abs())
            .fold(0.0, |most, way| if way > most || way.is_nan() { way } else { most })
    }

    fn tolerance(&self, now: &Trial) -> f64 {
        let scale = self.bodies.iter().map(|&body| {
            let place = &now.places[body];
            place[0].abs().max(place[1].abs()) + self.surfaces.reach(body)
        });
        let rounding = ROUNDING * scale.fold(0.0, f64::max);
        let gap = narrowest(&now.features).map_or(self.law.range(), |feature| feature.at.gap);
        rounding.max(TOLERANCE * gap)
    }

    /// Newton's step; without the curvature of the surfaces it exists always, but converges slower.
    fn direction(&self, now: &Trial, exact: bool) -> DVector<f64> {
        let n = now.velocity.len();
        let mut stiffness = DMatrix::<f64>::zeros(n, n);
        for feature in &now.features {
            let gradient = feature.gradient();
            let gap = feature.at.gap;
            let mut block = gradient * gradient.transpose() * self.law.slope(gap);
            if exact {
                block += feature.hessian() * self.law.force(gap);
            }
            block *= feature.weight;
            let rows = self.rows(feature);
            for (i, row) in rows.into_iter().enumerate() {
                for (j, column) in rows.into_iter().enumerate() {
                    if let (Some(row), Some(column)) = (row, column) {
                        stiffness[(row, column)] += block[(i, j)];
                    }
                }
            }
        }
        self.newton(now, stiffness)
    }

    /// Newton's step with differences of the loads for their derivative.
    fn measured_direction(&self, now: &Trial) -> DVector<f64> {
        let n = now.velocity.len();
        let gap = narrowest(&now.features).map_or(self.law.range(), |feature| feature.at.gap);
        let mut stiffness = DMatrix::<f64>::zeros(n, n);
        for row in 0..n {
            let (body, mode) = (self.bodies[row / 3], row % 3);
            let way = DIFFERENCE * gap.min(self.surfaces.reach(body));
            let turn = way / self.weight(row);
            let loads = [1.0, -1.0].map(|sign| {
                let mut places = now.places.clone();
                places[body][mode] += sign * turn;
                self.load(&self.surfaces.features(&places, self.law.range()))
            });
            stiffness.set_column(row, &((&loads[0] - &loads[1]) / (2.0 * turn)));
        }
        self.newton(now, stiffness)
    }

    /// Newton's step for a derivative of the loads by the places.
    fn newton(&self, now: &Trial, stiffness: DMatrix<f64>) -> DVector<f64> {
        let n = now.velocity.len();
        let matrix = DMatrix::identity(n, n) - self.mobility * stiffness * self.coefficient;
        let solved = matrix.lu().solve(&now.residual);
        // A singular matrix gives no direction, which the caller sees as a step that is not finite
        solved.map_or_else(|| DVector::from_element(n, f64::NAN), |step| -step)
    }

    /// The longest of the halved steps that keeps all gaps open and lowers the residual.
    fn search(&self, now: &Trial, step: &DVector<f64>) -> Option<Trial> {
        if !step.iter().all(|number| number.is_finite()) {
            return None;
        }
        let full = self.places(&(&now.velocity + step));
        let mut part = self.surfaces.passable(&now.places, &full);
        let at_rounding = 100.0 * self.tolerance(now);
        let way = self.size(step);
        for _ in 0..MAX_HALVINGS {
            let velocity = &now.velocity + step * part;
            let velocity = self.retract(&now.features, &now.places, step, part, velocity);
            let places = self.places(&velocity);
            let features = self.surfaces.features(&places, self.law.range());
            if features.iter().all(|feature| feature.at.gap > 0.0) {
                let trial = self.trial(velocity, places, features);
                let wanted = (1.0 - 1e-4 * part) * now.norm;
                if trial.norm <= wanted || part * way <= at_rounding {
                    return Some(trial);
                }
            }
            part *= 0.5;
        }
        None
    }

    /// The quadratic law is finite at contact: a gap that closes never opens again.
    fn check_strength(&self, now: &Trial) -> Result<(), ContactError> {
        let LawKind::Quadratic { .. } = self.law.kind() else { return Ok(()) };
        match narrowest(&now.features) {
            Some(closing) if closing.at.gap < CLOSED * self.law.range() => {
                let (first, second, gap) = self.named(closing);
                let greatest = self.law.force(0.0);
                Err(ContactError::TooWeak { first, second, gap, greatest })
            }
            _ => Ok(()),
        }
    }

    /// The solution after a last step, to first order in it.
    fn finish(&self, now: &Trial, step: &DVector<f64>, iterations: usize) -> ContactSolution {
        let velocity = &now.velocity + step;
        let contacts = now.features.iter().map(|feature| {
            let mut closing = 0.0;
            let gradient = feature.gradient();
            self.scatter(feature, |row, entry| closing += entry * step[row], &gradient);
            let change = self.coefficient * closing;
            let gap = feature.at.gap;
            let mut feature = *feature;
            feature.at.gap += change;
            let force = feature.weight * (self.law.force(gap) + self.law.slope(gap) * change);
            Contact { feature, force: force.max(0.0) }
        });
        let places = self.places(&velocity);
        let least: Option<LeastGap> = self.surfaces.least_gap(&places);
        let loads = ContactLoads::gather(self.surfaces.n_bodies(), contacts.collect(), least);
        let velocities = (0..self.bodies.len())
            .map(|body| [0, 1, 2].map(|mode| velocity[3 * body + mode]))
            .collect();
        ContactSolution { velocities, places, loads, iterations }
    }

    fn named(&self, feature: &Feature) -> (String, String, f64) {
        let first = self.surfaces.body_name(feature.body).to_owned();
        (first, self.surfaces.partner_name(feature.partner).to_owned(), feature.at.gap)
    }

    /// Names and gap of the closest pair.
    fn narrowest(&self, now: &Trial) -> (String, String, f64) {
        match self.surfaces.least_gap(&now.places) {
            Some(LeastGap { body, partner, gap }) => {
                let first = self.surfaces.body_name(body).to_owned();
                (first, self.surfaces.partner_name(partner).to_owned(), gap)
            }
            None => (String::new(), String::new(), f64::INFINITY),
        }
    }
}

fn narrowest(features: &[Feature]) -> Option<&Feature> {
    features.iter().reduce(|least, at| if at.at.gap < least.at.gap { at } else { least })
}
