//! Bodies that a given mesh leaves out: `shape.side = "cylinder"` takes its outline and its centre from the mesh.

use std::collections::BTreeMap;

use alewife_mesh::spatial::{Imported, SolidHole};

use crate::spec::body::given::hole::HoleInFrame;
use crate::text::tree::{TomlNode, TomlValue, TreeError};
use crate::text::type_error::suggestion;
use crate::{Case, DomainSpec, MeshFile, ShapeSpec};

/// How far a centre that is written may be from that of the hole, over its size.
const APART: f64 = 1e-6;

/// Gives bodies that are holes a centre that stands for the one the mesh has, where none is written.
pub fn without_center(root: &mut TomlNode) {
    let in_space = root.get("geometry").and_then(TomlNode::text) == Some("spatial");
    let dimensions = if in_space { 3 } else { 2 };
    let bodies = root.table_mut().and_then(|entries| entries.get_mut("body"));
    let Some(TomlValue::Array(bodies)) = bodies.map(|body| &mut body.value) else { return };
    for body in bodies {
        let is_hole = body.get("shape.side").is_some();
        let Some(shape) = body.get("shape").cloned().filter(|_| is_hole) else { continue };
        let node = |value| TomlNode { key: shape.key.clone(), origin: shape.origin.clone(), value };
        let unknown = node(TomlValue::Array(vec![node(TomlValue::Float(f64::NAN)); dimensions]));
        if let Some(entries) = body.table_mut() {
            entries.entry("center".to_owned()).or_insert(unknown);
        }
    }
}

/// Takes outlines and centres of bodies that are holes from the mesh of a case, which has been read.
///
/// # Errors
/// When there is no such mesh or side, or nothing inside it.
pub fn read_into(case: &mut Case, root: &TomlNode) -> Result<(), TreeError> {
    let Case { body: bodies, domain, .. } = case;
    let mut taken: BTreeMap<String, String> = BTreeMap::new();
    for (index, body) in bodies.iter_mut().enumerate() {
        let ShapeSpec::Side(shape) = &mut body.shape else { continue };
        let refused = |key: &str, message: String, help: &str| TreeError {
            origin: root.find(&format!("body.{index}.{key}")).node.origin.clone(),
            message,
            help: help.to_owned(),
        };
        let side = shape.side.clone();
        let DomainSpec::Mesh(file) = &*domain else {
            return Err(refused(
                "shape.side",
                format!("\"{}\" is the hole of a mesh, and the domain is none", body.name),
                "write domain.mesh = { file = \"flow.msh\" }, or another shape",
            ));
        };
        if let Some(other) = taken.insert(side.clone(), body.name.clone()) {
            let message = format!("the side `{side}` is the surface of \"{other}\" already");
            return Err(refused("shape.side", message, "give each body a side of its own"));
        }
        let Found { hole, center, size } = found(file, &side)
            .map_err(|Refused { message, help }| refused("shape.side", message, &help))?;
        let is_unknown = body.center.iter().all(|x| x.is_nan());
        let is_there = body.center.len() == center.len()
            && body.center.iter().zip(&center).all(|(x, own)| (x - own).abs() < APART * size);
        if !is_unknown && !is_there {
            return Err(refused(
                "center",
                format!("the hole inside `{side}` has its centre at {center:?}"),
                "leave `center` out: the hole is where the mesh has it",
            ));
        }
        let turned = [("angle", body.angle != 0.0), ("orientation", body.orientation.is_some())];
        if let Some((key, _)) = turned.into_iter().find(|(_, is_turned)| *is_turned) {
            let message = format!("\"{}\" is turned as the mesh has it", body.name);
            return Err(refused(key, message, &format!("leave `{key}` out")));
        }
        body.center = center;
        shape.hole = Some(Box::new(hole));
    }
    let sides: Vec<&str> = taken.keys().map(String::as_str).collect();
    if let (DomainSpec::Mesh(file), false) = (domain, sides.is_empty()) {
        file.around_bodies = file.spatial().map(|imported| imported.without_sides(&sides));
    }
    Ok(())
}

/// A hole of a mesh.
struct Found {
    hole: HoleInFrame,
    center: Vec<f64>,
    /// About how large it is (m).
    size: f64,
}

/// Why there is none.
struct Refused {
    message: String,
    help: String,
}

/// The hole inside a side of a mesh.
fn found(file: &MeshFile, side: &str) -> Result<Found, Refused> {
    let is_known = file.side_names().contains(&side);
    if !is_known {
        let help = suggestion(side, &file.side_names());
        return Err(Refused { message: format!("the mesh has no side `{side}`"), help });
    }
    let no_hole = |reason: String| {
        Refused {
        message: format!("the side `{side}` does not run around one hole of the mesh{reason}"),
        help: "name a side that is closed, in one piece, with the fluid outside; give each hole a physical name of its \
               own"
            .to_owned(),
    }
    };
    if let Some(mesh) = file.planar() {
        let hole = mesh.boundary_named(side).and_then(|boundary| mesh.hole(boundary));
        let hole = hole.ok_or_else(|| no_hole(String::new()))?;
        let size = hole.moments.measure.sqrt();
        let center = hole.moments.centroid.as_slice().to_vec();
        return Ok(Found { hole: HoleInFrame::planar(&hole), center, size });
    }
    let mesh = file.spatial().map(Imported::mesh);
    let boundary = mesh.and_then(|mesh| Some((mesh, mesh.boundary_named(side)?)));
    let (mesh, boundary) = boundary.ok_or_else(|| no_hole(String::new()))?;
    let SolidHole { solid, center } =
        SolidHole::new(mesh, boundary).map_err(|fault| no_hole(format!(": {fault}")))?;
    let (size, center) = (solid.reach(), center.as_slice().to_vec());
    Ok(Found { hole: HoleInFrame::Spatial(solid), center, size })
}
