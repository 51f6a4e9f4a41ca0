//! `Shape`: disc, sphere, ellipse, spheroid, closed spline; boundary curve and mass moments.

use crate::Point;

/// The outline of a body in its own frame, centred on the origin before placement.
///
/// In an axisymmetric domain the shapes are `Sphere` and `Spheroid`; their meridian (y >= 0) is
/// meshed. In a planar domain they are `Disc`, `Ellipse` and `Spline`.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// Disc of the given radius (planar).
    Disc {
        /// Radius (m).
        radius: f64,
    },
    /// Ellipse with semi-axes along the body's x and y (planar).
    Ellipse {
        /// Semi-axes (m).
        semi_axes: [f64; 2],
    },
    /// Closed smooth spline through points listed counter-clockwise (planar).
    Spline {
        /// Points in the body frame (m), not repeated at the end.
        points: Vec<[f64; 2]>,
    },
    /// Sphere of the given radius, centred on the axis (axisymmetric) or anywhere (3D).
    Sphere {
        /// Radius (m).
        radius: f64,
    },
    /// Ellipsoid of revolution: semi-axis along the axis of revolution, and across it.
    Spheroid {
        /// Semi-axes (m): along the axis of revolution, across it.
        semi_axes: [f64; 2],
    },
}

/// A shape put in its place in the domain.
#[derive(Debug, Clone, PartialEq)]
pub struct PlacedShape {
    /// Name of the body; the boundary it makes carries it.
    pub name: String,
    /// Outline.
    pub shape: Shape,
    /// Position of the shape's origin (m).
    pub center: Point<2>,
    /// Rotation of the body frame, counter-clockwise (rad).
    pub angle: f64,
    /// Wanted cell size on the surface (m); `None` takes [`crate::Sizing::surface`].
    pub size: Option<f64>,
}
