//! `Link` and `Joint`: what a tree is made of, and what a drive does to a joint.

use nalgebra::Vector3;

use super::loads::Load;
use super::spatial::{Number, Pose, Symmetric, real, vector};

/// What a joint lets its link do: turn about its axis, or go along it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum JointKind {
    /// Nothing.
    Fixed,
    /// It turns about the axis (rad).
    Hinge,
    /// It goes along the axis (m).
    Slider,
}

/// What moves a joint besides its spring, its damper and its fluid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Drive<T: Number> {
    /// A motor of the effort (N m, N) that is commanded; none if it is zero.
    Effort,
    /// The coordinate and its rate are those commanded, whatever that takes.
    Given,
    /// The rate is the one commanded, whatever that takes, and the coordinate its integral, to second order.
    Rate,
    /// A servo: the effort is `gain` times the commanded rate less the joint's own, at most `limit`.
    Servo {
        /// Effort per rate (N m s/rad, N s/m).
        gain: T,
        /// Largest effort (N m, N).
        limit: T,
    },
}

/// Soft ends of the way of a joint: beyond them a spring and a damper resist.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stops<T: Number> {
    /// Smallest coordinate (rad, m).
    pub lower: T,
    /// Largest coordinate (rad, m).
    pub upper: T,
    /// Effort per way beyond an end (N m/rad, N/m).
    pub stiffness: T,
    /// Effort per rate beyond an end (N m s/rad, N s/m).
    pub damping: T,
}

/// A joint of one coordinate q, or of none, with the effort -stiffness (q - rest) - damping q' besides that of
/// its drive.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint<T: Number> {
    /// What it lets its link do.
    pub kind: JointKind,
    /// Unit vector in the frame of the link.
    pub axis: Vector3<T>,
    /// What moves it.
    pub drive: Drive<T>,
    /// Effort per coordinate (N m/rad, N/m).
    pub stiffness: T,
    /// Coordinate without effort of the spring (rad, m).
    pub rest: T,
    /// Effort per rate (N m s/rad, N s/m).
    pub damping: T,
    /// Effort per acceleration of its coordinate, besides that of the links: of the rotor of a geared motor its moment
    /// of inertia times the square of the gear (kg m2, kg).
    pub armature: T,
    /// Ends of its way, if there are any.
    pub stops: Option<Stops<T>>,
}

impl<T: Number> Joint<T> {
    /// A joint without spring, damper, stops and motor.
    #[must_use]
    pub fn new(kind: JointKind, axis: [f64; 3]) -> Self {
        let zero = real(0.0);
        Self {
            kind,
            axis: vector(axis),
            drive: Drive::Effort,
            stiffness: zero,
            rest: zero,
            damping: zero,
            armature: zero,
            stops: None,
        }
    }

    /// The same joint with another drive.
    #[must_use]
    pub fn driven(self, drive: Drive<T>) -> Self {
        Self { drive, ..self }
    }
}

/// What a link weighs and displaces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weight<T: Number> {
    /// Mass that is weighed (kg).
    pub mass: T,
    /// Centre of mass in the frame of the link (m).
    pub mass_center: Vector3<T>,
    /// Mass of the fluid that is displaced (kg).
    pub displaced: T,
    /// Centre of buoyancy in the frame of the link (m).
    pub buoyancy_center: Vector3<T>,
}

/// A load in a frame of its own.
#[derive(Debug, Clone, PartialEq)]
pub struct PlacedLoad<T: Number> {
    /// Its frame in that of the link; the same frame if absent.
    pub pose: Option<Pose<T>>,
    /// The law.
    pub load: Load<T>,
}

/// A rigid part of a tree. The first link of a tree moves with the root, and its joint is not used.
#[derive(Debug, Clone, PartialEq)]
pub struct Link<T: Number> {
    /// Number of the link it is joined to, smaller than its own.
    pub parent: usize,
    /// Where its frame is in that of its parent when the coordinate of the joint is zero.
    pub at: Pose<T>,
    /// How it is joined.
    pub joint: Joint<T>,
    /// Masses about the origin of its frame, without the fluid's.
    pub inertia: Symmetric<T>,
    /// Weight and buoyancy; none if absent.
    pub weight: Option<Weight<T>>,
    /// What the fluid does to it.
    pub loads: Vec<PlacedLoad<T>>,
}

impl<T: Number> Link<T> {
    /// A link at its parent's origin, without loads.
    #[must_use]
    pub fn new(parent: usize, joint: Joint<T>, inertia: Symmetric<T>) -> Self {
        let at = Pose::identity();
        Self { parent, at, joint, inertia, weight: None, loads: Vec::new() }
    }

    /// A root with its inertia.
    #[must_use]
    pub fn root(inertia: Symmetric<T>) -> Self {
        Self::new(0, Joint::new(JointKind::Fixed, [1.0, 0.0, 0.0]), inertia)
    }

    /// The same link elsewhere on its parent (m).
    #[must_use]
    pub fn placed(self, position: [f64; 3]) -> Self {
        Self { at: Pose::at(vector(position)), ..self }
    }

    /// The same link with another load in its frame.
    #[must_use]
    pub fn loaded(mut self, load: Load<T>) -> Self {
        self.loads.push(PlacedLoad { pose: None, load });
        self
    }
}

/// What is asked of a joint at a time; which of these counts is said by its `Drive`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Command<T: Number> {
    /// Coordinate of a given joint (rad, m).
    pub place: T,
    /// Rate of a given joint, or what a servo is to reach (rad/s, m/s).
    pub rate: T,
    /// Effort of a motor (N m, N).
    pub effort: T,
}

impl<T: Number> Command<T> {
    /// Rest at the coordinate zero.
    #[must_use]
    pub fn none() -> Self {
        let zero = real(0.0);
        Self { place: zero, rate: zero, effort: zero }
    }
}
