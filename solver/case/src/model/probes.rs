//! Where probes are at the start: those that ride on bodies by the frames of these.

use nalgebra::{Point3, Rotation2, Vector2};

use super::Model;
use crate::{Geometry, Probe};

impl Model {
    /// The body each probe rides on, if it does.
    #[must_use]
    pub fn probe_bodies(&self) -> Vec<Option<usize>> {
        let body = |probe: &Probe| self.body_index(probe.body.as_ref()?);
        self.case.probe.iter().map(body).collect()
    }

    /// The points of each probe at the start (m), one or two.
    #[must_use]
    pub fn probe_points(&self) -> Vec<Vec<Vec<f64>>> {
        let points = |probe: &Probe| {
            let all = [&probe.point, &probe.minus].into_iter().filter(|point| !point.is_empty());
            all.map(|point| self.probe_point(probe, point)).collect()
        };
        self.case.probe.iter().map(points).collect()
    }

    /// A point of a probe at the start (m).
    #[must_use]
    pub fn probe_point(&self, probe: &Probe, point: &[f64]) -> Vec<f64> {
        let Some(body) = probe.body.as_ref().and_then(|name| self.body_index(name)) else {
            return point.to_vec();
        };
        let body = &self.bodies[body];
        if self.case.geometry == Geometry::Spatial {
            let [x, y, z] = [0, 1, 2].map(|axis| point.get(axis).copied().unwrap_or(f64::NAN));
            let at = body.pose_in_space() * Point3::new(x, y, z);
            return at.coords.as_slice().to_vec();
        }
        let own = |values: &[f64], axis: usize| values.get(axis).copied().unwrap_or(f64::NAN);
        let turned = Rotation2::new(body.angle) * Vector2::new(own(point, 0), own(point, 1));
        vec![own(&body.center, 0) + turned.x, own(&body.center, 1) + turned.y]
    }
}
