//! Bodies of MJCF with their joints, masses and geoms.

use std::collections::BTreeMap;

use alewife_reduced::tree::{JointKind, Pose};
use nalgebra::{Matrix3, Vector3};
use roxmltree::Node;

use super::defaults::{Defaults, Element};
use super::geoms::{as_ellipsoid, geom};
use super::joined::{MOST_BODIES, Raw};
use super::mass::Mass;
use super::source::{Read, Remark, children, refuse, remark, unit};
use super::turn::{Angles, rotation};
use crate::reduced::exchange::robot::{JointOf, RobotJoint, RobotSite};

/// What helps where a file has what only `MuJoCo` itself writes out.
pub(super) const FLATTEN: &str = "have MuJoCo write it out: \
    mujoco.mj_saveLastXML(\"flat.xml\", mujoco.MjModel.from_xml_path(\"model.xml\"))";

/// Bodies of a file in the making.
pub(super) struct Bodies<'d, 'a, 'i> {
    pub defaults: &'d Defaults<'a, 'i>,
    pub angles: Angles,
    /// Whether masses are those of geoms; where a body has no `<inertial>` if absent.
    pub by_geoms: Option<bool>,
    pub raws: Vec<Raw>,
    /// Joints by their names, of bodies of the file.
    pub joints: BTreeMap<String, JointOf>,
    /// Sites by their names, of bodies of the file.
    pub sites: BTreeMap<String, RobotSite>,
    pub notes: Vec<Remark>,
}

/// What stands in a body.
struct Inside {
    inertial: Option<Mass>,
    of_geoms: Mass,
    /// A geom whose mass is not known.
    unknown: Option<Remark>,
}

