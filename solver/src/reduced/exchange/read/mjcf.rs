//! MJCF as a `Robot`.

use alewife_reduced::tree::Pose;
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};
use roxmltree::Node;

use super::bodies::{Bodies, FLATTEN};
use super::defaults::{Defaults, OUTSIDE};
use super::drives::{Drives, Key, key};
use super::joined::{Found, Joined, Raw, Whereabouts, joined, length_at_zero};
use super::source::{Read, Remark, children, exactly, not_negative, refuse, remark};
use super::turn::Angles;
use crate::reduced::exchange::robot::{
    Fluid, JointOf, Motor, MotorLaw, Robot, RobotSite, RobotTendon,
};

/// Sections of a file that say nothing of a motion.
const SILENT: [&str; 9] =
    ["asset", "compiler", "custom", "default", "option", "sensor", "size", "statistic", "visual"];

/// What `<option>` says.
struct Settings {
    step: f64,
    gravity: Vector3<f64>,
    fluid: Option<Fluid>,
}

/// The robot of a file.
///
/// # Errors
/// When the file has what no case has.
pub(super) fn read(root: Node<'_, '_>) -> Read<Found> {
    let mut defaults = Defaults::none();
    for node in children(root).filter(|node| node.has_tag_name("default")) {
        defaults.add(node, None)?;
    }
    let mut bodies = Bodies {
        defaults: &defaults,
        angles: Angles { unit: std::f64::consts::PI / 180.0, sequence: "xyz".to_owned() },
        by_geoms: None,
        raws: Vec::new(),
        joints: std::collections::BTreeMap::new(),
        sites: std::collections::BTreeMap::new(),
        notes: Vec::new(),
    };
    compiler(root, &mut bodies)?;
    let settings = settings(root)?;
    for node in children(root).filter(|node| node.has_tag_name("worldbody")) {
        world(node, &mut bodies)?;
    }
    let mut drives = Drives::default();
    for node in children(root) {
        match node.tag_name().name() {
            "tendon" => drives.tendons(node, &mut bodies)?,
            "actuator" => drives.actuators(node, &mut bodies)?,
            "worldbody" | "keyframe" => {}
            "equality" if children(node).next().is_none() => {}
            "equality" => {
                let first = children(node).next().unwrap_or(node);
                let what = "the reduced model is a tree: it has no loops and no constraints";
                return refuse(first, what, "a model without <equality>");
            }
            "contact" => {
                bodies.notes.push(remark(node, "it is left out: the reduced model has no contact"));
            }
            tag if SILENT.contains(&tag) => {}
            tag => return refuse(node, format!("<{tag}> is not known"), FLATTEN),
        }
    }
    let start = start(root, &bodies, &drives)?;
    whole(root, bodies, &drives, &start, &settings)
}

fn compiler(root: Node<'_, '_>, bodies: &mut Bodies<'_, '_, '_>) -> Read<()> {
    for node in children(root).filter(|node| node.has_tag_name("compiler")) {
        for (name, absent) in
            [("coordinate", "local"), ("settotalmass", "-1"), ("fusestatic", "false")]
        {
            if node.attribute(name).is_some_and(|value| value != absent) && name != "fusestatic" {
                let what = format!("`{name}` is not known");
                return refuse(node, what, FLATTEN);
            }
        }
        match node.attribute("angle") {
            Some("radian") => bodies.angles.unit = 1.0,
            Some("degree") | None => {}
            Some(other) => {
                let what = format!("`angle` is \"{other}\"");
                return refuse(node, what, "radian or degree");
            }
        }
        if let Some(sequence) = node.attribute("eulerseq") {
            bodies.angles.sequence = sequence.to_owned();
        }
        match node.attribute("inertiafromgeom") {
            Some("true") => bodies.by_geoms = Some(true),
            Some("false") => bodies.by_geoms = Some(false),
            _ => {}
        }
    }
    Ok(())
}

