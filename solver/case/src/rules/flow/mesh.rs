//! Problems of `[mesh]` and cells too coarse for a body.

use std::collections::HashSet;

use crate::MovingMesh;
use crate::rules::Findings;
use crate::text::type_error::suggestion;

/// Edges on an outline below which a body is hardly round.
const FEWEST_EDGES: f64 = 8.0;

/// Layers of cells across a gap that a moving mesh may ask for, however few a new one has.
const MODEST_LAYERS: f64 = 2.0;

/// Most refinement boxes.
const MOST_BOXES: usize = 1000;

/// Layers of cells across a gap below which it is warned about.
const FEW_LAYERS: f64 = 1.5;

pub fn check(findings: &mut Findings<'_>) {
    let case = findings.case();
    let mesh = &case.mesh;
    let sides = case.sides();
    for side in mesh.sides.keys().filter(|side| !sides.contains(&side.as_str())) {
        let help = suggestion(side, &sides);
        let key = format!("mesh.sides.{side}");
        findings.error(&key, format!("this domain has no side `{side}`"), &help);
    }
    check_boxes(findings);
    let is_given = mesh.gap_layers > 0.0 && mesh.scale > 0.0;
    let layers = mesh.gap_layers / mesh.scale;
    if is_given && layers < FEW_LAYERS {
        let plural = if layers == 1.0 { "" } else { "s" };
        findings.warning(
            "mesh.gap_layers",
            format!("gaps get {layers} layer{plural} of cells: too few for the pressure in them"),
            "4 are usual",
        );
    }
    check_moving(findings);
    check_edges(findings);
}

/// Refinement boxes have an inside, and part of the domain in it.
fn check_boxes(findings: &mut Findings<'_>) {
    let case = findings.case();
    if case.mesh.boxes.len() > MOST_BOXES {
        findings.error(
            "mesh.box",
            format!("{} refinement boxes are more than {MOST_BOXES}", case.mesh.boxes.len()),
            "join neighbouring ones: every size is compared with each of them",
        );
        return;
    }
    let extent = case.extent();
    let axes = 0..case.geometry.dimensions();
    for (index, refined) in case.mesh.boxes.iter().enumerate() {
        let key = format!("mesh.box.{index}");
        if !findings.is_vector(&refined.min) || !findings.is_vector(&refined.max) {
            continue;
        }
        if axes.clone().any(|axis| refined.max[axis] <= refined.min[axis]) {
            findings.error(
                &format!("{key}.max"),
                format!("the box from {:?} to {:?} is empty", refined.min, refined.max),
                "all numbers of `max` must be larger than those of `min`",
            );
        } else if axes.clone().any(|axis| {
            refined.max[axis] <= extent.min[axis] || refined.min[axis] >= extent.max[axis]
        }) {
            findings.warning(
                &key,
                format!(
                    "the box from {:?} to {:?} lies outside the domain and refines nothing",
                    refined.min, refined.max
                ),
                &format!("the domain reaches from {:?} to {:?}", extent.min, extent.max),
            );
        }
    }
}

/// Outlines with few edges.
fn check_edges(findings: &mut Findings<'_>) {
    let mesh = &findings.case().mesh;
    let mut coarse: HashSet<(Option<usize>, String)> = HashSet::new();
    for (index, body) in findings.model().bodies.iter().enumerate() {
        let (key, declared) = match (body.size, mesh.surface) {
            (Some(size), _) => (format!("body.{index}.size"), size),
            (None, Some(surface)) => ("mesh.surface".to_owned(), surface),
            (None, None) => ("mesh.size".to_owned(), mesh.size),
        };
        let size = declared * mesh.scale;
        let edges = body.shape.perimeter() / size;
        if size > 0.0 && edges > 0.0 && edges < FEWEST_EDGES {
            // Of copies that are all alike the first says it
            let swimmer = findings.model().swimmer_of_body(index);
            if swimmer.is_some() && !coarse.insert((swimmer, format!("{edges:.3}"))) {
                continue;
            }
            findings.warning(
                &key,
                format!("the outline of \"{}\" is about {edges:.1} edges long", body.name),
                &format!(
                    "for {FEWEST_EDGES} edges write at most {:.3}",
                    body.shape.perimeter() / FEWEST_EDGES / mesh.scale
                ),
            );
        }
    }
}

/// When a mesh that moves is replaced.
fn check_moving(findings: &mut Findings<'_>) {
    let case = findings.case();
    let (moving, gap_layers) = (case.mesh.moving, case.mesh.gap_layers);
    // Both as written: the scale of the mesh makes gaps coarser than they were meant to be, which
    // is no reason to refuse them. A mesh with few layers is replaced once it has lost some.
    if let Some(layers) = moving.layers.filter(|layers| *layers > gap_layers.max(MODEST_LAYERS)) {
        findings.error(
            "mesh.moving.layers",
            format!(
                "the domain is remeshed below {layers} layers across a gap, but a new mesh has {gap_layers}"
            ),
            &format!("write at most mesh.gap_layers = {gap_layers}, or raise that"),
        );
    }
    if moving != MovingMesh::default() && !findings.model().mesh_moves() {
        findings.warning(
            "mesh.moving",
            "`mesh.moving` has no effect: nothing moves through the mesh".to_owned(),
            "leave it out",
        );
    }
}
