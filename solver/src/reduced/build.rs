//! `Reduced`: the tree of a case, where its bodies are in it, and what its joints are told.

use alewife_reduced::tree::{
    Command, Connection, Joint, JointKind as Kind, Link, Placement, Pose, Root, State, Symmetric,
    Tree, Weight, Wrench,
};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, UnitVector3, Vector3};

use super::ReducedError;
use super::hung::{Hung, angle_about};
use super::inertia::{Solid, in_space};
use super::inputs::pushes::{Propeller, Pull};
use super::inputs::told::Told;
use super::law::Law;
use super::part::{Part, Piece};
use crate::case::{Body, FlowModel, Geometry, Model, Motion, ReducedSpec};

/// A case as a tree.
#[derive(Debug, Clone)]
pub(super) struct Reduced {
    pub tree: Tree<f64>,
    pub root: Root,
    pub gravity: [f64; 3],
    /// Of each body of the model.
    pub parts: Vec<Part>,
    /// Of each link.
    pub told: Vec<Told>,
    pub start: State<f64>,
    pub has_inertia: bool,
    /// Forces from outside.
    pub pulls: Vec<Pull>,
    /// Thrusters as they start.
    pub propellers: Vec<Propeller>,
    /// What moves it in place of loads, with the links of its joints.
    pub connection: Option<(Connection, Vec<usize>)>,
}

impl Reduced {
    pub fn command(&self, time: f64, link: usize) -> Command<f64> {
        self.told[link].command(time)
    }

    pub fn new(model: &Model) -> Result<Self, ReducedError> {
        Builder::new(model)?.finish()
    }
}

/// A tree in the making.
pub(super) struct Builder<'a> {
    pub model: &'a Model,
    pub spec: ReducedSpec,
    pub has_inertia: bool,
    pub solids: Vec<Solid>,
    pub links: Vec<Link<f64>>,
    pub parts: Vec<Option<Part>>,
    pub told: Vec<Told>,
    /// Coordinates and rates of the joints of links at the start.
    pub coordinates: Vec<[f64; 2]>,
}

/// How the first link moves, and where it starts.
struct Footing {
    root: Root,
    at: Placement<f64>,
}

/// The frame of the centre of mass of a body in the world.
fn place(body: &Body, solid: &Solid, geometry: Geometry) -> Isometry3<f64> {
    let frame = if geometry == Geometry::Spatial {
        body.pose_in_space()
    } else {
        let at = |axis: usize| body.center.get(axis).copied().unwrap_or(0.0);
        let turned = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), body.angle);
        Isometry3::from_parts(Translation3::new(at(0), at(1), 0.0), turned)
    };
    frame * Translation3::from(solid.center)
}

fn pose_of(frame: &Isometry3<f64>) -> Pose<f64> {
    Pose {
        rotation: *frame.rotation.to_rotation_matrix().matrix(),
        position: frame.translation.vector,
    }
}

fn placement_of(frame: &Isometry3<f64>) -> Placement<f64> {
    let q = frame.rotation;
    Placement { position: frame.translation.vector, quaternion: [q.w, q.i, q.j, q.k] }
}

impl<'a> Builder<'a> {
    fn new(model: &'a Model) -> Result<Self, ReducedError> {
        let geometry = model.case.geometry;
        let solids = model.bodies.iter().map(|body| Solid::of(body, geometry));
        Ok(Self {
            spec: model.case.reduced_model(),
            has_inertia: model.case.fluid.model != FlowModel::Stokes,
            solids: solids.collect::<Result<_, _>>()?,
            links: Vec::new(),
            parts: vec![None; model.bodies.len()],
            told: Vec::new(),
            coordinates: Vec::new(),
            model,
        })
    }

    pub fn geometry(&self) -> Geometry {
        self.model.case.geometry
    }

