//! Quantities of a swimmer of a reduced model: its mean motion, power, and averages over its cycles.

use alewife_reduced::tree::{Number, norm, real};
use nalgebra::{Matrix3, Vector3};

use super::build::Reduced;
use super::measure::{Moving, Value};
use super::part::Part;
use crate::case::{SwimmerModel, SwimmerQuantity};

/// What is remembered of a swimmer at the end of a step.
#[derive(Debug, Clone, Copy)]
struct Past<T: Number> {
    time: T,
    center: Vector3<T>,
    angle: T,
    /// Integrals of the power, and of it where it is positive (J).
    work: T,
    given: T,
}

/// A swimmer through time.
#[derive(Debug, Clone)]
pub(super) struct Swimming<T: Number = f64> {
    bodies: Vec<usize>,
    period: Option<T>,
    past: Vec<Past<T>>,
    now: Option<Now<T>>,
}

/// A swimmer at one time.
#[derive(Debug, Clone, Copy)]
pub(super) struct Now<T: Number = f64> {
    center: Vector3<T>,
    angle: T,
    linear: Vector3<T>,
    /// About the centre.
    momentum: Vector3<T>,
    inertia: Matrix3<T>,
    force: Vector3<T>,
    torque: Vector3<T>,
    power: T,
}

impl<T: Number> Now<T> {
    /// That of bodies by their numbers.
    pub fn of(own: &[usize], reduced: &Reduced, bodies: &[Moving<T>]) -> Self {
        let parts = || own.iter().map(|body| (&reduced.parts[*body], &bodies[*body]));
        let mass: f64 = parts().map(|(part, _)| part.mass).sum();
        let zeros = Vector3::repeat(real::<T>(0.0));
        let mean = |value: fn(&Moving<T>) -> Vector3<T>| {
            parts().fold(zeros, |sum, (part, body)| sum + value(body) * real::<T>(part.mass))
                / real::<T>(mass)
        };
        let center = mean(|body| body.pose.position);
        let linear = mean(|body| body.twist.linear);
        let mut momentum = zeros;
        let mut inertia = Matrix3::repeat(real::<T>(0.0));
        let (mut force, mut torque, mut power) = (zeros, zeros, real::<T>(0.0));
        for (part, body) in parts() {
            let arm = body.pose.position - center;
            let own = turned_inertia(part, body);
            let mass: T = real(part.mass);
            momentum += arm.cross(&body.twist.linear) * mass + own * body.twist.angular;
            let square = Matrix3::from_diagonal_element(arm.dot(&arm));
            inertia += own + (square - arm * arm.transpose()) * mass;
            force += body.load.force;
            torque += body.load.torque + arm.cross(&body.load.force);
            power += body.power();
        }
        Self {
            center,
            angle: bodies[own[0]].angle,
            linear,
            momentum,
            inertia,
            force,
            torque,
            power,
        }
    }
}

impl Now {
    /// A quantity of one time; none of those of a cycle, or that only a flow has.
    pub fn value(&self, quantity: SwimmerQuantity) -> Option<Value> {
        let angular = solve(&self.inertia, &self.momentum);
        let rigid = self.linear.dot(&self.force) + angular.dot(&self.torque);
        Some(match quantity {
            SwimmerQuantity::Position => Value::Vector(self.center),
            SwimmerQuantity::Angle => Value::Scalar(self.angle),
            SwimmerQuantity::Velocity => Value::Vector(self.linear),
            SwimmerQuantity::AngularVelocity => Value::Vector(angular),
            SwimmerQuantity::Force => Value::Vector(self.force),
            SwimmerQuantity::Torque => Value::Vector(self.torque),
            SwimmerQuantity::Power => Value::Scalar(self.power),
            SwimmerQuantity::ShapePower => Value::Scalar(self.power + rigid),
            _ => return None,
        })
    }
}

/// Averages over the last cycle.
struct Cycle<T: Number> {
    way: Vector3<T>,
    before: Option<Vector3<T>>,
    angle: T,
    work: T,
    given: T,
    period: T,
}

impl Swimming {
    pub fn new(swimmer: &SwimmerModel) -> Self {
        Self::with_period(swimmer, swimmer.period)
    }
}

impl<T: Number> Swimming<T> {
    /// One whose cycle takes as long (s).
    pub fn with_period(swimmer: &SwimmerModel, period: Option<T>) -> Self {
        Self { bodies: swimmer.bodies.clone(), period, past: Vec::new(), now: None }
    }