fn settings(root: Node<'_, '_>) -> Read<Settings> {
    let mut settings =
        Settings { step: 0.002, gravity: Vector3::new(0.0, 0.0, -9.81), fluid: None };
    let (mut density, mut viscosity) = (0.0, 0.0);
    for node in children(root).filter(|node| node.has_tag_name("option")) {
        let one = |name: &str, absent: f64| -> Read<f64> {
            let text = node.attribute(name);
            let [value] = text.map_or(Ok([absent]), |text| exactly::<1>(node, name, text))?;
            not_negative(node, name, value)
        };
        settings.step = one("timestep", settings.step)?;
        (density, viscosity) = (one("density", density)?, one("viscosity", viscosity)?);
        if let Some(text) = node.attribute("gravity") {
            settings.gravity = exactly::<3>(node, "gravity", text)?.into();
        }
        if let Some(text) = node.attribute("wind")
            && exactly::<3>(node, "wind", text)? != [0.0; 3]
        {
            let what = "the reduced model has its fluid at rest, and there is wind";
            return refuse(node, what, "leave out `wind`");
        }
        let flags = || children(node).filter(|flag| flag.has_tag_name("flag"));
        if flags().any(|flag| flag.attribute("gravity") == Some("disable")) {
            settings.gravity = Vector3::zeros();
        }
        for name in ["passive", "spring", "damper", "actuation"] {
            if let Some(flag) = flags().find(|flag| flag.attribute(name) == Some("disable")) {
                let what = format!("`{name}` is switched off");
                return refuse(flag, what, "leave it on");
            }
        }
        if settings.step == 0.0 {
            return refuse(node, "`timestep` is 0", "a number above 0");
        }
    }
    settings.fluid = (density > 0.0 || viscosity > 0.0).then_some(Fluid { density, viscosity });
    Ok(settings)
}

/// What stands in the world.
fn world<'a, 'i>(node: Node<'a, 'i>, bodies: &mut Bodies<'_, 'a, 'i>) -> Read<()> {
    for child in children(node) {
        match child.tag_name().name() {
            "body" => bodies.read(child, None, OUTSIDE)?,
            "camera" | "light" => {}
            "geom" => {
                let what = "it is left out: the reduced model has no walls";
                bodies.notes.push(remark(child, what));
            }
            "site" => {}
            tag => return refuse(child, format!("<{tag}> in the world is not known"), FLATTEN),
        }
    }
    Ok(())
}

/// Where the model starts: as its first keyframe says.
fn start(root: Node<'_, '_>, bodies: &Bodies<'_, '_, '_>, drives: &Drives) -> Read<Key> {
    let (mut n_places, mut n_rates) = (0, 0);
    for raw in &bodies.raws {
        n_places += if raw.is_free { 7 } else { raw.joints.len() };
        n_rates += if raw.is_free { 6 } else { raw.joints.len() };
    }
    let Some(node) = children(root).find(|node| node.has_tag_name("keyframe")) else {
        return Ok(Key::default());
    };
    let key = key(node, [n_places, n_rates, drives.motors.len()])?;
    let mut at = 0;
    for raw in &bodies.raws {
        let q = key.places.as_ref().filter(|_| raw.is_free).map(|places| &places[at + 3..at + 7]);
        if q.is_some_and(|q| q.iter().all(|part| part.abs() < 1e-12)) {
            let what = format!("`qpos` has no rotation of \"{}\"", raw.name);
            return refuse(node, what, "a quaternion that is not zero");
        }
        at += if raw.is_free { 7 } else { raw.joints.len() };
    }
    Ok(key)
}

/// Puts a free body where it starts, and its joints; gives the velocities of free bodies, of the origin in axes of the world
/// and of the rotation in their own.
fn place(raws: &mut [Raw], key: &Key) -> Vec<[Vector3<f64>; 2]> {
    let mut velocities = vec![[Vector3::zeros(); 2]; raws.len()];
    let (mut at, mut rate) = (0, 0);
    for (raw, velocity) in raws.iter_mut().zip(&mut velocities) {
        if raw.is_free {
            if let Some(q) = &key.places {
                let own = Quaternion::new(q[at + 3], q[at + 4], q[at + 5], q[at + 6]);
                let position = Vector3::new(q[at], q[at + 1], q[at + 2]);
                let is_unturned = own == Quaternion::identity();
                let turn = UnitQuaternion::from_quaternion(own).to_rotation_matrix();
                let rotation = if is_unturned { Matrix3::identity() } else { *turn.matrix() };
                raw.pose = Pose { rotation, position };
            }
            if let Some(v) = &key.rates {
                let three = |from: usize| Vector3::new(v[from], v[from + 1], v[from + 2]);
                *velocity = [three(rate), three(rate + 3)];
            }
            (at, rate) = (at + 7, rate + 6);
            continue;
        }
        for joint in &mut raw.joints {
            if let Some(q) = &key.places {
                joint.start[0] = q[at] - joint.from;
            }
            if let Some(v) = &key.rates {
                joint.start[1] = v[rate];
            }
            (at, rate) = (at + 1, rate + 1);
        }
    }
    velocities
}

