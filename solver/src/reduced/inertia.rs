//! `Solid`: mass, centre and moments of a body, and the ellipse or ellipsoid its loads are those of.

use alewife_mesh::SecondMoments;
use nalgebra::Vector3;

use super::ReducedError;
use crate::case::{Body, Geometry, Link, ShapeSpec, ShapedLink};

/// What a tree needs of a body, a density.
#[derive(Debug, Clone, Copy)]
pub(super) struct Solid {
    /// Volume (m3), in the plane area (m2).
    pub volume: f64,
    /// Moments of inertia about the centre, a density (m5; m4 planar, about z).
    pub moments: Vector3<f64>,
    /// Centre of volume in the body frame (m).
    pub center: Vector3<f64>,
    /// Middle of the extent along x, from the centre (m).
    pub middle: Vector3<f64>,
    /// Semi-axes (m); in the plane half length and half width.
    pub semi_axes: Vector3<f64>,
}

impl Solid {
    pub fn of(body: &Body, geometry: Geometry) -> Result<Self, ReducedError> {
        let shape = &body.shape;
        if geometry == Geometry::Planar {
            return planar(shape).ok_or_else(|| unknown(body));
        }
        let axes = match shape {
            ShapeSpec::Sphere { radius } => [*radius; 3],
            ShapeSpec::Spheroid { semi_axes: [along, across] } => [*along, *across, *across],
            ShapeSpec::Ellipsoid { semi_axes } => *semi_axes,
            _ => return Err(unknown(body)),
        };
        let axes = Vector3::from(axes);
        let volume = 4.0 / 3.0 * std::f64::consts::PI * axes.product();
        let square = axes.component_mul(&axes);
        let moments = Vector3::repeat(square.sum()) - square;
        Ok(Self {
            volume,
            moments: moments * (0.2 * volume),
            center: Vector3::zeros(),
            middle: Vector3::zeros(),
            semi_axes: axes,
        })
    }
}

fn unknown(body: &Body) -> ReducedError {
    ReducedError::Unknown(format!("the shape of \"{}\"", body.name))
}

fn planar(shape: &ShapeSpec) -> Option<Solid> {
    let moments = shape.outline().moments()?;
    let SecondMoments::Planar { polar } = moments.second else { return None };
    let (density, magnetic_moment) = (None, Vec::new());
    let link = Link::Shaped(ShapedLink { shape: shape.clone(), density, magnetic_moment });
    let extent = link.extent().ok()?;
    let center = Vector3::new(moments.centroid.x, moments.centroid.y, 0.0);
    let middle = Vector3::new(0.5 * (extent.front + extent.back) - center.x, 0.0, 0.0);
    let half = 0.5 * (extent.front - extent.back);
    Some(Solid {
        volume: moments.measure,
        moments: Vector3::new(0.0, 0.0, polar),
        center,
        middle,
        semi_axes: Vector3::new(half, extent.half_width, extent.half_width),
    })
}
