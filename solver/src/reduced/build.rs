//! `Reduced`: the tree of a case, where its bodies are in it, and what its joints are told.

use alewife_reduced::tree::loads::{
    AddedMass, Ellipsoid, EllipsoidCoefficients, Load, Resistive, StripCoefficients, Strips,
};
use alewife_reduced::tree::{
    Command, Drive, Joint, JointKind as Kind, Link, PlacedLoad, Placement, Pose, Root, State,
    Symmetric, Tree, Weight,
};
use nalgebra::{Isometry3, Rotation3, Translation3, UnitQuaternion, UnitVector3, Vector3};

use super::ReducedError;
use super::inertia::Solid;
use crate::case::{
    AddedMassSpec, Body, FlowModel, Geometry, JointKind, LoadLaw, Model, Motion, ReducedSpec,
    Stroke,
};

/// Where a body is in the tree.
#[derive(Debug, Clone)]
pub(super) struct Part {
    /// Number of its link.
    pub link: usize,
    /// Its centre and axes in the frame of the link.
    pub inside: Pose<f64>,
    /// Mass (kg), or volume (m3) where there is no inertia.
    pub mass: f64,
    /// Moments of inertia about its centre in its axes, of the same density.
    pub moments: Vector3<f64>,
}

/// What a joint is told: its coordinate, or the effort of its motor.
#[derive(Debug, Clone)]
pub(super) enum Told {
    /// Nothing.
    Nothing,
    /// Its coordinate.
    Given(Stroke),
    /// Its effort.
    Effort(Stroke),
}

/// A case as a tree.
#[derive(Debug, Clone)]
pub(super) struct Reduced {
    pub tree: Tree<f64>,
    /// Of each body of the model.
    pub parts: Vec<Part>,
    /// Of each link.
    pub told: Vec<Told>,
    pub start: State<f64>,
    pub has_inertia: bool,
}

impl Reduced {
    pub fn command(&self, time: f64, link: usize) -> Command<f64> {
        let none = Command::none();
        match &self.told[link] {
            Told::Nothing => none,
            Told::Given(stroke) => {
                let [place, rate] = stroke.at(time);
                Command { place, rate, ..none }
            }
            Told::Effort(stroke) => Command { effort: stroke.at(time)[0], ..none },
        }
    }

    pub fn new(model: &Model) -> Result<Self, ReducedError> {
        Builder::new(model)?.finish()
    }
}

struct Builder<'a> {
    model: &'a Model,
    spec: ReducedSpec,
    has_inertia: bool,
    solids: Vec<Solid>,
    links: Vec<Link<f64>>,
    parts: Vec<Option<Part>>,
    told: Vec<Told>,
    coordinates: Vec<f64>,
}

/// The frame of the centre of a body in the world.
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

