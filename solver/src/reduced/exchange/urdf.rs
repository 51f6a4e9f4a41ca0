//! A `Robot` as URDF, the XML of ROS.

use alewife_reduced::tree::{JointKind, Pose};
use nalgebra::{Rotation3, Vector3};

use super::markup::{Element, Markup, is_unturned};
use super::robot::{Robot, RobotBody, RobotJoint};

/// What stands for the world, on which bodies hang.
const WORLD: &str = "world";

/// Half of the way of a slider without ends (m): the format asks for ends.
const FAR: f64 = 1e6;

/// The text of a robot, which begins with remarks. A link has its frame at its joint, with the axes of its body.
pub(super) fn urdf(robot: &Robot, remarks: &[String]) -> String {
    let mut out = Markup::new(remarks);
    out.open(&Element::new("robot").with("name", &robot.name));
    let is_based = robot.bodies.iter().any(|body| body.parent.is_none() && !body.is_free);
    if is_based {
        out.put(&Element::new("link").with("name", WORLD));
    }
    for (number, body) in robot.bodies.iter().enumerate() {
        put_link(robot, number, &mut out);
        if body.parent.is_some() || !body.is_free {
            put_joints(robot, number, &mut out);
        }
    }
    out.finish()
}

/// What the file cannot have of a robot.
pub(super) fn missing(robot: &Robot) -> Vec<String> {
    let mut notes = Vec::new();
    let joints = || robot.bodies.iter().flat_map(|body| &body.joints);
    let sprung: Vec<&str> =
        joints().filter(|joint| joint.stiffness != 0.0).map(|joint| joint.name.as_str()).collect();
    let geared: Vec<&str> =
        joints().filter(|joint| joint.armature != 0.0).map(|joint| joint.name.as_str()).collect();
    let motors: Vec<&str> = robot.motors.iter().map(|motor| motor.name.as_str()).collect();
    let tendons: Vec<&str> = robot.tendons.iter().map(|tendon| tendon.name.as_str()).collect();
    for (what, names) in
        [("springs", sprung), ("armature", geared), ("motors", motors), ("tendons", tendons)]
    {
        if !names.is_empty() {
            notes.push(format!("URDF has no {what}: left out are {}", names.join(", ")));
        }
    }
    if robot.fluid.is_some() {
        notes.push(
            "URDF has no fluid: ellipsoids are shown by boxes around them, and have no loads"
                .to_owned(),
        );
    }
    if robot.bodies.iter().any(|body| body.displaced != 0.0) {
        notes.push("URDF has no buoyancy".to_owned());
    }
    let starts = |body: &RobotBody| {
        body.velocity.iter().any(|part| *part != Vector3::zeros())
            || body.joints.iter().any(|joint| joint.start != [0.0; 2])
    };
    if robot.bodies.iter().any(starts) {
        notes.push("URDF has no start: coordinates and velocities there are left out".to_owned());
    }
    if robot.bodies.iter().any(|body| way_of(body) == Way::Floating) {
        notes.push("the keel is left out: the first link floats".to_owned());
    }
    if robot.bodies.iter().any(|body| body.is_free) {
        notes.push(
            "the first link is a base that moves freely, where what reads the file makes it so"
                .to_owned(),
        );
    }
    notes
}

/// Where the frame of a link is in that of its body (m).
fn origin_of(body: &RobotBody) -> Vector3<f64> {
    body.joints.last().map_or_else(Vector3::zeros, |joint| joint.position)
}

/// An origin by position and angles about the fixed axes x, y, z.
fn origin(pose: &Pose<f64>) -> Element {
    let element = Element::new("origin").numbers("xyz", pose.position.as_slice());
    if is_unturned(&pose.rotation) {
        return element;
    }
    let (roll, pitch, yaw) = Rotation3::from_matrix_unchecked(pose.rotation).euler_angles();
    element.numbers("rpy", &[roll, pitch, yaw])
}

