//! Edge lengths wanted on a surface, and rough distances, which are enough for sizes.

use super::triangulated::{Bend as TriangleBend, BentFoot};
use super::{Form, SAMPLES, SmoothSurface};
use crate::Point;

/// Edges are at most as many radii long of the largest ball inside that touches the surface there: with
/// longer ones the lattice has edges that go through a thin body.
const EDGES_OF_RADIUS_INSIDE: f64 = 1.5;

/// Places on triangles that are looked at.
const TRIANGLES: usize = 10_000;

/// A place at which a surface bends, with the edge length wanted there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bend {
    /// Where (m).
    pub at: Point<3>,
    /// Edge length (m).
    pub size: f64,
}

/// How far a point is from a surface, and the edge length wanted where that is nearest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SizedGap {
    /// Signed distance (m), positive in the fluid.
    pub gap: f64,
    /// Edge length (m).
    pub size: f64,
}

impl SmoothSurface {
    /// Edge length wanted on the surface (m) at one of its points.
    #[must_use]
    pub fn size_at(&self, on: Point<3>) -> f64 {
        if let Form::Slender(slender) = &self.form {
            let parts = [self.turn, EDGES_OF_RADIUS_INSIDE];
            return self.size.min(slender.smaller_radius(self.to_local(on), parts));
        }
        if let Form::Sheet(sheet) = &self.form {
            return self.size.min(sheet.nearest(on).size);
        }
        if let Form::Triangulated(triangles) = &self.form {
            return self.size_by(triangles.bent_foot(self.to_local(on)).bend);
        }
        let size = self.size.min(self.turn * self.radius_of_curvature(on));
        size.min(EDGES_OF_RADIUS_INSIDE * self.radius_inside(on))
    }

    /// Edge length wanted on a triangle (m).
    fn size_by(&self, bend: TriangleBend) -> f64 {
        self.size.min(self.turn * bend.radius).min(EDGES_OF_RADIUS_INSIDE * bend.inside)
    }

    /// Edge length wanted on it where that is the same everywhere (m).
    #[must_use]
    pub fn uniform_size(&self) -> Option<f64> {
        match &self.form {
            Form::Ellipsoid(_)
            | Form::Revolved(_)
            | Form::Slender(_)
            | Form::Triangulated(_)
            | Form::Sheet(_) => None,
            _ => Some(self.size_at(self.origin)),
        }
    }

    /// About the signed distance of a point (m), and the edge length wanted where the surface is nearest.
    #[must_use]
    pub fn sized_gap(&self, point: Point<3>) -> SizedGap {
        if let Form::Slender(slender) = &self.form {
            let parts = [self.turn, EDGES_OF_RADIUS_INSIDE];
            let rough = slender.rough_sized_gap(self.to_local(point), parts);
            let gap = if self.is_hollow { -rough.gap } else { rough.gap };
            return SizedGap { gap, size: self.size.min(rough.size) };
        }
        if let Form::Triangulated(triangles) = &self.form {
            let BentFoot { foot, bend } = triangles.bent_foot(self.to_local(point));
            let gap = if self.is_hollow { -foot.gap } else { foot.gap };
            return SizedGap { gap, size: self.size_by(bend) };
        }
        if let Form::Sheet(sheet) = &self.form {
            let near = sheet.near(point);
            return SizedGap { gap: near.distance, size: self.size.min(near.triangle.size) };
        }
        if let Some(size) = self.uniform_size() {
            return SizedGap { gap: self.gap(point), size };
        }
        let foot = self.foot(point);
        SizedGap { gap: foot.gap, size: self.size_at(foot.point) }
    }

    /// About the signed distance of a point (m).
    #[must_use]
    pub fn rough_gap(&self, point: Point<3>) -> f64 {
        match &self.form {
            Form::Slender(slender) if !self.is_hollow => slender.rough_gap(self.to_local(point)),
            _ => self.gap(point),
        }
    }

    /// Whether a point (m) may be nearer than some distance (m), or inside the solid: at little cost.
    #[must_use]
    pub fn may_be_within(&self, point: Point<3>, distance: f64) -> bool {
        match &self.form {
            Form::Slender(slender) if !self.is_hollow => {
                slender.may_be_within(self.to_local(point), distance)
            }
            _ => self.least_gap(point) <= distance,
        }
    }

    /// Distance of a point (m) near the surface over the smallest radius of curvature there.
    #[must_use]
    pub fn relative_distance(&self, near: Point<3>) -> f64 {
        if let Form::Slender(slender) = &self.form {
            return slender.relative_distance(self.to_local(near));
        }
        if let Form::Triangulated(triangles) = &self.form {
            let BentFoot { foot, bend } = triangles.bent_foot(self.to_local(near));
            return foot.gap.abs() / bend.radius;
        }
        let foot = self.foot(near);
        foot.gap.abs() / self.radius_of_curvature(foot.point)
    }

    /// Finds the places where it bends so much that the edge length grows faster from them than by
    /// this per unit length.
    pub fn find_bends(&mut self, growth: f64) {
        if self.uniform_size().is_some() {
            return;
        }
        let axes = (0..3).flat_map(|axis| {
            let axis: Point<3> = self.rotation.column(axis).into();
            [axis, -axis]
        });
        let far = 2.0 * self.reach();
        let n = if matches!(self.form, Form::Triangulated(_)) { TRIANGLES } else { SAMPLES };
        let mut all: Vec<Bend> = if let Form::Sheet(sheet) = &self.form {
            sheet.triangles().map(|(at, own)| Bend { at, size: own.size }).collect()
        } else {
            let on = axes.map(|to| self.foot(self.origin + to * far).point).chain(self.places(n));
            on.map(|at| Bend { at, size: self.size_at(at) }).collect()
        };
        all.retain(|bend| bend.size < self.size);
        all.sort_by(|a, b| a.size.total_cmp(&b.size));
        let mut bends: Vec<Bend> = Vec::new();
        for bend in all {
            let reaches = |known: &Bend| known.size + growth * (known.at - bend.at).norm();
            if bends.iter().all(|known| reaches(known) > bend.size) {
                bends.push(bend);
            }
        }
        self.bends = bends;
    }
}
