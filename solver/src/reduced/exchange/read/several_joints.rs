//! Several joints of one body: a keel, where the first body has one, else a chain of bodies without mass.

use alewife_reduced::tree::{JointKind, Pose};
use nalgebra::{Matrix3, Vector3};

use super::source::Remark;
use super::words::Names;
use crate::case::KeelSpec;
use crate::reduced::exchange::robot::{JointOf, Motor, Robot, RobotBody, RobotSite, RobotTendon};

/// How far apart places and axes that are the same may be by rounding (m, 1).
const ROUNDING: f64 = 1e-9;

/// Half lengths of a body without mass (m): what the fluid does to it is nothing beside any other load.
const NOTHING: f64 = 1e-9;

/// The keel that the joints of a first body are: along and about x, y and z of the world in this order, without springs and
/// dampers but those that keep its height and keep it level; none if they are something else.
pub(super) fn keel_of(body: &RobotBody) -> Option<KeelSpec> {
    let [along_x, along_y, along_z, about_x, about_y, about_z] = &body.joints[..] else {
        return None;
    };
    for (nth, joint) in body.joints.iter().enumerate() {
        let kind = if nth < 3 { JointKind::Slider } else { JointKind::Hinge };
        let axis = body.pose.rotation * joint.axis;
        let is_there = nth < 3 || (joint.position - about_x.position).norm() < ROUNDING;
        let is_along = (axis - Vector3::ith(nth % 3, 1.0)).norm() < ROUNDING;
        let is_at_rest = joint.rest == 0.0 && joint.start == [0.0; 2];
        if joint.kind != kind || !is_along || !is_there || !is_at_rest {
            return None;
        }
    }
    let is_free = [along_x, along_y, about_z]
        .iter()
        .all(|joint| joint.stiffness == 0.0 && joint.damping == 0.0);
    let is_light = body.joints.iter().all(|joint| joint.armature == 0.0);
    let is_even = about_x.stiffness == about_y.stiffness && about_x.damping == about_y.damping;
    (is_free && is_even && is_light).then(|| KeelSpec {
        position: Some(about_x.position.into()),
        heave_stiffness: along_z.stiffness,
        heave_damping: along_z.damping,
        tilt_stiffness: about_x.stiffness,
        tilt_damping: about_x.damping,
    })
}

/// The same robot with a joint a body at most: of several all but the last move bodies without mass between its parent and it,
/// in the order of the file, and in its frame. Joints that are a keel stay together.
pub(super) fn chained(robot: Robot, notes: &mut Vec<Remark>) -> Robot {
    let mut names = Names::default();
    for body in &robot.bodies {
        names.of(&body.name);
    }
    let mut chained = Chained { bodies: Vec::new(), last: Vec::new(), first: Vec::new(), names };
    for (number, body) in robot.bodies.into_iter().enumerate() {
        let is_whole = number == 0 && keel_of(&body).is_some();
        let between = if is_whole { Vec::new() } else { chained.split(&body) };
        if !between.is_empty() {
            let what = format!(
                "\"{}\" has {} joints: between them are bodies without mass, {}",
                body.name,
                body.joints.len(),
                between.join(", ")
            );
            notes.push(Remark { line: 1, element: None, what, help: None });
        }
        chained.add(body, between.len());
    }
    let Chained { bodies, last, first, .. } = chained;
    // The nth joint of a keel is that of its body; else bodies stand in the order of joints
    let joint = |of: JointOf| match last[of.body] - first[of.body] {
        0 => JointOf { body: last[of.body], ..of },
        _ => JointOf { body: first[of.body] + of.nth, nth: 0 },
    };
    let motors = robot.motors.into_iter().map(|one| Motor { joint: joint(one.joint), ..one });
    let site = |site: RobotSite| RobotSite { body: last[site.body], ..site };
    let tendons = robot
        .tendons
        .into_iter()
        .map(|one| RobotTendon { sites: one.sites.into_iter().map(site).collect(), ..one });
    Robot { motors: motors.collect(), tendons: tendons.collect(), bodies, ..robot }
}

/// Bodies with one joint each, in the making.
struct Chained {
    bodies: Vec<RobotBody>,
    /// Of each body of the file, itself.
    last: Vec<usize>,
    /// The one that its first joint moves.
    first: Vec<usize>,
    names: Names,
}

impl Chained {
    /// Adds what all joints of a body but its last one move, and tells its names.
    fn split(&mut self, body: &RobotBody) -> Vec<String> {
        let between = body.joints.split_last().map_or(&[][..], |(_, between)| between);
        let mut added = Vec::new();
        for (nth, joint) in between.iter().enumerate() {
            let name = self.names.of(&format!("{}-{}", body.name, nth + 1));
            let above = body.parent.map(|parent| self.last[parent]);
            let here = self.bodies.len();
            self.bodies.push(RobotBody {
                name: name.clone(),
                parent: if nth == 0 { above } else { Some(here - 1) },
                pose: if nth == 0 { body.pose } else { Pose::identity() },
                mass: 0.0,
                center: Vector3::zeros(),
                inertia: Matrix3::zeros(),
                is_free: false,
                velocity: body.velocity,
                joints: vec![joint.clone()],
                ellipsoids: Vec::new(),
                extent: Some(Vector3::repeat(NOTHING)),
                middle: Vector3::zeros(),
                largest: None,
                displaced: 0.0,
                lifted_at: Vector3::zeros(),
            });
            added.push(name);
        }
        added
    }

    /// Adds a body itself, below so many that its joints move before it.
    fn add(&mut self, body: RobotBody, n_between: usize) {
        let here = self.bodies.len();
        self.first.push(here - n_between);
        self.last.push(here);
        let above = body.parent.map(|parent| self.last[parent]);
        let joints = body.joints[n_between..].to_vec();
        self.bodies.push(match n_between {
            0 => RobotBody { parent: above, ..body },
            _ => RobotBody { parent: Some(here - 1), pose: Pose::identity(), joints, ..body },
        });
    }
}
