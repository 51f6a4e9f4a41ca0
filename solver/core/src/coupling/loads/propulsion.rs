//! What a swimmer does as a whole: mean motion, power of its shape, thrust and drag.

use nalgebra::{Matrix3, Vector3};

use super::super::problem::{Group, Problem};
use super::BodyLoads;
use super::surface_load::SurfaceStress;
use crate::body::{Inertia, Mode, Modes, Pose, Twist, Wrench, in_space};

/// Centre of mass of a group, and the rigid motion with its linear and angular momentum; by volume
/// where bodies have no mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeanMotion {
    /// Centre of mass (m).
    pub center: Vector3<f64>,
    /// Linear velocity of it (m/s), and angular velocity about it (rad/s).
    pub twist: Twist,
}

/// Powers and forces along the way of a swimmer.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PropulsionPower {
    /// Rate of work of all its surface on the fluid (W).
    pub power: f64,
    /// The part of it done by the motion of the shape, without that of the mean rigid motion (W).
    pub shape_power: f64,
    /// The same with nothing recovered anywhere on the surface: points where the fluid works on the
    /// shape do not count (W).
    pub expended_power: f64,
    /// Forces on the surface along the velocity of the centre of mass (N).
    pub thrust: f64,
    /// Forces on the surface against that velocity (N), positive.
    pub drag: f64,
    /// Thrust times speed (W).
    pub thrust_power: f64,
}

impl PropulsionPower {
    /// All numbers, in the order of their declaration.
    #[must_use]
    pub fn numbers(&self) -> [f64; 6] {
        let Self { power, shape_power, expended_power, thrust, drag, thrust_power } = *self;
        [power, shape_power, expended_power, thrust, drag, thrust_power]
    }

    /// From all numbers.
    #[must_use]
    pub fn of([power, shape_power, expended_power, thrust, drag, thrust_power]: [f64; 6]) -> Self {
        Self { power, shape_power, expended_power, thrust, drag, thrust_power }
    }
}

/// Mean motion of a group with bodies at these poses.
#[must_use]
pub fn mean_motion<const D: usize>(
    problem: &Problem<D>,
    group: &Group,
    poses: &[Pose],
    twists: &[Twist],
) -> MeanMotion {
    let by_volume = group.bodies.iter().all(|body| problem.bodies[*body].inertia.mass == 0.0);
    let inertia = |body: usize| -> &Inertia {
        let rigid = &problem.bodies[body];
        if by_volume { &rigid.volume } else { &rigid.inertia }
    };
    let (mut total, mut center, mut linear) = (0.0, Vector3::zeros(), Vector3::zeros());
    for &body in &group.bodies {
        let mass = inertia(body).mass;
        total += mass;
        center += poses[body].center * mass;
        linear += twists[body].linear * mass;
    }
    let (center, linear) = (center / total, linear / total);
    let (mut momentum, mut tensor) = (Vector3::zeros(), Matrix3::zeros());
    for &body in &group.bodies {
        let own = poses[body].tensor_to_world(&inertia(body).tensor);
        let (mass, lever) = (inertia(body).mass, poses[body].center - center);
        momentum +=
            lever.cross(&(twists[body].linear - linear)) * mass + own * twists[body].angular;
        let offset =
            Matrix3::from_diagonal_element(lever.norm_squared()) - lever * lever.transpose();
        tensor += offset * mass + own;
    }
    let angular = angular_velocity(&tensor, &momentum, problem.modes());
    MeanMotion { center, twist: Twist { linear, angular } }
}

/// The angular velocity with an angular momentum, in the rotations of a geometry.
fn angular_velocity(tensor: &Matrix3<f64>, momentum: &Vector3<f64>, modes: Modes) -> Vector3<f64> {
    if modes == Modes::SPATIAL {
        return tensor.lu().solve(momentum).unwrap_or_else(Vector3::zeros);
    }
    let mut angular = Vector3::zeros();
    for axis in modes.rotations().map(Mode::axis) {
        angular[axis] = momentum[axis] / tensor[(axis, axis)];
    }
    angular
}

/// Load of the fluid on a group about its centre of mass.
#[must_use]
pub fn group_load(
    group: &Group,
    center: &Vector3<f64>,
    poses: &[Pose],
    loads: &[BodyLoads],
) -> Wrench {
    let mut sum = Wrench::default();
    for &body in &group.bodies {
        let load = &loads[body].load;
        let lever = poses[body].center - center;
        sum = sum + *load;
        sum.torque += lever.cross(&load.force);
    }
    sum
}

/// Bodies with the loads of the fluid on them.
#[derive(Debug, Clone, Copy)]
pub struct LoadedBodies<'a> {
    /// Poses in the laboratory.
    pub poses: &'a [Pose],
    /// What is added to their centres for where they are in the mesh (m): whole periods.
    pub image_shifts: &'a [Vector3<f64>],
    /// Rigid velocities.
    pub twists: &'a [Twist],
    /// Loads of the fluid.
    pub loads: &'a [BodyLoads],
}

/// What a group does to the fluid.
#[must_use]
pub fn propulsion_power<const D: usize>(
    problem: &Problem<D>,
    group: &Group,
    bodies: &LoadedBodies<'_>,
    stress: &SurfaceStress<'_, D>,
) -> PropulsionPower {
    let LoadedBodies { poses, image_shifts, twists, loads } = bodies;
    let MeanMotion { center, twist } = mean_motion(problem, group, poses, twists);
    let load = group_load(group, &center, poses, loads);
    let power: f64 = group.bodies.iter().map(|body| loads[*body].power).sum();
    let shape_power = power + load.force.dot(&twist.linear) + load.torque.dot(&twist.angular);
    let speed = twist.linear.norm();
    let ahead = if speed > 0.0 { twist.linear / speed } else { Vector3::zeros() };
    let (mut expended_power, mut thrust, mut drag) = (0.0, 0.0, 0.0);
    for &body in &group.bodies {
        stress.for_each_point(problem.bodies[body].boundary, |at| {
            let lever = in_space(&at.position) - image_shifts[body] - center;
            let (force, velocity) = (in_space(&at.force), in_space(&at.velocity));
            let along = force.dot(&ahead);
            thrust += along.max(0.0);
            drag += (-along).max(0.0);
            expended_power += (-force.dot(&(velocity - twist.velocity_at(&lever)))).max(0.0);
        });
    }
    PropulsionPower {
        power,
        shape_power,
        expended_power,
        thrust,
        drag,
        thrust_power: thrust * speed,
    }
}
