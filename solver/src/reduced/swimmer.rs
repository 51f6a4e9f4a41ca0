//! Quantities of a swimmer of a reduced model: its mean motion, power, and averages over its cycles.

use nalgebra::{Matrix3, Vector3};

use super::build::Reduced;
use super::measure::{Moving, Value};
use super::part::Part;
use crate::case::{SwimmerModel, SwimmerQuantity};

/// What is remembered of a swimmer at the end of a step.
#[derive(Debug, Clone, Copy)]
struct Past {
    time: f64,
    center: Vector3<f64>,
    angle: f64,
    /// Integrals of the power, and of it where it is positive (J).
    work: f64,
    given: f64,
}

/// A swimmer through time.
#[derive(Debug, Clone)]
pub(super) struct Swimming {
    bodies: Vec<usize>,
    period: Option<f64>,
    past: Vec<Past>,
    now: Option<Now>,
}

/// A swimmer at one time.
#[derive(Debug, Clone, Copy)]
pub(super) struct Now {
    center: Vector3<f64>,
    angle: f64,
    linear: Vector3<f64>,
    angular: Vector3<f64>,
    force: Vector3<f64>,
    torque: Vector3<f64>,
    power: f64,
}

impl Now {
    /// That of bodies by their numbers.
    pub fn of(own: &[usize], reduced: &Reduced, bodies: &[Moving]) -> Self {
        let parts = || own.iter().map(|body| (&reduced.parts[*body], &bodies[*body]));
        let mass: f64 = parts().map(|(part, _)| part.mass).sum();
        let mean = |value: fn(&Moving) -> Vector3<f64>| {
            parts().fold(Vector3::zeros(), |sum, (part, body)| sum + value(body) * part.mass) / mass
        };
        let center = mean(|body| body.pose.position);
        let linear = mean(|body| body.twist.linear);
        let mut momentum = Vector3::zeros();
        let mut inertia = Matrix3::zeros();
        let (mut force, mut torque, mut power) = (Vector3::zeros(), Vector3::zeros(), 0.0);
        for (part, body) in parts() {
            let arm = body.pose.position - center;
            let own = turned_inertia(part, body);
            momentum += arm.cross(&body.twist.linear) * part.mass + own * body.twist.angular;
            inertia += own
                + (Matrix3::identity() * arm.norm_squared() - arm * arm.transpose()) * part.mass;
            force += body.load.force;
            torque += body.load.torque + arm.cross(&body.load.force);
            power += body.power();
        }
        let angular = solve(&inertia, &momentum);
        Self { center, angle: bodies[own[0]].angle, linear, angular, force, torque, power }
    }

    /// A quantity of one time; none of those of a cycle, or that only a flow has.
    pub fn value(&self, quantity: SwimmerQuantity) -> Option<Value> {
        let rigid = self.linear.dot(&self.force) + self.angular.dot(&self.torque);
        Some(match quantity {
            SwimmerQuantity::Position => Value::Vector(self.center),
            SwimmerQuantity::Angle => Value::Scalar(self.angle),
            SwimmerQuantity::Velocity => Value::Vector(self.linear),
            SwimmerQuantity::AngularVelocity => Value::Vector(self.angular),
            SwimmerQuantity::Force => Value::Vector(self.force),
            SwimmerQuantity::Torque => Value::Vector(self.torque),
            SwimmerQuantity::Power => Value::Scalar(self.power),
            SwimmerQuantity::ShapePower => Value::Scalar(self.power + rigid),
            _ => return None,
        })
    }
}

/// Averages over the last cycle.
struct Cycle {
    way: Vector3<f64>,
    before: Option<Vector3<f64>>,
    angle: f64,
    work: f64,
    given: f64,
    period: f64,
}

impl Swimming {
    pub fn new(swimmer: &SwimmerModel) -> Self {
        let (bodies, period) = (swimmer.bodies.clone(), swimmer.period);
        Self { bodies, period, past: Vec::new(), now: None }
    }

