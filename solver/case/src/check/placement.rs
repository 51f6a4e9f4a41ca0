//! Bodies that overlap or leave the domain, and probes that are not in the fluid.

use alewife_mesh::{Domain, MeshError, Outline, PlacedShape, Point, check_wrapped_placement};

use super::{Findings, Severity};
use crate::Diagnostic;

/// Distance out of the fluid, over the size of the domain or a body, that is taken for rounding.
const ROUNDING: f64 = 1e-6;

pub fn check(findings: &mut Findings<'_>) {
    let (case, model) = (findings.case(), findings.model());
    let domain = case.mesh_domain();
    let mut bodies: Vec<PlacedShape> =
        model.bodies.iter().map(|body| body.placed(case.mesh.scale)).collect();
    // What hangs on another body may reach beyond a periodic side
    for (index, placed) in bodies.iter_mut().enumerate() {
        if model.joint_above(index).is_some() {
            let center = placed.center;
            let images = domain.images().into_iter().map(|shift| center + shift);
            let inside = |place: &Point<2>| domain.clearance(*place);
            placed.center = images.max_by(|a, b| inside(a).total_cmp(&inside(b))).unwrap_or(center);
        }
    }
    let problems = placement_problems(&domain, &bodies);
    let is_placed = problems.is_empty();
    for (index, error) in problems {
        let key = findings.written(&format!("body.{index}.center"));
        let (message, help) = match &error {
            MeshError::Outside { body, gap, x, y } => (
                format!(
                    "body \"{body}\" touches or leaves the domain at ({x:.4}, {y:.4}): gap {gap:.3e}"
                ),
                "move it inward, make it smaller, or enlarge the domain",
            ),
            MeshError::Overlap { first, second, gap, x, y } => (
                format!(
                    "bodies \"{first}\" and \"{second}\" touch or overlap at ({x:.4}, {y:.4}): \
                     gap {gap:.3e}"
                ),
                "move them apart, or make them smaller",
            ),
            other => (other.to_string(), ""),
        };
        let location = findings.file.location(&key);
        findings.diagnostics.push(Diagnostic {
            severity: Severity::Error,
            key,
            message,
            help: help.to_owned(),
            location,
        });
    }
    for (index, probe) in case.probe.iter().enumerate() {
        let key = format!("probe.{index}");
        let has_point = findings.vector(&format!("{key}.point"), &probe.point);
        if has_point {
            probe_point(
                findings,
                &format!("{key}.point"),
                &domain,
                &bodies,
                &probe.point,
                is_placed,
            );
        }
        if !probe.minus.is_empty() && findings.vector(&format!("{key}.minus"), &probe.minus) {
            probe_point(
                findings,
                &format!("{key}.minus"),
                &domain,
                &bodies,
                &probe.minus,
                is_placed,
            );
        }
    }
}

/// Everything that is wrong with where bodies are, each with the index of the body to move.
fn placement_problems(domain: &Domain, bodies: &[PlacedShape]) -> Vec<(usize, MeshError)> {
    let mut problems = Vec::new();
    let mut inside: Vec<usize> = Vec::new();
    for (index, body) in bodies.iter().enumerate() {
        if let Err(error) = check_wrapped_placement(domain, std::slice::from_ref(body)) {
            problems.push((index, error));
            continue;
        }
        // Across a periodic side a body may lie, beyond it it may not
        let gap = domain.clearance(body.center);
        if gap < 0.0 {
            let (x, y) = (body.center.x, body.center.y);
            problems.push((index, MeshError::Outside { body: body.name.clone(), gap, x, y }));
            continue;
        }
        for other in &inside {
            let pair = [bodies[*other].clone(), body.clone()];
            if let Err(error) = check_wrapped_placement(domain, &pair) {
                problems.push((index, error));
            }
        }
        inside.push(index);
    }
    problems
}

/// Whether a point is in the fluid, or on its boundary.
fn probe_point(
    findings: &mut Findings<'_>,
    key: &str,
    domain: &Domain,
    bodies: &[PlacedShape],
    point: &[f64],
    are_bodies_placed: bool,
) {
    let place = Point::<2>::new(point[0], point[1]);
    let [min, max] = findings.case().domain.extent();
    let size = (max[0] - min[0]).hypot(max[1] - min[1]);
    let below_axis = if domain.is_axisymmetric() { -place.y } else { 0.0 };
    if domain.clearance(place) < -ROUNDING * size || below_axis > ROUNDING * size {
        findings.error(
            key,
            format!("the point {point:?} is outside the domain"),
            &format!("the domain reaches from {min:?} to {max:?}"),
        );
        return;
    }
    if !are_bodies_placed {
        return;
    }
    for (body, placed) in findings.model().bodies.iter().zip(bodies) {
        let Ok(outline) = Outline::new(placed) else { continue };
        let gaps = domain.images().into_iter().map(|shift| outline.nearest(place + shift).gap);
        if gaps.fold(f64::INFINITY, f64::min) < -ROUNDING * body.shape.reach() {
            findings.error(
                key,
                format!("the point {point:?} is inside the body \"{}\"", body.name),
                "move it into the fluid, or on to the surface of the body",
            );
        }
    }
}
