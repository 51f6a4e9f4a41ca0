//! `StepEnergy`: what a step does to the energy of bodies in contact, which says whether it is short enough.
//!
//! A step knows forces at its ends only. With these its work is that of the trapezoidal rule, and what this misses of the
//! changes of the energy stored in contact and of the kinetic energy of the bodies is the error of the step. Where it is
//! small beside the energy of the impact, bodies leave with the velocity they came with, whatever the stiffness: half a
//! period of contact then takes some fifty steps of BDF2, which by itself loses 24 / n^3 of the velocity in n steps.
//! Bodies that rest on each other, or that the fluid stops, have no impact to follow: of the energy stored counts what
//! the loads of contact give to the motion, and its scale is the kinetic one of the approach, what is stored, and the
//! work of all other forces over the range.

use nalgebra::{DMatrix, DVector, Matrix6, Vector3};

use super::{ContactLoads, ContactPair, Gaps, Law, Partner, Section};
use crate::body::{Pose, RigidVector, Twist};

/// Error of a step over the energy of the contact that is as large as it should be.
const TOLERANCE: f64 = 5e-4;
/// The same of a step of first order, which loses energy at each of them.
const FIRST_ORDER_TOLERANCE: f64 = 1e-4;
/// Energy that is made counts as so many times what is lost where nothing but contact stops a body: a rebound may be lower
/// than the fall, not higher.
const WEIGHT_OF_GAIN: f64 = 10.0;
/// Singular value over the largest below which a motion has no inertia.
const NO_INERTIA: f64 = 1e-12;

/// A body in a step; pairs are of its start and its end.
#[derive(Debug, Clone)]
pub struct BodyInStep {
    /// Mass matrix in the world, without motions that are held or given (kg, kg m2).
    pub inertia: Matrix6<f64>,
    /// Velocities (m/s, rad/s).
    pub twists: [Twist; 2],
    /// Their rates (m/s2, rad/s2).
    pub accelerations: [Twist; 2],
    /// Displacement in the laboratory (m, rad).
    pub displacement: RigidVector,
    /// Whether it is rigid and hangs on no other body: all forces on it do work on its own motion.
    pub is_alone: bool,
    /// What a body with coordinates does, which has no inertia as a rigid one.
    pub elastic: Option<ElasticMotion>,
}

/// A body with coordinates in a step.
#[derive(Debug, Clone)]
pub struct ElasticMotion {
    /// Rates of its coordinates at the start and at the end.
    pub rates: [DVector<f64>; 2],
    /// Change of its coordinates.
    pub displacement: DVector<f64>,
    /// The inverse of its mass matrix, zero for coordinates that are held; none without inertia.
    pub response: Option<DMatrix<f64>>,
    /// Rate of its momentum at the end (N).
    pub momentum_rate: Vector3<f64>,
}

/// A side of a pair: its body, what of it moves with its point, and the derivative of the gap by that.
struct Side<'a> {
    body: usize,
    section: Option<&'a Section>,
    gradient: RigidVector,
}

/// A step as contact sees it; pairs are of its start and its end.
pub struct StepEnergy<'a> {
    /// Surfaces of bodies and walls.
    pub gaps: [&'a dyn Gaps; 2],
    /// The law.
    pub law: &'a Law,
    /// Poses of all bodies as seen in the mesh.
    pub poses: [&'a [Pose]; 2],
    /// All bodies.
    pub bodies: &'a [BodyInStep],
    /// Loads of contact at the end.
    pub loads: &'a ContactLoads,
    /// Whether the step is of second order.
    pub is_second_order: bool,
}

/// What a step has done to the energy of bodies in contact.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ContactEnergy {
    /// Stored in contact at the end of the step (J; J/m planar).
    pub stored: f64,
    /// Made by the error of the step; negative where it was lost (J; J/m planar).
    pub made: f64,
    /// Error of the step over what is accepted; zero without contact.
    pub error: f64,
}

