//! What parts of a model take from the whole: every `command` its name and a history of its own.

use super::Model;
use super::commands::Commands;
use crate::spec::body::command::Command;
use crate::{
    Body, BoundaryCondition, DrivenLaw, EndLoadSpec, EndLoads, EndMoment, GaitSpec, Hold,
    JointKind, MagneticSpec, Motion, Stroke, TimeFunction,
};

/// A command of a body or a side: what it is called there, the key below that of its owner, and the command.
type Found<'a> = (String, String, &'a mut Command);

impl Model {
    /// The same with commands of its own, for which nothing was asked yet: what is asked for in one run must not
    /// reach another.
    #[must_use]
    pub fn disconnected(&self) -> Self {
        let mut model = self.clone();
        model.connect_commands();
        model
    }

    /// Gives expressions of gaits the numbers of the case.
    pub(super) fn define_gaits(&mut self) {
        for body in &mut self.bodies {
            let definitions = match &mut body.gait {
                Some(GaitSpec::Midline(gait)) => &mut gait.definitions,
                Some(GaitSpec::Slip(gait)) => &mut gait.definitions,
                _ => continue,
            };
            definitions.clone_from(&self.case.define);
        }
    }

    /// Finds all commands, and gives each a history.
    pub(super) fn connect_commands(&mut self) {
        let mut commands = Commands::default();
        let written = self.case.joint.len();
        for (index, joint) in self.joints.iter_mut().enumerate() {
            let Some(command) = of_stroke(of_joint(&mut joint.kind)) else { continue };
            let made = index.checked_sub(written);
            let (name, key) = match made.and_then(|made| Some((made, self.joint_names.get(made)?)))
            {
                None => (format!("{}.joint", joint.child), format!("joint.{index}.kind")),
                Some((made, name)) => {
                    let swimmer = self.swimmer_of_joints.get(made).copied().unwrap_or_default();
                    (name.clone(), format!("swimmer.{swimmer}.kind"))
                }
            };
            commands.connect(name, key, command);
        }
        let written = self.case.body.len();
        for (index, body) in self.bodies.iter_mut().enumerate() {
            let made = index.checked_sub(written).and_then(|made| self.swimmer_of_bodies.get(made));
            let name = body.name.clone();
            for (what, below, command) in of_body(body) {
                let key = match made {
                    None => format!("body.{index}.{below}"),
                    Some(swimmer) => format!("swimmer.{swimmer}.kind"),
                };
                commands.connect(format!("{name}.{what}"), key, command);
            }
        }
        for (side, condition) in &mut self.case.boundary {
            if let Some(command) = of_factor(of_side(condition)) {
                commands.connect(format!("{side}.factor"), format!("boundary.{side}"), command);
            }
        }
        let flow = self.case.flow.as_mut().and_then(|flow| flow.factor.as_mut());
        if let Some(command) = of_factor(flow) {
            commands.connect("flow.factor".to_owned(), "flow.factor".to_owned(), command);
        }
        let magnetic = self.case.field.as_mut().and_then(|field| field.magnetic.as_mut());
        for (what, below, command) in magnetic.map(of_magnetic).unwrap_or_default() {
            commands.connect(format!("field.{what}"), format!("field.magnetic.{below}"), command);
        }
        let thrusters = self.case.reduced.iter_mut().flat_map(|reduced| &mut reduced.thruster);
        for (index, thruster) in thrusters.enumerate() {
            if let Some(command) = of_stroke(Some(&mut thruster.drive)) {
                let key = format!("reduced.thruster.{index}.drive");
                commands.connect(format!("thruster.{}", thruster.name), key, command);
            }
        }
        self.commands = commands;
    }
}

fn of_stroke(stroke: Option<&mut Stroke>) -> Option<&mut Command> {
    match stroke {
        Some(Stroke::Command(command)) => Some(command),
        _ => None,
    }
}

fn of_factor(factor: Option<&mut TimeFunction>) -> Option<&mut Command> {
    match factor {
        Some(TimeFunction::Command(command)) => Some(command),
        _ => None,
    }
}

/// The stroke or motor of a joint.
fn of_joint(kind: &mut JointKind) -> Option<&mut Stroke> {
    match kind {
        JointKind::Arm { length, .. } => Some(length),
        JointKind::Bent { angle, .. } => Some(angle),
        JointKind::Hinge(hinge) => hinge.torque.as_mut(),
        JointKind::Slider(slider) => slider.force.as_mut(),
        JointKind::Ball(_) => None,
    }
}

fn of_side(condition: &mut BoundaryCondition) -> Option<&mut TimeFunction> {
    match condition {
        BoundaryCondition::Velocity { factor, .. }
        | BoundaryCondition::Parabolic { factor, .. }
        | BoundaryCondition::Developed { factor, .. }
        | BoundaryCondition::Pressure { factor, .. }
        | BoundaryCondition::Traction { factor, .. }
        | BoundaryCondition::Shear { factor, .. } => factor.as_mut(),
        BoundaryCondition::Profile(profile) => profile.factor.as_mut(),
        BoundaryCondition::NoSlip
        | BoundaryCondition::DoNothing
        | BoundaryCondition::TractionFree
        | BoundaryCondition::Symmetry
        | BoundaryCondition::Axis
        | BoundaryCondition::WavingSheet { .. }
        | BoundaryCondition::Periodic(_) => None,
    }
}

