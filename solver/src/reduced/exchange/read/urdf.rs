//! URDF as a `Robot`.

use std::collections::BTreeMap;

use alewife_reduced::tree::{JointKind, Pose};
use nalgebra::{Matrix3, Vector3};
use roxmltree::Node;

use super::joined::{Found, Joined, MOST_BODIES, Raw, joined};
use super::mass::{Mass, Solid};
use super::source::{Read, Remark, children, exactly, not_negative, refuse, remark, unit};
use super::turn::roll_pitch_yaw;
use crate::reduced::exchange::robot::{Robot, RobotJoint};

/// The time step of a model whose file has none (s).
const STEP: f64 = 0.002;

/// The elements of links and joints, by names.
struct File<'a, 'i> {
    links: BTreeMap<&'a str, Node<'a, 'i>>,
    /// Joints by the links above them, in the order of the file.
    below: BTreeMap<&'a str, Vec<Node<'a, 'i>>>,
    notes: Vec<Remark>,
    raws: Vec<Raw>,
}

/// The robot of a file: its first link moves freely, unless it is "world" or has no mass.
///
/// # Errors
/// When the file has what no case has.
pub(super) fn read(root: Node<'_, '_>) -> Read<Found> {
    let mut file = File {
        links: BTreeMap::new(),
        below: BTreeMap::new(),
        notes: Vec::new(),
        raws: Vec::new(),
    };
    let first = file.sort(root)?;
    file.link(first, None, None)?;
    let base = &file.raws[0];
    if base.mass.mass > 0.0 && base.name != "world" {
        file.notes.push(remark(first, "it is the base: it moves freely in the case"));
        file.raws[0].is_free = true;
    }
    let Joined { bodies, notes: more, .. } = joined(&file.raws)?;
    let mut notes = file.notes;
    notes.extend(more);
    let robot = Robot {
        name: root.attribute("name").unwrap_or("model").to_owned(),
        gravity: Vector3::zeros(),
        step: STEP,
        fluid: None,
        bodies,
        motors: Vec::new(),
        tendons: Vec::new(),
    };
    Ok(Found { robot, notes })
}

/// The link that an element below a joint names.
fn end<'a>(joint: Node<'a, '_>, tag: &str) -> Read<&'a str> {
    let found = children(joint).find(|child| child.has_tag_name(tag));
    match found.and_then(|child| child.attribute("link")) {
        Some(name) => Ok(name),
        None => refuse(joint, format!("it has no {tag}"), format!("<{tag} link=\"NAME\"/>")),
    }
}

/// Where a frame is by `<origin>`; not elsewhere if that is absent.
fn origin(node: Node<'_, '_>) -> Read<Pose<f64>> {
    let Some(origin) = children(node).find(|child| child.has_tag_name("origin")) else {
        return Ok(Pose::identity());
    };
    let three = |name: &str| -> Read<[f64; 3]> {
        origin.attribute(name).map_or(Ok([0.0; 3]), |text| exactly::<3>(origin, name, text))
    };
    let rotation = match three("rpy")? {
        [0.0, 0.0, 0.0] => Matrix3::identity(),
        angles => roll_pitch_yaw(angles),
    };
    Ok(Pose { rotation, position: three("xyz")?.into() })
}

/// A number of an element.
fn number(node: Node<'_, '_>, name: &str) -> Read<f64> {
    match node.attribute(name) {
        Some(text) => exactly::<1>(node, name, text).map(|[value]| value),
        None => refuse(node, format!("it has no `{name}`"), format!("{name}=\"...\"")),
    }
}

impl<'a, 'i> File<'a, 'i> {
    /// Sorts the elements of a file, and gives the first link.
    fn sort(&mut self, root: Node<'a, 'i>) -> Read<Node<'a, 'i>> {
        let mut above = BTreeMap::new();
        for node in children(root) {
            match node.tag_name().name() {
                "link" => {
                    let name = node.attribute("name").unwrap_or_default();
                    if self.links.insert(name, node).is_some() {
                        return refuse(node, "two links have one name", "a name of its own");
                    }
                }
                "joint" => {
                    let (parent, child) = (end(node, "parent")?, end(node, "child")?);
                    if above.insert(child, node).is_some() {
                        let what = format!("two joints are above \"{child}\": that is no tree");
                        return refuse(node, what, "one joint above each link");
                    }
                    self.below.entry(parent).or_default().push(node);
                }
                "material" | "gazebo" => {}
                _ => self.notes.push(remark(node, "it is left out")),
            }
        }
        for joint in self.below.values().flatten() {
            for tag in ["parent", "child"] {
                let name = end(*joint, tag)?;
                if !self.links.contains_key(name) {
                    let names: Vec<&str> = self.links.keys().copied().collect();
                    let what = format!("there is no link \"{name}\"");
                    return refuse(*joint, what, format!("links: {}", names.join(", ")));
                }
            }
        }
        let mut bases = children(root).filter(|node| {
            let name = node.attribute("name").unwrap_or_default();
            node.has_tag_name("link") && !above.contains_key(name)
        });
        match (bases.next(), bases.next()) {
            (Some(first), None) => Ok(first),
            (None, _) => refuse(root, "no link is the first one", "a tree of links"),
            (Some(_), Some(second)) => {
                refuse(second, "it hangs on nothing, as the link above", "one tree of links")
            }
        }
    }

