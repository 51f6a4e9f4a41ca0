//! `BodyShapes`: the shapes of all bodies at one time, and the velocities of their surfaces.

use alewife_mesh::spatial::BodySurface;
use alewife_mesh::{Outline, Point};
use nalgebra::Vector3;
use thiserror::Error;

use super::problem::RigidBody;
use crate::body::{Inertia, Orientation, Pose};
use crate::gait::{DeformedOutline, Gait, GaitError};

/// A gait that gives a body no shape at some time.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("body `{body}`: {reason}")]
pub struct ShapeError {
    /// Name of the body.
    pub body: String,
    /// When, and why.
    #[source]
    pub reason: GaitError,
}

/// The shapes of all bodies at one time, each evaluated once.
#[derive(Debug, Clone)]
pub struct BodyShapes {
    time: f64,
    /// `None` for bodies that do not deform.
    shapes: Vec<Option<BodyShape>>,
}

#[derive(Debug, Clone)]
struct BodyShape {
    deformed: DeformedOutline,
    boundary: ShapeBoundary,
}

/// What bounds a body that deforms, in its own frame.
#[derive(Debug, Clone)]
enum ShapeBoundary {
    /// In the plane or the meridian plane.
    Curve(Outline),
    /// In space.
    Surface(BodySurface),
}

impl RigidBody {
    /// The outline at a time (s); `None` for a body that does not deform.
    ///
    /// # Errors
    /// [`ShapeError`] where a gait gives the body no shape.
    pub fn deformed_at(&self, time: f64) -> Result<Option<DeformedOutline>, ShapeError> {
        let deformed = self.shape.as_ref().map(|motion| motion.at(time)).transpose();
        deformed.map_err(|reason| ShapeError { body: self.name.clone(), reason })
    }

    /// Mass and inertia tensor with the outline at a time (s).
    ///
    /// # Errors
    /// [`ShapeError`] where a gait gives the body no shape.
    pub fn inertia_at(&self, time: f64) -> Result<Inertia, ShapeError> {
        if self.inertia.is_zero() {
            return Ok(self.inertia);
        }
        Ok(self.inertia_with(self.deformed_at(time)?.as_ref()))
    }
}

impl BodyShapes {
    /// The shapes at a time (s).
    ///
    /// # Errors
    /// [`ShapeError`] where a gait gives its body no shape.
    pub fn at(bodies: &[RigidBody], time: f64) -> Result<Self, ShapeError> {
        let shape = |body: &RigidBody| {
            let Some(deformed) = body.deformed_at(time)? else { return Ok(None) };
            let refuse = |reason| ShapeError { body: body.name.clone(), reason };
            // A body in space crosses itself where its outline in the plane of the midline does
            let outline = deformed.outline(time).map_err(refuse)?;
            let boundary = match body.pose.orientation {
                Orientation::Planar(_) => ShapeBoundary::Curve(outline),
                Orientation::Spatial(_) => ShapeBoundary::Surface(
                    deformed.surface().ok_or(GaitError::Shape).map_err(refuse)?,
                ),
            };
            Ok(Some(BodyShape { deformed, boundary }))
        };
        Ok(Self { time, shapes: bodies.iter().map(shape).collect::<Result<_, _>>()? })
    }

    /// At time zero, as if no body deformed.
    #[must_use]
    pub fn rigid(n_bodies: usize) -> Self {
        Self { time: 0.0, shapes: vec![None; n_bodies] }
    }

    /// When (s).
    #[must_use]
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Positions, velocities and moments of a body that deforms, in its own frame.
    #[must_use]
    pub fn deformed(&self, body: usize) -> Option<&DeformedOutline> {
        self.shapes[body].as_ref().map(|shape| &shape.deformed)
    }

    /// The closed curve of a body that deforms; its centre is the origin, its angle zero.
    #[must_use]
    pub fn outline(&self, body: usize) -> Option<&Outline> {
        match &self.shapes[body].as_ref()?.boundary {
            ShapeBoundary::Curve(outline) => Some(outline),
            ShapeBoundary::Surface(_) => None,
        }
    }

    /// The surface of a body that deforms in space, in its own frame.
    #[must_use]
    pub fn surface(&self, body: usize) -> Option<&BodySurface> {
        match &self.shapes[body].as_ref()?.boundary {
            ShapeBoundary::Curve(_) => None,
            ShapeBoundary::Surface(surface) => Some(surface),
        }
    }

    /// What moves the surfaces of the bodies at these poses, besides their rigid motions.
    #[must_use]
    pub fn surfaces<'a>(
        &'a self,
        bodies: &'a [RigidBody],
        poses: &[Pose],
    ) -> Vec<MovingSurface<'a>> {
        let surface = |((body, shape), pose): ((&'a RigidBody, &'a Option<BodyShape>), &Pose)| {
            let place = |shape: &'a BodyShape| {
                let center = Point::<2>::new(pose.center.x, pose.center.y);
                let outline = match &shape.boundary {
                    ShapeBoundary::Curve(outline) => Some(outline.placed_at(center, pose.angle())),
                    ShapeBoundary::Surface(_) => None,
                };
                (&shape.deformed, outline)
            };
            MovingSurface {
                gait: body.gait.as_deref(),
                shape: shape.as_ref().map(place),
                pose: *pose,
                time: self.time,
            }
        };
        bodies.iter().zip(&self.shapes).zip(poses).map(surface).collect()
    }
}

/// The surface of a body at one time.
pub struct MovingSurface<'a> {
    gait: Option<&'a dyn Gait>,
    /// The shape in the frame of the body, and where the outline of one in the plane is in the world.
    shape: Option<(&'a DeformedOutline, Option<Outline>)>,
    pose: Pose,
    time: f64,
}

impl MovingSurface<'_> {
    /// Where the body is.
    #[must_use]
    pub fn pose(&self) -> &Pose {
        &self.pose
    }

    /// Velocity of the surface relative to the rigid motion, in the world (m/s), at a point of it
    /// (m).
    #[must_use]
    pub fn velocity(&self, point: &Vector3<f64>) -> Vector3<f64> {
        let rotation = self.pose.rotation();
        let mut velocity = Vector3::zeros();
        if let Some(gait) = self.gait {
            let lever = point - self.pose.center;
            velocity += gait.velocity(&(rotation.inverse() * lever), self.time);
        }
        if let Some((deformed, outline)) = &self.shape {
            velocity += match outline {
                Some(outline) => {
                    let rate = deformed.rate(outline.parameter_of(point.xy()));
                    Vector3::new(rate.x, rate.y, 0.0)
                }
                None => {
                    let place = rotation.inverse() * (point - self.pose.center);
                    deformed.velocity(deformed.material_at(&place))
                }
            };
        }
        rotation * velocity
    }
}
