//! `FlexibleShape`: an outline that follows the coordinates of a flexible body.

use std::sync::Arc;

use alewife_mesh::{Moments, Point, Shape, Spline};
use nalgebra::DVector;

use super::carried::Carried;
use crate::gait::deformed_outline::{
    DeformedOutline, MaterialCurve, RecoilCorrection, ShapeMotion,
};
use crate::gait::error::GaitError;
use crate::gait::recoil::RecoilMotion;
use crate::structure::Flexible;

/// An outline at rest, and what moves its points.
#[derive(Debug)]
pub struct FlexibleShape {
    rest: Arc<Spline>,
    body: Arc<dyn Flexible>,
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
        let carried = Carried::new(&self.rest, &self.body, coordinates);
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
