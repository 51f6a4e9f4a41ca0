//! From the reduced model of a case to a `Robot`.

use alewife_reduced::tree::{Drive, JointKind, Pose, Tree, Weight};
use nalgebra::{Matrix3, Vector3};

use super::error::ExchangeError;
use super::robot::{
    Fluid, JointOf, Motor, MotorLaw, Robot, RobotBody, RobotEllipsoid, RobotJoint, RobotSite,
    RobotTendon, seen_from,
};
use crate::case::{AddedMassSpec, LiftSpec, LoadLaw, Model, TimeSettings, Units};
use crate::reduced::build::Reduced;
use crate::reduced::inertia::Solid;
use crate::reduced::inputs::told::Told;
use crate::reduced::part::Part;

/// Square root of stiffness over inertia of what holds a joint that is given, by the time step: as stiff as steps follow.
const STIFFNESS: f64 = 0.5;

/// Relative distance of two places that are the same but for rounding.
const ROUNDING: f64 = 1e-12;

/// A robot, and what of the case it has not.
#[derive(Debug, Clone)]
pub(super) struct Described {
    pub robot: Robot,
    pub notes: Vec<String>,
}

/// A robot in the making.
struct Making<'a> {
    model: &'a Model,
    reduced: &'a Reduced,
    /// The body of each link that has one.
    body_of: Vec<Option<usize>>,
    /// The frame of the body in that of the link.
    frames: Vec<Pose<f64>>,
    motors: Vec<Motor>,
    notes: Vec<String>,
}

/// A link on the way to a body, with its frame in that of what the body hangs on when all joints are at zero.
struct OnWay {
    link: usize,
    frame: Pose<f64>,
}

/// The robot of a case.
///
/// # Errors
/// When the case has no reduced model, or one without inertia.
pub(super) fn describe(model: &Model, name: &str) -> Result<Described, ExchangeError> {
    let reduced = Reduced::new(model)?;
    if !reduced.has_inertia {
        return Err(ExchangeError::WithoutInertia);
    }
    let mut making = Making {
        model,
        reduced: &reduced,
        body_of: vec![None; reduced.tree.links().len()],
        frames: Vec::new(),
        motors: Vec::new(),
        notes: Vec::new(),
    };
    for (body, part) in reduced.parts.iter().enumerate() {
        let solid = Solid::of(&model.bodies[body], model.case.geometry)?;
        making.body_of[part.link] = Some(body);
        making.frames.push(part.inside.then(&Pose::at(-solid.center)));
    }
    let bodies = making.bodies()?;
    let tendons = making.tendons();
    making.left_out();
    let case = &model.case;
    let fluid = (case.reduced_model().loads == LoadLaw::Ellipsoid)
        .then(|| Fluid { density: case.fluid.density, viscosity: case.reference_viscosity() });
    let step = step_of(model);
    let Making { motors, notes, .. } = making;
    let gravity = reduced.gravity.into();
    let name = name.to_owned();
    let robot = Robot { name, gravity, step, fluid, bodies, motors, tendons };
    Ok(Described { robot, notes })
}