fn put_link(robot: &Robot, number: usize, out: &mut Markup) {
    let body = &robot.bodies[number];
    let shift = origin_of(body);
    out.open(&Element::new("link").with("name", &body.name));
    out.open(&Element::new("inertial"));
    out.put(&origin(&Pose::at(body.center - shift)));
    out.put(&Element::new("mass").numbers("value", &[body.mass]));
    let mut element = Element::new("inertia");
    for (name, i, j) in
        [("ixx", 0, 0), ("ixy", 0, 1), ("ixz", 0, 2), ("iyy", 1, 1), ("iyz", 1, 2), ("izz", 2, 2)]
    {
        element = element.numbers(name, &[body.inertia[(i, j)]]);
    }
    out.put(&element);
    out.close();
    let mut shown: Vec<Shown> = body
        .ellipsoids
        .iter()
        .map(|one| Shown { pose: one.pose, semi_axes: one.semi_axes })
        .collect();
    if let Some(semi_axes) = body.extent.filter(|_| shown.is_empty()) {
        shown.push(Shown { pose: Pose::at(body.middle), semi_axes });
    }
    for one in shown {
        out.open(&Element::new("visual"));
        let position = one.pose.position - shift;
        out.put(&origin(&Pose { position, ..one.pose }));
        out.open(&Element::new("geometry"));
        out.put(&Element::new("box").numbers("size", (one.semi_axes * 2.0).as_slice()));
        out.close();
        out.close();
    }
    out.close();
}

/// An ellipsoid as it is shown.
struct Shown {
    pose: Pose<f64>,
    semi_axes: Vector3<f64>,
}

/// How a body moves on what it hangs on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Way {
    /// Not at all.
    Fixed,
    /// Along x and y and about z.
    Planar,
    /// In all ways.
    Floating,
    /// By its joints one after another.
    Joints,
}

fn way_of(body: &RobotBody) -> Way {
    let kinds: Vec<JointKind> = body.joints.iter().map(|joint| joint.kind).collect();
    match kinds[..] {
        [] => Way::Fixed,
        [JointKind::Slider, JointKind::Slider, JointKind::Hinge] => Way::Planar,
        [_, _, _, _, _, _] => Way::Floating,
        _ => Way::Joints,
    }
}

/// The joints above a body; between two of them there is a link without mass.
fn put_joints(robot: &Robot, number: usize, out: &mut Markup) {
    let body = &robot.bodies[number];
    let (mut above, shift) = match body.parent {
        Some(parent) => (robot.bodies[parent].name.clone(), origin_of(&robot.bodies[parent])),
        None => (WORLD.to_owned(), Vector3::zeros()),
    };
    let way = way_of(body);
    if way != Way::Joints {
        let kind = match way {
            Way::Planar => "planar",
            Way::Floating => "floating",
            Way::Fixed | Way::Joints => "fixed",
        };
        let at = body.pose.then(&Pose::at(origin_of(body)));
        let pose = Pose { position: at.position - shift, ..at };
        out.open(&Element::new("joint").with("name", &body.name).with("type", kind));
        ends(&pose, &above, &body.name, out);
        if way == Way::Planar {
            let across = body.joints[2].axis;
            out.put(&Element::new("axis").numbers("xyz", across.as_slice()));
        }
        out.close();
        return;
    }
    let last = body.joints.len() - 1;
    let mut before: Option<Vector3<f64>> = None;
    for (nth, joint) in body.joints.iter().enumerate() {
        // All frames on the way have the axes of the body
        let pose = match before {
            None => {
                let at = body.pose.then(&Pose::at(joint.position));
                Pose { position: at.position - shift, ..at }
            }
            Some(before) => Pose::at(joint.position - before),
        };
        before = Some(joint.position);
        let below = if nth == last { body.name.clone() } else { format!("{}.link", joint.name) };
        if nth < last {
            out.put(&Element::new("link").with("name", &below));
        }
        put_joint(joint, &pose, [&above, &below], out);
        above = below;
    }
}

fn ends(pose: &Pose<f64>, parent: &str, child: &str, out: &mut Markup) {
    out.put(&origin(pose));
    out.put(&Element::new("parent").with("link", parent));
    out.put(&Element::new("child").with("link", child));
}

fn put_joint(joint: &RobotJoint, pose: &Pose<f64>, [parent, child]: [&str; 2], out: &mut Markup) {
    let is_slider = joint.kind == JointKind::Slider;
    let kind = if is_slider { "prismatic" } else { "continuous" };
    out.open(&Element::new("joint").with("name", &joint.name).with("type", kind));
    ends(pose, parent, child, out);
    out.put(&Element::new("axis").numbers("xyz", joint.axis.as_slice()));
    if is_slider {
        let limit = Element::new("limit").numbers("lower", &[-FAR]).numbers("upper", &[FAR]);
        out.put(&limit.numbers("effort", &[FAR]).numbers("velocity", &[FAR]));
    }
    if joint.damping != 0.0 {
        let dynamics = Element::new("dynamics").numbers("damping", &[joint.damping]);
        out.put(&dynamics.with("friction", "0"));
    }
    out.close();
}