/// Angle of a rotation about an axis (rad), within half a turn.
fn angle_about(axis: &UnitVector3<f64>, rotation: &UnitQuaternion<f64>) -> f64 {
    let angle = 2.0 * rotation.imag().dot(axis).atan2(rotation.w);
    angle - (angle / std::f64::consts::TAU).round() * std::f64::consts::TAU
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

    /// Hangs all bodies on the root, parents first.
    fn finish(mut self) -> Result<Reduced, ReducedError> {
        let (model, geometry) = (self.model, self.model.case.geometry);
        let mut roots = (0..model.bodies.len()).filter(|body| model.joint_above(*body).is_none());
        let (Some(first), None) = (roots.next(), roots.next()) else {
            return Err(ReducedError::Unknown("several swimmers".to_owned()));
        };
        self.add_root(first);
        let mut waiting: Vec<usize> = (0..model.bodies.len()).filter(|one| *one != first).collect();
        while !waiting.is_empty() {
            let before = waiting.len();
            let mut later = Vec::new();
            for child in waiting {
                match self.parent_of(child).filter(|parent| self.parts[*parent].is_some()) {
                    Some(parent) => self.add_child(parent, child)?,
                    None => later.push(child),
                }
            }
            if later.len() == before {
                return Err(ReducedError::Unknown("joints in a circle".to_owned()));
            }
            waiting = later;
        }
        let root = match (&model.bodies[first].motion, geometry) {
            (Motion::Held, _) => Root::Held,
            (_, Geometry::Spatial) => Root::Free,
            _ => Root::Planar,
        };
        let gravity = &model.case.fluid.gravity;
        let gravity = [0, 1, 2].map(|axis| gravity.get(axis).copied().unwrap_or(0.0));
        let tree = Tree::new(root, self.links)?.in_gravity(gravity);
        let mut start = tree.rest();
        let frame = place(&model.bodies[first], &self.solids[first], geometry);
        let q = frame.rotation;
        start.root =
            Placement { position: frame.translation.vector, quaternion: [q.w, q.i, q.j, q.k] };
        for link in 1..tree.links().len() {
            if let Some(velocity) = tree.velocity_of(link) {
                start.coordinates[velocity] = self.coordinates[link];
            }
        }
        let parts: Option<Vec<Part>> = self.parts.into_iter().collect();
        let parts = parts.ok_or_else(|| ReducedError::Unknown("bodies apart".to_owned()))?;
        Ok(Reduced { tree, parts, told: self.told, start, has_inertia: self.has_inertia })
    }

    fn parent_of(&self, child: usize) -> Option<usize> {
        let joint = self.model.joint_above(child)?;
        self.model.body_index(&self.model.joints[joint].parent)
    }

    fn add_root(&mut self, body: usize) {
        let inside = Pose::identity();
        let mut link = Link::root(Symmetric::zero());
        self.fill(body, &inside, &mut link);
        self.push(body, link, inside, Told::Nothing, 0.0);
    }

    fn push(&mut self, body: usize, link: Link<f64>, inside: Pose<f64>, told: Told, start: f64) {
        let density = if self.has_inertia { self.density(body) } else { 1.0 };
        let solid = &self.solids[body];
        let (mass, moments) = (density * solid.volume, solid.moments * density);
        self.parts[body] = Some(Part { link: self.links.len(), inside, mass, moments });
        self.links.push(link);
        self.told.push(told);
        self.coordinates.push(start);
    }

    fn density(&self, body: usize) -> f64 {
        self.model.bodies[body].density.unwrap_or(self.model.case.fluid.density)
    }

    /// Masses, weight and loads of a body in its link.
    fn fill(&self, body: usize, inside: &Pose<f64>, link: &mut Link<f64>) {
        let solid = &self.solids[body];
        let density = self.density(body);
        if self.has_inertia {
            let rigid = Symmetric::rigid(density * solid.volume, solid.moments * density);
            link.inertia = rigid.seen_from(inside);
        }
        let displaced = self.model.case.fluid.density * solid.volume;
        link.weight = Some(Weight {
            mass: density * solid.volume,
            mass_center: inside.position,
            displaced,
            buoyancy_center: inside.position,
        });
        let pose = Some(inside.then(&Pose::at(solid.middle)));
        link.loads.push(PlacedLoad { pose, load: self.load(body) });
    }

    fn load(&self, body: usize) -> Load<f64> {
        let case = &self.model.case;
        let (density, viscosity) = (case.fluid.density, case.reference_viscosity());
        let c = self.spec.coefficients_of(&self.model.bodies[body].name);
        let c = |k: usize| c.get(k).copied().unwrap_or_default();
        let axes = self.solids[body].semi_axes;
        match self.spec.loads {
            LoadLaw::Links => Load::Strips(Strips {
                half_length: axes.x,
                half_width: axes.y,
                depth: 1.0,
                density,
                viscosity,
                coefficients: StripCoefficients {
                    added_mass: c(0),
                    normal_linear: c(1),
                    normal_quadratic: c(2),
                    tangential_linear: c(3),
                    tangential_quadratic: c(4),
                },
            }),
            LoadLaw::Resistive => Load::Resistive(Resistive {
                length: 2.0 * axes.x,
                half_width: axes.y,
                viscosity,
                along: c(0),
                across: c(1),
            }),
            LoadLaw::Ellipsoid => {
                let inertia = match self.spec.added_mass {
                    Some(AddedMassSpec::Mujoco) => AddedMass::Mujoco,
                    Some(AddedMassSpec::Full) | None => AddedMass::Full,
                };
                let coefficients = EllipsoidCoefficients::from_array([0, 1, 2, 3, 4].map(c));
                let law = Ellipsoid::new(axes.into(), density, viscosity, coefficients, inertia);
                Load::Ellipsoid(Box::new(law))
            }
        }
    }

    /// Hangs a body on its parent.
    fn add_child(&mut self, parent: usize, child: usize) -> Result<(), ReducedError> {
        let (model, geometry) = (self.model, self.model.case.geometry);
        let Some((above, Some(part))) =
            model.joint_above(child).map(|joint| (joint, self.parts[parent].clone()))
        else {
            return Err(ReducedError::Unknown("bodies apart".to_owned()));
        };
        let joint = &model.joints[above];
        let [parent_place, child_place] =
            [parent, child].map(|one| place(&model.bodies[one], &self.solids[one], geometry));
        let [on_parent, on_child] = joint.ends();
        let on_parent = on_parent - self.solids[parent].center;
        let on_child = on_child - self.solids[child].center;
        let relative = parent_place.rotation.inverse() * child_place.rotation;
        let hung = Hung::of(&joint.kind, geometry == Geometry::Spatial, &relative)?;
        let start = match &hung.told {
            Told::Given(stroke) => stroke.at(0.0)[0],
            _ if hung.joint.kind == Kind::Slider => {
                let end = parent_place.inverse() * child_place * Translation3::from(on_child);
                (end.translation.vector - on_parent).dot(&hung.joint.axis)
            }
            _ if geometry == Geometry::Spatial => {
                angle_about(&UnitVector3::new_unchecked(hung.joint.axis), &relative)
            }
            _ => model.bodies[child].angle - model.bodies[parent].angle,
        };
        let inside = pose_of(&(hung.rest * Translation3::from(-on_child)));
        let mut link = Link::new(part.link, hung.joint, Symmetric::zero());
        link.at = part.inside.then(&Pose::at(on_parent));
        self.fill(child, &inside, &mut link);
        self.push(child, link, inside, hung.told, start);
        Ok(())
    }
}

