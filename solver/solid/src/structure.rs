//! `Structure`: a body of any number of velocities, as the equations of motion ask for it.

use nalgebra::{DMatrix, DVector, Vector3};

/// An elastic body with coordinates q (n) and velocities v = dq/dt, which obeys
///
/// ```text
/// M dv/dt + f(q, v, t) = Q,
/// ```
///
/// where the load Q is the work of outer forces per virtual displacement: dW = Q . dq. Coordinates are places
/// (m) or angles (rad); in planar problems masses and forces are per length.
pub trait Structure: Send + Sync {
    /// Number of coordinates n.
    fn n_coordinates(&self) -> usize;

    /// Mass matrix M (n x n), symmetric and constant.
    fn mass(&self) -> DMatrix<f64>;

    /// Inner forces f (n) at a time (s): elastic, active and of damping, less loads that are given at ends.
    fn forces(
        &self,
        coordinates: &DVector<f64>,
        velocities: &DVector<f64>,
        time: f64,
    ) -> DVector<f64>;

    /// How the inner forces depend on coordinates and on velocities, at a time (s).
    fn tangents(
        &self,
        coordinates: &DVector<f64>,
        velocities: &DVector<f64>,
        time: f64,
    ) -> Tangents;

    /// Elastic energy (J, in planar problems per length), which has no part of what is active.
    fn elastic_energy(&self, coordinates: &DVector<f64>, time: f64) -> f64;

    /// Power of activation, damping and loads at ends at a time (s); none of what has none of them.
    fn inner_power(
        &self,
        _coordinates: &DVector<f64>,
        _velocities: &DVector<f64>,
        _time: f64,
    ) -> InnerPower {
        InnerPower::default()
    }
}

/// Power of what is part of a structure at an instant (W, in planar problems per length).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct InnerPower {
    /// Of active moments, and of rest curvatures that change: what muscles or motors give.
    pub activation: f64,
    /// What damping takes.
    pub dissipation: f64,
    /// Of loads that are given at its ends.
    pub ends: f64,
}

/// A structure with a surface, whose material points are named by their places at rest (m).
///
/// Places and velocities are seen from a frame that stays where the body is put at the start. Which coordinates a
/// point moves with does not depend on where they are.
pub trait Flexible: Structure + std::fmt::Debug {
    /// Coordinates (n) at time zero.
    fn initial(&self) -> DVector<f64>;

    /// Coordinates that are given at a time (s), always the same ones, ascending: where the body is clamped.
    fn held(&self, time: f64) -> Vec<Held>;

    /// Where the point at a place at rest (m) is.
    fn place(&self, coordinates: &DVector<f64>, rest: &Vector3<f64>) -> Vector3<f64>;

    /// The velocity there, as a sum of weights times velocities of the structure.
    fn weights(&self, coordinates: &DVector<f64>, rest: &Vector3<f64>) -> Vec<Weight>;

    /// How the section moves as a whole that the point at a place at rest (m) is on, of bodies of which that is known.
    fn section(&self, _coordinates: &DVector<f64>, _rest: &Vector3<f64>) -> Option<SectionMotion> {
        None
    }

    /// Length (m) by which a coordinate counts as the displacement of a point: one of coordinates that are places.
    fn length_of(&self, _coordinate: usize) -> f64 {
        1.0
    }

    /// The centre of the body, as a sum of weights times coordinates.
    fn center_weights(&self) -> Vec<Weight>;

    /// The sum of the loads that are given at its ends at coordinates and a time (s), which are part of its inner forces; seen
    /// as places are.
    fn given_load(&self, _coordinates: &DVector<f64>, _time: f64) -> GivenLoad {
        GivenLoad::default()
    }

    /// How its midline is bent, of bodies that have one.
    fn bend(&self, _coordinates: &DVector<f64>) -> Option<Bend> {
        None
    }

