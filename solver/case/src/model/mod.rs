//! `Model`: what follows from a case: all bodies and joints, those of its swimmers included.

pub(crate) mod balls;
pub(crate) mod commands;
mod connect;
pub(crate) mod copies;
pub(crate) mod derived_number;
mod geometry;
pub(crate) mod impact;
pub(crate) mod numbers;
mod part_pose;
mod parts;
mod probes;
pub(crate) mod random;
pub(crate) mod region;
pub(crate) mod speed;

use std::collections::HashMap;

use self::commands::Commands;
use self::copies::{Individual, individuals, product};
use self::parts::{Part, parts, poses};
use crate::spec::body::joint::LABORATORY;
use crate::text::diagnostic::CaseError;
use crate::{
    AxialVector, Body, BoundaryCondition, Case, Copies, FlowModel, GaitSpec, Geometry, Joint,
    LoadFrame, Motion, SwimmerKind, SwimmerSpec, TimeSettings,
};

/// Most bodies of a case; a run with a tenth of it takes days.
const MOST_BODIES: usize = 20_000;

/// What a case describes: the case as it is written, and the bodies, joints and swimmers that
/// follow from it.
#[derive(Debug, Clone)]
pub struct Model {
    /// The case as it is written.
    pub case: Case,
    /// Bodies of `[[body]]`, then those of each `[[swimmer]]`.
    pub bodies: Vec<Body>,
    /// Joints of `[[joint]]`, then those of each `[[swimmer]]`.
    pub joints: Vec<Joint>,
    /// Individuals of each `[[swimmer]]`, then bodies with a gait that belong to none.
    pub swimmers: Vec<SwimmerModel>,
    /// All that is asked for while a run goes on.
    pub commands: Commands,
    /// Names of the joints of swimmers, after those of `[[joint]]`: `NAME.joint.2`.
    joint_names: Vec<String>,
    /// Number of the `[[swimmer]]` of each body after those of `[[body]]`.
    swimmer_of_bodies: Vec<usize>,
    /// Number of the `[[swimmer]]` of each joint after those of `[[joint]]`.
    swimmer_of_joints: Vec<usize>,
    /// First body of each name.
    by_name: HashMap<String, usize>,
    /// First joint of each name of a child.
    joint_of_child: HashMap<String, usize>,
    /// First joint whose child a body is.
    joint_above: Vec<Option<usize>>,
}

/// Bodies that swim together, and are reported as one.
#[derive(Debug, Clone, PartialEq)]
pub struct SwimmerModel {
    /// Name in `series.csv`.
    pub name: String,
    /// Its bodies; the others are attached to the first one.
    pub bodies: Vec<usize>,
    /// Duration of one cycle (s).
    pub period: Option<f64>,
    /// Drag over velocity when it is towed (N s/m; N s/m2 planar).
    pub resistance: Option<f64>,
}

impl Model {
    /// What follows from a case.
    ///
    /// # Errors
    /// [`CaseError::Wrong`] when the numbers of radii, arms or gaits of a swimmer do not fit, a
    /// body it names does not exist, or there is no space for a copy.
    pub fn new(case: Case) -> Result<Self, CaseError> {
        let mut model = Self {
            bodies: case.body.clone(),
            joints: case.joint.clone(),
            swimmers: Vec::new(),
            commands: Commands::default(),
            joint_names: Vec::new(),
            swimmer_of_bodies: Vec::new(),
            swimmer_of_joints: Vec::new(),
            by_name: HashMap::new(),
            joint_of_child: HashMap::new(),
            joint_above: Vec::new(),
            case,
        };
        if model.bodies.len() > MOST_BODIES {
            let message = format!(
                "{} bodies are more than the {MOST_BODIES} a case may have",
                model.bodies.len()
            );
            return Err(CaseError::at("body", message, "leave some out"));
        }
        for body in 0..model.bodies.len() {
            model.register_name(body);
        }
        for joint in 0..model.joints.len() {
            model.register_child(joint);
        }
        for (index, swimmer) in model.case.swimmer.clone().iter().enumerate() {
            match &swimmer.kind {
                SwimmerKind::Bodies(names) => model.join_bodies(index, swimmer, names)?,
                _ => model.add_individuals(index, swimmer)?,
            }
        }
        model.bodies.iter_mut().for_each(Body::settle_motion);
        model.add_single_bodies();
        model.joint_above = vec![None; model.bodies.len()];
        for (child, joint) in &model.joint_of_child {
            if let Some(&child) = model.by_name.get(child) {
                model.joint_above[child] = Some(*joint);
            }
        }
        model.connect_commands();
        model.define_gaits();
        Ok(model)
    }