impl StepEnergy<'_> {
    /// What the step has done.
    #[must_use]
    pub fn measure(&self) -> ContactEnergy {
        let range = self.law.range();
        let pairs = [0, 1].map(|end| self.gaps[end].pairs(self.poses[end], range));
        let touching = if pairs[1].is_empty() { &pairs[0] } else { &pairs[1] };
        let [before, stored] = pairs.each_ref().map(|pairs| self.stored(pairs));
        let impact: f64 = touching.iter().filter_map(|pair| self.impact(pair)).sum();
        let involved = self.involved(touching);
        if involved.iter().all(|&body| !self.bodies[body].has_inertia()) {
            return ContactEnergy { stored, ..ContactEnergy::default() };
        }
        let others: f64 = involved.iter().map(|&body| self.other_forces(body)).sum();
        let [inertia, contact] = self.shares(&involved, &pairs, others);
        let potential = inertia * (self.work_of_contact(&pairs) + stored - before);
        let kinetic: f64 = involved.iter().map(|&body| self.bodies[body].kinetic_defect()).sum();
        let kinetic = contact * kinetic;
        let bounce = impact + before;
        let scale = bounce + range * others;
        let made = potential + kinetic;
        // What is made in a film is lost in it again
        let weight = 1.0 + (WEIGHT_OF_GAIN - 1.0) * (bounce / scale);
        let size = (potential.abs() + kinetic.abs()).max(weight * made);
        let tolerance = if self.is_second_order { TOLERANCE } else { FIRST_ORDER_TOLERANCE };
        let error = if size > 0.0 { size / (tolerance * scale) } else { 0.0 };
        ContactEnergy { stored, made, error }
    }

    /// Energy stored in pairs (J).
    fn stored(&self, pairs: &[ContactPair]) -> f64 {
        pairs.iter().map(|pair| pair.weight * self.law.energy(pair.gap)).sum()
    }

    /// Work of the law on the bodies by the trapezoidal rule (J).
    fn work_of_contact(&self, pairs: &[Vec<ContactPair>; 2]) -> f64 {
        let [from, to] = self.poses;
        let way = |body: usize| to[body].displacement_from(&from[body]);
        let work = |pair: &ContactPair| {
            let force = pair.weight * self.law.force(pair.gap);
            let along = |side: Side<'_>| self.bodies[side.body].way_along(&side, way(side.body));
            0.5 * force * sides(pair).map(along).sum::<f64>()
        };
        pairs.iter().flatten().map(work).sum()
    }

    /// Kinetic energy with which the bodies of a pair near or leave each other (J); none where nothing gives way.
    fn impact(&self, pair: &ContactPair) -> Option<f64> {
        let (mut rates, mut answer) = ([0.0; 2], 0.0);
        for side in sides(pair) {
            let (body, gradient) = (&self.bodies[side.body], &side.gradient);
            if let (Some(elastic), Some(section)) = (&body.elastic, side.section) {
                let gradient = elastic.on_coordinates(section, gradient);
                for (rate, rates) in rates.iter_mut().zip(&elastic.rates) {
                    *rate += gradient.dot(rates);
                }
                answer += elastic
                    .response
                    .as_ref()
                    .map_or(0.0, |response| gradient.dot(&(response * &gradient)));
                continue;
            }
            for (rate, twist) in rates.iter_mut().zip(&body.twists) {
                *rate += gradient.dot(&twist.to_vector());
            }
            let threshold = NO_INERTIA * body.inertia.amax();
            let inverse = body.inertia.pseudo_inverse(threshold).ok()?;
            answer += gradient.dot(&(inverse * gradient));
        }
        let rate = rates[0].abs().max(rates[1].abs());
        (answer > 0.0).then(|| 0.5 * rate * rate / answer)
    }

    /// Bodies of pairs, ascending.
    fn involved(&self, pairs: &[ContactPair]) -> Vec<usize> {
        let mut bodies: Vec<usize> = pairs.iter().flat_map(sides).map(|side| side.body).collect();
        bodies.sort_unstable();
        bodies.dedup();
        bodies
    }

    /// Part of the loads of contact at the end of the step that changes velocities, where the rest balances other forces (N);
    /// and part of all forces that is contact, where the rest is a film or a drive.
    fn shares(&self, involved: &[usize], pairs: &[Vec<ContactPair>; 2], others: f64) -> [f64; 2] {
        let at_end = involved.iter().map(|&body| self.loads.wrenches[body].force.norm());
        let at_end: f64 = at_end.sum();
        let force = |pair: &ContactPair| pair.weight * self.law.force(pair.gap);
        let largest = at_end.max(pairs[0].iter().map(force).sum());
        let rates = involved.iter().map(|&body| {
            let BodyInStep { inertia, accelerations, elastic, .. } = &self.bodies[body];
            if let Some(elastic) = elastic {
                return elastic.momentum_rate.norm();
            }
            (inertia * accelerations[1].to_vector()).fixed_rows::<3>(0).norm()
        });
        let rate: f64 = rates.sum();
        let part = |of: f64, whole: f64| if whole > 0.0 { (of / whole).min(1.0) } else { 1.0 };
        [part(rate, at_end), part(largest, largest + others)]
    }

    /// All other forces on a body at the end of the step (N).
    fn other_forces(&self, body: usize) -> f64 {
        let BodyInStep { inertia, accelerations, is_alone, elastic, .. } = &self.bodies[body];
        if let Some(elastic) = elastic.as_ref().filter(|elastic| elastic.response.is_some()) {
            return (elastic.momentum_rate - self.loads.wrenches[body].force).norm();
        }
        if !is_alone || *inertia == Matrix6::zeros() {
            return 0.0;
        }
        let change = inertia * accelerations[1].to_vector() - self.loads.wrenches[body].to_vector();
        let free = |axis: usize| if inertia[(axis, axis)] > 0.0 { change[axis] } else { 0.0 };
        Vector3::from_fn(|axis, _| free(axis)).norm()
    }
}

