//! Bodies that would run into each other in their strokes, foreseen before anything is solved.

use alewife_mesh::{Domain, MeshError, PlacedShape, Point, check_placement};

use super::Findings;
use crate::{Case, Geometry, Joint, Stroke, TimeSettings, hang};

/// Times of a cycle at which bodies are looked at.
const TIMES: u32 = 96;

/// Half the side of the box around a swimmer over the distance of its farthest body.
const ROOM: f64 = 10.0;

pub fn check(findings: &mut Findings<'_>) {
    let case = findings.case();
    let TimeSettings::Unsteady(unsteady) = &case.time else { return };
    let index_of = |name: &str| case.body.iter().position(|body| body.name == name);
    let is_child = |body: usize| case.joint.iter().any(|joint| joint.child == case.body[body].name);
    let mut seen: Vec<usize> = Vec::new();
    for root in (0..case.body.len()).filter(|body| !is_child(*body)) {
        // Copies of a swimmer all make the same strokes
        let swimmer = case.body[root].swimmer;
        if swimmer.is_some_and(|swimmer| seen.contains(&swimmer)) {
            continue;
        }
        seen.extend(swimmer);
        let mut tree = vec![root];
        let mut joints: Vec<(usize, usize, &Joint)> = Vec::new();
        let mut next = 0;
        while let Some(&parent) = tree.get(next) {
            for joint in case.joint.iter().filter(|j| j.parent == case.body[parent].name) {
                let Some(child) = index_of(&joint.child) else { continue };
                joints.push((next, tree.len(), joint));
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
            meet(case, &tree, &joints, time).map(|error| (time, error))
        });
        if let Some((time, MeshError::Overlap { first, second, .. })) = meeting {
            let joint =
                case.joint.iter().position(|joint| joint.child == second || joint.child == first);
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
    case: &Case,
    tree: &[usize],
    joints: &[(usize, usize, &Joint)],
    time: f64,
) -> Option<MeshError> {
    let start = &case.body[tree[0]];
    let mut places = vec![[0.0; 3]; tree.len()];
    places[0] = [0.0, 0.0, start.angle];
    for &(parent, child, joint) in joints {
        let put = hang(places[parent], joint.on_parent, joint.on_child, &joint.kind, time);
        places[child] = put;
    }
    let bodies: Vec<PlacedShape> = tree
        .iter()
        .zip(&places)
        .map(|(body, place)| PlacedShape {
            center: Point::<2>::new(place[0], place[1]),
            angle: place[2],
            ..case.body[*body].placed(case.mesh.scale)
        })
        .collect();
    let far = bodies.iter().zip(tree).fold(0.0f64, |far, (placed, body)| {
        far.max(placed.center.norm() + case.body[*body].shape.reach())
    });
    let room = ROOM * far;
    let domain = match case.geometry {
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
