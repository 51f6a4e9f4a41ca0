//! What of outlines and surfaces follows the coordinates of their bodies.

use alewife_mesh::Spline;
use nalgebra::Vector3;

use super::deformed_outline::{DeformedOutline, MaterialCurve, MaterialPoint};
use super::flexible::Carried;
use crate::structure::{SectionMotion, Weight};

impl DeformedOutline {
    /// Where a point of an outline that follows coordinates is at rest (m), by its parameter; `None` of another outline.
    #[must_use]
    pub fn rest_place(&self, parameter: f64) -> Option<Vector3<f64>> {
        Some(self.carried_outline()?.rest_place(parameter))
    }

    /// Where a point of a surface in space that follows coordinates is at rest (m); `None` of another surface.
    #[must_use]
    pub fn rest_place_in_space(&self, at: MaterialPoint) -> Option<Vector3<f64>> {
        match &self.curve {
            MaterialCurve::CarriedSections { carried, .. } => Some(carried.rest_place(at.into())),
            _ => None,
        }
    }

    /// The velocity of the point at a place at rest (m) by those of the coordinates, in the frame of the body; none
    /// of what follows no coordinates.
    #[must_use]
    pub fn weights(&self, rest: &Vector3<f64>) -> Vec<Weight> {
        match &self.curve {
            MaterialCurve::Carried { carried, .. } => carried.weights(rest),
            MaterialCurve::CarriedSections { carried, .. } => carried.weights(rest),
            _ => Vec::new(),
        }
    }

    /// Whether it follows coordinates.
    #[must_use]
    pub fn follows_coordinates(&self) -> bool {
        matches!(self.curve, MaterialCurve::Carried { .. } | MaterialCurve::CarriedSections { .. })
    }

    /// After which the parameter of an outline that follows coordinates is where it began; `None` of another outline.
    #[must_use]
    pub fn period(&self) -> Option<f64> {
        Some(self.carried_outline()?.period())
    }

    /// The parameter along a surface in space that follows coordinates at the end of its tail; `None` of another one.
    #[must_use]
    pub fn end_along(&self) -> Option<f64> {
        match &self.curve {
            MaterialCurve::CarriedSections { carried, .. } => Some(carried.end()),
            _ => None,
        }
    }

    /// How the section moves that a point of an outline that follows coordinates is on, by the parameter of the point; its
    /// place is in the frame of the body. `None` of another outline.
    #[must_use]
    pub fn section(&self, parameter: f64) -> Option<SectionMotion> {
        let carried = self.carried_outline()?;
        carried.section(&carried.rest_place(parameter))
    }

    fn carried_outline(&self) -> Option<&Carried<Spline>> {
        match &self.curve {
            MaterialCurve::Carried { carried, .. } => Some(carried),
            _ => None,
        }
    }
}
