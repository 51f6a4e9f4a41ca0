//! `Carried`: the points of an outline or of a surface, carried by the coordinates of a flexible body.

use std::sync::Arc;

use alewife_mesh::Spline;
use alewife_mesh::spatial::{SectionPoint, Sections};
use nalgebra::{DVector, Vector3};

use crate::structure::{Flexible, SectionMotion, Weight};

/// The points of what bounds a body at rest, carried by coordinates.
#[derive(Debug, Clone)]
pub(in crate::gait) struct Carried<R> {
    rest: Arc<R>,
    body: Arc<dyn Flexible>,
    coordinates: DVector<f64>,
    /// Where the body is, seen from where it started (m).
    center: Vector3<f64>,
}

impl<R> PartialEq for Carried<R> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.body, &other.body) && self.coordinates == other.coordinates
    }
}

impl<R> Carried<R> {
    /// What bounds a body at rest with these coordinates.
    pub(super) fn new(rest: &Arc<R>, body: &Arc<dyn Flexible>, coordinates: DVector<f64>) -> Self {
        let center = body.way_of_center(&coordinates);
        Self { rest: Arc::clone(rest), body: Arc::clone(body), coordinates, center }
    }

    /// Where the point at a place at rest (m) is, seen from the centre.
    pub(in crate::gait) fn place(&self, rest: &Vector3<f64>) -> Vector3<f64> {
        self.body.place(&self.coordinates, rest) - self.center
    }

    /// How the section moves that the point at a place at rest (m) is on, seen from the centre.
    pub(in crate::gait) fn section(&self, rest: &Vector3<f64>) -> Option<SectionMotion> {
        let section = self.body.section(&self.coordinates, rest)?;
        Some(SectionMotion { place: section.place - self.center, ..section })
    }

    /// The velocity there by those of the body.
    pub(in crate::gait) fn weights(&self, rest: &Vector3<f64>) -> Vec<Weight> {
        self.body.weights(&self.coordinates, rest)
    }
}

impl Carried<Spline> {
    /// The parameter after which the outline is where it began.
    pub(in crate::gait) fn period(&self) -> f64 {
        self.rest.knots().last().copied().unwrap_or_default()
    }

    /// Where a point of the outline is at rest (m), by the parameter of the outline.
    pub(in crate::gait) fn rest_place(&self, parameter: f64) -> Vector3<f64> {
        let at = self.rest.evaluate(parameter)[0];
        Vector3::new(at.x, at.y, 0.0)
    }
}

impl Carried<Sections> {
    /// The parameter of the end of the tail.
    pub(in crate::gait) fn end(&self) -> f64 {
        self.rest.end()
    }

    /// Where a point of the surface is at rest (m).
    pub(in crate::gait) fn rest_place(&self, at: SectionPoint) -> Vector3<f64> {
        self.rest.point(at)
    }
}
