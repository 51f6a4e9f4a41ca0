//! A `Robot` as the text of a case.

use std::fmt::Write as _;

use alewife_reduced::tree::{JointKind, Pose, rotation};
use nalgebra::{Rotation3, UnitQuaternion, UnitVector3, Vector3};

use super::driven::{Drive, drives};
use super::mass::Mass;
use super::several_joints::keel_of;
use super::source::Remark;
use super::words::{Names, float, list, plain, quaternion, quoted};
use crate::case::KeelSpec;
use crate::reduced::exchange::markup::is_unturned;
use crate::reduced::exchange::robot::{Robot, RobotBody, RobotEllipsoid, RobotJoint};
use crate::reduced::hung::angle_about;

/// Density (kg/m3) and dynamic viscosity (Pa s) of water at 20 degrees, of a model without a fluid.
const WATER: [f64; 2] = [998.2, 1.002e-3];

/// Viscosity (Pa s) of a model that has none: a case has one above 0.
const NONE: f64 = 1e-30;

/// End of the motion (s), which no model has.
const END: f64 = 1.0;

/// What stands before the line of a joint on command, in place of which the next line keeps what the motor starts with.
const ON_COMMAND: &str = "# ";

/// Text in the making.
struct Text<'a> {
    robot: &'a Robot,
    keel: Option<KeelSpec>,
    /// What drives the joint above each body.
    drives: Vec<Drive>,
    /// Frames of the bodies in the world at the start.
    poses: Vec<Pose<f64>>,
    /// Their angular velocities then.
    turning: Vec<Vector3<f64>>,
    notes: Vec<Remark>,
    out: String,
}

/// The text of a case of a robot from a file of this name; with what a case has not of it.
pub(super) fn text(robot: &Robot, file: &str, notes: &mut Vec<Remark>) -> String {
    let keel = keel_of(&robot.bodies[0]);
    let poses = poses_at_start(robot);
    let mut text = Text {
        robot,
        drives: drives(robot),
        keel,
        turning: turning_at_start(robot, &poses),
        poses,
        notes: Vec::new(),
        out: String::new(),
    };
    text.head(file, notes);
    for number in 0..robot.bodies.len() {
        text.body(number);
    }
    for number in 0..robot.bodies.len() {
        text.joint(number);
    }
    text.reduced();
    notes.extend(text.notes);
    text.out
}

/// Frames of the bodies in the world where joints are at their starts.
fn poses_at_start(robot: &Robot) -> Vec<Pose<f64>> {
    let mut poses: Vec<Pose<f64>> = Vec::new();
    for body in &robot.bodies {
        let above = body.parent.map_or_else(Pose::identity, |parent| poses[parent]);
        let mut pose = above.then(&body.pose);
        for joint in &body.joints {
            let [start, _] = joint.start;
            if start == 0.0 {
                continue;
            }
            if joint.kind == JointKind::Slider {
                pose.position += pose.rotation * joint.axis * start;
                continue;
            }
            let anchor = pose.then(&Pose::at(joint.position)).position;
            pose.rotation *= rotation(&joint.axis, start);
            pose.position = anchor - pose.rotation * joint.position;
        }
        poses.push(pose);
    }
    poses
}

/// Angular velocities of the bodies at the start, by which a case has the rates of its hinges.
fn turning_at_start(robot: &Robot, poses: &[Pose<f64>]) -> Vec<Vector3<f64>> {
    let mut turning: Vec<Vector3<f64>> = Vec::new();
    for (body, pose) in robot.bodies.iter().zip(poses) {
        let mut own = body.parent.map_or(body.velocity[1], |parent| turning[parent]);
        // Its axis stays where it is as it turns
        if let Some(joint) = body.joints.first().filter(|joint| joint.kind == JointKind::Hinge) {
            own += pose.rotation * joint.axis * joint.start[1];
        }
        turning.push(own);
    }
    turning
}

