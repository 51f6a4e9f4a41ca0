//! Bodies that would collide in their strokes, found before anything is solved.

use std::f64::consts::TAU;

use alewife_mesh::{Domain, MeshError, Outline, PlacedShape, Point, check_placement, closest};

use crate::model::balls::{Ball, BallGrid};
use crate::rules::Findings;
use crate::spec::body::joint::{PlanarPose, child_pose};
use crate::{Geometry, Joint, Model, Stroke, TimeSettings};

/// Times of a cycle at which bodies are looked at.
const TIMES: u32 = 96;

/// Half the side of the box around a swimmer over the distance of its farthest body.
const ROOM: f64 = 10.0;

/// Gap over the sizes of two bodies above which they are apart for certain.
const APART: f64 = 1e-5;

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
        let tree = Tree::new(model, &children, root);
        let strokes: Vec<&Stroke> =
            tree.joints.iter().filter_map(|link| link.joint.kind.stroke()).collect();
        let end = strokes.iter().map(|stroke| cycle(stroke)).fold(0.0, f64::max);
        let end = end.min(unsteady.end);
        // How a free hinge bends, only the run will tell.
        if strokes.len() < tree.joints.len() || end == 0.0 {
            continue;
        }
        let meeting = (1..=TIMES).find_map(|nth| {
            let time = end * f64::from(nth) / f64::from(TIMES);
            tree.overlap(time).map(|error| (time, error))
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
        // A whole turn of a motor
        Stroke::Steady { rate, .. } if *rate != 0.0 => TAU / rate.abs(),
        Stroke::Steady { .. } => 0.0,
        Stroke::Sine { period, ramp, .. } => period + ramp,
        Stroke::Legs { period, .. } => *period,
        Stroke::Table(knots) => knots.last().map_or(0.0, |knot| knot[0]),
        Stroke::Cubic(knots) => knots.last().map_or(0.0, |knot| knot[0]),
        Stroke::Cycle(cycle) => cycle.period,
        // What will be asked for, nobody knows
        Stroke::Command(_) => 0.0,
    }
}

/// Bodies that hang on each other, the one all others hang on first.
struct Tree<'a> {
    geometry: Geometry,
    bodies: Vec<PlacedShape>,
    /// `None` of a shape that has none.
    outlines: Vec<Option<Outline>>,
    joints: Vec<Link<'a>>,
}

/// A joint between bodies of a tree, by their positions in it.
struct Link<'a> {
    parent: usize,
    child: usize,
    joint: &'a Joint,
}

impl<'a> Tree<'a> {
    fn new(model: &'a Model, children: &[Vec<usize>], root: usize) -> Self {
        let mut indices = vec![root];
        let mut joints: Vec<Link<'a>> = Vec::new();
        let mut next = 0;
        while let Some(&parent) = indices.get(next) {
            for &child in &children[parent] {
                let Some(joint) = model.joint_above(child) else { continue };
                let joint = &model.joints[joint];
                joints.push(Link { parent: next, child: indices.len(), joint });
                indices.push(child);
            }
            next += 1;
        }
        let placed = |body: &usize| model.bodies[*body].placed(model.case.mesh.scale);
        let bodies: Vec<PlacedShape> = indices.iter().map(placed).collect();
        let outlines = bodies.iter().map(|body| Outline::new(body).ok()).collect();
        Self { geometry: model.case.geometry, bodies, outlines, joints }
    }

    /// The bodies at a time (s), the first one where it starts.
    fn at(&self, time: f64) -> Vec<PlacedShape> {
        let mut poses = vec![PlanarPose::default(); self.bodies.len()];
        poses[0].angle = self.bodies[0].angle;
        for Link { parent, child, joint } in &self.joints {
            let [on_parent, on_child] = joint.ends_in_plane();
            poses[*child] = child_pose(poses[*parent], on_parent, on_child, &joint.kind, time);
        }
        let placed = |(body, pose): (&PlacedShape, &PlanarPose)| PlacedShape {
            center: pose.center,
            angle: pose.angle,
            ..body.clone()
        };
        self.bodies.iter().zip(&poses).map(placed).collect()
    }

    /// The first overlap of two bodies at a time (s).
    fn overlap(&self, time: f64) -> Option<MeshError> {
        let bodies = self.at(time);
        let outline = |index: usize| {
            let (outline, body) = (self.outlines[index].as_ref()?, &bodies[index]);
            Some(outline.placed_at(body.center, body.angle))
        };
        let outlines: Vec<Option<Outline>> = (0..bodies.len()).map(outline).collect();
        let far = outlines
            .iter()
            .flatten()
            .fold(0.0f64, |far, outline| far.max(outline.center().norm() + outline.reach()));
        let mut grid = BallGrid::new([-far; 2].into(), [far; 2].into(), bodies.len());
        for (index, outline) in outlines.iter().enumerate() {
            let Some(outline) = outline else { continue };
            let radius = (1.0 + APART) * outline.reach();
            let circle = Ball { center: outline.center(), radius };
            let mut near: Vec<usize> = grid.near(&circle).collect();
            near.sort_unstable();
            near.dedup();
            for other in near {
                let Some(placed) = &outlines[other] else { continue };
                let size = outline.reach().min(placed.reach());
                if closest(outline, placed).gap <= APART * size {
                    let pair = [bodies[other].clone(), bodies[index].clone()];
                    let refused = check_placement(&self.surroundings(ROOM * far), &pair).err();
                    if refused.is_some() {
                        return refused;
                    }
                }
            }
            grid.insert(index, &circle);
        }
        None
    }

    /// A domain whose sides are as far from the origin as said (m).
    fn surroundings(&self, room: f64) -> Domain {
        match self.geometry {
            Geometry::Planar | Geometry::Spatial => Domain::Box {
                min: Point::<2>::new(-room, -room),
                max: Point::<2>::new(room, room),
                periodic_x: false,
                periodic_y: false,
            },
            Geometry::Axisymmetric => {
                Domain::Cylinder { x: [-room, room], radius: room, periodic_x: false }
            }
        }
    }
}
