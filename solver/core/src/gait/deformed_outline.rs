//! `ShapeMotion` and `DeformedOutline`: an outline that moves in the frame of its body.

use std::sync::Arc;

use alewife_mesh::spatial::{self, BodySurface, SectionPoint, Sections, Slender};
use alewife_mesh::{Moments, Outline, PlacedShape, Point, Shape, Spline};
use nalgebra::{Isometry3, Vector3};

use super::closed::on_outline;

use super::error::GaitError;
use super::flexible::Carried;
use super::recoil::RecoilMotion;
use crate::structure::Flexible;

/// A material point of a body that deforms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MaterialPoint {
    /// Parameter of a curve, or along the body from its nose; of a sphere the angle from its x axis.
    pub along: f64,
    /// Angle about the midline or the axis (rad); zero in the plane.
    pub around: f64,
}

/// How the outline of a body moves in the body's own frame: as the time has it, or the coordinates of the body.
pub trait ShapeMotion: std::fmt::Debug + Send + Sync {
    /// The outline at a time (s).
    ///
    /// # Errors
    /// [`GaitError`] where the gait makes no outline at this time.
    fn at(&self, time: f64) -> Result<DeformedOutline, GaitError>;

    /// The outline at a time (s) with coordinates of the body; that at the time where it has none.
    ///
    /// # Errors
    /// [`GaitError`] where they make no outline.
    fn with_coordinates(
        &self,
        time: f64,
        _coordinates: &[f64],
    ) -> Result<DeformedOutline, GaitError> {
        self.at(time)
    }

    /// What has the coordinates, where the outline follows some.
    fn flexible(&self) -> Option<&Arc<dyn Flexible>> {
        None
    }

    /// Times (s) at which rates may jump, ascending, within (from, to); none for smooth gaits.
    fn discontinuities(&self, from: f64, to: f64) -> Vec<f64>;

    /// How large the rigid motion is that is subtracted from the prescribed one over a period.
    ///
    /// # Errors
    /// [`GaitError`] where the gait makes no outline at some time of it.
    fn recoil(&self) -> Result<RecoilMotion, GaitError>;
}

/// An outline at one time, in the frame of its body: the origin is the centre of area, and the body
/// has no angular momentum in it.
#[derive(Debug, Clone, PartialEq)]
pub struct DeformedOutline {
    /// Positions and velocities of its material points.
    pub(super) curve: MaterialCurve,
    /// Area or volume, centre (the origin) and second moments.
    pub moments: Moments,
    /// Rate of the second moment that resists turning in the plane (m⁴/s; m⁵/s of a sphere).
    pub inertia_rate: f64,
    /// What was subtracted from the prescribed motion.
    pub recoil: RecoilCorrection,
}

/// A closed curve by its material points.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum MaterialCurve {
    /// Positions (m) and velocities (m/s), linear in the same parameter.
    Spline { points: Arc<Spline>, rates: Spline },
    /// Points carried by coordinates, and the spline through some of them.
    Carried { points: Arc<Spline>, carried: Carried<Spline> },
    /// Points of a surface in space carried by coordinates, and the sections through some of them.
    CarriedSections { surface: Arc<Slender>, carried: Carried<Sections> },
    /// Sections in space, and those of their velocities.
    Sections { surface: Arc<Slender>, rates: Sections },
    /// A disc or a sphere; the parameter is the angle.
    Round { radius: f64, radial_speed: f64, is_sphere: bool },
}

/// What is subtracted from a prescribed motion, so that the body has no momentum of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RecoilCorrection {
    /// Where the centre of area is, as seen from the head (m).
    pub center: Point<2>,
    /// Its velocity there (m/s).
    pub velocity: Point<2>,
    /// Angle by which the angular velocity has turned the body since the start (rad).
    pub angle: f64,
    /// Angular velocity that carries the angular momentum (rad/s).
    pub angular_velocity: f64,
    /// Speed along all normals that keeps the area, which is added (m/s).
    pub normal_speed: f64,
    /// Mean over the outline of |velocity along the normal|, after all corrections (m/s).
    pub mean_normal_speed: f64,
    /// Velocity (m/s) of the centre of the interior from which the angular momentum is taken, in this
    /// frame: that interior ends at the exact profile, and the outline is a spline through its material points.
    pub interior_drift: f64,
}

impl RecoilCorrection {
    pub(super) const NONE: Self = Self {
        center: Point::<2>::new(0.0, 0.0),
        velocity: Point::<2>::new(0.0, 0.0),
        angle: 0.0,
        angular_velocity: 0.0,
        normal_speed: 0.0,
        mean_normal_speed: 0.0,
        interior_drift: 0.0,
    };
}

impl MaterialCurve {
    /// The curve, whose parameter is a material point.
    pub(super) fn shape(&self) -> Option<Shape> {
        Some(match *self {
            Self::Spline { ref points, .. } | Self::Carried { ref points, .. } => {
                Shape::Curve { spline: Arc::clone(points) }
            }
            Self::Sections { .. } => Shape::Curve { spline: Arc::new(self.outline()?) },
            // It bends out of any plane
            Self::CarriedSections { .. } => return None,
            Self::Round { radius, is_sphere: true, .. } => Shape::Sphere { radius },
            Self::Round { radius, is_sphere: false, .. } => Shape::Disc { radius },
        })
    }
}

impl DeformedOutline {
    /// The outline, whose parameter is a material point; of a body in space in the plane of its midline, `None` where it has none.
    #[must_use]
    pub fn shape(&self) -> Option<Shape> {
        self.curve.shape()
    }

