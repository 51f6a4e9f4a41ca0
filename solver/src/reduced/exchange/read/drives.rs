//! Motors, tendons and the start of MJCF.

use roxmltree::Node;

use super::bodies::Bodies;
use super::defaults::{Element, OUTSIDE};
use super::source::{Read, children, numbers, refuse, remark};
use crate::reduced::exchange::robot::{JointOf, Motor, MotorLaw, RobotSite, RobotTendon};

/// Motors and tendons, by bodies of the file.
#[derive(Debug, Default)]
pub(super) struct Drives {
    /// Those that are known, in the order of the file, with none where one is left out.
    pub motors: Vec<Option<Motor>>,
    pub tendons: Vec<TendonOfFile>,
}

/// A tendon, whose length at rest may be the one it has where the file has its bodies.
#[derive(Debug, Clone)]
pub(super) struct TendonOfFile {
    pub tendon: RobotTendon,
    pub is_at_rest: bool,
}

impl Drives {
    /// Reads `<actuator>`.
    ///
    /// # Errors
    /// When one names a joint that is not there, or its numbers are wrong.
    pub fn actuators<'a, 'i>(
        &mut self,
        node: Node<'a, 'i>,
        bodies: &mut Bodies<'_, 'a, 'i>,
    ) -> Read<()> {
        for child in children(node) {
            let defaults = bodies.defaults;
            let element = defaults.of(child, OUTSIDE)?;
            let kind = child.tag_name().name();
            let known = ["motor", "position", "velocity"].contains(&kind);
            let motor = match child.attribute("joint") {
                Some(joint) if known => motor(&element, kind, joint, bodies)?,
                _ => {
                    let what = "it is left out: known are motor, position and velocity of a joint";
                    bodies.notes.push(remark(child, what));
                    None
                }
            };
            self.motors.push(motor);
        }
        Ok(())
    }

    /// Reads `<tendon>`.
    ///
    /// # Errors
    /// When a tendon wraps around something, has ends between which it is slack, or passes where nothing is.
    pub fn tendons<'a, 'i>(
        &mut self,
        node: Node<'a, 'i>,
        bodies: &mut Bodies<'_, 'a, 'i>,
    ) -> Read<()> {
        for child in children(node) {
            if !child.has_tag_name("spatial") {
                let what = "it is left out: known are spatial tendons";
                bodies.notes.push(remark(child, what));
                continue;
            }
            let defaults = bodies.defaults;
            let element = defaults.of(child, OUTSIDE)?;
            let number = self.tendons.len();
            if let Some(tendon) = tendon(&element, number, bodies)? {
                self.tendons.push(tendon);
            }
        }
        Ok(())
    }
}

/// The joint of a name.
fn joint_of(node: Node<'_, '_>, name: &str, bodies: &Bodies<'_, '_, '_>) -> Read<JointOf> {
    match bodies.joints.get(name) {
        Some(joint) => Ok(*joint),
        None => {
            let names: Vec<&str> = bodies.joints.keys().map(String::as_str).collect();
            let help = match names.len() {
                0 => "no body has a hinge or a slide".to_owned(),
                _ => format!("hinges and sliders: {}", names.join(", ")),
            };
            refuse(node, format!("there is no joint \"{name}\""), help)
        }
    }
}

/// A motor by its law, as if its gear were one.
fn motor<'a, 'i>(
    element: &Element<'_, 'a, 'i>,
    kind: &str,
    joint: &str,
    bodies: &mut Bodies<'_, 'a, 'i>,
) -> Read<Option<Motor>> {
    let node = element.node;
    let joint = joint_of(node, joint, bodies)?;
    let gear = element.numbers("gear")?.and_then(|gear| gear.first().copied()).unwrap_or(1.0);
    if gear == 0.0 {
        return refuse(node, "its gear is 0", "another one");
    }
    for name in ["dampratio", "timeconst", "inheritrange"] {
        if element.text(name).is_some() {
            bodies.notes.push(remark(node, format!("it is left out: `{name}` is not known")));
            return Ok(None);
        }
    }
    let range = |name: &str, limited: &str| -> Read<Option<[f64; 2]>> {
        let is_free = element.text(limited) == Some("false");
        Ok(element.exactly::<2>(name)?.filter(|_| !is_free))
    };
    let scaled = |[a, b]: [f64; 2], factor: f64| {
        if factor < 0.0 { [b * factor, a * factor] } else { [a * factor, b * factor] }
    };
    let told = range("ctrlrange", "ctrllimited")?;
    let force = range("forcerange", "forcelimited")?.map(|range| scaled(range, gear));
    let square = gear * gear;
    let mut limits = told.map(|range| scaled(range, gear.recip()));
    let law = match kind {
        "velocity" => {
            let limit = match force {
                Some([least, most]) if (least + most).abs() > 1e-12 * most.abs() => {
                    return refuse(node, "`forcerange` is not the same to both sides", "-F F");
                }
                other => other.map(|[_, most]| most),
            };
            MotorLaw::Rate { gain: element.not_negative("kv", 1.0)? * square, limit }
        }
        "position" => {
            if force.is_some() {
                bodies.notes.push(remark(node, "its `forcerange` is left out"));
            }
            let own = &mut bodies.raws[joint.body].joints[joint.nth];
            own.damping += element.not_negative("kv", 0.0)? * square;
            MotorLaw::Place { gain: element.not_negative("kp", 1.0)? * square }
        }
        _ => {
            let efforts = told.map(|range| scaled(range, gear));
            limits = match (efforts, force) {
                (Some(own), Some(force)) => Some([own[0].max(force[0]), own[1].min(force[1])]),
                (own, force) => own.or(force),
            };
            MotorLaw::Effort
        }
    };
    let name = node.attribute("name").unwrap_or(kind).to_owned();
    Ok(Some(Motor {
        name,
        joint,
        law,
        control: if kind == "motor" { gear } else { gear.recip() },
        limits,
    }))
}