/// A joint of a case as one of a tree.
struct Hung {
    joint: Joint<f64>,
    told: Told,
    /// How the child is turned where the coordinate is zero.
    rest: UnitQuaternion<f64>,
}

impl Hung {
    fn of(
        kind: &JointKind,
        is_spatial: bool,
        relative: &UnitQuaternion<f64>,
    ) -> Result<Self, ReducedError> {
        let in_plane = |direction: f64| Vector3::new(direction.cos(), direction.sin(), 0.0);
        let unit = |axis: Option<[f64; 3]>, else_: Vector3<f64>| {
            axis.map_or(else_, |axis| Vector3::from(axis).normalize())
        };
        let motor = |stroke: &Option<Stroke>| stroke.clone().map_or(Told::Nothing, Told::Effort);
        // How the child is turned from its axes at a coordinate of zero
        let back = |axis: Vector3<f64>, angle: f64| {
            let turn = Rotation3::from_axis_angle(&UnitVector3::new_unchecked(axis), -angle);
            if is_spatial {
                UnitQuaternion::from(turn) * relative
            } else {
                UnitQuaternion::identity()
            }
        };
        let made = |kind, axis: Vector3<f64>| Joint::new(kind, axis.into());
        Ok(match kind {
            JointKind::Arm { length, direction, along } => Self {
                joint: made(Kind::Slider, unit(*along, in_plane(*direction))).driven(Drive::Given),
                told: Told::Given(length.clone()),
                rest: *relative,
            },
            JointKind::Slider(slider) => {
                let axis = unit(slider.along, in_plane(slider.direction));
                let (stiffness, damping, rest) = (slider.stiffness, slider.damping, slider.rest);
                let joint = Joint { stiffness, damping, rest, ..made(Kind::Slider, axis) };
                Self { joint, told: motor(&slider.force), rest: *relative }
            }
            JointKind::Bent { angle, axis } => {
                let axis = unit(*axis, Vector3::z());
                Self {
                    joint: made(Kind::Hinge, axis).driven(Drive::Given),
                    told: Told::Given(angle.clone()),
                    rest: back(axis, angle.at(0.0)[0]),
                }
            }
            JointKind::Hinge(hinge) => {
                let axis = unit(hinge.axis, Vector3::z());
                let (stiffness, damping, rest) = (hinge.stiffness, hinge.damping, hinge.rest);
                let joint = Joint { stiffness, damping, rest, ..made(Kind::Hinge, axis) };
                let turned = angle_about(&UnitVector3::new_unchecked(axis), relative);
                Self { joint, told: motor(&hinge.torque), rest: back(axis, turned) }
            }
            JointKind::Ball(_) => {
                return Err(ReducedError::Unknown("joints that turn about all axes".to_owned()));
            }
        })
    }
}