impl BodyInStep {
    fn has_inertia(&self) -> bool {
        let elastic = self.elastic.as_ref().is_some_and(|elastic| elastic.response.is_some());
        elastic || self.inertia != Matrix6::zeros()
    }

    /// How far what moves with the point of a side gets along the gradient of the gap (m), the body by a displacement as seen
    /// from the mesh.
    fn way_along(&self, side: &Side<'_>, seen: RigidVector) -> f64 {
        let (Some(elastic), Some(section)) = (&self.elastic, side.section) else {
            return side.gradient.dot(&seen);
        };
        let own = elastic.on_coordinates(section, &side.gradient).dot(&elastic.displacement);
        let frame = (seen - self.displacement).fixed_rows::<3>(0).into_owned();
        own + side.gradient.fixed_rows::<3>(0).dot(&frame)
    }

    /// Change of the kinetic energy without the work of all forces by the trapezoidal rule (J).
    fn kinetic_defect(&self) -> f64 {
        if !self.is_alone {
            return 0.0;
        }
        let [before, after] = self.twists.map(|twist| twist.to_vector());
        let [first, last] = self.accelerations.map(|rate| rate.to_vector());
        let gain = 0.5 * (after + before).dot(&(self.inertia * (after - before)));
        gain - 0.5 * self.displacement.dot(&(self.inertia * (first + last)))
    }
}

impl ElasticMotion {
    /// The derivative by all coordinates of the body of what changes so by the motion of a section.
    fn on_coordinates(&self, section: &Section, gradient: &RigidVector) -> DVector<f64> {
        let mut all = DVector::zeros(self.displacement.len());
        section.on_coordinates(gradient).for_each(|at| all[at.coordinate] += at.value);
        all
    }
}

/// The bodies on both sides of a pair.
fn sides(pair: &ContactPair) -> impl Iterator<Item = Side<'_>> {
    let partner = match pair.partner {
        Partner::Body(other) => Some(other),
        Partner::Wall(_) => None,
    };
    let bodies = [Some(pair.body), partner].into_iter();
    bodies.zip(&pair.sections).zip(pair.gradient()).filter_map(|((body, section), gradient)| {
        Some(Side { body: body?, section: section.as_ref(), gradient })
    })
}