/// Commands of a magnetic field: of its components along the coordinates, and of factors.
fn of_magnetic(magnetic: &mut MagneticSpec) -> Vec<Found<'_>> {
    let components = magnetic.components.iter_mut().enumerate().map(|(axis, stroke)| {
        let name = ["x", "y", "z"][axis.min(2)].to_owned();
        (name, format!("components.{axis}"), Some(stroke))
    });
    let linear = magnetic.linear.iter_mut();
    let linear = linear.map(|one| ("linear".to_owned(), "linear".to_owned(), one.factor.as_mut()));
    let dipoles = magnetic.dipoles.iter_mut().enumerate().map(|(nth, one)| {
        (format!("dipole.{}", nth + 1), format!("dipoles.{nth}"), one.factor.as_mut())
    });
    let strokes = components.chain(linear).chain(dipoles);
    strokes.filter_map(|(name, key, stroke)| Some((name, key, of_stroke(stroke)?))).collect()
}

/// Commands of a body: of its load, its motion and its gait.
fn of_body(body: &mut Body) -> Vec<Found<'_>> {
    let mut found: Vec<Found<'_>> = Vec::new();
    if let Some(command) = of_factor(body.load_factor.as_mut()) {
        found.push(("load".to_owned(), "load_factor".to_owned(), command));
    }
    if let Motion::Imposed(imposed) = &mut body.motion {
        for (what, key, factor) in [
            ("motion", "factor", &mut imposed.factor),
            ("turn", "angular_factor", &mut imposed.angular_factor),
        ] {
            if let Some(command) = of_factor(factor.as_mut()) {
                found.push((what.to_owned(), format!("motion.imposed.{key}"), command));
            }
        }
    }
    for driven in &mut body.driven {
        let what = driven.motion.name();
        let (below, command) = match &mut driven.law {
            DrivenLaw::Way(stroke) => ("imposed", of_stroke(Some(stroke))),
            DrivenLaw::Rate(rate) => ("velocity.factor", of_factor(rate.factor.as_mut())),
        };
        if let Some(command) = command {
            found.push((format!("motion.{what}"), format!("motion.{what}.{below}"), command));
        }
    }
    let muscles = body.activation.iter_mut().flat_map(|active| {
        let about_z = [("curvature", &mut active.curvature), ("moment", &mut active.moment)];
        let about_y =
            [("curvature_y", &mut active.curvature_y), ("moment_y", &mut active.moment_y)];
        let all = about_z.map(|(key, stroke)| ("activation", key, stroke)).into_iter();
        all.chain(about_y.map(|(key, stroke)| ("activation_y", key, stroke)))
    });
    for (name, key, stroke) in muscles {
        if let Some(command) = of_stroke(stroke.as_mut()) {
            found.push((name.to_owned(), format!("activation.{key}"), command));
        }
    }
    found.extend(body.rod.iter_mut().filter_map(|rod| rod.load.as_mut()).flat_map(of_ends));
    if let Some(Hold::Angle(angle)) = body.attached.as_mut().map(|attached| &mut attached.hold)
        && let Some(command) = of_stroke(Some(angle))
    {
        found.push(("angle".to_owned(), "attached.hold.angle".to_owned(), command));
    }
    found.extend(body.gait.iter_mut().flat_map(of_gait));
    found
}

/// Commands of loads at the ends of a rod.
fn of_ends(loads: &mut EndLoads) -> Vec<Found<'_>> {
    let mut found: Vec<Found<'_>> = Vec::new();
    for at_end in loads.ends_mut() {
        let EndLoadSpec { force, moment, .. } = at_end.load;
        let forces = force.iter_mut().zip(["x", "y", "z"]).enumerate();
        let forces = forces.map(|(axis, (stroke, name))| {
            (format!("force.{name}"), format!("force.{axis}"), stroke)
        });
        let is_in_space = matches!(moment, Some(EndMoment::Spatial(_)));
        let moments = moment.iter_mut().flat_map(EndMoment::components_mut);
        let moments = moments.zip(["x", "y", "z"]).enumerate().map(|(axis, (stroke, name))| {
            if is_in_space {
                (format!("moment.{name}"), format!("moment.{axis}"), stroke)
            } else {
                ("moment".to_owned(), "moment".to_owned(), stroke)
            }
        });
        for (name, key, stroke) in forces.chain(moments) {
            if let Some(command) = of_stroke(Some(stroke)) {
                let end = at_end.end.name();
                found.push((format!("{end}.{name}"), format!("rod.load.{end}.{key}"), command));
            }
        }
    }
    found
}

/// Commands of a gait.
fn of_gait(gait: &mut GaitSpec) -> Vec<Found<'_>> {
    let mut found: Vec<Found<'_>> = Vec::new();
    match gait {
        GaitSpec::Squirmer(gait) => {
            for (mode, factor) in &mut gait.factors {
                if let Some(command) = of_factor(Some(factor)) {
                    let key = format!("gait.squirmer.factors.{mode}");
                    found.push((format!("mode.{mode}"), key, command));
                }
            }
            if let Some(command) = of_factor(gait.turn.as_mut()) {
                found.push(("turn".to_owned(), "gait.squirmer.turn".to_owned(), command));
            }
        }
        GaitSpec::Joints(gait) => {
            for (nth, joint) in gait.joints.iter_mut().enumerate() {
                if let Some(command) = of_stroke(Some(&mut joint.angle)) {
                    found.push((format!("joint.{}", nth + 1), "gait".to_owned(), command));
                }
            }
        }
        GaitSpec::Carangiform(gait) => {
            for (what, stroke) in [("beat", &mut gait.beat), ("bend", &mut gait.bend)] {
                if let Some(command) = of_stroke(stroke.as_mut()) {
                    found.push((what.to_owned(), format!("gait.carangiform.{what}"), command));
                }
            }
        }
        // Others wait for nothing
        _ => {}
    }
    found
}
