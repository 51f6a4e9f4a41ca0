//! `FlexibleShape`: an outline that follows the coordinates of a flexible body.

use std::sync::Arc;

use alewife_mesh::{Moments, Point, Shape, Spline};
use nalgebra::{DVector, Vector3};

use super::deformed_outline::{DeformedOutline, MaterialCurve, RecoilCorrection, ShapeMotion};
use super::error::GaitError;
use super::recoil::RecoilMotion;
use crate::structure::{Flexible, Weight};

/// An outline at rest, and what moves its points.
#[derive(Debug)]
pub struct FlexibleShape {
    rest: Arc<Spline>,
    body: Arc<dyn Flexible>,
}

/// The points of an outline at rest, carried by coordinates.
#[derive(Debug, Clone)]
pub(super) struct CarriedOutline {
    rest: Arc<Spline>,
    body: Arc<dyn Flexible>,
    coordinates: DVector<f64>,
    /// Where the body is, seen from where it started (m).
    center: Vector3<f64>,
}

impl PartialEq for CarriedOutline {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.body, &other.body) && self.coordinates == other.coordinates
    }
}

impl CarriedOutline {
    /// Where a point of the outline is at rest (m), by the parameter of the outline.
    pub(super) fn rest_place(&self, parameter: f64) -> Vector3<f64> {
        let at = self.rest.evaluate(parameter)[0];
        Vector3::new(at.x, at.y, 0.0)
    }

    /// Where the point at a place at rest (m) is, seen from the centre.
    pub(super) fn place(&self, rest: &Vector3<f64>) -> Vector3<f64> {
        self.body.place(&self.coordinates, rest) - self.center
    }

    /// The velocity there by those of the body.
    pub(super) fn weights(&self, rest: &Vector3<f64>) -> Vec<Weight> {
        self.body.weights(&self.coordinates, rest)
    }
}

impl FlexibleShape {
    /// A body with an outline at rest.
    #[must_use]
    pub fn new(rest: Spline, body: Arc<dyn Flexible>) -> Self {
        Self { rest: Arc::new(rest), body }
    }
}

impl ShapeMotion for FlexibleShape {
    fn at(&self, time: f64) -> Result<DeformedOutline, GaitError> {
        self.with_coordinates(time, self.body.initial().as_slice())
    }

    fn with_coordinates(
        &self,
        time: f64,
        coordinates: &[f64],
    ) -> Result<DeformedOutline, GaitError> {
        let coordinates = DVector::from_column_slice(coordinates);
        let carried = CarriedOutline {
            rest: Arc::clone(&self.rest),
            body: Arc::clone(&self.body),
            center: self.body.way_of_center(&coordinates),
            coordinates,
        };
        let knots = self.rest.knots();
        let place = |knot: &f64| carried.place(&carried.rest_place(*knot)).xy();
        let points: Vec<[f64; 2]> =
            knots[..knots.len() - 1].iter().map(|knot| place(knot).into()).collect();
        let spline = Spline::with_knots(&points, knots).ok_or(GaitError::Midline { time })?;
        let points = Arc::new(spline);
        let moments = Shape::Curve { spline: Arc::clone(&points) }.moments();
        let moments = moments.ok_or(GaitError::Midline { time })?;
        Ok(DeformedOutline {
            curve: MaterialCurve::Carried { points, carried },
            moments: Moments { centroid: Point::<2>::zeros(), ..moments },
            inertia_rate: 0.0,
            recoil: RecoilCorrection::NONE,
        })
    }

    fn discontinuities(&self, _from: f64, _to: f64) -> Vec<f64> {
        Vec::new()
    }

    fn recoil(&self) -> Result<RecoilMotion, GaitError> {
        Ok(RecoilMotion::default())
    }

    fn flexible(&self) -> Option<&Arc<dyn Flexible>> {
        Some(&self.body)
    }
}