    /// Hangs all bodies on the root, parents first.
    fn finish(mut self) -> Result<Reduced, ReducedError> {
        let model = self.model;
        let is_root = |body: &usize| {
            let above = model.joint_above(*body);
            above.is_none_or(|joint| model.hangs_on_laboratory(&model.joints[joint]))
        };
        let mut roots = (0..model.bodies.len()).filter(is_root);
        let (Some(first), None) = (roots.next(), roots.next()) else {
            return Err(ReducedError::Unknown("several swimmers".to_owned()));
        };
        let footing = self.add_root(first)?;
        let mut waiting: Vec<usize> = (0..model.bodies.len()).filter(|one| *one != first).collect();
        while !waiting.is_empty() {
            let before = waiting.len();
            let mut later = Vec::new();
            for child in waiting {
                match self.parent_of(child).filter(|parent| self.parts[*parent].is_some()) {
                    Some(parent) => self.add_child(Some(parent), child)?,
                    None => later.push(child),
                }
            }
            if later.len() == before {
                return Err(ReducedError::Unknown("joints in a circle".to_owned()));
            }
            waiting = later;
        }
        self.made(first, footing)
    }

    /// The tree of all links, and what acts on it.
    fn made(self, first: usize, footing: Footing) -> Result<Reduced, ReducedError> {
        let Footing { root, at } = footing;
        let (model, spec) = (self.model, &self.spec);
        let parts: Option<Vec<Part>> = self.parts.iter().cloned().collect();
        let parts = parts.ok_or_else(|| ReducedError::Unknown("bodies apart".to_owned()))?;
        let mut pulls = Vec::new();
        for (body, part) in model.bodies.iter().zip(&parts) {
            let load = Wrench { force: in_space(&body.force), torque: body.torque.0.into() };
            if load != Wrench::zero() {
                let (link, inside) = (part.link, part.inside);
                let (factor, is_in_body) =
                    (body.load_factor.clone(), !body.load_frame.is_laboratory());
                pulls.push(Pull { link, inside, load, factor, is_in_body });
            }
        }
        let propellers = spec.thruster.iter().filter_map(|one| {
            let body = model.body_index(&one.body)?;
            let frame = parts[body].inside.then(&Pose::at(-self.solids[body].center));
            Some(Propeller::new(one, parts[body].link, &frame))
        });
        let propellers = propellers.collect();
        let connection = match &spec.connection {
            Some(table) => {
                let values = table.values.concat();
                let (ranges, nodes) = (table.range.clone(), table.nodes.clone());
                let below = |joint: &crate::case::Joint| {
                    model.body_index(&joint.child).map_or(0, |child| parts[child].link)
                };
                let links = model.joints.iter().map(below).collect();
                Some((Connection::new(root, ranges, nodes, values)?, links))
            }
            None => None,
        };
        let gravity: [f64; 3] = in_space(&model.case.fluid.gravity).into();
        let tree = Tree::new(root, self.links.clone())?.in_gravity(gravity);
        let mut start = tree.rest();
        start.root = at;
        for link in 1..tree.links().len() {
            if let Some(velocity) = tree.velocity_of(link) {
                [start.coordinates[velocity], start.velocities[velocity]] = self.coordinates[link];
            }
        }
        self.set_off(&tree, first, &mut start);
        let tendons = self.tendons(&tree, &parts, &start);
        let tree = tree.with_tendons(tendons)?;
        let (told, has_inertia) = (self.told, self.has_inertia);
        Ok(Reduced {
            tree,
            root,
            gravity,
            parts,
            told,
            start,
            has_inertia,
            pulls,
            propellers,
            connection,
        })
    }

    fn parent_of(&self, child: usize) -> Option<usize> {
        let joint = self.model.joint_above(child)?;
        self.model.body_index(&self.model.joints[joint].parent)
    }

