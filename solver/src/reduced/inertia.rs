//! `Solid`: mass, centre and moments of a body, and the ellipse or ellipsoid its loads are those of.

use alewife_mesh::SecondMoments;
use nalgebra::{Matrix3, Vector3};

use super::ReducedError;
use super::build::in_space;
use crate::case::{Body, Geometry, Link, ShapeSpec, ShapedLink};

/// What a tree needs of a body, a density.
#[derive(Debug, Clone, Copy)]
pub(super) struct Solid {
    /// Volume (m3), in the plane area (m2).
    pub volume: f64,
    /// Inertia about the centroid, a density (m5; m4 planar, about z).
    pub inertia: Matrix3<f64>,
    /// Centre of mass in the frame of the body (m).
    pub center: Vector3<f64>,
    /// Centroid in the frame of the body (m).
    pub centroid: Vector3<f64>,
    /// Middle of the extent along x, from the centre of mass (m).
    pub middle: Vector3<f64>,
    /// Semi-axes (m); in the plane half length and half width.
    pub semi_axes: Vector3<f64>,
}

impl Solid {
    pub fn of(body: &Body, geometry: Geometry) -> Result<Self, ReducedError> {
        let mut solid = Self::of_shape(body, geometry)?;
        if !body.center_of_mass.is_empty() {
            let center = in_space(&body.center_of_mass);
            solid.middle -= center - solid.center;
            solid.center = center;
        }
        Ok(solid)
    }

    /// Centred at the centroid.
    fn of_shape(body: &Body, geometry: Geometry) -> Result<Self, ReducedError> {
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
            inertia: Matrix3::from_diagonal(&(moments * (0.2 * volume))),
            center: Vector3::zeros(),
            centroid: Vector3::zeros(),
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
        inertia: Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, polar)),
        center,
        centroid: center,
        middle,
        semi_axes: Vector3::new(half, extent.half_width, extent.half_width),
    })
}
