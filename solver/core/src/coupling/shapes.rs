//! `BodyShapes`: the shapes of all bodies at one time, by their gaits or their coordinates.

use std::ops::Range;
use std::sync::Arc;

use alewife_mesh::spatial::BodySurface;
use alewife_mesh::{Outline, Point};
use thiserror::Error;

use super::problem::{RigidBody, coordinate_ranges, initial_coordinates};
use super::surface::MovingSurface;
use crate::body::{Inertia, Orientation, Pose};
use crate::gait::{DeformedOutline, GaitError};

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
    /// Coordinates of all bodies that they are of.
    coordinates: Vec<f64>,
    /// `None` for bodies that do not deform.
    shapes: Vec<Option<Arc<BodyShape>>>,
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

impl BodyShapes {
    /// These shapes, where bodies have coordinates with others of them.
    ///
    /// # Errors
    /// [`ShapeError`] where they give a body no shape.
    pub fn with_coordinates(
        &self,
        bodies: &[RigidBody],
        coordinates: &[f64],
    ) -> Result<Self, ShapeError> {
        if coordinates == self.coordinates {
            return Ok(self.clone());
        }
        Self::with(bodies, self.time, coordinates)
    }
}

impl RigidBody {
    /// The outline at a time (s) with coordinates of the body; `None` for a body that does not deform.
    ///
    /// # Errors
    /// [`ShapeError`] where they give the body no shape.
    pub fn deformed_at(
        &self,
        time: f64,
        coordinates: &[f64],
    ) -> Result<Option<DeformedOutline>, ShapeError> {
        let shape = self.shape.as_ref();
        let deformed = shape.map(|motion| motion.with_coordinates(time, coordinates)).transpose();
        deformed.map_err(|reason| ShapeError { body: self.name.clone(), reason })
    }

    /// Mass and inertia tensor with the outline at a time (s); none of a body with coordinates, which have its mass.
    ///
    /// # Errors
    /// [`ShapeError`] where a gait gives the body no shape.
    pub fn inertia_at(&self, time: f64) -> Result<Inertia, ShapeError> {
        if self.inertia.is_zero() || self.flexible().is_some() {
            return Ok(self.inertia);
        }
        Ok(self.inertia_with(self.deformed_at(time, &[])?.as_ref()))
    }
}

impl BodyShapes {
    /// The shapes at a time (s), those of bodies with coordinates as they are at time zero.
    ///
    /// # Errors
    /// [`ShapeError`] where a gait gives its body no shape.
    pub fn at(bodies: &[RigidBody], time: f64) -> Result<Self, ShapeError> {
        Self::with(bodies, time, &initial_coordinates(bodies))
    }

    /// The shapes at a time (s) with coordinates of all bodies.
    ///
    /// # Errors
    /// [`ShapeError`] where they give a body no shape.
    pub fn with(bodies: &[RigidBody], time: f64, coordinates: &[f64]) -> Result<Self, ShapeError> {
        let shape = |(body, own): (&RigidBody, Range<usize>)| {
            let deformed = body.deformed_at(time, &coordinates[own])?;
            let Some(deformed) = deformed else { return Ok(None) };
            let refuse = |reason| ShapeError { body: body.name.clone(), reason };
            let outline = || deformed.outline(time).map_err(refuse);
            let boundary = match body.pose.orientation {
                Orientation::Planar(_) => ShapeBoundary::Curve(outline()?),
                Orientation::Spatial(_) => {
                    // A body in space crosses itself where its outline in the plane of the midline does, if it has such a plane
                    if !deformed.follows_coordinates() {
                        outline()?;
                    }
                    ShapeBoundary::Surface(
                        deformed.surface().ok_or(GaitError::Shape).map_err(refuse)?,
                    )
                }
            };
            Ok(Some(Arc::new(BodyShape { deformed, boundary })))
        };
        let bodies = bodies.iter().zip(coordinate_ranges(bodies));
        let shapes = bodies.map(shape).collect::<Result<_, _>>()?;
        Ok(Self { time, coordinates: coordinates.to_vec(), shapes })
    }

    /// At time zero, as if no body deformed.
    #[must_use]
    pub fn rigid(n_bodies: usize) -> Self {
        Self { time: 0.0, coordinates: Vec::new(), shapes: vec![None; n_bodies] }
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
        let own = coordinate_ranges(bodies).into_iter();
        type Shaped<'a> = (&'a RigidBody, &'a Option<Arc<BodyShape>>);
        let surface = |((body, shape), (pose, own)): (Shaped<'a>, (&Pose, Range<usize>))| {
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
                shape: shape.as_deref().map(place),
                is_flexible: body.flexible().is_some(),
                first: own.start,
                pose: *pose,
                time: self.time,
            }
        };
        bodies.iter().zip(&self.shapes).zip(poses.iter().zip(own)).map(surface).collect()
    }
}