fn tendon<'a, 'i>(
    element: &Element<'_, 'a, 'i>,
    number: usize,
    bodies: &mut Bodies<'_, 'a, 'i>,
) -> Read<Option<TendonOfFile>> {
    let node = element.node;
    let mut sites: Vec<RobotSite> = Vec::new();
    for child in children(node) {
        let name = child.attribute("site").filter(|_| child.has_tag_name("site"));
        let Some(name) = name else {
            let tag = child.tag_name().name();
            let what = format!("a tendon through a <{tag}> is not known");
            return refuse(child, what, "a tendon that is straight between its sites");
        };
        match bodies.sites.get(name) {
            Some(site) => sites.push(*site),
            None => {
                let what = format!("there is no site \"{name}\" on a body");
                return refuse(child, what, "the name of a site within a body");
            }
        }
    }
    let stiffness = element.not_negative("stiffness", 0.0)?;
    if stiffness <= 0.0 {
        bodies.notes.push(remark(node, "it is left out: it has no stiffness"));
        return Ok(None);
    }
    let is_limited = element.text("range").is_some() && element.text("limited") != Some("false");
    if is_limited {
        bodies.notes.push(remark(node, "its limits are left out"));
    }
    for name in ["armature", "frictionloss"] {
        if element.number(name, 0.0)? != 0.0 {
            bodies.notes.push(remark(node, format!("its `{name}` is left out")));
        }
    }
    let (rest, pushes, is_at_rest) = match element.numbers("springlength")?.as_deref() {
        None => (0.0, true, true),
        Some([rest]) if *rest < 0.0 => (0.0, true, true),
        Some([rest]) => (*rest, true, false),
        Some([least, most]) if least == most => (*most, true, false),
        Some([least, most]) if *least <= 0.0 => (*most, false, false),
        Some(_) => {
            let help = "one length, or 0 and the length above which it pulls";
            return refuse(node, "a tendon is not slack between two lengths above 0", help);
        }
    };
    let damping = element.not_negative("damping", 0.0)?;
    let name = node.attribute("name").map_or_else(|| format!("tendon-{number}"), str::to_owned);
    let tendon = RobotTendon { name, sites, stiffness, damping, rest, pushes };
    Ok(Some(TendonOfFile { tendon, is_at_rest }))
}

/// Coordinates, velocities and controls of the first keyframe.
#[derive(Debug, Clone, Default)]
pub(super) struct Key {
    pub places: Option<Vec<f64>>,
    pub rates: Option<Vec<f64>>,
    pub controls: Option<Vec<f64>>,
}

/// Reads the first `<key>` of `<keyframe>`, by numbers of coordinates, velocities and controls.
///
/// # Errors
/// When it has another number of them.
pub(super) fn key(node: Node<'_, '_>, counts: [usize; 3]) -> Read<Key> {
    let Some(key) = children(node).find(|child| child.has_tag_name("key")) else {
        return Ok(Key::default());
    };
    let mut found = [None, None, None];
    for ((name, count), found) in ["qpos", "qvel", "ctrl"].into_iter().zip(counts).zip(&mut found) {
        let Some(text) = key.attribute(name) else { continue };
        let values = numbers(key, name, text)?;
        if values.len() != count {
            let what = format!("`{name}` has {} numbers", values.len());
            return refuse(key, what, format!("the model has {count}"));
        }
        *found = Some(values);
    }
    let [places, rates, controls] = found;
    Ok(Key { places, rates, controls })
}