    fn register_name(&mut self, body: usize) {
        self.by_name.entry(self.bodies[body].name.clone()).or_insert(body);
    }

    fn register_child(&mut self, joint: usize) {
        self.joint_of_child.entry(self.joints[joint].child.clone()).or_insert(joint);
    }

    /// Makes one swimmer of bodies that exist.
    fn join_bodies(
        &mut self,
        index: usize,
        swimmer: &SwimmerSpec,
        names: &[String],
    ) -> Result<(), CaseError> {
        let find = |name: &String| {
            self.body_index(name).ok_or_else(|| {
                let known: Vec<&str> = self.bodies.iter().map(|body| body.name.as_str()).collect();
                CaseError::at(
                    &format!("swimmer.{index}.kind.bodies"),
                    format!("there is no body \"{name}\" before it"),
                    &format!("bodies: {}", known.join(", ")),
                )
            })
        };
        let bodies = names.iter().map(find).collect::<Result<Vec<usize>, CaseError>>()?;
        let period = swimmer.period.or_else(|| self.period_of(&bodies));
        let (name, resistance) = (swimmer.name.clone(), swimmer.resistance);
        self.swimmers.push(SwimmerModel { name, bodies, period, resistance });
        Ok(())
    }

    /// Period of the first gait of bodies, or else of the first joint they are children of (s).
    fn period_of(&self, bodies: &[usize]) -> Option<f64> {
        let gait = |body: &usize| self.bodies[*body].gait.as_ref().and_then(GaitSpec::period);
        bodies.iter().find_map(gait).or_else(|| {
            let above = |body: &usize| self.joint_of_child.get(&self.bodies[*body].name).copied();
            let mut joints: Vec<usize> = bodies.iter().filter_map(above).collect();
            joints.sort_unstable();
            joints.into_iter().find_map(|joint| self.joints[joint].kind.period())
        })
    }

    /// Makes bodies and joints of all copies of a swimmer.
    fn add_individuals(&mut self, index: usize, swimmer: &SwimmerSpec) -> Result<(), CaseError> {
        let key = format!("swimmer.{index}");
        let parts = parts(&key, &swimmer.kind, self.case.geometry)?;
        self.has_room_for(&key, swimmer, parts.len())?;
        for individual in individuals(&self.case, &key, swimmer, &parts, &self.bodies)? {
            self.add_individual(index, swimmer, &parts, individual);
        }
        Ok(())
    }

    /// Refuses copies that would make more bodies than a run can have, before they are made.
    fn has_room_for(
        &self,
        key: &str,
        swimmer: &SwimmerSpec,
        n_parts: usize,
    ) -> Result<(), CaseError> {
        let (name, written, count) = match &swimmer.copies {
            None => return Ok(()),
            Some(Copies::Lattice { counts, .. }) => {
                let written: Vec<String> = counts.iter().map(usize::to_string).collect();
                ("lattice.counts", written.join(" x "), product(counts))
            }
            Some(Copies::Random { count, .. }) => ("random.count", count.to_string(), Some(*count)),
        };
        let bodies = count.and_then(|count| count.checked_mul(n_parts.max(1)));
        let room = MOST_BODIES.saturating_sub(self.bodies.len());
        if bodies.is_some_and(|bodies| bodies <= room) {
            return Ok(());
        }
        Err(CaseError::at(
            &format!("{key}.copies.{name}"),
            format!(
                "{written} copies of \"{}\" make more than the {MOST_BODIES} bodies a case may have",
                swimmer.name
            ),
            &format!("ask for at most {} copies", room / n_parts.max(1)),
        ))
    }

