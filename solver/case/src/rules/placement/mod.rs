//! Bodies that overlap or leave the domain, and probes that are not in the fluid.

mod arrangement;
mod plane;
mod space;
mod symmetry;

use alewife_mesh::{MeshError, SMALLEST_GAP};

use self::arrangement::{Arrangement, Misplaced};
use super::Findings;
use crate::Geometry;

pub fn check(findings: &mut Findings<'_>) {
    let model = findings.model();
    if model.case.geometry == Geometry::Spatial {
        if let Some(domain) = model.case.domain_in_space() {
            symmetry::check(findings, &domain);
            report(findings, &space::Solids::new(domain, model));
        }
    } else {
        let domain = model.case.mesh_domain();
        let bodies = plane::placed_bodies(model, &domain);
        report(findings, &plane::Layout::new(&domain, &bodies, model.case.extent().in_plane()));
    }
}

/// Tells what is wrong with bodies and probes.
fn report(findings: &mut Findings<'_>, arrangement: &impl Arrangement) {
    let misplaced = arrangement.misplaced();
    for Misplaced { body, error } in &misplaced {
        let key = if is_of_place(error) { "center" } else { "shape" };
        findings.error(&format!("body.{body}.{key}"), message(error), remedy(error));
    }
    for (index, probe) in findings.case().probe.iter().enumerate() {
        let minus = Some(&probe.minus).filter(|minus| !minus.is_empty());
        for (name, point) in [("point", Some(&probe.point)), ("minus", minus)] {
            let key = format!("probe.{index}.{name}");
            let Some(point) = point.filter(|point| findings.is_vector(point)) else { continue };
            let point = findings.model().probe_point(probe, point);
            check_probe(findings, &key, arrangement, &point, misplaced.is_empty());
        }
    }
    for (index, tracer) in findings.case().tracer.iter().enumerate() {
        // Bodies may have left, or come, when later ones are released
        let is_placed = misplaced.is_empty() && tracer.start == 0.0;
        for (nth, point) in tracer.points.iter().enumerate() {
            let key = format!("tracer.{index}.points.{nth}");
            if findings.is_vector(point) && findings.is_right(&format!("tracer.{index}.points")) {
                check_probe(findings, &key, arrangement, point, is_placed);
            }
        }
    }
}

/// A probe, or a seed of tracers, must be in the domain, and in the fluid or on the surface of a body.
fn check_probe(
    findings: &mut Findings<'_>,
    key: &str,
    arrangement: &impl Arrangement,
    point: &[f64],
    is_placed: bool,
) {
    if arrangement.is_outside(point) {
        let extent = findings.case().extent();
        let n = point.len();
        findings.error(
            key,
            format!("the point {point:?} is outside the domain"),
            &format!("the domain reaches from {:?} to {:?}", &extent.min[..n], &extent.max[..n]),
        );
    } else if is_placed {
        for body in arrangement.around(point) {
            findings.error(
                key,
                format!("the point {point:?} is inside the body \"{body}\""),
                "move it into the fluid, or on to the surface of the body",
            );
        }
    }
}

/// Whether an error is about where a body is.
fn is_of_place(error: &MeshError) -> bool {
    !matches!(error, MeshError::Body { .. } | MeshError::SelfIntersection { .. })
}

/// What is wrong with where a body is.
pub(super) fn message(error: &MeshError) -> String {
    match error {
        MeshError::Outside { body, gap, x, y } => outside(body, None, *gap, &[*x, *y]),
        MeshError::BodyMeetsSide { body, side, gap, at } => outside(body, Some(side), *gap, at),
        MeshError::BodyMeetsPeriodicSide { body, side, gap, at } => format!(
            "the cylinder \"{body}\" touches or crosses the periodic side `{side}` at {}: gap {gap:.3e}",
            coordinates(at)
        ),
        MeshError::BodyMeetsImage { body, gap, at } => format!(
            "body \"{body}\" touches or overlaps its own image one period away, at {}: gap {gap:.3e}",
            coordinates(at)
        ),
        MeshError::Overlap { first, second, gap, x, y } if first == second => format!(
            "body \"{first}\" touches or overlaps its own image across a periodic side at {}: gap {gap:.3e}",
            coordinates(&[*x, *y])
        ),
        MeshError::Overlap { first, second, gap, x, y } => {
            overlap([first, second], *gap, &[*x, *y])
        }
        MeshError::BodiesMeet { first, second, gap, at } => overlap([first, second], *gap, at),
        other => other.to_string(),
    }
}

fn outside(body: &str, side: Option<&str>, gap: f64, at: &[f64]) -> String {
    let at = coordinates(at);
    if gap > 0.0 {
        let what = side.map_or("the boundary".to_owned(), |side| format!("the side `{side}`"));
        return format!("body \"{body}\" is {gap:.3e} from {what} at {at}: {}", thin());
    }
    let what = side.map_or("the domain".to_owned(), |side| format!("the domain at side `{side}`,"));
    format!("body \"{body}\" touches or leaves {what} at {at}: gap {gap:.3e}")
}

fn overlap([first, second]: [&str; 2], gap: f64, at: &[f64]) -> String {
    let at = coordinates(at);
    if gap > 0.0 {
        return format!(
            "bodies \"{first}\" and \"{second}\" are {gap:.3e} apart at {at}: {}",
            thin()
        );
    }
    format!("bodies \"{first}\" and \"{second}\" touch or overlap at {at}: gap {gap:.3e}")
}

/// A place in brackets.
pub(super) fn coordinates(at: &[f64]) -> String {
    // No negative zeros
    let shown = |part: &f64| if part.abs() < 5e-5 { 0.0 } else { *part };
    let parts: Vec<String> = at.iter().map(|part| format!("{:.4}", shown(part))).collect();
    format!("({})", parts.join(", "))
}

/// What is said of a gap that is too small.
fn thin() -> String {
    format!("gaps below {SMALLEST_GAP:e} of the size of a body cannot be meshed")
}

/// What to do about it.
fn remedy(error: &MeshError) -> &'static str {
    match error {
        MeshError::Outside { .. } => "move it inward, make it smaller, or enlarge the domain",
        MeshError::BodyMeetsSide { .. } => {
            "move it inward, make it smaller, enlarge the domain, or make the side a plane of symmetry"
        }
        MeshError::BodyMeetsPeriodicSide { .. } => {
            "cylinders without ends do not cross periodic sides: move them, or the box"
        }
        MeshError::Overlap { first, second, .. } if first == second => {
            "make it smaller, turn it, or enlarge the domain along its period"
        }
        MeshError::BodyMeetsImage { .. } => "make it smaller, turn it, or enlarge the domain",
        MeshError::Overlap { .. } | MeshError::BodiesMeet { .. } => {
            "move them apart, or make them smaller"
        }
        _ => "",
    }
}