impl Making<'_> {
    /// All bodies, in the order of their links.
    fn bodies(&mut self) -> Result<Vec<RobotBody>, ExchangeError> {
        let mut made: Vec<RobotBody> = Vec::new();
        for link in 0..self.reduced.tree.links().len() {
            let Some(body) = self.body_of[link] else { continue };
            let nth = made.len();
            let one = self.body(body, nth, &made)?;
            made.push(one);
        }
        Ok(made)
    }

    /// A body, which gets a number.
    fn body(
        &mut self,
        body: usize,
        number: usize,
        made: &[RobotBody],
    ) -> Result<RobotBody, ExchangeError> {
        let (model, reduced) = (self.model, self.reduced);
        let (one, part) = (&model.bodies[body], &reduced.parts[body]);
        let links = reduced.tree.links();
        let mut way = vec![part.link];
        let mut above = part.link;
        while above > 0 && self.body_of[links[above].parent].is_none() {
            above = links[above].parent;
            way.insert(0, above);
        }
        let parent = (above > 0).then(|| self.body_of[links[above].parent]).flatten();
        let mut frame = match parent {
            Some(parent) => seen_from(&self.frames[parent], &Pose::identity()),
            None => reduced.start.root.pose(),
        };
        let mut joints = Vec::new();
        for link in way {
            if link > 0 {
                frame = frame.then(&links[link].at);
                joints.push(OnWay { link, frame });
            }
        }
        let pose = frame.then(&self.frames[body]);
        let solid = Solid::of(one, model.case.geometry)?;
        if part.mass == 0.0 {
            self.notes.push(format!(
                "\"{}\" has no mass, which MuJoCo and `alewife import` refuse of a body that moves: give it a small \
                 `mass` in the case, and `inertia`",
                one.name
            ));
        }
        let is_root = part.link == 0;
        let mut robot = RobotBody {
            name: one.name.clone(),
            parent: parent.and_then(|parent| {
                made.iter().position(|other| other.name == model.bodies[parent].name)
            }),
            pose,
            mass: part.mass,
            center: solid.center,
            inertia: in_space(&part.inertia),
            is_free: is_root && reduced.tree.n_root() == 6,
            velocity: [Vector3::zeros(); 2],
            joints: Vec::new(),
            ellipsoids: self.ellipsoids(part),
            extent: Some(solid.semi_axes),
            middle: solid.center + solid.middle,
            largest: None,
            displaced: 0.0,
            lifted_at: solid.center,
        };
        if is_root {
            self.root(&mut robot);
        }
        self.joints(&mut robot, number, &joints);
        robot.displaced = self.lift(&robot, part.link);
        Ok(robot)
    }

    /// How a first body without a joint moves, and how fast it starts.
    fn root(&self, robot: &mut RobotBody) {
        let reduced = self.reduced;
        let twist = reduced.tree.twists(&reduced.start)[0];
        robot.velocity = [twist.linear, twist.angular];
        if reduced.tree.n_root() != 3 {
            return;
        }
        // Of a planar tree: along x and y of the world, and about z through the centre of mass
        let [x, y, z] = [0, 1, 2].map(|axis| robot.pose.rotation.tr_mul(&Vector3::ith(axis, 1.0)));
        let starts = [twist.linear.x, twist.linear.y, twist.angular.z];
        let kinds = [JointKind::Slider, JointKind::Slider, JointKind::Hinge];
        for (((kind, axis), rate), name) in
            kinds.into_iter().zip([x, y, z]).zip(starts).zip(["x", "y", "angle"])
        {
            robot.joints.push(RobotJoint {
                name: format!("{}.{name}", robot.name),
                kind,
                axis,
                position: robot.center,
                stiffness: 0.0,
                rest: 0.0,
                damping: 0.0,
                armature: 0.0,
                start: [0.0, rate],
                from: 0.0,
            });
        }
    }

    /// The joints on the way to a body, which has a number.
    fn joints(&mut self, robot: &mut RobotBody, number: usize, way: &[OnWay]) {
        let (tree, start) = (&self.reduced.tree, &self.reduced.start);
        for (nth, OnWay { link, frame }) in way.iter().enumerate() {
            let (joint, Some(velocity)) = (&tree.links()[*link].joint, tree.velocity_of(*link))
            else {
                continue;
            };
            let own = seen_from(&robot.pose, frame);
            let name = match way.len() {
                1 => robot.name.clone(),
                _ => format!("{}.{}", robot.name, nth + 1),
            };
            let at = JointOf { body: number, nth: robot.joints.len() };
            self.motor(&name, at, *link, velocity);
            robot.joints.push(RobotJoint {
                name,
                kind: joint.kind,
                axis: own.rotation * joint.axis,
                position: own.position,
                stiffness: joint.stiffness,
                rest: joint.rest,
                damping: joint.damping,
                armature: joint.armature,
                start: [start.coordinates[velocity], start.velocities[velocity]],
                from: 0.0,
            });
        }
    }

    /// What drives the joint of a link.
    fn motor(&mut self, name: &str, joint: JointOf, link: usize, velocity: usize) {
        let (reduced, told) = (self.reduced, &self.reduced.told[link]);
        let command = told.command(0.0);
        let asked = match told {
            Told::Given(stroke) | Told::Effort(stroke) => stroke.command(),
            Told::Nothing | Told::Way(_) | Told::Rate(..) => None,
        };
        let limits = asked.and_then(|command| command.limits);
        let mut add = |end: &str, law: MotorLaw, control: f64| {
            let limits = limits.filter(|_| !matches!(law, MotorLaw::Rate { .. }));
            self.motors.push(Motor { name: format!("{name}{end}"), joint, law, control, limits });
        };
        match (reduced.tree.links()[link].joint.drive, told) {
            (Drive::Servo { gain, limit }, _) => {
                let limit = limit.is_finite().then_some(limit);
                add("", MotorLaw::Rate { gain, limit }, command.rate);
            }
            (Drive::Effort, Told::Effort(_)) => add("", MotorLaw::Effort, command.effort),
            (Drive::Effort, _) => {}
            (Drive::Given | Drive::Rate, _) => {
                let inertia = inertia_of(&reduced.tree, velocity);
                let frequency = STIFFNESS / step_of(self.model);
                let place = MotorLaw::Place { gain: inertia * frequency * frequency };
                let rate = MotorLaw::Rate { gain: 2.0 * inertia * frequency, limit: None };
                add(".place", place, reduced.start.coordinates[velocity]);
                add(".rate", rate, command.rate);
            }
        }
    }

    /// Ellipsoids with loads of the fluid.
    fn ellipsoids(&self, part: &Part) -> Vec<RobotEllipsoid> {
        if self.model.case.reduced_model().loads != LoadLaw::Ellipsoid {
            return Vec::new();
        }
        let coefficients =
            std::array::from_fn(|k| part.coefficients.get(k).copied().unwrap_or_default());
        let body = self.body_of[part.link].unwrap_or_default();
        let placed = part.laws().into_iter().map(|piece| RobotEllipsoid {
            pose: seen_from(&self.frames[body], &part.inside.then(&piece.place)),
            semi_axes: piece.law.semi_axes(),
            coefficients,
        });
        placed.collect()
    }

    /// Mass of the fluid that a body displaces, which MJCF has at the centre of mass.
    fn lift(&mut self, robot: &RobotBody, link: usize) -> f64 {
        let Some(Weight { displaced, mass_center, buoyancy_center, .. }) =
            self.reduced.tree.links()[link].weight
        else {
            return 0.0;
        };
        let apart = (mass_center - buoyancy_center).norm();
        let has_weight = self.reduced.gravity != [0.0; 3];
        if has_weight && displaced > 0.0 {
            let size = robot.extent.map_or(1.0, |extent| extent.max());
            if apart > ROUNDING * size {
                self.notes.push(format!(
                    "buoyancy of \"{}\" acts {apart} m from its centre of mass in the case, and at \
                     it in the file: the torque between weight and buoyancy is left out",
                    robot.name
                ));
            }
            return displaced;
        }
        0.0
    }

    fn tendons(&self) -> Vec<RobotTendon> {
        let names = self.model.case.reduced_model().tendon.into_iter().map(|tendon| tendon.name);
        let order: Vec<usize> = self.body_of.iter().filter_map(|body| *body).collect();
        let made = self.reduced.tree.tendons().iter().zip(names).map(|(tendon, name)| {
            let site = |site: &alewife_reduced::tree::Site<f64>| {
                let body = self.body_of[site.link]?;
                let frame = seen_from(&self.frames[body], &Pose::at(site.place));
                let number = order.iter().position(|one| *one == body)?;
                Some(RobotSite { body: number, position: frame.position })
            };
            let (stiffness, damping, rest) = (tendon.stiffness, tendon.damping, tendon.rest);
            let sites = tendon.sites.iter().filter_map(site).collect();
            RobotTendon { name, sites, stiffness, damping, rest, pushes: tendon.pushes }
        });
        made.collect()
    }

    /// What the case has that no file of robots does.
    fn left_out(&mut self) {
        let (spec, case) = (self.model.case.reduced_model(), &self.model.case);
        let mut note = |text: String| self.notes.push(text);
        let resists = |part: &Part| part.coefficients.iter().any(|one| *one != 0.0);
        if spec.loads != LoadLaw::Ellipsoid && self.reduced.parts.iter().any(resists) {
            note(format!(
                "loads by the law \"{}\" are left out: the file has masses, joints and motors, and no \
                 fluid",
                spec.loads.name()
            ));
        }
        if spec.loads == LoadLaw::Ellipsoid {
            if spec.added_mass != Some(AddedMassSpec::Mujoco) {
                note(
                    "the case has the whole added mass, MuJoCo no resistance of the fluid to \
                     accelerations: reduced.added_mass = \"mujoco\" has the case do the same"
                        .to_owned(),
                );
            }
            if spec.lift != Some(LiftSpec::Mujoco3) {
                note(
                    "the lift of small ellipsoids is that of MuJoCo 4: MuJoCo 3 has the one of \
                     reduced.lift = \"mujoco-3\""
                        .to_owned(),
                );
            }
        }
        let is_si =
            matches!(&case.units, Units::Words(words) if words.trim().eq_ignore_ascii_case("si"));
        if !is_si {
            note("numbers are in the units of the case, which are not SI".to_owned());
        }
        if case.geometry != crate::case::Geometry::Spatial {
            note(
                "a case in the plane is a length across it of one: masses and efforts are those of a \
                 metre; moments about x and y, which do nothing, are those about z"
                    .to_owned(),
            );
        }
        let thrusters: Vec<&str> = spec.thruster.iter().map(|one| one.name.as_str()).collect();
        if !thrusters.is_empty() {
            note(format!("thrusters are left out: {}", thrusters.join(", ")));
        }
        let pulled: Vec<usize> = self.reduced.pulls.iter().map(|pull| pull.link).collect();
        for link in pulled {
            if let Some(body) = self.body_of[link] {
                let name = &self.model.bodies[body].name;
                self.notes
                    .push(format!("force and torque on \"{name}\" from outside are left out"));
            }
        }
    }
}

/// The time step (s); a second of a steady case, which has no reduced model.
fn step_of(model: &Model) -> f64 {
    match &model.case.time {
        TimeSettings::Unsteady(time) => time.step,
        TimeSettings::Steady(_) => 1.0,
    }
}

/// Moments of a planar body, of which only that about z is known, as those of one in space.
fn in_space(inertia: &Matrix3<f64>) -> Matrix3<f64> {
    let about_z = inertia[(2, 2)];
    let is_planar = inertia[(0, 0)] == 0.0 && inertia[(1, 1)] == 0.0;
    if is_planar { Matrix3::from_diagonal_element(about_z) } else { *inertia }
}

/// Inertia that a joint feels at the start of a tree, that of the fluid included.
fn inertia_of(tree: &Tree<f64>, velocity: usize) -> f64 {
    let mut state = tree.rest();
    state.velocities[velocity] = 1.0;
    2.0 * tree.kinetic_energy(&state)
}
