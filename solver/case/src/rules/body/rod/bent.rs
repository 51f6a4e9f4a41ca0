//! `BentByLoad`: how sharply the loads at its ends bend a rod.

use std::f64::consts::PI;

use crate::{AlongBody, Body, Geometry, Hold, LoadedEnd, RodEnd, Stroke};

/// How sharply a load at an end bends a rod.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BentByLoad {
    /// Where the load is given.
    pub end: RodEnd,
    /// `force` or `moment`.
    pub by: &'static str,
    /// The largest curvature (1/m).
    pub curvature: f64,
    /// Half of the largest thickness of the body (m).
    pub half_width: f64,
}

/// Half width over the radius of curvature above which a rod is no slender one.
const BENT: f64 = 0.5;

impl BentByLoad {
    /// Whether a rod that is bent so is none any more.
    #[must_use]
    pub fn is_too_sharp(&self) -> bool {
        self.curvature * self.half_width > BENT
    }
}

/// How sharply a rod is bent by the loads that are given at its ends, where they are as large as they get: by a moment
/// at that end, by a force at the tip at a head that is clamped. There the curvature k of an elastica of stiffness B
/// that a force F bends is F L / B at most, and B k^2 / 2 = F (1 - cos) is F at most for a force across it.
#[must_use]
pub fn bent_by_loads(geometry: Geometry, body: &Body) -> Vec<BentByLoad> {
    let (Some(rod), Some(profile)) = (&body.rod, body.shape.profile()) else {
        return Vec::new();
    };
    let half_width = profile.stations().iter().map(|at| at.half_width).fold(0.0, f64::max);
    let stiffness = match (&rod.bending, rod.young) {
        (Some(AlongBody::Constant(value)), _) => *value,
        (Some(AlongBody::Table(rows)), _) => rows.iter().map(|row| row[1]).fold(0.0, f64::max),
        (None, young) => {
            // Of a strip of unit width, and of a round section
            let second_moment = match geometry {
                Geometry::Spatial => PI / 4.0 * half_width.powi(4),
                Geometry::Planar | Geometry::Axisymmetric => 2.0 / 3.0 * half_width.powi(3),
            };
            young.unwrap_or_default() * second_moment
        }
    };
    let largest = |stroke: &Stroke| stroke.range().map(f64::abs).into_iter().fold(0.0, f64::max);
    let is_clamped = body.attached.as_ref().is_some_and(|attached| attached.hold != Hold::Hinged);
    let mut all = Vec::new();
    for LoadedEnd { end, load } in body.end_loads() {
        let mut bent = |by, curvature: f64| {
            all.push(BentByLoad { end, by, curvature, half_width });
        };
        if let Some(moment) = &load.moment {
            // In space one about the end twists it: which one that is depends on how it is bent
            let moment = moment.components().iter().map(largest).fold(0.0, f64::hypot);
            bent("moment", moment / stiffness);
        }
        if is_clamped && end == RodEnd::Tip && !load.force.is_empty() {
            let force = load.force.iter().map(largest).fold(0.0, f64::hypot);
            let across = (2.0 * force / stiffness).sqrt();
            bent("force", across.min(force * profile.length() / stiffness));
        }
    }
    all.retain(|bent| bent.curvature.is_finite());
    all
}