    /// Takes over the bodies at a time.
    pub fn observe(&mut self, reduced: &Reduced, bodies: &[Moving], time: f64) {
        let now = Now::of(&self.bodies, reduced, bodies);
        let (center, angle, power) = (now.center, now.angle, now.power);
        let last = self.past.last();
        let step = last.map_or(0.0, |last| time - last.time);
        let before = self.now.map_or(power, |now| now.power);
        let sum = |value: fn(&Past) -> f64, rate: f64| last.map_or(0.0, value) + step * rate;
        let past = Past {
            time,
            center,
            angle,
            work: sum(|past| past.work, 0.5 * (before + power)),
            given: sum(|past| past.given, 0.5 * (before.max(0.0) + power.max(0.0))),
        };
        self.past.push(past);
        self.now = Some(now);
    }

    /// What was at a time, between the ends of steps.
    fn at(&self, time: f64) -> Option<Past> {
        let first = self.past.first()?;
        if time < first.time - 1e-9 {
            return None;
        }
        let after = self.past.partition_point(|past| past.time < time);
        let Some(late) = self.past.get(after) else { return self.past.last().copied() };
        let Some(early) = after.checked_sub(1).map(|before| self.past[before]) else {
            return Some(*late);
        };
        let part = (time - early.time) / (late.time - early.time);
        let between = |a: f64, b: f64| a + part * (b - a);
        Some(Past {
            time,
            center: early.center + (late.center - early.center) * part,
            angle: between(early.angle, late.angle),
            work: between(early.work, late.work),
            given: between(early.given, late.given),
        })
    }

    fn cycle(&self) -> Option<Cycle> {
        let (period, now) = (self.period?, self.past.last()?);
        let start = self.at(now.time - period)?;
        let before = self.at(now.time - 2.0 * period);
        Some(Cycle {
            way: now.center - start.center,
            before: before.map(|before| start.center - before.center),
            angle: now.angle - start.angle,
            work: now.work - start.work,
            given: now.given - start.given,
            period,
        })
    }

    /// A quantity; none of those that only a flow has.
    pub fn value(&self, quantity: SwimmerQuantity) -> Option<Value> {
        let now = self.now?;
        let of_cycle =
            |value: fn(&Cycle) -> f64| Value::Scalar(self.cycle().as_ref().map_or(f64::NAN, value));
        Some(match quantity {
            SwimmerQuantity::CycleDisplacement => {
                let nowhere = Vector3::repeat(f64::NAN);
                Value::Vector(self.cycle().map_or(nowhere, |cycle| cycle.way))
            }
            SwimmerQuantity::CycleAngle => of_cycle(|cycle| cycle.angle),
            SwimmerQuantity::CycleSpeed => of_cycle(|cycle| cycle.way.norm() / cycle.period),
            SwimmerQuantity::CyclePower => of_cycle(|cycle| cycle.work / cycle.period),
            SwimmerQuantity::CycleCostOfTransport => {
                of_cycle(|cycle| cycle.given / cycle.way.norm())
            }
            SwimmerQuantity::CycleDrift => of_cycle(|cycle| {
                cycle
                    .before
                    .map_or(f64::NAN, |before| (cycle.way - before).norm() / cycle.way.norm())
            }),
            _ => return now.value(quantity),
        })
    }
}

/// Inertia of a body in axes of the world.
fn turned_inertia(part: &Part, body: &Moving) -> Matrix3<f64> {
    let turn = body.pose.rotation;
    turn * part.inertia * turn.transpose()
}

/// The angular velocity of a momentum; about z alone in the plane, where there are no other moments.
fn solve(inertia: &Matrix3<f64>, momentum: &Vector3<f64>) -> Vector3<f64> {
    let in_plane = || Vector3::new(0.0, 0.0, momentum.z / inertia[(2, 2)]);
    if momentum.xy().norm() <= 0.0 {
        return in_plane();
    }
    inertia.try_inverse().map_or_else(in_plane, |inverse| inverse * momentum)
}
