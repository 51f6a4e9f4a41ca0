//! `FlexibleSurface`: a surface in space that follows the coordinates of a flexible body.

use std::sync::Arc;

use alewife_mesh::spatial::{Sections, Slender, SolidMoments, parts_of};
use alewife_mesh::{Moments, Point, SecondMoments};
use nalgebra::{DVector, Vector3};

use super::carried::Carried;
use crate::gait::deformed_outline::{
    DeformedOutline, MaterialCurve, RecoilCorrection, ShapeMotion,
};
use crate::gait::error::GaitError;
use crate::gait::recoil::RecoilMotion;
use crate::structure::Flexible;

/// Sections at rest, and what moves their points.
///
/// The surface that is meshed goes through the points of the sections at their knots on the sides of their widths and heights, which are
/// carried exactly, and so are the nodes on it.
#[derive(Debug)]
pub struct FlexibleSurface {
    rest: Arc<Sections>,
    /// Parameters from the nose along one side to the tail and back along the other one.
    knots: Vec<f64>,
    /// Points there at rest (m), along the widths and along the heights.
    outlines: [Vec<Vector3<f64>>; 2],
    body: Arc<dyn Flexible>,
}

impl FlexibleSurface {
    /// A body with sections at rest; `None` of fewer than two.
    #[must_use]
    pub fn new(rest: Sections, body: Arc<dyn Flexible>) -> Option<Self> {
        let (own, end) = (rest.knots().to_vec(), rest.end());
        let n = own.len() - 1;
        if n < 2 {
            return None;
        }
        let there_and_back = |i: usize| if i <= n { (i, 1.0) } else { (2 * n - i, -1.0) };
        let knots = (0..=2 * n).map(|i| match there_and_back(i) {
            (knot, 1.0) => own[knot],
            (knot, _) => 2.0 * end - own[knot],
        });
        let outline = |nth: usize| -> Vec<Vector3<f64>> {
            let point = |i: usize| {
                let (knot, side) = there_and_back(i);
                let parts = parts_of(&rest.at(own[knot])[0]);
                parts[0] + parts[1 + nth] * side
            };
            (0..2 * n).map(point).collect()
        };
        let (knots, outlines) = (knots.collect(), [outline(0), outline(1)]);
        Some(Self { rest: Arc::new(rest), knots, outlines, body })
    }
}

impl ShapeMotion for FlexibleSurface {
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
        let outlines = self.outlines.each_ref().map(|outline| -> Vec<Vector3<f64>> {
            outline.iter().map(|rest| carried.place(rest)).collect()
        });
        let [widths, heights] = &outlines;
        let sections = Sections::around([widths, heights], &self.knots);
        let sections = sections.ok_or(GaitError::Midline { time })?;
        let moments = sections.solid_moments();
        let SolidMoments { volume, .. } = moments;
        if !(volume > 0.0 && volume.is_finite()) {
            return Err(GaitError::Midline { time });
        }
        Ok(DeformedOutline {
            curve: MaterialCurve::CarriedSections {
                surface: Arc::new(Slender::new(sections)),
                carried,
            },
            moments: Moments {
                measure: volume,
                centroid: Point::<2>::zeros(),
                second: SecondMoments::Spatial { tensor: moments.tensor() },
            },
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