    /// The body in space; `None` of one in the plane.
    #[must_use]
    pub fn solid(&self) -> Option<spatial::Shape> {
        match &self.curve {
            MaterialCurve::Sections { surface, .. }
            | MaterialCurve::CarriedSections { surface, .. } => {
                Some(spatial::Shape::Slender(Arc::clone(surface)))
            }
            MaterialCurve::Round { radius, is_sphere: true, .. } => {
                Some(spatial::Shape::Sphere { radius: *radius })
            }
            MaterialCurve::Spline { .. }
            | MaterialCurve::Carried { .. }
            | MaterialCurve::Round { .. } => None,
        }
    }

    /// The surface in space, in the frame of the body; `None` of a body in the plane.
    #[must_use]
    pub fn surface(&self) -> Option<BodySurface> {
        let name = "a body that deforms";
        BodySurface::new(&spatial::Body::new(name, self.solid()?, Isometry3::identity())).ok()
    }

    /// The closed curve in the frame of the body: its centre is the origin, its angle zero. `time` (s)
    /// is that of this outline.
    ///
    /// # Errors
    /// [`GaitError`] when it crosses itself.
    pub fn outline(&self, time: f64) -> Result<Outline, GaitError> {
        let placed = PlacedShape {
            name: "a body that deforms".to_owned(),
            shape: self.shape().ok_or(GaitError::Shape)?,
            center: Point::<2>::zeros(),
            angle: 0.0,
            size: None,
        };
        Outline::new(&placed).map_err(|error| GaitError::of_outline(time, error))
    }

    /// Position of a material point in the body frame (m), by the parameter of
    /// [`alewife_mesh::Outline::at`].
    #[must_use]
    pub fn position(&self, parameter: f64) -> Point<2> {
        match &self.curve {
            MaterialCurve::Spline { points, .. } => points.evaluate(parameter)[0],
            MaterialCurve::Carried { carried, .. } => {
                carried.place(&carried.rest_place(parameter)).xy()
            }
            MaterialCurve::Sections { surface, .. }
            | MaterialCurve::CarriedSections { surface, .. } => {
                let sections = surface.sections();
                sections.point(on_outline(sections, parameter)).xy()
            }
            MaterialCurve::Round { radius, .. } => radial(parameter) * *radius,
        }
    }

    /// Velocity of a material point in the body frame (m/s): the rate of [`Self::position`], without what
    /// coordinates of the body give of it.
    #[must_use]
    pub fn rate(&self, parameter: f64) -> Point<2> {
        match &self.curve {
            MaterialCurve::Spline { rates, .. } => rates.evaluate(parameter)[0],
            MaterialCurve::Carried { .. } | MaterialCurve::CarriedSections { .. } => {
                Point::<2>::zeros()
            }
            MaterialCurve::Sections { rates, .. } => rates.point(on_outline(rates, parameter)).xy(),
            MaterialCurve::Round { radial_speed, .. } => radial(parameter) * *radial_speed,
        }
    }
}

impl DeformedOutline {
    /// The material point of the surface in space nearest to a point of the body frame (m).
    #[must_use]
    pub fn material_at(&self, point: &Vector3<f64>) -> MaterialPoint {
        match &self.curve {
            MaterialCurve::Sections { surface, .. }
            | MaterialCurve::CarriedSections { surface, .. } => {
                let SectionPoint { along, around } = surface.parameter_of(*point);
                MaterialPoint { along, around }
            }
            MaterialCurve::Spline { .. }
            | MaterialCurve::Carried { .. }
            | MaterialCurve::Round { .. } => MaterialPoint {
                along: point.y.hypot(point.z).atan2(point.x),
                around: point.z.atan2(point.y),
            },
        }
    }

    /// Where a material point of a surface in space is in the body frame (m).
    #[must_use]
    pub fn place(&self, at: MaterialPoint) -> Vector3<f64> {
        match &self.curve {
            MaterialCurve::Sections { surface, .. } => surface.sections().point(at.into()),
            MaterialCurve::CarriedSections { carried, .. } => {
                carried.place(&carried.rest_place(at.into()))
            }
            MaterialCurve::Spline { .. }
            | MaterialCurve::Carried { .. }
            | MaterialCurve::Round { .. } => around_axis(self.position(at.along), at.around),
        }
    }

    /// Velocity of a material point of a surface in space in the body frame (m/s): the rate of
    /// [`Self::place`], without what coordinates of the body give of it.
    #[must_use]
    pub fn velocity(&self, at: MaterialPoint) -> Vector3<f64> {
        match &self.curve {
            MaterialCurve::Sections { rates, .. } => rates.point(at.into()),
            MaterialCurve::CarriedSections { .. } => Vector3::zeros(),
            MaterialCurve::Spline { .. }
            | MaterialCurve::Carried { .. }
            | MaterialCurve::Round { .. } => around_axis(self.rate(at.along), at.around),
        }
    }
}

impl From<MaterialPoint> for SectionPoint {
    fn from(MaterialPoint { along, around }: MaterialPoint) -> Self {
        Self { along, around }
    }
}

/// A vector of the plane turned about x by an angle (rad).
fn around_axis(vector: Point<2>, angle: f64) -> Vector3<f64> {
    Vector3::new(vector.x, vector.y * angle.cos(), vector.y * angle.sin())
}

/// Unit vector at an angle (rad).
fn radial(angle: f64) -> Point<2> {
    Point::<2>::new(angle.cos(), angle.sin())
}
