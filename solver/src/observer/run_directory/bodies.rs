//! `bodies.json`: which bodies swim together, what joins them, and how each of them swims.

use std::io;
use std::path::Path;

use nalgebra::Vector3;
use serde::Serialize;

use crate::case::{Body, GaitSpec, Geometry, Joint, JointKind, Model};
use crate::observer::system::write_whole;

/// Where it is written in the directory of a run.
pub(super) const FILE: &str = "bodies.json";

/// The content of the file.
#[derive(Debug, Serialize)]
struct Bodies<'a> {
    /// The body the frame of reference travels with.
    frame: Option<&'a str>,
    bodies: Vec<OneBody<'a>>,
    swimmers: Vec<Swimmer<'a>>,
    joints: Vec<OneJoint<'a>>,
}

/// A body and its gait.
#[derive(Debug, Serialize)]
struct OneBody<'a> {
    name: &'a str,
    gait: Option<&'static str>,
    /// Unit vector in the frame of the body; none where it turns in time.
    heading: Option<[f64; 3]>,
    deforms: bool,
}

/// A swimmer of `[[swimmer]]`, or a copy of it.
#[derive(Debug, Serialize)]
struct Swimmer<'a> {
    name: &'a str,
    bodies: Vec<&'a str>,
}

/// A joint, its ends in the frames of the bodies (m).
#[derive(Debug, Serialize)]
struct OneJoint<'a> {
    kind: &'static str,
    parent: &'a str,
    child: &'a str,
    on_parent: [f64; 3],
    on_child: [f64; 3],
    /// The swimmer it was made for; none of `[[joint]]`.
    swimmer: Option<&'a str>,
}

/// Writes `bodies.json` to the directory of a run.
///
/// # Errors
/// When the file system refuses.
pub(in crate::observer) fn write_bodies(directory: &Path, model: &Model) -> io::Result<()> {
    let mut text = serde_json::to_vec_pretty(&bodies(model))?;
    text.push(b'\n');
    write_whole(&directory.join(FILE), &text)
}

/// Ends of a joint in the frames of its parent and its child as messages have them (m).
pub(in crate::observer) fn joint_ends(model: &Model, joint: &Joint) -> [Vector3<f64>; 2] {
    let [on_parent, on_child] = joint.ends();
    [on_parent - centroid(model, &joint.parent), on_child - centroid(model, &joint.child)]
}

/// The origin of the frame of a body from that of its shape (m): frames are at centres of mass.
fn centroid(model: &Model, name: &str) -> Vector3<f64> {
    let own = model.body_index(name).map(|body| &model.bodies[body].center_of_mass);
    if let Some(own) = own.filter(|own| !own.is_empty()) {
        return Vector3::from_fn(|axis, _| own.get(axis).copied().unwrap_or(0.0));
    }
    let body = model.body_index(name).filter(|_| model.case.geometry.dimensions() == 2);
    let moments = body.and_then(|body| model.bodies[body].shape.outline().moments());
    moments.map_or_else(Vector3::zeros, |moments| {
        Vector3::new(moments.centroid.x, moments.centroid.y, 0.0)
    })
}

fn bodies(model: &Model) -> Bodies<'_> {
    // The swimmer of each body; a body of `[[body]]` that swims alone is none of `[[swimmer]]`
    let mut owners = vec![None; model.bodies.len()];
    let mut swimmers = Vec::new();
    for swimmer in &model.swimmers {
        let name = swimmer.name.as_str();
        if let [body] = swimmer.bodies[..]
            && model.swimmer_of_body(body).is_none()
            && model.bodies[body].name == name
        {
            continue;
        }
        let mut members = swimmer.bodies.clone();
        members.sort_unstable();
        for &member in &members {
            owners[member] = Some(name);
        }
        let bodies = members.iter().map(|&member| model.bodies[member].name.as_str()).collect();
        swimmers.push(Swimmer { name, bodies });
    }
    let joined = model.joints.iter().enumerate();
    let joined = joined.filter(|(_, joint)| !model.hangs_on_laboratory(joint));
    let joints = joined.map(|(nth, joint)| {
        let [on_parent, on_child] = joint_ends(model, joint).map(Into::into);
        let Joint { parent, child, kind, .. } = joint;
        let made_for = model.swimmer_of_joint(nth).and_then(|_| model.body_index(child));
        let swimmer = made_for.and_then(|child| owners[child]);
        OneJoint { kind: kind_of_joint(kind), parent, child, on_parent, on_child, swimmer }
    });
    Bodies {
        frame: model.frame_body().map(|body| model.bodies[body].name.as_str()),
        bodies: model.bodies.iter().map(|body| one_body(body, model.case.geometry)).collect(),
        swimmers,
        joints: joints.collect(),
    }
}