    /// The first body, on what holds or guides it.
    fn add_root(&mut self, body: usize) -> Result<Footing, ReducedError> {
        let geometry = self.geometry();
        let one = &self.model.bodies[body];
        let frame = place(one, &self.solids[body], geometry);
        if self.model.joint_above(body).is_some() {
            self.push(Link::root(Symmetric::zero()), Told::Nothing, [0.0; 2]);
            self.add_child(None, body)?;
            return Ok(Footing { root: Root::Held, at: Placement::identity() });
        }
        if let Some(keel) = self.spec.keel.clone() {
            let at = Translation3::from(self.keep(body, &keel, &frame));
            let ground = Isometry3::from_parts(at, UnitQuaternion::identity());
            return Ok(Footing { root: Root::Held, at: placement_of(&ground) });
        }
        let is_guided = matches!(one.motion, Motion::Imposed(_))
            || !one.locked.is_empty()
            || one.spring.is_some();
        if is_guided && one.motion != Motion::Held {
            self.guide(body, &frame);
            let ground = Isometry3::from_parts(frame.translation, UnitQuaternion::identity());
            return Ok(Footing { root: Root::Held, at: placement_of(&ground) });
        }
        let mut link = Link::root(Symmetric::zero());
        self.fill(body, &Pose::identity(), &mut link);
        self.push(link, Told::Nothing, [0.0; 2]);
        let root = match (&one.motion, geometry) {
            (Motion::Held, _) => Root::Held,
            (_, Geometry::Spatial) => Root::Free,
            _ => Root::Planar,
        };
        Ok(Footing { root, at: placement_of(&frame) })
    }

    pub fn push(&mut self, link: Link<f64>, told: Told, start: [f64; 2]) {
        self.links.push(link);
        self.told.push(told);
        self.coordinates.push(start);
    }

    /// Masses, weight and load of a body in the link that is pushed next.
    pub fn fill(&mut self, body: usize, inside: &Pose<f64>, link: &mut Link<f64>) {
        let (model, solid) = (self.model, self.solids[body]);
        let one = &model.bodies[body];
        let density = one.density.unwrap_or(model.case.fluid.density);
        let (mut mass, mut inertia) = (solid.volume, solid.inertia);
        if self.has_inertia {
            mass = one.mass.unwrap_or(density * solid.volume);
            inertia = one.inertia.map_or(solid.inertia * (mass / solid.volume), |own| own.tensor());
            let rigid = Symmetric { angular: inertia, ..Symmetric::rigid(mass, Vector3::zeros()) };
            link.inertia = rigid.seen_from(inside);
        }
        let buoyancy = self.spec.buoyancy.get(&one.name);
        let volume = buoyancy.and_then(|own| own.volume).unwrap_or(solid.volume);
        let center = match buoyancy.filter(|own| !own.center.is_empty()) {
            Some(own) => in_space(&own.center),
            None => solid.centroid,
        };
        link.weight = Some(Weight {
            mass: one.mass.unwrap_or(density * solid.volume),
            mass_center: inside.position,
            displaced: model.case.fluid.density * volume,
            buoyancy_center: inside.then(&Pose::at(center - solid.center)).position,
        });
        let law = Law::new(&model.case, &self.spec, &solid).of_tail(self.tail(body));
        let place = law.place(&solid);
        let coefficients = self.spec.coefficients_of(&one.name);
        let own = self.spec.ellipsoid.iter().filter(|ellipsoid| ellipsoid.body == one.name);
        let pieces = own.map(|ellipsoid| Piece::new(ellipsoid, &law, &solid.center));
        let (number, inside, pieces) = (self.links.len(), *inside, pieces.collect());
        let part = Part { link: number, inside, mass, inertia, law, coefficients, place, pieces };
        link.loads.extend(part.loads(&part.coefficients));
        self.parts[body] = Some(part);
    }

    /// Where the head is from the tail, the last body of a chain: 1 along its x axis, or -1; none of other bodies.
    fn tail(&self, body: usize) -> Option<f64> {
        let (model, solid) = (self.model, &self.solids[body]);
        let name = &model.bodies[body].name;
        let is_of_it = |joint: &&crate::case::Joint| {
            let [parent, child] = [&joint.parent, &joint.child].map(|end| end == name);
            (parent || child) && !model.hangs_on_laboratory(joint)
        };
        let mut joints = model.joints.iter().filter(is_of_it);
        let (Some(joint), None) = (joints.next(), joints.next()) else { return None };
        let [on_parent, on_child] = joint.ends();
        let end = if joint.child == *name { on_child } else { on_parent };
        let is_ahead = end.x >= solid.center.x + solid.middle.x;
        (body + 1 == model.bodies.len()).then_some(if is_ahead { 1.0 } else { -1.0 })
    }