    /// Where its base is and how it moves, of bodies that have one; seen as places are.
    fn base(&self, _coordinates: &DVector<f64>, _velocities: &DVector<f64>) -> Option<BaseMotion> {
        None
    }

    /// Velocities (n) of the structure in a rigid motion, of bodies of which they are known; seen as places are.
    fn rigid_velocities(
        &self,
        _coordinates: &DVector<f64>,
        _motion: &BaseMotion,
    ) -> Option<DVector<f64>> {
        None
    }

    /// How far the centre has come since time zero (m).
    fn way_of_center(&self, coordinates: &DVector<f64>) -> Vector3<f64> {
        weighted(&self.center_weights(), &(coordinates - self.initial()))
    }
}

/// Loads at the ends of a structure, each about its own end.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct GivenLoad {
    /// Sum of the forces (N, in planar problems N/m).
    pub force: Vector3<f64>,
    /// Sum of the moments (N m, in planar problems N).
    pub moment: Vector3<f64>,
}

impl GivenLoad {
    /// How large it is (N), a moment as the force at a radius (m).
    #[must_use]
    pub fn size(&self, radius: f64) -> f64 {
        self.force.norm() + self.moment.norm() / radius
    }
}

/// A point with the rigid motion there: of the base of a structure, or of all of it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BaseMotion {
    /// Place (m).
    pub place: Vector3<f64>,
    /// Velocity (m/s).
    pub velocity: Vector3<f64>,
    /// Angular velocity (rad/s).
    pub angular_velocity: Vector3<f64>,
}

/// How a midline is bent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bend {
    /// Where it ends (m).
    pub tip: Vector3<f64>,
    /// Its curvature where that is largest in size (1/m).
    pub curvature: f64,
}

/// A coordinate that is given, and its velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Held {
    /// Which coordinate.
    pub coordinate: usize,
    /// Its value.
    pub value: f64,
    /// Its velocity (1/s).
    pub rate: f64,
}

/// What a coordinate counts in a place, or its velocity in a velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weight {
    /// Which coordinate.
    pub coordinate: usize,
    /// Along x, y and z.
    pub weight: Vector3<f64>,
}

/// A section of a body, which moves as one piece; seen as places are.
#[derive(Debug, Clone, PartialEq)]
pub struct SectionMotion {
    /// Where its centre is (m).
    pub place: Vector3<f64>,
    /// What coordinates count in its velocities.
    pub weights: Vec<SectionWeight>,
}

/// What the velocity of a coordinate counts in those of a section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionWeight {
    /// Which coordinate.
    pub coordinate: usize,
    /// In the velocity of its centre, along x, y and z.
    pub linear: Vector3<f64>,
    /// In its angular velocity.
    pub angular: Vector3<f64>,
}

/// The sum of weights times values, one for each coordinate.
#[must_use]
pub fn weighted(weights: &[Weight], values: &DVector<f64>) -> Vector3<f64> {
    weights.iter().map(|Weight { coordinate, weight }| weight * values[*coordinate]).sum()
}

/// Derivatives of the inner forces (n x n each).
#[derive(Debug, Clone, PartialEq)]
pub struct Tangents {
    /// By coordinates: the stiffness K.
    pub stiffness: DMatrix<f64>,
    /// By velocities: the damping C.
    pub damping: DMatrix<f64>,
}

/// An outer load Q, such as weight or drag, which may depend on the motion of the structure.
pub trait Load: Send + Sync {
    /// The load Q (n) at a time (s).
    fn load(
        &self,
        coordinates: &DVector<f64>,
        velocities: &DVector<f64>,
        time: f64,
    ) -> DVector<f64>;

    /// How the load depends on coordinates and on velocities, at a time (s): its derivatives in place of those
    /// of inner forces.
    fn tangents(
        &self,
        coordinates: &DVector<f64>,
        velocities: &DVector<f64>,
        time: f64,
    ) -> Tangents;
}