    /// Takes over the bodies at a time.
    pub fn observe(&mut self, reduced: &Reduced, bodies: &[Moving<T>], time: T) {
        let now = Now::of(&self.bodies, reduced, bodies);
        let (center, angle, power) = (now.center, now.angle, now.power);
        let last = self.past.last();
        let zero: T = real(0.0);
        let step = last.map_or(zero, |last| time - last.time);
        let before = self.now.map_or(power, |now| now.power);
        let sum = |value: fn(&Past<T>) -> T, rate: T| last.map_or(zero, value) + step * rate;
        let given = |power: T| if power.re() > 0.0 { power } else { zero };
        let past = Past {
            time,
            center,
            angle,
            work: sum(|past| past.work, (before + power) * 0.5),
            given: sum(|past| past.given, (given(before) + given(power)) * 0.5),
        };
        self.past.push(past);
        self.now = Some(now);
    }

    /// What was at a time, between the ends of steps.
    fn at(&self, time: T) -> Option<Past<T>> {
        let first = self.past.first()?;
        if time.re() < first.time.re() - 1e-9 {
            return None;
        }
        let after = self.past.partition_point(|past| past.time.re() < time.re());
        let Some(late) = self.past.get(after) else { return self.past.last().copied() };
        let Some(early) = after.checked_sub(1).map(|before| self.past[before]) else {
            return Some(*late);
        };
        let part = (time - early.time) / (late.time - early.time);
        let between = |a: T, b: T| a + part * (b - a);
        Some(Past {
            time,
            center: early.center + (late.center - early.center) * part,
            angle: between(early.angle, late.angle),
            work: between(early.work, late.work),
            given: between(early.given, late.given),
        })
    }

    fn cycle(&self) -> Option<Cycle<T>> {
        let (period, now) = (self.period?, self.past.last()?);
        let start = self.at(now.time - period)?;
        let before = self.at(now.time - period * 2.0);
        Some(Cycle {
            way: now.center - start.center,
            before: before.map(|before| start.center - before.center),
            angle: now.angle - start.angle,
            work: now.work - start.work,
            given: now.given - start.given,
            period,
        })
    }

    /// Where it is, how far it is turned, and averages over its last cycle; none of all else.
    pub fn at_the_end(&self, quantity: SwimmerQuantity) -> Option<Value<T>> {
        let now = self.now.as_ref()?;
        let none: T = real(f64::NAN);
        let of_cycle =
            |value: fn(&Cycle<T>) -> T| Value::Scalar(self.cycle().as_ref().map_or(none, value));
        Some(match quantity {
            SwimmerQuantity::Position => Value::Vector(now.center),
            SwimmerQuantity::Angle => Value::Scalar(now.angle),
            SwimmerQuantity::CycleDisplacement => {
                Value::Vector(self.cycle().map_or(Vector3::repeat(none), |cycle| cycle.way))
            }
            SwimmerQuantity::CycleAngle => of_cycle(|cycle| cycle.angle),
            SwimmerQuantity::CycleSpeed => of_cycle(|cycle| norm(&cycle.way) / cycle.period),
            SwimmerQuantity::CyclePower => of_cycle(|cycle| cycle.work / cycle.period),
            SwimmerQuantity::CycleCostOfTransport => {
                of_cycle(|cycle| cycle.given / norm(&cycle.way))
            }
            SwimmerQuantity::CycleDrift => of_cycle(|cycle| {
                let away = |before: Vector3<T>| norm(&(cycle.way - before)) / norm(&cycle.way);
                cycle.before.map_or(real(f64::NAN), away)
            }),
            _ => return None,
        })
    }
}

impl Swimming {
    /// A quantity; none of those that only a flow has.
    pub fn value(&self, quantity: SwimmerQuantity) -> Option<Value> {
        self.at_the_end(quantity).or_else(|| self.now?.value(quantity))
    }
}

/// Inertia of a body in axes of the world.
fn turned_inertia<T: Number>(part: &Part, body: &Moving<T>) -> Matrix3<T> {
    let turn = body.pose.rotation;
    turn * part.inertia.map(real::<T>) * turn.transpose()
}

/// The angular velocity of a momentum; about z alone in the plane, where there are no other moments.
fn solve(inertia: &Matrix3<f64>, momentum: &Vector3<f64>) -> Vector3<f64> {
    let in_plane = || Vector3::new(0.0, 0.0, momentum.z / inertia[(2, 2)]);
    if momentum.xy().norm() <= 0.0 {
        return in_plane();
    }
    inertia.try_inverse().map_or_else(in_plane, |inverse| inverse * momentum)
}
