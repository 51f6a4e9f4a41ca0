//! `Shape` and `Body`: what bodies in space are made of, and where they are.

use std::sync::Arc;

use nalgebra::Isometry3;

use super::curve::Centreline;
use super::surface::{Slender, Triangulated};

/// A solid in its own frame.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// Sphere about the origin.
    Sphere {
        /// Radius (m).
        radius: f64,
    },
    /// Ellipsoid about the origin.
    Ellipsoid {
        /// Semi-axes along x, y and z (m).
        semi_axes: [f64; 3],
    },
    /// Cylinder about the x axis with half spheres at its ends, its middle at the origin.
    ///
    /// Its curvature jumps where they meet, so curved facets follow it to second order only there.
    Capsule {
        /// Radius (m).
        radius: f64,
        /// Distance between the centres of the half spheres (m).
        length: f64,
    },
    /// Cylinder about the x axis without ends: it goes through two opposite sides of a box, and is
    /// the one part of its body.
    Cylinder {
        /// Radius (m).
        radius: f64,
    },
    /// A profile turned about the x axis: a smooth curve through points.
    Revolved {
        /// Points (x, distance from the axis) (m), the first and the last on the axis.
        profile: Vec<[f64; 2]>,
    },
    /// All points at a distance from a curve; its ends are half spheres.
    Tube {
        /// The curve in its middle.
        centreline: Centreline,
        /// Radius (m).
        radius: f64,
    },
    /// Elliptic sections about a midline in the plane z = 0: a fish, a flagellate, at rest or bent.
    Slender(Arc<Slender>),
    /// A closed surface of triangles.
    Triangulated(Arc<Triangulated>),
}

/// A solid that a body is made of.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// What it is.
    pub shape: Shape,
    /// Its place in the frame of the body (m).
    pub pose: Isometry3<f64>,
}

/// A rigid body in its place: the union of its parts.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Name; the boundary it makes carries it.
    pub name: String,
    /// Parts, at least one; where the surfaces of two meet, the body has a crease.
    pub parts: Vec<Part>,
    /// Its place in the domain (m).
    pub pose: Isometry3<f64>,
    /// Wanted cell size on the surface (m); `None` takes [`crate::Sizing::surface`].
    pub size: Option<f64>,
}

impl Body {
    /// A body of one part in the frame of the body.
    #[must_use]
    pub fn new(name: &str, shape: Shape, pose: Isometry3<f64>) -> Self {
        let parts = vec![Part { shape, pose: Isometry3::identity() }];
        Self { name: name.to_owned(), parts, pose, size: None }
    }
}
