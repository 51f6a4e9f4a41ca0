//! Problems of `[time]`, and motions that would need a moving mesh.

use super::Findings;
use crate::case::{Body, Geometry, Lock, Model, Motion, ShapeSpec, TimeSettings};

/// Distance of end / step from a whole number above which the last step is not a whole one.
const WHOLE_STEPS: f64 = 1e-6;

pub fn check(findings: &mut Findings<'_>) {
    let case = findings.case();
    match &case.time {
        TimeSettings::Steady(steady) => {
            if case.fluid.model == Model::UnsteadyStokes {
                findings.error(
                    "time.steady",
                    "the model `unsteady-stokes` has no steady solution of its own".to_owned(),
                    "march with [time.unsteady], or write model = \"stokes\", to which it settles",
                );
            }
            findings.positive("time.steady.tolerance", steady.tolerance);
            if steady.tolerance >= 1.0 {
                findings.error(
                    "time.steady.tolerance",
                    format!("a residual {} times the first one is no solution", steady.tolerance),
                    "write a number below 1, such as 1e-11",
                );
            }
            if steady.max_iterations == 0 {
                findings.error(
                    "time.steady.max_iterations",
                    "no iterations are allowed".to_owned(),
                    "write 1 or more; 25 is usual",
                );
            }
            if case.fluid.model == Model::NavierStokes {
                steady_frame(findings);
            }
        }
        TimeSettings::Unsteady(unsteady) => {
            findings.positive("time.unsteady.step", unsteady.step);
            findings.positive("time.unsteady.end", unsteady.end);
            let steps = unsteady.end / unsteady.step;
            if steps > 0.0 && steps < 1.0 {
                findings.error(
                    "time.unsteady.step",
                    format!("the step {} is longer than the run, {}", unsteady.step, unsteady.end),
                    "lower the step, or raise time.unsteady.end",
                );
            } else if steps.is_finite() && (steps - steps.round()).abs() > WHOLE_STEPS * steps {
                findings.warning(
                    "time.unsteady.step",
                    format!("the step does not divide the end: {steps:.4} steps"),
                    &format!("write step = {}", unsteady.end / steps.ceil()),
                );
            }
            for (index, body) in case.body.iter().enumerate() {
                check_mesh_stays(findings, index, body);
            }
        }
    }
}

/// Whether a body may change its place.
fn translates(body: &Body) -> bool {
    match &body.motion {
        Motion::Held => false,
        Motion::Free => ![Lock::X, Lock::Y].iter().all(|lock| body.locked.contains(lock)),
        Motion::Imposed(imposed) => imposed.velocity.iter().any(|part| *part != 0.0),
    }
}

/// Whether a body may turn, and would look different then.
fn turns_visibly(body: &Body, geometry: Geometry) -> bool {
    let turns = match &body.motion {
        Motion::Held => false,
        Motion::Free => !body.locked.contains(&Lock::Rotation),
        Motion::Imposed(imposed) => imposed.angular_velocity != 0.0,
    };
    turns && geometry == Geometry::Planar && !matches!(body.shape, ShapeSpec::Disc { .. })
}

/// The mesh is made once: until it can follow the bodies, the frame of reference has to.
fn check_mesh_stays(findings: &mut Findings<'_>, index: usize, body: &Body) {
    let case = findings.case();
    let (key, name) = (format!("body.{index}.motion"), &body.name);
    let is_frame = case.frame.as_deref() == Some(name.as_str());
    if translates(body) && !is_frame {
        findings.error(
            &key,
            format!(
                "body \"{name}\" moves through the mesh: moving meshes are not there yet for \
                 unsteady runs"
            ),
            &format!("let the frame of reference travel with it: frame = \"{name}\" at the top"),
        );
    }
    if turns_visibly(body, case.geometry) {
        findings.error(
            &key,
            format!(
                "body \"{name}\" turns and is not a disc: moving meshes are not there yet for \
                 unsteady runs"
            ),
            "lock it with locked = [\"rotation\"], make it a disc, or solve for one instant with \
             [time.steady]",
        );
    }
    let frame_moves =
        case.body.iter().any(|other| Some(&other.name) == case.frame.as_ref() && translates(other));
    if frame_moves && !is_frame && !translates(body) {
        findings.error(
            &key,
            format!(
                "body \"{name}\" stays behind while the frame of reference travels: moving meshes \
                 are not there yet for unsteady runs"
            ),
            "only one body can be in an unsteady run whose frame travels",
        );
    }
}

/// A flow around a travelling body is steady only as seen from the body.
fn steady_frame(findings: &mut Findings<'_>) {
    let case = findings.case();
    for (index, body) in case.body.iter().enumerate() {
        if translates(body) && case.frame.as_deref() != Some(body.name.as_str()) {
            findings.warning(
                &format!("body.{index}.motion"),
                format!("a flow with inertia around the travelling body \"{}\" is steady only as seen from it", body.name),
                &format!("write frame = \"{}\" at the top", body.name),
            );
        }
    }
}
