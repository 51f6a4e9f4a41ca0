//! `Robot`: bodies, joints, motors and tendons, as MJCF and URDF have them and as a case has them.

use alewife_reduced::tree::{JointKind, Pose};
use nalgebra::{Matrix3, Vector3};

/// A tree of rigid bodies with what acts on it.
#[derive(Debug, Clone)]
pub(super) struct Robot {
    pub name: String,
    /// Acceleration by weight (m/s2).
    pub gravity: Vector3<f64>,
    /// Time step (s).
    pub step: f64,
    pub fluid: Option<Fluid>,
    /// Parents first.
    pub bodies: Vec<RobotBody>,
    pub motors: Vec<Motor>,
    pub tendons: Vec<RobotTendon>,
}

/// A fluid at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Fluid {
    /// Density (kg/m3).
    pub density: f64,
    /// Dynamic viscosity (Pa s).
    pub viscosity: f64,
}

/// A rigid body.
#[derive(Debug, Clone)]
pub(super) struct RobotBody {
    pub name: String,
    /// The body it hangs on; the world if absent.
    pub parent: Option<usize>,
    /// Its frame in that of its parent, or of the world, when the coordinates of its joints are zero.
    pub pose: Pose<f64>,
    /// Mass (kg).
    pub mass: f64,
    /// Centre of mass in its frame (m).
    pub center: Vector3<f64>,
    /// Inertia about the centre of mass, in its axes (kg m2).
    pub inertia: Matrix3<f64>,
    /// Whether it moves freely from its parent, the world.
    pub is_free: bool,
    /// Velocity of its centre of mass and angular velocity at the start, of a free body, in axes of the world.
    pub velocity: [Vector3<f64>; 2],
    /// Its joints in the order in which they move it, from the parent on; none where it is held, or free.
    pub joints: Vec<RobotJoint>,
    pub ellipsoids: Vec<RobotEllipsoid>,
    /// Half lengths along its axes of an ellipsoid that stands for it in pictures (m).
    pub extent: Option<Vector3<f64>>,
    /// Its middle in the frame of the body (m).
    pub middle: Vector3<f64>,
    /// The largest shape that a file shows of it, as an ellipsoid in a fluid.
    pub largest: Option<RobotEllipsoid>,
    /// Mass of the fluid it displaces (kg).
    pub displaced: f64,
    /// Where that lifts it, in its frame (m).
    pub lifted_at: Vector3<f64>,
}

/// A hinge or a slider.
#[derive(Debug, Clone)]
pub(super) struct RobotJoint {
    pub name: String,
    pub kind: JointKind,
    /// Unit vector along it, in the frame of the body.
    pub axis: Vector3<f64>,
    /// A point of the axis, in the frame of the body (m).
    pub position: Vector3<f64>,
    /// Effort per coordinate (N m/rad, N/m).
    pub stiffness: f64,
    /// Coordinate without effort of the spring (rad, m).
    pub rest: f64,
    /// Effort per rate (N m s/rad, N s/m).
    pub damping: f64,
    /// Effort per acceleration, of what turns with it alone (kg m2, kg).
    pub armature: f64,
    /// Coordinate and rate at the start.
    pub start: [f64; 2],
    /// What a file calls its coordinate where it is zero here.
    pub from: f64,
}

/// A joint by its body, and its number among the joints of that.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct JointOf {
    pub body: usize,
    pub nth: usize,
}

/// What drives a joint.
#[derive(Debug, Clone)]
pub(super) struct Motor {
    pub name: String,
    pub joint: JointOf,
    pub law: MotorLaw,
    /// What it is told at the start.
    pub control: f64,
    /// Least and most that it may be told.
    pub limits: Option<[f64; 2]>,
}

/// The effort of a motor by what it is told, u.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum MotorLaw {
    /// u.
    Effort,
    /// gain (u - q), with the coordinate q.
    Place {
        /// Effort per coordinate (N m/rad, N/m).
        gain: f64,
    },
    /// gain (u - q'), at most the limit.
    Rate {
        /// Effort per rate (N m s/rad, N s/m).
        gain: f64,
        /// Largest effort (N m, N).
        limit: Option<f64>,
    },
}

/// An ellipsoid with loads of a fluid.
#[derive(Debug, Clone, Copy)]
pub(super) struct RobotEllipsoid {
    /// Its centre and axes in the frame of the body.
    pub pose: Pose<f64>,
    /// Half lengths along its axes (m).
    pub semi_axes: Vector3<f64>,
    /// Blunt, slender, angular, Kutta, Magnus.
    pub coefficients: [f64; 5],
}

/// An elastic line.
#[derive(Debug, Clone)]
pub(super) struct RobotTendon {
    pub name: String,
    pub sites: Vec<RobotSite>,
    pub stiffness: f64,
    pub damping: f64,
    /// Length at rest (m).
    pub rest: f64,
    /// Whether it pushes where it is shorter.
    pub pushes: bool,
}

/// A point of a body.
#[derive(Debug, Clone, Copy)]
pub(super) struct RobotSite {
    pub body: usize,
    /// Place in the frame of the body (m).
    pub position: Vector3<f64>,
}

/// A pose seen from another one, both of the same frame.
pub(super) fn seen_from(outer: &Pose<f64>, inner: &Pose<f64>) -> Pose<f64> {
    Pose {
        rotation: outer.rotation.tr_mul(&inner.rotation),
        position: outer.rotation.tr_mul(&(inner.position - outer.position)),
    }
}

/// A point of a tendon, with the number of that.
#[derive(Debug, Clone, Copy)]
pub(super) struct Numbered {
    pub tendon: usize,
    /// Which of its points.
    pub nth: usize,
    pub site: RobotSite,
}

impl Robot {
    /// The points of all tendons.
    pub fn sites(&self) -> impl Iterator<Item = Numbered> {
        self.tendons.iter().enumerate().flat_map(|(tendon, one)| {
            let numbered = one.sites.iter().enumerate();
            numbered.map(move |(nth, site)| Numbered { tendon, nth, site: *site })
        })
    }

    /// Numbers of the bodies, each with all that hangs on it before the next one.
    pub fn depth_first(&self) -> Vec<usize> {
        let below = |parent: Option<usize>| {
            let children = (0..self.bodies.len()).filter(|one| self.bodies[*one].parent == parent);
            children.rev().collect::<Vec<usize>>()
        };
        let (mut order, mut waiting) = (Vec::new(), below(None));
        while let Some(next) = waiting.pop() {
            order.push(next);
            waiting.extend(below(Some(next)));
        }
        order
    }
}
