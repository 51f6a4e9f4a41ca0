//! Slip along the surface of a body of any smooth shape, by expressions of the place in its frame and of time.

use alewife_mesh::spatial::BodySurface;
use alewife_mesh::{Outline, Surface};
use nalgebra::Vector3;

use super::Gait;
use crate::case::ParsedFormula;

/// The surface along which a body slips, in the frame of the body.
#[derive(Debug)]
pub enum SlipSurface {
    /// In the plane or the meridian plane.
    Curve(Outline),
    /// In space.
    Surface(BodySurface),
}

/// The part along the surface of a velocity: u - (u . n) n, n being the normal of the exact surface.
#[derive(Debug)]
pub struct Slip {
    /// The components of the velocity (m/s); those that are not given are zero.
    pub velocity: Vec<ParsedFormula>,
    /// Along what it slips.
    pub surface: SlipSurface,
}

impl SlipSurface {
    /// Unit normal at a point of the surface (m).
    fn normal(&self, point: &Vector3<f64>) -> Vector3<f64> {
        match self {
            Self::Curve(outline) => {
                let normal = outline.nearest(point.xy()).normal;
                Vector3::new(normal.x, normal.y, 0.0)
            }
            Self::Surface(surface) => surface.nearest_point(*point).normal,
        }
    }
}

impl Gait for Slip {
    fn velocity(&self, point: &Vector3<f64>, time: f64) -> Vector3<f64> {
        let at = [point.x, point.y, point.z, time];
        let given = Vector3::from_fn(|axis, _| self.velocity.get(axis).map_or(0.0, |v| v.at(&at)));
        let normal = self.surface.normal(point);
        given - normal * given.dot(&normal)
    }
}