    /// Reads a link below a joint with all that hangs on it. No link comes twice: each has one joint above.
    fn link(
        &mut self,
        node: Node<'a, 'i>,
        joint: Option<Node<'a, 'i>>,
        parent: Option<usize>,
    ) -> Read<()> {
        let name = node.attribute("name").unwrap_or_default();
        let number = self.raws.len();
        if number >= MOST_BODIES {
            return refuse(node, "the file has too many links", format!("at most {MOST_BODIES}"));
        }
        let mut raw = Raw {
            element: remark(node, ""),
            name: name.to_owned(),
            parent,
            pose: joint.map_or_else(|| Ok(Pose::identity()), origin)?,
            mass: inertial(node)?,
            is_free: false,
            joints: Vec::new(),
            ellipsoids: Vec::new(),
            extent: extent(node)?,
            largest: None,
            lift: 0.0,
        };
        if let Some(joint) = joint {
            self.joint(joint, &mut raw)?;
        }
        self.raws.push(raw);
        for joint in self.below.remove(name).unwrap_or_default() {
            if let Some(child) = self.links.get(end(joint, "child")?).copied() {
                self.link(child, Some(joint), Some(number))?;
            }
        }
        Ok(())
    }

    /// The joint above a link.
    fn joint(&mut self, node: Node<'a, 'i>, raw: &mut Raw) -> Read<()> {
        let kind = match node.attribute("type").unwrap_or_default() {
            "fixed" => return Ok(()),
            "floating" => {
                raw.is_free = true;
                return Ok(());
            }
            "revolute" | "continuous" => JointKind::Hinge,
            "prismatic" => JointKind::Slider,
            other => {
                let what = format!("joints of the type \"{other}\" are not known");
                return refuse(node, what, "revolute, continuous, prismatic, fixed or floating");
            }
        };
        let find = |tag: &str| children(node).find(|child| child.has_tag_name(tag));
        if let Some(mimic) = find("mimic") {
            let what = "a joint that follows another one is not known";
            return refuse(mimic, what, "leave it out, or hold the joint: type=\"fixed\"");
        }
        let axis = match find("axis").and_then(|axis| Some((axis, axis.attribute("xyz")?))) {
            Some((axis, text)) => unit(axis, "xyz", exactly::<3>(axis, "xyz", text)?)?,
            None => Vector3::x(),
        };
        let dynamics = find("dynamics");
        let of_dynamics = |name: &str| -> Read<f64> {
            match dynamics.filter(|node| node.attribute(name).is_some()) {
                Some(node) => not_negative(node, name, number(node, name)?),
                None => Ok(0.0),
            }
        };
        if of_dynamics("friction")? != 0.0 {
            self.notes.push(remark(node, "its friction is left out"));
        }
        let is_endless = node.attribute("type") == Some("continuous");
        if find("limit").is_some() && !is_endless {
            self.notes.push(remark(node, "its limits are left out"));
        }
        raw.joints.push(RobotJoint {
            name: node.attribute("name").unwrap_or_default().to_owned(),
            kind,
            axis,
            position: Vector3::zeros(),
            stiffness: 0.0,
            rest: 0.0,
            damping: of_dynamics("damping")?,
            armature: 0.0,
            start: [0.0; 2],
            from: 0.0,
        });
        Ok(())
    }
}

/// Mass, centre and moments of a link; none of one without.
fn inertial(link: Node<'_, '_>) -> Read<Mass> {
    let find = |node: Node<'_, '_>, tag: &str| children(node).any(|child| child.has_tag_name(tag));
    let Some(node) = children(link).find(|child| child.has_tag_name("inertial")) else {
        return Ok(Mass::zero());
    };
    if !find(node, "mass") || !find(node, "inertia") {
        return refuse(node, "it has no mass, or no moments", "<mass .../> and <inertia .../>");
    }
    let (mut mass, mut inertia) = (0.0, Matrix3::zeros());
    for child in children(node) {
        match child.tag_name().name() {
            "mass" => mass = not_negative(child, "value", number(child, "value")?)?,
            "inertia" => {
                let [xx, xy, xz] =
                    [number(child, "ixx")?, number(child, "ixy")?, number(child, "ixz")?];
                let [yy, yz, zz] =
                    [number(child, "iyy")?, number(child, "iyz")?, number(child, "izz")?];
                inertia = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
            }
            _ => {}
        }
    }
    Ok(Mass { mass, center: Vector3::zeros(), inertia }.seen_from(&origin(node)?))
}

/// Half lengths along the axes of a link of the largest of its shapes; none where all are meshes.
fn extent(link: Node<'_, '_>) -> Read<Option<Vector3<f64>>> {
    let mut largest: Option<Vector3<f64>> = None;
    let shapes = children(link).filter(|c| c.has_tag_name("visual") || c.has_tag_name("collision"));
    for shape in shapes {
        let turn = origin(shape)?.rotation;
        let geometry = children(shape).find(|child| child.has_tag_name("geometry"));
        for node in geometry.into_iter().flat_map(children) {
            let solid = match node.tag_name().name() {
                "sphere" => Solid::Ellipsoid(Vector3::repeat(number(node, "radius")?)),
                "cylinder" => Solid::Cylinder {
                    radius: number(node, "radius")?,
                    half: 0.5 * number(node, "length")?,
                },
                "box" => {
                    let size = node.attribute("size").unwrap_or_default();
                    Solid::Box(Vector3::from(exactly::<3>(node, "size", size)?) * 0.5)
                }
                _ => continue,
            };
            let own = turn.abs() * solid.semi_axes();
            if own.min() > 0.0 && largest.is_none_or(|was| own.product() > was.product()) {
                largest = Some(own);
            }
        }
    }
    Ok(largest)
}
