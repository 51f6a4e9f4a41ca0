//! Bodies that would run into each other in their strokes, foreseen before anything is solved.

use alewife_mesh::{Domain, MeshError, PlacedShape, Point, check_placement};

use super::Findings;
use crate::joint::{PlanarPose, child_pose};
use crate::{Geometry, Joint, Model, Stroke, TimeSettings};

/// Times of a cycle at which bodies are looked at.
const TIMES: u32 = 96;

/// Half the side of the box around a swimmer over the distance of its farthest body.
const ROOM: f64 = 10.0;

pub fn check(findings: &mut Findings<'_>) {
    let model = findings.model();
    let TimeSettings::Unsteady(unsteady) = &model.case.time else { return };
    let children = model.children();
    let mut seen = vec![false; model.case.swimmer.len()];
    for root in (0..model.bodies.len()).filter(|body| model.joint_above(*body).is_none()) {
        // Copies of a swimmer all make the same strokes
        if let Some(swimmer) = model.swimmer_of_body(root)
            && std::mem::replace(&mut seen[swimmer], true)
        {
            continue;
        }
        let mut tree = vec![root];
        let mut joints: Vec<(usize, usize, &Joint)> = Vec::new();
        let mut next = 0;
        while let Some(&parent) = tree.get(next) {
            for &child in &children[parent] {
                let Some(joint) = model.joint_above(child) else { continue };
                joints.push((next, tree.len(), &model.joints[joint]));
                tree.push(child);
            }
            next += 1;
        }
        let strokes: Vec<&Stroke> =
            joints.iter().filter_map(|(_, _, joint)| joint.kind.stroke()).collect();
        let end = strokes.iter().map(|stroke| cycle(stroke)).fold(0.0, f64::max);
        let end = end.min(unsteady.end);
        // How a free hinge bends, only the run will tell.
        if strokes.len() < joints.len() || end == 0.0 {
            continue;
        }
        let meeting = (1..=TIMES).find_map(|nth| {
            let time = end * f64::from(nth) / f64::from(TIMES);
            meet(model, &tree, &joints, time).map(|error| (time, error))
        });
        if let Some((time, MeshError::Overlap { first, second, .. })) = meeting {
            let joint =
                model.joints.iter().position(|joint| joint.child == second || joint.child == first);
            findings.error(
                &format!("joint.{}", joint.unwrap_or(0)),
                format!("in their strokes \"{first}\" and \"{second}\" meet at time {time:.4}"),
                "bend less, keep arms longer, or make the bodies smaller",
            );
        }
    }
}

/// The time after which a stroke has been everywhere (s).
fn cycle(stroke: &Stroke) -> f64 {
    match stroke {
        Stroke::Constant(_) => 0.0,
        Stroke::Sine { period, ramp, .. } => period + ramp,
        Stroke::Legs { period, .. } => *period,
        Stroke::Table(knots) => knots.last().map_or(0.0, |knot| knot[0]),
    }
}

/// The bodies of a tree, its root where it starts, if two of them overlap at a time (s).
fn meet(
    model: &Model,
    tree: &[usize],
    joints: &[(usize, usize, &Joint)],
    time: f64,
) -> Option<MeshError> {
    let mut poses = vec![PlanarPose::default(); tree.len()];
    poses[0].angle = model.bodies[tree[0]].angle;
    for &(parent, child, joint) in joints {
        let Joint { on_parent, on_child, kind, .. } = joint;
        poses[child] = child_pose(poses[parent], *on_parent, *on_child, kind, time);
    }
    let bodies: Vec<PlacedShape> = tree
        .iter()
        .zip(&poses)
        .map(|(body, pose)| PlacedShape {
            center: pose.center,
            angle: pose.angle,
            ..model.bodies[*body].placed(model.case.mesh.scale)
        })
        .collect();
    let far = bodies.iter().zip(tree).fold(0.0f64, |far, (placed, body)| {
        far.max(placed.center.norm() + model.bodies[*body].shape.reach())
    });
    let room = ROOM * far;
    let domain = match model.case.geometry {
        Geometry::Planar => Domain::Box {
            min: Point::<2>::new(-room, -room),
            max: Point::<2>::new(room, room),
            periodic_x: false,
            periodic_y: false,
        },
        Geometry::Axisymmetric => {
            Domain::Cylinder { x: [-room, room], radius: room, periodic_x: false }
        }
    };
    check_placement(&domain, &bodies).err()
}