    /// Hangs a body on its parent, or on the laboratory.
    fn add_child(&mut self, parent: Option<usize>, child: usize) -> Result<(), ReducedError> {
        let (model, geometry) = (self.model, self.geometry());
        let on = parent.map_or(Some((0, Pose::identity())), |one| {
            self.parts[one].as_ref().map(|part| (part.link, part.inside))
        });
        let (Some(above), Some((link, inside))) = (model.joint_above(child), on) else {
            return Err(ReducedError::Unknown("bodies apart".to_owned()));
        };
        let joint = &model.joints[above];
        let placed = |one: usize| place(&model.bodies[one], &self.solids[one], geometry);
        let (parent_place, child_place) =
            (parent.map_or_else(Isometry3::identity, placed), placed(child));
        let [on_parent, on_child] = joint.ends();
        let on_parent =
            on_parent - parent.map_or_else(Vector3::zeros, |one| self.solids[one].center);
        let on_child = on_child - self.solids[child].center;
        let relative = parent_place.rotation.inverse() * child_place.rotation;
        let mut hung = Hung::of(&joint.kind, geometry == Geometry::Spatial, &relative)?;
        if let Some(told) = self.serve(child, &mut hung.joint) {
            hung.told = told;
        }
        let rotor = self.spec.armature.get(&model.bodies[child].name);
        hung.joint.armature = rotor.copied().unwrap_or_default();
        let start = match &hung.told {
            Told::Given(stroke) => stroke.at(0.0)[0],
            _ if hung.joint.kind == Kind::Slider => {
                let end = parent_place.inverse() * child_place * Translation3::from(on_child);
                (end.translation.vector - on_parent).dot(&hung.joint.axis)
            }
            _ if geometry == Geometry::Spatial => {
                angle_about(&UnitVector3::new_unchecked(hung.joint.axis), &relative)
            }
            _ => model.bodies[child].angle - parent.map_or(0.0, |one| model.bodies[one].angle),
        };
        let held = pose_of(&(hung.rest * Translation3::from(-on_child)));
        let mut made = Link::new(link, hung.joint, Symmetric::zero());
        made.at = inside.then(&Pose::at(on_parent));
        self.fill(child, &held, &mut made);
        self.push(made, hung.told, [start, 0.0]);
        Ok(())
    }

    /// The velocities of what starts with some.
    fn set_off(&self, tree: &Tree<f64>, first: usize, start: &mut State<f64>) {
        let starts = |body: &Body| {
            !body.angular_velocity.is_zero() || body.velocity.iter().any(|part| *part != 0.0)
        };
        if !self.model.bodies.iter().any(starts) {
            return;
        }
        let body = &self.model.bodies[first];
        let back = start.root.rotation().transpose();
        let linear = back * in_space(&body.velocity);
        let angular = back * Vector3::from(body.angular_velocity.0);
        match tree.n_root() {
            3 => start.velocities[..3].copy_from_slice(&[linear.x, linear.y, angular.z]),
            6 => {
                start.velocities[..3].copy_from_slice(linear.as_slice());
                start.velocities[3..6].copy_from_slice(angular.as_slice());
            }
            _ => {}
        }
        // Hinges by the angular velocities of both their bodies, parents first
        for (child, body) in self.model.bodies.iter().enumerate() {
            let Some(part) = self.parts[child].as_ref().filter(|_| child != first) else {
                continue;
            };
            let is_free = matches!(self.told[part.link], Told::Nothing | Told::Effort(_));
            let link = &tree.links()[part.link];
            let velocity = tree.velocity_of(part.link).filter(|_| is_free);
            let (Some(velocity), Kind::Hinge) = (velocity, link.joint.kind) else { continue };
            let axis =
                tree.poses(start)[link.parent].rotation * (link.at.rotation * link.joint.axis);
            let parent = tree.twists(start)[link.parent].angular;
            let longest = axis.iamax();
            let own = body.angular_velocity.0[longest];
            start.velocities[velocity] = (own - parent[longest]) / axis[longest];
        }
    }
}

/// A joint along an axis of the laboratory, or about one.
pub(super) fn lone(kind: Kind, axis: Vector3<f64>) -> Joint<f64> {
    Joint::new(kind, axis.into())
}