impl<'a, 'i> Bodies<'_, 'a, 'i> {
    /// Reads a body with those in it.
    ///
    /// # Errors
    /// When something in it is wrong or not known.
    pub fn read(&mut self, node: Node<'a, 'i>, parent: Option<usize>, class: &str) -> Read<()> {
        let class = node.attribute("childclass").unwrap_or(class);
        let defaults = self.defaults;
        let own = defaults.of(node, class)?;
        if node.attribute("mocap") == Some("true") {
            return refuse(
                node,
                "a body that is moved from outside is not known",
                "leave out `mocap`",
            );
        }
        let number = self.raws.len();
        if number >= MOST_BODIES {
            return refuse(node, "the file has too many bodies", format!("at most {MOST_BODIES}"));
        }
        let name = node.attribute("name").map_or_else(|| format!("body-{number}"), str::to_owned);
        let pose = Pose { rotation: rotation(&own, &self.angles)?, position: own.vector("pos")? };
        self.raws.push(Raw {
            element: remark(node, ""),
            name,
            parent,
            pose,
            mass: Mass::zero(),
            is_free: false,
            joints: Vec::new(),
            ellipsoids: Vec::new(),
            extent: None,
            largest: None,
            lift: own.number("gravcomp", 0.0)?,
        });
        let mut inside = Inside { inertial: None, of_geoms: Mass::zero(), unknown: None };
        for child in children(node).filter(|child| !child.has_tag_name("body")) {
            self.part(child, number, class, &mut inside)?;
        }
        self.raws[number].mass = self.mass(&inside)?;
        for child in children(node).filter(|child| child.has_tag_name("body")) {
            self.read(child, Some(number), class)?;
        }
        Ok(())
    }

    /// Masses of a body.
    fn mass(&self, inside: &Inside) -> Read<Mass> {
        match inside.inertial.filter(|_| self.by_geoms != Some(true)) {
            Some(mass) => Ok(mass),
            None => match &inside.unknown {
                Some(geom) => {
                    let help = "an <inertial> of its body".to_owned();
                    Err(Remark { help: Some(help), ..geom.clone() })
                }
                None if self.by_geoms == Some(false) => Ok(Mass::zero()),
                None => Ok(inside.of_geoms),
            },
        }
    }

    /// An element of a body.
    fn part(
        &mut self,
        node: Node<'a, 'i>,
        number: usize,
        class: &str,
        inside: &mut Inside,
    ) -> Read<()> {
        let defaults = self.defaults;
        let element = defaults.of(node, class)?;
        match node.tag_name().name() {
            "inertial" => inside.inertial = Some(inertial(&element, &self.angles)?),
            "freejoint" => self.raws[number].is_free = true,
            "joint" => self.joint(&element, number)?,
            "geom" => self.geom(&element, number, inside)?,
            "site" => {
                if let Some(name) = node.attribute("name") {
                    let position = element.vector("pos")?;
                    self.sites.insert(name.to_owned(), RobotSite { body: number, position });
                }
            }
            "camera" | "light" => {}
            tag => {
                return refuse(node, format!("<{tag}> in a body is not known"), FLATTEN);
            }
        }
        Ok(())
    }

    fn geom(
        &mut self,
        element: &Element<'_, 'a, 'i>,
        number: usize,
        inside: &mut Inside,
    ) -> Read<()> {
        let found = geom(element, &self.angles)?;
        match (found.mass, found.solid) {
            (Some(mass), Some(solid)) => {
                inside.of_geoms = inside.of_geoms.with(&mass);
                let extent = found.pose.rotation.abs() * solid.semi_axes();
                let was = self.raws[number].extent.map_or(0.0, |was| was.product());
                if extent.product() > was {
                    self.raws[number].extent = Some(extent);
                    self.raws[number].largest = Some(as_ellipsoid(found.pose, &solid));
                }
            }
            _ => {
                inside.unknown = Some(remark(element.node, "the mass of a mesh is not known here"))
            }
        }
        self.raws[number].ellipsoids.extend(found.ellipsoid);
        Ok(())
    }

    fn joint(&mut self, element: &Element<'_, 'a, 'i>, number: usize) -> Read<()> {
        let node = element.node;
        let kind = match element.text("type").unwrap_or("hinge") {
            "free" => {
                self.raws[number].is_free = true;
                return self.inert(element, &["damping", "stiffness", "armature", "frictionloss"]);
            }
            "hinge" => JointKind::Hinge,
            "slide" => JointKind::Slider,
            other => {
                let what = format!("joints of the type \"{other}\" are not known");
                return refuse(node, what, "hinge, slide or free");
            }
        };
        // Angles in the unit of the file
        let angle = if kind == JointKind::Hinge { self.angles.unit } else { 1.0 };
        let from = element.number("ref", 0.0)? * angle;
        if from != 0.0 {
            self.notes.push(remark(node, format!("its coordinate counts from `ref`, {from}")));
        }
        if element.text("springdamper").is_some() {
            return refuse(node, "`springdamper` is not known", "stiffness and damping");
        }
        self.left_out(element)?;
        let raw = &mut self.raws[number];
        let axis = element.exactly::<3>("axis")?.unwrap_or([0.0, 0.0, 1.0]);
        let name = node.attribute("name").unwrap_or_default();
        if !name.is_empty() {
            let at = JointOf { body: number, nth: raw.joints.len() };
            self.joints.insert(name.to_owned(), at);
        }
        raw.joints.push(RobotJoint {
            name: name.to_owned(),
            kind,
            axis: unit(node, "axis", axis)?,
            position: element.vector("pos")?,
            stiffness: element.not_negative("stiffness", 0.0)?,
            rest: element.number("springref", 0.0)? * angle - from,
            damping: element.not_negative("damping", 0.0)?,
            armature: element.not_negative("armature", 0.0)?,
            start: [0.0; 2],
            from,
        });
        Ok(())
    }

    /// Numbers of a joint that a case has not.
    fn inert(&mut self, element: &Element<'_, 'a, 'i>, names: &[&str]) -> Read<()> {
        for name in names {
            if element.number(name, 0.0)? != 0.0 {
                self.notes.push(remark(element.node, format!("its `{name}` is left out")));
            }
        }
        Ok(())
    }

    /// What a joint has that a case has not.
    fn left_out(&mut self, element: &Element<'_, 'a, 'i>) -> Read<()> {
        let is_limited = element.text("range").is_some()
            && element.text("limited").is_none_or(|limited| limited != "false");
        if is_limited {
            self.notes.push(remark(element.node, "its limits are left out"));
        }
        self.inert(element, &["frictionloss"])?;
        if element.text("actuatorfrcrange").is_some() {
            self.notes.push(remark(element.node, "its `actuatorfrcrange` is left out"));
        }
        Ok(())
    }
}

/// Mass, centre and moments as they are written.
fn inertial(element: &Element<'_, '_, '_>, angles: &Angles) -> Read<Mass> {
    let node = element.node;
    let mass = element.number("mass", f64::NAN)?;
    if mass.is_nan() || mass < 0.0 {
        return refuse(node, "it has no mass", "mass=\"...\" of 0 or more (kg)");
    }
    let center = element.vector("pos")?;
    let turn = rotation(element, angles)?;
    let own = match (element.exactly::<6>("fullinertia")?, element.exactly::<3>("diaginertia")?) {
        (Some([xx, yy, zz, xy, xz, yz]), _) => Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz),
        (None, Some(moments)) => Matrix3::from_diagonal(&Vector3::from(moments)),
        (None, None) => {
            return refuse(node, "it has no moments", "diaginertia or fullinertia (kg m2)");
        }
    };
    Ok(Mass { mass, center, inertia: turn * own * turn.transpose() })
}
