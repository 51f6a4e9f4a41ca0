//! `side`: a body that a given mesh leaves out, by the name of the side around it.

use std::sync::Arc;

use alewife_mesh::spatial::Triangulated;
use alewife_mesh::{Hole, Moments, Point};
use serde::{Deserialize, Serialize};

/// `side`: the hole of a given mesh inside the side of this name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(transparent)]
pub struct HoleShape {
    /// Name of the side.
    pub side: String,
    /// What the mesh leaves out.
    #[serde(skip)]
    #[cfg_attr(test, schemars(skip))]
    pub(crate) hole: Option<Box<HoleInFrame>>,
}

/// A hole, seen from its centroid.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum HoleInFrame {
    /// In the plane.
    Planar {
        /// Nodes around it, counter-clockwise (m).
        points: Vec<[f64; 2]>,
        /// Of what is inside, about the origin.
        moments: Moments,
    },
    /// In space.
    Spatial(Arc<Triangulated>),
}

impl HoleInFrame {
    /// A hole of a mesh in the plane.
    pub fn planar(hole: &Hole) -> Self {
        let center = hole.moments.centroid;
        let points = hole.outline.iter().map(|point| (point - center).into()).collect();
        let centroid = Point::<2>::zeros();
        Self::Planar { points, moments: Moments { centroid, ..hole.moments } }
    }
}

impl HoleShape {
    /// Nodes around it in the frame of the body, counter-clockwise (m); none in space, or before the mesh is read.
    #[must_use]
    pub fn points(&self) -> &[[f64; 2]] {
        match self.hole.as_deref() {
            Some(HoleInFrame::Planar { points, .. }) => points,
            _ => &[],
        }
    }

    /// Area, centroid and second moment in the plane, along its curved edges; `None` in space, or before the mesh is
    /// read.
    #[must_use]
    pub fn moments(&self) -> Option<Moments> {
        match self.hole.as_deref() {
            Some(HoleInFrame::Planar { moments, .. }) => Some(*moments),
            _ => None,
        }
    }

    /// The solid it is in space; `None` in the plane, or before the mesh is read.
    #[must_use]
    pub fn solid(&self) -> Option<&Arc<Triangulated>> {
        match self.hole.as_deref() {
            Some(HoleInFrame::Spatial(solid)) => Some(solid),
            _ => None,
        }
    }
}