    fn add_individual(
        &mut self,
        index: usize,
        swimmer: &SwimmerSpec,
        parts: &[Part],
        individual: Individual,
    ) {
        let Individual { name, pose } = individual;
        let first = self.bodies.len();
        for (nth, (part, pose)) in parts.iter().zip(poses(parts, pose)).enumerate() {
            let own = if parts.len() == 1 { name.clone() } else { format!("{name}-{}", nth + 1) };
            let mut motion = swimmer.motion.clone();
            if let Some(attachment) = &part.attachment {
                motion = Motion::Free;
                let parent = format!("{name}-{}", attachment.parent + 1);
                self.joints.push(attachment.joint(parent, own.clone()));
                self.swimmer_of_joints.push(index);
                self.joint_names.push(format!("{name}.joint.{}", attachment.number + 1));
                self.register_child(self.joints.len() - 1);
            }
            self.bodies.push(Body {
                name: own,
                shape: part.shape.clone(),
                center: pose.center(),
                angle: pose.angle(),
                orientation: pose.orientation(),
                density: part.density.or(swimmer.density),
                mass: None,
                inertia: None,
                center_of_mass: Vec::new(),
                motion,
                locked: Vec::new(),
                driven: Vec::new(),
                velocity: Vec::new(),
                angular_velocity: AxialVector::default(),
                gait: part.gait.clone(),
                force: Vec::new(),
                torque: AxialVector::default(),
                load_factor: None,
                load_frame: LoadFrame::default(),
                spring: None,
                magnetic_moment: part.moment_in(swimmer),
                rod: None,
                attached: None,
                activation: None,
                size: swimmer.size,
            });
            self.swimmer_of_bodies.push(index);
            self.register_name(first + nth);
        }
        let mut bodies: Vec<usize> = (first..self.bodies.len()).collect();
        bodies.sort_by_key(|body| parts[body - first].attachment.is_some());
        let period = swimmer.period.or_else(|| swimmer.kind.period());
        self.swimmers.push(SwimmerModel { name, bodies, period, resistance: swimmer.resistance });
    }

    /// A body with a gait that belongs to no swimmer is one itself.
    fn add_single_bodies(&mut self) {
        let mut is_member = vec![false; self.bodies.len()];
        for &body in self.swimmers.iter().flat_map(|swimmer| &swimmer.bodies) {
            is_member[body] = true;
        }
        for (index, body) in self.bodies.iter().enumerate() {
            if let (Some(gait), false) = (&body.gait, is_member[index]) {
                self.swimmers.push(SwimmerModel {
                    name: body.name.clone(),
                    bodies: vec![index],
                    period: gait.period(),
                    resistance: None,
                });
            }
        }
    }

    /// The body of that name.
    #[must_use]
    pub fn body_index(&self, name: &str) -> Option<usize> {
        self.by_name.get(name).copied()
    }

    /// Whether a joint hangs on the laboratory, and not on a body of that name.
    #[must_use]
    pub fn hangs_on_laboratory(&self, joint: &Joint) -> bool {
        joint.parent == LABORATORY && self.body_index(LABORATORY).is_none()
    }

    /// The joint by which a body is attached to another one, by its number in [`Self::joints`].
    #[must_use]
    pub fn joint_above(&self, body: usize) -> Option<usize> {
        self.joint_above[body]
    }

