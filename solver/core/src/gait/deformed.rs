//! `ShapeMotion` and `Deformed`: an outline that moves in the frame of its body.

use alewife_mesh::{Moments, Point, Shape, Spline};

/// How the outline of a body moves in the body's own frame.
pub trait ShapeMotion: std::fmt::Debug + Send + Sync {
    /// The outline at a time (s).
    fn at(&self, time: f64) -> Deformed;

    /// Times (s) at which rates may jump, ascending, within (from, to); none for smooth gaits.
    fn breaks(&self, from: f64, to: f64) -> Vec<f64>;
}

/// An outline at one time, in the frame of its body: the origin is the centre of area, and the body
/// has no angular momentum in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Deformed {
    /// Outline; its parameter is a material point.
    pub shape: Shape,
    /// Its velocity.
    pub(super) rates: Rates,
    /// Area or volume, centre (the origin) and second moments.
    pub moments: Moments,
    /// Rate of the second moment that resists turning in the plane (m⁴/s; m⁵/s of a sphere).
    pub inertia_rate: f64,
    /// What was taken from the prescribed motion to get here.
    pub removed: Removed,
}

/// Velocity of an outline.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Rates {
    /// At each parameter.
    Spline(Spline),
    /// Along the radius (m/s).
    Radial(f64),
}

/// What was taken from a prescribed motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Removed {
    /// Velocity of the centre of area, as seen from the head at the start (m/s).
    pub velocity: Point<2>,
    /// Angular velocity that carries the angular momentum (rad/s).
    pub angular_velocity: f64,
    /// Speed along all normals that keeps the area, which is added (m/s).
    pub normal_speed: f64,
    /// Mean over the outline of |velocity along the normal|, after all corrections (m/s).
    pub mean_normal_speed: f64,
    /// Linear momentum of the interior per mass, which should be zero in this frame (m/s): the
    /// interior keeps its area everywhere, so this is the error of the outline's spline.
    pub momentum_defect: f64,
}

impl Removed {
    pub(super) const NOTHING: Self = Self {
        velocity: Point::<2>::new(0.0, 0.0),
        angular_velocity: 0.0,
        normal_speed: 0.0,
        mean_normal_speed: 0.0,
        momentum_defect: 0.0,
    };
}

impl Deformed {
    /// Place of a material point in the body frame (m), by the parameter of
    /// [`alewife_mesh::Outline::at`].
    #[must_use]
    pub fn position(&self, parameter: f64) -> Point<2> {
        match &self.shape {
            Shape::Curve { spline } => spline.evaluate(parameter)[0],
            Shape::Disc { radius } | Shape::Sphere { radius } => outward(parameter) * *radius,
            // No motion makes any other
            _ => Point::<2>::zeros(),
        }
    }

    /// Velocity of a material point in the body frame (m/s): the rate of [`Self::position`].
    #[must_use]
    pub fn rate(&self, parameter: f64) -> Point<2> {
        match &self.rates {
            Rates::Spline(spline) => spline.evaluate(parameter)[0],
            Rates::Radial(speed) => outward(parameter) * *speed,
        }
    }
}

fn outward(angle: f64) -> Point<2> {
    Point::<2>::new(angle.cos(), angle.sin())
}
