//! `Sheet`: a smooth part of a surface of triangles, continued beyond its rim by its tangent planes.
//!
//! Where two sheets meet in a sharp edge both are cut through the mesh, so that the edge becomes one of it.

use super::facets::Continued;
use super::patch::Patch;
use super::{Facets, Foot};
use crate::{BoundaryId, Point};

/// What is wanted on a triangle of a sheet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SheetTriangle {
    /// The side of the region it belongs to.
    pub side: BoundaryId,
    /// Smallest radius of curvature (m).
    pub radius: f64,
    /// Edge length (m).
    pub size: f64,
}

/// The triangle that is nearest to a point.
#[derive(Debug, Clone, Copy)]
pub struct NearTriangle {
    /// What is wanted on it.
    pub triangle: SheetTriangle,
    /// Distance to it (m).
    pub distance: f64,
}

/// Triangles that turn by small angles only where they meet.
#[derive(Debug, Clone)]
pub struct Sheet {
    facets: Facets,
    triangles: Vec<SheetTriangle>,
    middles: Vec<Point<3>>,
    /// A point and the unit normal into the fluid of a flat one.
    plane: Option<[Point<3>; 2]>,
}

impl PartialEq for Sheet {
    fn eq(&self, other: &Self) -> bool {
        self.facets == other.facets
    }
}

impl Sheet {
    /// Triangles with what is wanted on each, and a point and the normal of a plane they are all in.
    pub(crate) fn new(
        patches: Vec<Patch>,
        triangles: Vec<SheetTriangle>,
        plane: Option<[Point<3>; 2]>,
    ) -> Self {
        let middle = |patch: &Patch| patch.points().take(3).sum::<Point<3>>() / 3.0;
        let middles = patches.iter().map(middle).collect();
        Self { facets: Facets::new(patches), triangles, middles, plane }
    }

    /// Whether it is part of a plane.
    #[must_use]
    pub fn is_flat(&self) -> bool {
        self.plane.is_some()
    }

    /// The nearest point of the continued sheet to another one (m).
    #[must_use]
    pub fn foot(&self, point: Point<3>) -> Foot {
        if let Some([on, normal]) = self.plane {
            let gap = normal.dot(&(point - on));
            return Foot { point: point - normal * gap, normal, gap };
        }
        match self.facets.continued(point, f64::INFINITY) {
            Some(Continued { foot, .. }) => foot,
            None => self.facets.foot(point),
        }
    }

    /// Gap of a point to the continued sheet (m) where the sheet itself is within a distance (m).
    #[must_use]
    pub fn gap_within(&self, point: Point<3>, within: f64) -> Option<f64> {
        let near = self.facets.continued(point, within).filter(|near| near.distance <= within)?;
        let on_plane = self.plane.map(|[on, normal]| normal.dot(&(point - on)));
        Some(on_plane.unwrap_or(near.foot.gap))
    }

    /// What is nearest to a point (m) of the sheet as far as it reaches.
    #[must_use]
    pub fn near(&self, point: Point<3>) -> NearTriangle {
        let near = self.facets.continued(point, f64::INFINITY);
        let (nth, distance) =
            near.map_or((0, f64::INFINITY), |near| (near.triangle, near.distance));
        NearTriangle { triangle: self.triangles[nth], distance }
    }

    /// What is wanted where it is nearest to a point (m).
    #[must_use]
    pub fn nearest(&self, point: Point<3>) -> SheetTriangle {
        self.near(point).triangle
    }

    /// Middles of its triangles (m) and what is wanted there.
    pub fn triangles(&self) -> impl Iterator<Item = (Point<3>, SheetTriangle)> + '_ {
        self.middles.iter().copied().zip(self.triangles.iter().copied())
    }
}
