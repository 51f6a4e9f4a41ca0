//! A `Robot` as MJCF, the XML of `MuJoCo`.

use alewife_reduced::tree::{JointKind, Pose};
use nalgebra::{Rotation3, UnitQuaternion};

use super::markup::{Element, Markup, is_unturned, numbers};
use super::robot::{MotorLaw, Robot, RobotBody, RobotJoint};

/// The text of a robot, which begins with remarks.
pub(super) fn mjcf(robot: &Robot, remarks: &[String]) -> String {
    let mut out = Markup::new(remarks);
    out.open(&Element::new("mujoco").with("model", &robot.name));
    out.put(&Element::new("compiler").with("angle", "radian").with("autolimits", "true"));
    options(robot, &mut out);
    out.open(&Element::new("default"));
    // Nothing touches: the case has no contact
    out.put(
        &Element::new("geom")
            .with("type", "ellipsoid")
            .with("contype", "0")
            .with("conaffinity", "0"),
    );
    out.close();
    out.open(&Element::new("worldbody"));
    for (number, body) in robot.bodies.iter().enumerate() {
        if body.parent.is_none() {
            put_body(robot, number, &mut out);
        }
    }
    out.close();
    tendons(robot, &mut out);
    motors(robot, &mut out);
    start(robot, &mut out);
    out.finish()
}

/// What of the robot is otherwise in the file.
pub(super) fn otherwise(robot: &Robot) -> Vec<String> {
    let given = robot.motors.iter().filter(|one| matches!(one.law, MotorLaw::Place { .. }));
    let names: Vec<String> = given
        .map(|motor| {
            let joint = &robot.bodies[motor.joint.body].joints[motor.joint.nth];
            format!("\"{}\"", joint.name)
        })
        .collect();
    if names.is_empty() {
        return Vec::new();
    }
    vec![format!(
        "the case gives the motion of the joints {}: motors of this name with .place and .rate behind it follow \
         the coordinate and the rate that they are told",
        names.join(", ")
    )]
}

fn options(robot: &Robot, out: &mut Markup) {
    let mut option = Element::new("option")
        .numbers("timestep", &[robot.step])
        .with("integrator", "implicitfast")
        .numbers("gravity", robot.gravity.as_slice());
    if let Some(fluid) = robot.fluid {
        option =
            option.numbers("density", &[fluid.density]).numbers("viscosity", &[fluid.viscosity]);
    }
    out.put(&option);
}

/// Position and rotation of a frame.
fn placed(element: Element, pose: &Pose<f64>) -> Element {
    let element = element.unless("pos", &pose.position, [0.0; 3]);
    if is_unturned(&pose.rotation) {
        return element;
    }
    let rotation = Rotation3::from_matrix_unchecked(pose.rotation);
    let q = UnitQuaternion::from_rotation_matrix(&rotation);
    element.numbers("quat", &[q.w, q.i, q.j, q.k])
}

/// A body with all that hangs on it.
fn put_body(robot: &Robot, number: usize, out: &mut Markup) {
    let body = &robot.bodies[number];
    let element = placed(Element::new("body").with("name", &body.name), &body.pose);
    let lift = if body.mass > 0.0 { body.displaced / body.mass } else { 0.0 };
    out.open(&element.unless_zero("gravcomp", lift));
    if body.is_free {
        out.put(&Element::new("freejoint").with("name", &body.name));
    }
    for joint in &body.joints {
        put_joint(joint, out);
    }
    put_inertia(body, out);
    put_geoms(body, out);
    for one in robot.sites().filter(|one| one.site.body == number) {
        let name = site_name(&robot.tendons[one.tendon].name, one.nth);
        let place = one.site.position;
        out.put(&Element::new("site").with("name", name).numbers("pos", place.as_slice()));
    }
    for (child, one) in robot.bodies.iter().enumerate() {
        if one.parent == Some(number) {
            put_body(robot, child, out);
        }
    }
    out.close();
}

fn put_joint(joint: &RobotJoint, out: &mut Markup) {
    let kind = if joint.kind == JointKind::Slider { "slide" } else { "hinge" };
    let element = Element::new("joint")
        .with("name", &joint.name)
        .with("type", kind)
        .unless("pos", &joint.position, [0.0; 3])
        .numbers("axis", joint.axis.as_slice())
        .unless_zero("stiffness", joint.stiffness)
        .unless_zero("springref", joint.rest)
        .unless_zero("damping", joint.damping)
        .unless_zero("armature", joint.armature);
    out.put(&element);
}