    /// Bodies attached to each body, in the order of [`Self::joints`].
    pub(crate) fn children(&self) -> Vec<Vec<usize>> {
        let mut children = vec![Vec::new(); self.bodies.len()];
        for joint in &self.joints {
            let ends = (self.body_index(&joint.parent), self.body_index(&joint.child));
            if let (Some(parent), Some(child)) = ends {
                children[parent].push(child);
            }
        }
        children
    }

    /// The `[[swimmer]]` a body was made for; `None` of one of `[[body]]`.
    #[must_use]
    pub fn swimmer_of_body(&self, body: usize) -> Option<usize> {
        let made = body.checked_sub(self.case.body.len())?;
        self.swimmer_of_bodies.get(made).copied()
    }

    /// The `[[swimmer]]` a joint was made for; `None` of one of `[[joint]]`.
    #[must_use]
    pub fn swimmer_of_joint(&self, joint: usize) -> Option<usize> {
        let made = joint.checked_sub(self.case.joint.len())?;
        self.swimmer_of_joints.get(made).copied()
    }

    /// The body the frame of reference travels with: that of the name, or the first one of the
    /// swimmer of that name.
    #[must_use]
    pub fn frame_body(&self) -> Option<usize> {
        let name = self.case.frame.as_deref()?;
        self.body_index(name).or_else(|| {
            let swimmer = self.swimmers.iter().find(|swimmer| swimmer.name == name)?;
            swimmer.bodies.first().copied()
        })
    }

    /// Whether the mesh deforms in time: a body moves as seen from the frame, turns and
    /// looks different then, or deforms; or a side of the domain waves.
    #[must_use]
    pub fn mesh_moves(&self) -> bool {
        let case = &self.case;
        let frame = self.frame_body();
        let frame_moves = frame.is_some_and(|body| self.bodies[body].translates(case.geometry));
        let moves = |(index, body): (usize, &Body)| {
            let travels = frame != Some(index) && (body.translates(case.geometry) || frame_moves);
            let turns = case.geometry != Geometry::Axisymmetric && body.turns() && !body.is_round();
            travels || turns || body.deforms()
        };
        let any = !self.joints.is_empty()
            || self.bodies.iter().enumerate().any(moves)
            || case.has_waving_sheet();
        matches!(case.time, TimeSettings::Unsteady(_)) && any
    }

    /// Whether the momentum of the fluid changes by the forces of bodies, sides and a mean flow alone: a
    /// fluid that is convected in time, and does not cross the sides.
    #[must_use]
    pub fn balances_momentum(&self) -> bool {
        let is_closed = |condition: &BoundaryCondition| {
            matches!(
                condition,
                BoundaryCondition::NoSlip
                    | BoundaryCondition::Symmetry
                    | BoundaryCondition::Axis
                    | BoundaryCondition::Periodic(_)
            )
        };
        let case = &self.case;
        case.fluid.model == FlowModel::NavierStokes
            && matches!(case.time, TimeSettings::Unsteady(_))
            && !self.bodies.is_empty()
            && case.fluid.force.is_empty()
            && case.boundary.values().all(is_closed)
    }

    /// Whether all work on the fluid is that of bodies and waving sheets, so that it balances
    /// dissipation and the rate of the kinetic energy. No work is done where there is no traction,
    /// but with inertia the fluid that leaves there takes its kinetic energy along.
    #[must_use]
    pub fn balances_energy(&self) -> bool {
        let is_balanced = |condition: &BoundaryCondition| match condition {
            BoundaryCondition::NoSlip
            | BoundaryCondition::Symmetry
            | BoundaryCondition::Axis
            | BoundaryCondition::Periodic(_)
            | BoundaryCondition::WavingSheet { .. } => true,
            BoundaryCondition::TractionFree => self.case.fluid.model == FlowModel::Stokes,
            _ => false,
        };
        let does_work = !self.bodies.is_empty() || self.case.has_waving_sheet();
        does_work
            && self.case.fluid.force.is_empty()
            && self.case.boundary.values().all(is_balanced)
    }
}
