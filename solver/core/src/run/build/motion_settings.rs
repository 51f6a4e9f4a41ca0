//! How the mesh of a case moves.

use crate::case::{Body, MeshEquation, Model};
use crate::coupling::Problem;
use crate::motion::{MotionKind, MotionSettings, Stiffening};

/// How the mesh of a case moves with the bodies of its problem.
#[must_use]
pub fn motion_settings<const D: usize>(model: &Model, problem: &Problem<D>) -> MotionSettings {
    let deforms_in_space = D == 3 && problem.bodies.iter().any(|body| body.shape.is_some());
    let kind = match model.case.mesh.moving.equation {
        MeshEquation::Elastic if deforms_in_space => MotionKind::around_deforming_bodies(),
        MeshEquation::Elastic => MotionKind::default(),
        MeshEquation::Harmonic => MotionKind::Harmonic(Stiffening::MasudHughes),
    };
    // The gap between a body and a rod at it is sheared if the mesh does not turn with both
    let holds_rod = |body: &Body| {
        let mut attached = model.bodies.iter().filter_map(|rod| rod.attached.as_ref());
        attached.any(|held| held.to.as_ref() == Some(&body.name))
    };
    let turns =
        |body: &Body| !problem.metric.is_revolved() && (!body.is_round() || holds_rod(body));
    MotionSettings { kind, turns: model.bodies.iter().map(turns).collect() }
}