fn put_inertia(body: &RobotBody, out: &mut Markup) {
    let i = &body.inertia;
    let element = Element::new("inertial")
        .numbers("pos", body.center.as_slice())
        .numbers("mass", &[body.mass]);
    if [i[(0, 1)], i[(0, 2)], i[(1, 2)]] == [0.0; 3] {
        out.put(&element.numbers("diaginertia", i.diagonal().as_slice()));
        return;
    }
    // By its axes: of the whole tensor MuJoCo finds them to 1e-10 only
    let own = i.symmetric_eigen();
    let mut axes = own.eigenvectors;
    if axes.determinant() < 0.0 {
        axes.column_mut(2).neg_mut();
    }
    let q = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
    let element = element.numbers("quat", &[q.w, q.i, q.j, q.k]);
    out.put(&element.numbers("diaginertia", own.eigenvalues.as_slice()));
}

fn put_geoms(body: &RobotBody, out: &mut Markup) {
    for ellipsoid in &body.ellipsoids {
        let element = placed(Element::new("geom"), &ellipsoid.pose)
            .numbers("size", ellipsoid.semi_axes.as_slice())
            .with("fluidshape", "ellipsoid")
            .numbers("fluidcoef", &ellipsoid.coefficients);
        out.put(&element);
    }
    // What is only seen
    if let Some(extent) = body.extent.filter(|_| body.ellipsoids.is_empty()) {
        let element = Element::new("geom").unless("pos", &body.middle, [0.0; 3]);
        out.put(&element.numbers("size", extent.as_slice()));
    }
}

/// The name of a point of a tendon.
fn site_name(tendon: &str, nth: usize) -> String {
    format!("{tendon}.{}", nth + 1)
}

fn tendons(robot: &Robot, out: &mut Markup) {
    if robot.tendons.is_empty() {
        return;
    }
    out.open(&Element::new("tendon"));
    for tendon in &robot.tendons {
        // Between two lengths there is no force: slack where it is shorter
        let rest =
            if tendon.pushes { numbers(&[tendon.rest]) } else { numbers(&[0.0, tendon.rest]) };
        out.open(
            &Element::new("spatial")
                .with("name", &tendon.name)
                .numbers("stiffness", &[tendon.stiffness])
                .unless_zero("damping", tendon.damping)
                .with("springlength", rest),
        );
        for nth in 0..tendon.sites.len() {
            out.put(&Element::new("site").with("site", site_name(&tendon.name, nth)));
        }
        out.close();
    }
    out.close();
}

fn motors(robot: &Robot, out: &mut Markup) {
    if robot.motors.is_empty() {
        return;
    }
    out.open(&Element::new("actuator"));
    for motor in &robot.motors {
        let kind = match motor.law {
            MotorLaw::Effort => "motor",
            MotorLaw::Place { .. } => "position",
            MotorLaw::Rate { .. } => "velocity",
        };
        let joint = &robot.bodies[motor.joint.body].joints[motor.joint.nth].name;
        let mut element = Element::new(kind).with("name", &motor.name).with("joint", joint);
        match motor.law {
            MotorLaw::Effort => {}
            MotorLaw::Place { gain } => element = element.numbers("kp", &[gain]),
            MotorLaw::Rate { gain, limit } => {
                element = element.numbers("kv", &[gain]);
                if let Some(limit) = limit {
                    element = element.numbers("forcerange", &[-limit, limit]);
                }
            }
        }
        if let Some(limits) = motor.limits {
            element = element.numbers("ctrlrange", &limits);
        }
        out.put(&element);
    }
    out.close();
}

/// The state that the case starts from, in the order in which `MuJoCo` counts coordinates: depth first.
fn start(robot: &Robot, out: &mut Markup) {
    let (mut places, mut rates) = (Vec::new(), Vec::new());
    for number in robot.depth_first() {
        let body = &robot.bodies[number];
        if body.is_free {
            let rotation = Rotation3::from_matrix_unchecked(body.pose.rotation);
            let q = UnitQuaternion::from_rotation_matrix(&rotation);
            places.extend_from_slice(body.pose.position.as_slice());
            places.extend([q.w, q.i, q.j, q.k]);
            // Its origin in the axes of the world, and its angular velocity in its own
            let [linear, angular] = body.velocity;
            let arm = body.pose.rotation * body.center;
            rates.extend_from_slice((linear - angular.cross(&arm)).as_slice());
            rates.extend_from_slice(body.pose.rotation.tr_mul(&angular).as_slice());
        }
        places.extend(body.joints.iter().map(|joint| joint.start[0]));
        rates.extend(body.joints.iter().map(|joint| joint.start[1]));
    }
    if places.is_empty() {
        return;
    }
    let mut key = Element::new("key").with("name", "start").numbers("qpos", &places);
    if rates.iter().any(|rate| *rate != 0.0) {
        key = key.numbers("qvel", &rates);
    }
    let controls: Vec<f64> = robot.motors.iter().map(|motor| motor.control).collect();
    if !controls.is_empty() {
        key = key.numbers("ctrl", &controls);
    }
    out.open(&Element::new("keyframe"));
    out.put(&key);
    out.close();
}
