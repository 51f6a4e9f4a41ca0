//! `MeshPoses`: poses of bodies where a mesh has them, told apart from those in the laboratory.

use std::ops::Deref;

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::pose::Pose;

/// Poses of the bodies around which a mesh lies, seen from where its nodes are seen. They differ from those in the
/// laboratory by whole periods, where a mesh has an image of a body, and by the way of a frame that goes with bodies.
///
/// What is bound to a mesh, constraints, loads and the motion of nodes, asks for these; what moves bodies, for those in the
/// laboratory.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MeshPoses(Vec<Pose>);

impl MeshPoses {
    /// Poses in the laboratory, `image_shifts` (m) added to their centres, seen from a frame at `origin` (m).
    #[must_use]
    pub fn seen_from(
        origin: &Vector3<f64>,
        laboratory: &[Pose],
        image_shifts: &[Vector3<f64>],
    ) -> Self {
        let pairs = laboratory.iter().zip(image_shifts);
        let seen = |(pose, shift): (&Pose, &Vector3<f64>)| Pose {
            center: pose.center + shift - origin,
            ..*pose
        };
        Self(pairs.map(seen).collect())
    }

    /// Of bodies of which a mesh, seen from the laboratory, has no images.
    #[must_use]
    pub fn of(laboratory: impl IntoIterator<Item = Pose>) -> Self {
        Self(laboratory.into_iter().collect())
    }

    /// All of them.
    #[must_use]
    pub fn into_vec(self) -> Vec<Pose> {
        self.0
    }
}

impl Deref for MeshPoses {
    type Target = [Pose];

    fn deref(&self) -> &[Pose] {
        &self.0
    }
}