fn one_body(body: &Body, geometry: Geometry) -> OneBody<'_> {
    let heading = match &body.gait {
        Some(GaitSpec::Squirmer(gait)) if gait.turn.is_none() => {
            Some(gait.axis_in_body(geometry == Geometry::Axisymmetric).into())
        }
        _ => None,
    };
    OneBody {
        name: &body.name,
        gait: body.gait.as_ref().map(kind_of_gait),
        heading,
        deforms: body.deforms(),
    }
}

/// The name of a gait in a case; `joints` of a chain with a skin.
fn kind_of_gait(gait: &GaitSpec) -> &'static str {
    match gait {
        GaitSpec::Squirmer(_) => "squirmer",
        GaitSpec::Slip(_) => "slip",
        GaitSpec::Carangiform(_) => "carangiform",
        GaitSpec::Anguilliform(_) => "anguilliform",
        GaitSpec::Flagellum(_) => "flagellum",
        GaitSpec::Midline(_) => "midline",
        GaitSpec::Pulsating(_) => "pulsating",
        GaitSpec::Joints(_) => "joints",
    }
}

/// The name of a kind of joint in a case.
fn kind_of_joint(kind: &JointKind) -> &'static str {
    match kind {
        JointKind::Arm { .. } => "arm",
        JointKind::Bent { .. } => "bent",
        JointKind::Hinge(_) => "hinge",
        JointKind::Slider(_) => "slider",
        JointKind::Ball(_) => "ball",
    }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;
    use crate::case::Case;

    fn written(case: &str) -> Value {
        let model = Case::read(case, &[]).unwrap().model;
        let place = tempfile::tempdir().unwrap();
        write_bodies(place.path(), &model).unwrap();
        serde_json::from_slice(&std::fs::read(place.path().join(FILE)).unwrap()).unwrap()
    }

    #[test]
    fn arms_of_a_swimmer_are_its_joints() {
        let written = written("three-sphere-3d");
        let names = ["swimmer-1", "swimmer-2", "swimmer-3"];
        assert_eq!(written["swimmers"], json!([{ "name": "swimmer", "bodies": names }]));
        let joints = written["joints"].as_array().unwrap();
        let ends: Vec<_> = joints.iter().map(|j| (&j["parent"], &j["child"])).collect();
        assert_eq!(
            ends,
            [(&json!(names[1]), &json!(names[0])), (&json!(names[1]), &json!(names[2]))]
        );
        assert!(joints.iter().all(|j| j["kind"] == "arm" && j["swimmer"] == "swimmer"));
    }

    #[test]
    fn joints_of_the_case_are_of_no_swimmer() {
        let written = written("flagellated-3d");
        let together = json!([{ "name": "bacterium", "bodies": ["head", "tail"] }]);
        assert_eq!(written["swimmers"], together);
        let joint = json!({
            "kind": "bent", "parent": "head", "child": "tail", "swimmer": null,
            "on_parent": [1.2, 0.0, 0.0], "on_child": [0.0, 0.0, 0.0],
        });
        assert_eq!(written["joints"], json!([joint]));
    }

    #[test]
    fn a_squirmer_has_a_heading_unless_it_turns() {
        let heading = |case: &str| written(case)["bodies"][0]["heading"].clone();
        assert_eq!(heading("squirmer-alone"), json!([1.0, 0.0, 0.0]));
        let alone = written("squirmer-alone");
        assert_eq!(alone["swimmers"], json!([]));
        assert_eq!(alone["bodies"][0]["gait"], "squirmer");
        let fish = &written("carangiform")["bodies"][0];
        assert_eq!((&fish["heading"], &fish["deforms"]), (&Value::Null, &json!(true)));
    }
}
