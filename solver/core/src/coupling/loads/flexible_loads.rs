//! What bodies with coordinates do: their energies and powers, and the load by which their base is held.
//!
//! No unknown stands for that load: the equations of motion in a rigid motion, in which inner forces do no work, give it.

use nalgebra::{DVector, Vector3};

use super::super::problem::Problem;
use super::BodyLoads;
use crate::body::{Pose, Wrench};
use crate::structure::{BaseMotion, Flexible, InnerPower, weighted};

/// What is known of bodies with coordinates at one time; numbers are those of all bodies.
#[derive(Debug, Clone, Copy)]
pub struct FlexibleStates<'a> {
    /// When (s).
    pub time: f64,
    /// Coordinates.
    pub coordinates: &'a [f64],
    /// Their rates.
    pub rates: &'a [f64],
    /// Rates of change of their rates; of no account where bodies have no inertia.
    pub accelerations: &'a [f64],
    /// Poses of the bodies.
    pub poses: &'a [Pose],
    /// Loads of the fluid on the bodies.
    pub loads: &'a [BodyLoads],
    /// Loads of contact on the bodies.
    pub contact: &'a [Wrench],
}

/// A body with coordinates at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlexibleReport {
    /// Elastic energy (J).
    pub elastic_energy: f64,
    /// Kinetic energy (J), zero without inertia.
    pub kinetic_energy: f64,
    /// Momentum (kg m/s), zero without inertia.
    pub momentum: Vector3<f64>,
    /// Power of what is active, of damping and of loads at its ends (W).
    pub inner: InnerPower,
    /// Force of loads that are given at its ends (N).
    pub end_force: Vector3<f64>,
    /// What holds its base, if anything does.
    pub base: Option<BaseReport>,
}

/// What holds the base of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BaseReport {
    /// Force on the body there, and torque about the base.
    pub load: Wrench,
    /// Rate of work on the body (W).
    pub power: f64,
}

/// A body with coordinates; `None` of one that has none.
#[must_use]
pub fn flexible_report<const D: usize>(
    problem: &Problem<D>,
    body: usize,
    now: &FlexibleStates<'_>,
) -> Option<FlexibleReport> {
    let rigid = &problem.bodies[body];
    let flexible = rigid.flexible()?;
    let range = problem.coordinates()[body].clone();
    let own = |all: &[f64]| DVector::from_column_slice(&all[range.clone()]);
    let (at, rates) = (own(now.coordinates), own(now.rates));
    let mass = flexible.mass() * f64::from(u8::from(problem.has_inertia));
    let impulse = &mass * &rates;
    let along = |axis: usize| {
        let motion = BaseMotion { velocity: Vector3::ith(axis, 1.0), ..BaseMotion::default() };
        flexible.rigid_velocities(&at, &motion).map_or(0.0, |motion| motion.dot(&impulse))
    };
    let is_held = rigid.attachment.is_some() || !flexible.held(now.time).is_empty();
    let missing = &mass * own(now.accelerations) + flexible.forces(&at, &rates, now.time);
    let body_at = BodyAt { flexible: flexible.as_ref(), coordinates: &at, missing: &missing };
    let outer = outer_load(problem, body, now, &body_at);
    let base = flexible.base(&at, &rates).filter(|_| is_held);
    Some(FlexibleReport {
        elastic_energy: flexible.elastic_energy(&at, now.time),
        kinetic_energy: 0.5 * rates.dot(&impulse),
        momentum: rigid.pose.to_world(&Vector3::from_fn(|axis, _| along(axis))),
        inner: flexible.inner_power(&at, &rates, now.time),
        end_force: rigid.pose.to_world(&flexible.given_load(&at, now.time).force),
        base: base.and_then(|base| body_at.base_report(&base, &outer, &rigid.pose)),
    })
}

/// A body with what its equations of motion need besides loads from outside, seen as its coordinates are.
struct BodyAt<'a> {
    flexible: &'a dyn Flexible,
    coordinates: &'a DVector<f64>,
    missing: &'a DVector<f64>,
}

/// Loads of the fluid and from outside, seen as coordinates are: forces and where they act.
fn outer_load<const D: usize>(
    problem: &Problem<D>,
    body: usize,
    now: &FlexibleStates<'_>,
    at: &BodyAt<'_>,
) -> OuterLoad {
    let rigid = &problem.bodies[body];
    let frame = &rigid.pose;
    let Wrench { force, torque } = match &now.contact[body] {
        contact if *contact == Wrench::default() => now.loads[body].load,
        contact => now.loads[body].load + *contact,
    };
    let external = rigid.external(now.time, &now.poses[body]).fixed_rows::<3>(0).into_owned();
    let center = weighted(&at.flexible.center_weights(), at.coordinates);
    OuterLoad {
        fluid: Wrench { force: frame.to_body(&force), torque: frame.to_body(&torque) },
        fluid_about: at.flexible.way_of_center(at.coordinates),
        external: frame.to_body(&external),
        center,
    }
}

/// Loads on a body from outside.
struct OuterLoad {
    fluid: Wrench,
    /// The point its torque is about (m).
    fluid_about: Vector3<f64>,
    /// Force that acts at the centre (N).
    external: Vector3<f64>,
    center: Vector3<f64>,
}

impl OuterLoad {
    /// Force, and torque about a place (m).
    fn about(&self, place: &Vector3<f64>) -> Wrench {
        let Self { fluid, fluid_about, external, center } = self;
        Wrench {
            force: fluid.force + external,
            torque: fluid.torque
                + (fluid_about - place).cross(&fluid.force)
                + (center - place).cross(external),
        }
    }
}

impl BodyAt<'_> {
    /// What holds a base that moves so, besides loads from outside; in the axes of the laboratory.
    fn base_report(
        &self,
        base: &BaseMotion,
        outer: &OuterLoad,
        frame: &Pose,
    ) -> Option<BaseReport> {
        let outer = outer.about(&base.place);
        let needed = |motion: BaseMotion| {
            let rates = self.flexible.rigid_velocities(self.coordinates, &motion)?;
            Some(rates.dot(self.missing))
        };
        let at = BaseMotion { place: base.place, ..BaseMotion::default() };
        let (mut force, mut torque) = (-outer.force, -outer.torque);
        for axis in 0..3 {
            let unit = Vector3::ith(axis, 1.0);
            force[axis] += needed(BaseMotion { velocity: unit, ..at })?;
            torque[axis] += needed(BaseMotion { angular_velocity: unit, ..at })?;
        }
        let power = force.dot(&base.velocity) + torque.dot(&base.angular_velocity);
        let load = Wrench { force: frame.to_world(&force), torque: frame.to_world(&torque) };
        Some(BaseReport { load, power })
    }
}