/// The coordinate that a case has where that of a model is zero: the angle between both bodies about the axis.
fn angle_at_zero(body: &RobotBody, joint: &RobotJoint) -> f64 {
    if joint.kind == JointKind::Slider || is_unturned(&body.pose.rotation) {
        return 0.0;
    }
    let turn = Rotation3::from_matrix_unchecked(body.pose.rotation);
    let axis = UnitVector3::new_unchecked(body.pose.rotation * joint.axis);
    let angle = angle_about(&axis, &UnitQuaternion::from_rotation_matrix(&turn));
    if angle.abs() < 1e-12 { 0.0 } else { angle }
}

impl Text<'_> {
    /// A line; writing to a text cannot fail.
    fn line(&mut self, line: &str) {
        let _ = writeln!(self.out, "{line}");
    }

    /// Title, fluid and time, with what was left out.
    fn head(&mut self, file: &str, notes: &[Remark]) {
        let robot = self.robot;
        self.line(&format!("# {}, of {}, by alewife import", plain(&robot.name), plain(file)));
        for note in notes {
            let text = plain(&Remark { help: None, ..note.clone() }.to_string());
            self.line(&format!("# line {text}"));
        }
        self.line(&format!("title = {}", quoted(&format!("{} of {file}", robot.name))));
        self.line("geometry = \"spatial\"\nunits = \"SI\"\n\n[fluid]\nmodel = \"navier-stokes\"");
        let [mut density, mut viscosity] = WATER;
        if let Some(fluid) = robot.fluid {
            (density, viscosity) = (fluid.density.max(NONE), fluid.viscosity.max(NONE));
        }
        self.line(&format!("density = {}", float(density)));
        self.line(&format!("viscosity = {}", float(viscosity)));
        if robot.gravity != Vector3::zeros() {
            self.line(&format!("gravity = {}", list(robot.gravity.as_slice())));
        }
        let [step, end] = [robot.step, END].map(float);
        self.line(&format!("\n[time.unsteady]\nstep = {step}\nend = {end}"));
    }

    fn body(&mut self, number: usize) {
        let (robot, pose) = (self.robot, self.poses[number]);
        let body = &robot.bodies[number];
        let own = Mass { mass: body.mass, center: body.center, inertia: body.inertia };
        let extent = body.extent.unwrap_or_else(|| own.ellipsoid());
        self.line(&format!("\n[[body]]\nname = {}", quoted(&body.name)));
        self.line(&format!("shape.ellipsoid.semi_axes = {}", list(extent.as_slice())));
        self.line(&format!("center = {}", list(pose.position.as_slice())));
        if !is_unturned(&pose.rotation) {
            self.line(&format!("orientation.quaternion = {}", quaternion(&pose.rotation)));
        }
        self.line(&format!("mass = {}", float(body.mass)));
        self.line(&format!("center_of_mass = {}", list(body.center.as_slice())));
        let i = &body.inertia;
        let even = (i + i.transpose()) * 0.5;
        let rows: Vec<String> =
            (0..3).map(|row| list(&[even[(row, 0)], even[(row, 1)], even[(row, 2)]])).collect();
        self.line(&format!("inertia = [{}]", rows.join(", ")));
        let is_held = number == 0 && !body.is_free && body.joints.is_empty();
        self.line(&format!("motion = \"{}\"", if is_held { "held" } else { "free" }));
        let [linear, _] = body.velocity;
        if body.is_free && linear != Vector3::zeros() {
            self.line(&format!("velocity = {}", list(linear.as_slice())));
        }
        let angular = self.turning[number];
        // Those of what slides are its parent's
        let turns = body.joints.first().map_or(body.is_free, |one| one.kind == JointKind::Hinge);
        if turns && self.keel.is_none() && angular != Vector3::zeros() {
            self.line(&format!("angular_velocity = {}", list(angular.as_slice())));
        }
    }

    fn joint(&mut self, number: usize) {
        let robot = self.robot;
        let body = &robot.bodies[number];
        let Some(joint) = body.joints.first().filter(|_| number > 0 || self.keel.is_none()) else {
            return;
        };
        let parent = body.parent.map_or("laboratory", |parent| &robot.bodies[parent].name);
        let on_parent = body.pose.then(&Pose::at(joint.position)).position;
        let from = angle_at_zero(body, joint);
        if from != 0.0 {
            let what = format!(
                "the angle of the joint above \"{}\" counts from the frames of both bodies: it is that of \
                 the file and {}",
                body.name,
                float(from - joint.from)
            );
            self.note(what);
        }
        let is_far = (from + joint.start[0]).abs() > std::f64::consts::PI;
        if is_far
            && joint.kind == JointKind::Hinge
            && joint.stiffness + self.drives[number].stiffness != 0.0
        {
            self.note(format!(
                "the joint above \"{}\" starts more than half a turn from zero: the case counts its angle, and \
                 has its spring, from the nearest turn",
                body.name
            ));
        }
        if joint.start[1] != 0.0 && joint.kind == JointKind::Slider {
            self.note(format!(
                "the velocity at the start of the joint above \"{}\" is left out",
                body.name
            ));
        }
        let kind = self.kind(number, joint, from);
        let name = if joint.kind == JointKind::Slider { "slider" } else { "hinge" };
        self.line(&format!("\n[[joint]]\nparent = {}", quoted(parent)));
        self.line(&format!("child = {}", quoted(&body.name)));
        self.line(&format!("on_parent = {}", list(on_parent.as_slice())));
        if joint.position != Vector3::zeros() {
            self.line(&format!("on_child = {}", list(joint.position.as_slice())));
        }
        let [constant, command] = self.effort(number, joint).unwrap_or_default();
        if !command.is_empty() {
            self.line(
                "# The effort its motors start with; on command of a session or an environment:",
            );
            self.line(&format!("{ON_COMMAND}kind.{name} = {{ {kind}{command} }}"));
        }
        self.line(&format!("kind.{name} = {{ {kind}{constant} }}"));
    }

    /// What a joint lets a body do, whose coordinate counts from a place.
    fn kind(&self, number: usize, joint: &RobotJoint, from: f64) -> String {
        let axis = self.robot.bodies[number].pose.rotation * joint.axis;
        let drive = self.drives[number];
        let stiffness = joint.stiffness + drive.stiffness;
        let mut kind = format!("axis = {}", list(axis.as_slice()));
        if joint.kind == JointKind::Slider {
            kind = format!("along = {}", list(axis.as_slice()));
        }
        if stiffness != 0.0 {
            let rest = from + joint.rest * joint.stiffness / stiffness;
            let _ = write!(kind, ", stiffness = {}", float(stiffness));
            if rest != 0.0 {
                let _ = write!(kind, ", rest = {}", float(rest));
            }
        }
        let damping = joint.damping + drive.damping;
        if damping != 0.0 {
            let _ = write!(kind, ", damping = {}", float(damping));
        }
        kind
    }

    /// The effort that a motor starts with, which it keeps, and the same on command.
    fn effort(&self, number: usize, joint: &RobotJoint) -> Option<[String; 2]> {
        let effort = self.drives[number].effort?;
        let name = if joint.kind == JointKind::Slider { "force" } else { "torque" };
        let limits =
            effort.limits.map_or_else(String::new, |ends| format!(", limits = {}", list(&ends)));
        let (start, filter) = (float(effort.start), float(self.robot.step));
        Some([
            format!(", {name}.constant = {start}"),
            format!(", {name}.command = {{ start = {start}{limits}, filter = {filter} }}"),
        ])
    }

    fn note(&mut self, what: String) {
        self.line(&format!("# {what}"));
        self.notes.push(Remark { line: 1, element: None, what, help: None });
    }

    /// `[reduced]`.
    fn reduced(&mut self) {
        let robot = self.robot;
        self.line("\n[reduced]");
        if robot.fluid.is_some() {
            self.line(
                "# As MuJoCo 3 has it; leave both out for all of the added mass and of the lift",
            );
            self.line("loads = \"ellipsoid\"\nadded_mass = \"mujoco\"\nlift = \"mujoco-3\"");
            for body in &robot.bodies {
                if let Some(ellipsoid) = body.ellipsoids.first() {
                    let c = ellipsoid.coefficients.map(float);
                    let [blunt, slender, angular, kutta, magnus] = &c;
                    self.line(&format!(
                        "body.{} = {{ blunt = {blunt}, slender = {slender}, angular = {angular}, \
                         kutta = {kutta}, magnus = {magnus} }}",
                        body.name
                    ));
                }
            }
        } else {
            self.line("# No loads of the fluid, as the file has none; \"ellipsoid\" has those of ellipsoids");
            self.line("loads = \"fossen\"");
        }
        self.keel_and_servos();
        self.buoyancy();
        self.ellipsoids();
        self.tendons();
    }

    fn keel_and_servos(&mut self) {
        if let Some(keel) = self.keel.clone() {
            let [heave, damping] = [keel.heave_stiffness, keel.heave_damping].map(float);
            let [tilt, tilt_damping] = [keel.tilt_stiffness, keel.tilt_damping].map(float);
            let position = list(&keel.position.unwrap_or_default());
            self.line(&format!(
                "keel = {{ position = {position}, heave_stiffness = {heave}, heave_damping = {damping}, \
                 tilt_stiffness = {tilt}, tilt_damping = {tilt_damping} }}"
            ));
        }
        let served = self.robot.bodies.iter().zip(&self.drives);
        let servos: Vec<String> = served
            .filter_map(|(body, drive)| {
                let servo = drive.servo?;
                let limit = servo
                    .limit
                    .map_or_else(String::new, |limit| format!(", limit = {}", float(limit)));
                let (rate, gain) = (float(servo.rate), float(servo.gain));
                let joint = quoted(&body.name);
                Some(format!("    {{ joint = {joint}, rate = {rate}, gain = {gain}{limit} }},"))
            })
            .collect();
        if !servos.is_empty() {
            self.line(&format!("servo = [\n{}\n]", servos.join("\n")));
        }
        if self.keel.is_none() {
            self.armature(0);
        }
        (1..self.robot.bodies.len()).for_each(|body| self.armature(body));
    }

    /// What turns with the joint of a body alone.
    fn armature(&mut self, number: usize) {
        let body = &self.robot.bodies[number];
        if let Some(joint) = body.joints.first().filter(|joint| joint.armature != 0.0) {
            self.line(&format!("armature.{} = {}", body.name, float(joint.armature)));
        }
    }

    /// What lifts bodies where they have weight.
    fn buoyancy(&mut self) {
        let robot = self.robot;
        if robot.gravity == Vector3::zeros() {
            return;
        }
        let density = robot.fluid.map_or(WATER[0], |fluid| fluid.density.max(NONE));
        for body in &robot.bodies {
            let volume = float(body.displaced / density);
            let center = list(body.lifted_at.as_slice());
            let name = &body.name;
            self.line(&format!("buoyancy.{name} = {{ volume = {volume}, center = {center} }}"));
        }
    }

    fn ellipsoids(&mut self) {
        let robot = self.robot;
        if robot.fluid.is_none() || robot.bodies.iter().all(|body| body.ellipsoids.is_empty()) {
            return;
        }
        self.line("ellipsoid = [");
        for body in &robot.bodies {
            for RobotEllipsoid { pose, semi_axes, .. } in &body.ellipsoids {
                let (name, at) = (quoted(&body.name), list(pose.position.as_slice()));
                let turned = match is_unturned(&pose.rotation) {
                    true => String::new(),
                    false => format!(", orientation.quaternion = {}", quaternion(&pose.rotation)),
                };
                let axes = list(semi_axes.as_slice());
                self.line(&format!(
                    "    {{ body = {name}, position = {at}, semi_axes = {axes}{turned} }},"
                ));
            }
        }
        self.line("]");
    }

    fn tendons(&mut self) {
        let robot = self.robot;
        let mut names = Names::default();
        for tendon in &robot.tendons {
            self.line(&format!("\n[[reduced.tendon]]\nname = {}", quoted(&names.of(&tendon.name))));
            self.line(&format!("stiffness = {}", float(tendon.stiffness)));
            self.line(&format!("damping = {}", float(tendon.damping)));
            self.line(&format!("rest = {}", float(tendon.rest)));
            self.line(&format!("pushes = {}\nsites = [", tendon.pushes));
            for site in &tendon.sites {
                let (body, at) = (&robot.bodies[site.body].name, list(site.position.as_slice()));
                self.line(&format!("    {{ body = {}, position = {at} }},", quoted(body)));
            }
            self.line("]");
        }
    }
}
