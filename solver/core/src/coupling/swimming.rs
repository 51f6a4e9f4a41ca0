//! What a swimmer does as a whole: mean motion, work of its shape, thrust and drag.

use alewife_mesh::{Mesh, Point};
use nalgebra::Vector3;

use super::loads::BodyLoads;
use super::problem::Problem;
use super::surface_load::Surface;
use super::system::Solution;
use crate::body::{Pose, Twist, Wrench};

/// Bodies that are told of as one.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// Name.
    pub name: String,
    /// Its bodies; the first is the one whose angle is told of as that of all.
    pub bodies: Vec<usize>,
    /// Time of one cycle (s).
    pub period: Option<f64>,
    /// Force per velocity that drags it when towed (N s/m).
    pub resistance: Option<f64>,
}

/// Centre of mass of a group, and the rigid motion with its linear and angular momentum; by volume
/// where bodies have no mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeanMotion {
    /// Centre of mass (m).
    pub center: Point<2>,
    /// Linear velocity of it (m/s), and angular velocity about it (rad/s).
    pub twist: Twist,
}

/// Rates of work and forces along the way of a swimmer.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Effort {
    /// Rate of work of all its surface on the fluid (W).
    pub power: f64,
    /// The part of it done by the motion of the shape, that by the mean rigid motion left out (W).
    pub shape_power: f64,
    /// The same with nothing won back anywhere on the surface: places where the fluid works on the
    /// shape do not count (W).
    pub spent_power: f64,
    /// Forces on the surface along the velocity of the centre of mass (N).
    pub thrust: f64,
    /// Forces on the surface against that velocity (N), positive.
    pub drag: f64,
    /// Thrust times speed (W).
    pub thrust_power: f64,
}

impl Effort {
    /// All numbers, in the order of their declaration.
    #[must_use]
    pub fn numbers(&self) -> [f64; 6] {
        let Self { power, shape_power, spent_power, thrust, drag, thrust_power } = *self;
        [power, shape_power, spent_power, thrust, drag, thrust_power]
    }

    /// From all numbers.
    #[must_use]
    pub fn of([power, shape_power, spent_power, thrust, drag, thrust_power]: [f64; 6]) -> Self {
        Self { power, shape_power, spent_power, thrust, drag, thrust_power }
    }

    /// This plus a factor times another.
    #[must_use]
    pub fn plus(&self, other: &Self, factor: f64) -> Self {
        let (mut sum, other) = (self.numbers(), other.numbers());
        sum.iter_mut().zip(other).for_each(|(sum, other)| *sum += factor * other);
        Self::of(sum)
    }
}

/// Mean motion of a group with bodies at these poses.
#[must_use]
pub fn mean_motion(
    problem: &Problem,
    group: &Group,
    poses: &[Pose],
    twists: &[Twist],
) -> MeanMotion {
    let by_volume = group.bodies.iter().all(|body| problem.bodies[*body].mass == 0.0);
    let weight = |body: usize| {
        let rigid = &problem.bodies[body];
        if by_volume { (rigid.volume, rigid.second_moment) } else { (rigid.mass, rigid.inertia) }
    };
    let (mut total, mut center, mut linear) = (0.0, Vector3::zeros(), Vector3::zeros());
    for &body in &group.bodies {
        let (mass, _) = weight(body);
        total += mass;
        center += poses[body].center * mass;
        linear += twists[body].linear * mass;
    }
    let (center, linear) = (center / total, linear / total);
    let (mut momentum, mut inertia) = (0.0, 0.0);
    for &body in &group.bodies {
        let (mass, own) = weight(body);
        let lever = poses[body].center - center;
        momentum +=
            mass * lever.cross(&(twists[body].linear - linear)).z + own * twists[body].angular.z;
        inertia += mass * lever.norm_squared() + own;
    }
    let spin = if problem.metric.has_rotation() { momentum / inertia } else { 0.0 };
    let twist = Twist { linear, angular: Vector3::new(0.0, 0.0, spin) };
    MeanMotion { center: center.xy(), twist }
}

/// Load of the fluid on a group about its centre of mass.
#[must_use]
pub fn group_load(group: &Group, center: &Point<2>, poses: &[Pose], loads: &[BodyLoads]) -> Wrench {
    let mut sum = Wrench::default();
    for &body in &group.bodies {
        let load = &loads[body].load;
        let lever = poses[body].center - Vector3::new(center.x, center.y, 0.0);
        sum = sum + *load;
        sum.torque += lever.cross(&load.force);
    }
    sum
}

/// What a group does to the fluid. `wraps` are added to the centres (m) of `poses` for where bodies are
/// in the mesh.
#[must_use]
pub fn effort(
    problem: &Problem,
    mesh: &Mesh<2>,
    group: &Group,
    (poses, wraps): (&[Pose], &[Point<2>]),
    solution: &Solution,
    loads: &[BodyLoads],
) -> Effort {
    let MeanMotion { center, twist } = mean_motion(problem, group, poses, &solution.twists);
    let load = group_load(group, &center, poses, loads);
    let power: f64 = group.bodies.iter().map(|body| loads[*body].power).sum();
    let shape_power = power + load.force.dot(&twist.linear) + load.torque.dot(&twist.angular);
    let (linear, spin) = (twist.linear.xy(), twist.angular.z);
    let speed = linear.norm();
    let ahead = if speed > 0.0 { linear / speed } else { Point::<2>::zeros() };
    let (mut spent_power, mut thrust, mut drag) = (0.0, 0.0, 0.0);
    for &body in &group.bodies {
        let surface = Surface {
            mesh,
            boundary: problem.bodies[body].boundary,
            viscosity: problem.viscosity,
            metric: problem.metric,
        };
        surface.for_each_force(&solution.fields(), |place, force, velocity| {
            let lever = place - wraps[body] - center;
            let rigid = linear + Point::<2>::new(-lever.y, lever.x) * spin;
            let along = force.dot(&ahead);
            thrust += along.max(0.0);
            drag += (-along).max(0.0);
            spent_power += (-force.dot(&(velocity - rigid))).max(0.0);
        });
    }
    Effort { power, shape_power, spent_power, thrust, drag, thrust_power: thrust * speed }
}
