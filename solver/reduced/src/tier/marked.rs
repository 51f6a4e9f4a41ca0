//! The nodes that the markers of a case are, which have to be near its solid.

use crate::soft::SoftBody;
use alewife_case::Diagnostic;
use alewife_case::soft::SoftFile;
use alewife_mesh::{Bounds, Point};
use alewife_solid::solid::SolidMesh;

/// The nodes of the markers of a case.
///
/// # Errors
/// When one is farther from the solid than a cell is wide.
pub(super) fn markers<const D: usize>(
    file: &SoftFile,
    body: &SoftBody<D>,
) -> Result<Vec<usize>, Vec<Diagnostic>> {
    let mesh = &body.solid.spec().mesh;
    let widest =
        mesh.cells.chunks(mesh.n_local()).map(|cell| width(mesh, cell)).fold(0.0, f64::max);
    let mut wrong = Vec::new();
    let mut nodes = Vec::new();
    for (index, marker) in file.case.marker.iter().enumerate() {
        let node = nearest(body, &marker.at);
        nodes.push(node);
        let distance = squared_distance(&mesh.nodes[node], &marker.at).sqrt();
        if distance > widest {
            let message = format!(
                "\"{}\" is {distance:.3e} from the nearest node of the solid, farther than its widest cell, {widest:.3e}",
                marker.name
            );
            let key = format!("marker.{index}.at");
            wrong.push(file.error(&key, message, &reach(mesh)));
        }
    }
    if wrong.is_empty() { Ok(nodes) } else { Err(wrong) }
}

/// Where markers may be, in words.
fn reach<const D: usize>(mesh: &SolidMesh<D>) -> String {
    let Bounds { min, max } = Bounds::around(&mesh.nodes);
    let along = |axis: usize| {
        format!("{} from {:.4} to {:.4}", ["x", "y", "z"][axis], min[axis], max[axis])
    };
    let all: Vec<String> = (0..D).map(along).collect();
    format!("give a place on the solid at rest (m): {}", all.join(", "))
}

/// The largest distance (m) between two nodes of a cell.
fn width<const D: usize>(mesh: &SolidMesh<D>, cell: &[usize]) -> f64 {
    let to_others = |one: &usize| {
        cell.iter().map(|other| (mesh.nodes[*one] - mesh.nodes[*other]).norm()).fold(0.0, f64::max)
    };
    cell.iter().map(to_others).fold(0.0, f64::max)
}

/// Square of the distance of a node from a place (m2).
fn squared_distance<const D: usize>(node: &Point<D>, at: &[f64]) -> f64 {
    node.iter().zip(at).map(|(x, y)| (x - y) * (x - y)).sum()
}

/// The node nearest to a point.
fn nearest<const D: usize>(body: &SoftBody<D>, at: &[f64]) -> usize {
    let nodes = &body.solid.spec().mesh.nodes;
    let distance = |node: &usize| squared_distance(&nodes[*node], at);
    (0..nodes.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
}