/// The robot of all that was read.
fn whole(
    root: Node<'_, '_>,
    bodies: Bodies<'_, '_, '_>,
    drives: &Drives,
    start: &Key,
    settings: &Settings,
) -> Read<Found> {
    let (mut raws, mut notes) = (bodies.raws, bodies.notes);
    let velocities = place(&mut raws, start);
    let Joined { bodies: mut made, places, notes: more } = joined(&raws)?;
    notes.extend(more);
    for (place, [linear, angular]) in places.iter().zip(velocities) {
        let Some(body) = place.body.filter(|body| made[*body].is_free) else { continue };
        let body = &mut made[body];
        let turned = body.pose.rotation * angular;
        let arm = body.pose.rotation * body.center;
        if linear != Vector3::zeros() || turned != Vector3::zeros() {
            body.velocity = [linear + turned.cross(&arm), turned];
        }
    }
    let motors = drives.motors.iter().enumerate().filter_map(|(nth, motor)| {
        let motor = motor.as_ref()?;
        let joint = JointOf { body: places[motor.joint.body].body?, ..motor.joint };
        let told = start.controls.as_ref().map_or(0.0, |all| all[nth]);
        // Targets count as the joint's coordinate does in the file
        let from = match motor.law {
            MotorLaw::Place { .. } => raws[motor.joint.body].joints[motor.joint.nth].from,
            MotorLaw::Effort | MotorLaw::Rate { .. } => 0.0,
        };
        let limits = motor.limits.map(|range| range.map(|end| end - from));
        // Until here it is what a control is multiplied by
        Some(Motor { joint, control: told * motor.control - from, limits, ..motor.clone() })
    });
    let motors: Vec<Motor> = motors.collect();
    let tendons = drives.tendons.iter().map(|one| {
        let sites = one.tendon.sites.iter().filter_map(|site| moved(site, &places));
        let tendon = RobotTendon { sites: sites.collect(), ..one.tendon.clone() };
        let rest = if one.is_at_rest { length_at_zero(&made, &tendon) } else { tendon.rest };
        RobotTendon { rest, ..tendon }
    });
    let tendons: Vec<RobotTendon> = tendons.collect();
    for one in drives.tendons.iter().zip(&tendons) {
        if one.0.tendon.sites.len() != one.1.sites.len() {
            let what = format!("the tendon \"{}\" ends at what does not move", one.1.name);
            return Err(Remark {
                help: Some("sites on bodies that move".to_owned()),
                ..remark(root, what)
            });
        }
    }
    if settings.fluid.is_some() {
        for (raw, place) in raws.iter().zip(&places) {
            if place.body.is_some_and(|body| made[body].ellipsoids.is_empty()) {
                let what = "MuJoCo has the loads of a box on it, the case has those of an ellipsoid in the \
                            place of its largest geom: none has fluidshape=\"ellipsoid\"";
                notes.push(super::joined::said(&raw.element, what));
            }
        }
        for body in made.iter_mut().filter(|body| body.ellipsoids.is_empty()) {
            body.ellipsoids.extend(body.largest);
        }
    }
    let name = root.attribute("model").unwrap_or("model").to_owned();
    let Settings { step, gravity, fluid } = *settings;
    let robot = Robot { name, gravity, step, fluid, bodies: made, motors, tendons };
    Ok(Found { robot, notes })
}

/// A site on the body that its own has become part of.
fn moved(site: &RobotSite, places: &[Whereabouts]) -> Option<RobotSite> {
    let place = places[site.body];
    let position = place.pose.position + place.pose.rotation * site.position;
    Some(RobotSite { body: place.body?, position })
}
