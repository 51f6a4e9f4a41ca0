//! `Problem`: what never changes during a run: fluid, sides of the domain, bodies.

mod attachment;
mod body;
mod group;
mod in_time;
mod joint;
mod lever;
mod magnet;
mod mean_flow;
mod side;

use std::ops::Range;

use alewife_mesh::{BoundaryId, Point};
use nalgebra::{DVector, Matrix6};

pub use attachment::{Attachment, BodyVector, OnBody};
pub use body::{Drive, RigidBody, Spring, second_moments};
pub use group::Group;
pub use in_time::{MovingValue, RateDiscontinuities, TimeValue};
pub(in crate::coupling) use joint::FreeArm;
pub use joint::{Arm, Joint, JointLaw, Length, Pivot, Turn, angle_about};
pub use lever::Lever;
pub use magnet::{FieldPart, LocalField, Magnet, MagneticField, UniformField};
pub use mean_flow::{MeanFlow, MeanFlowAlong, MeanFlowAt};
pub use side::{PressureProfile, Side, VelocityProfile};

use crate::body::{Mode, Modes, Pose, Twist, on_mesh};
use crate::flow::{Convection, LocalViscosity, OpenSide, Viscosity, ViscosityTerm};
use crate::space::Metric;
use crate::structure::Held;

/// Everything that is given.
pub struct Problem<const D: usize> {
    /// Cartesian, or revolved about x.
    pub metric: Metric,
    /// Density (kg/m3).
    pub density: f64,
    /// Dynamic viscosity (Pa s), or the law it follows.
    pub viscosity: Viscosity,
    /// Whether fluid and bodies have inertia (else quasi-steady Stokes flow).
    pub has_inertia: bool,
    /// Whether the fluid is convected.
    pub has_convection: bool,
    /// What holds on each boundary of the mesh; `None` for bodies.
    pub sides: Vec<Option<Side<D>>>,
    /// Whether their loads are asked for.
    pub reports_sides: bool,
    /// The bodies, in the order of their boundaries.
    pub bodies: Vec<RigidBody>,
    /// Bodies that are reported as one.
    pub groups: Vec<Group>,
    /// The body the frame travels with.
    pub frame: Option<usize>,
    /// What drives the fluid along periodic directions.
    pub mean_flow: Option<MeanFlow<D>>,
    /// Force per unit volume on the fluid (N/m3) by place (m) and time (s).
    pub force: Option<VelocityProfile<D>>,
    /// Velocity at the start (m/s), where it is not that of a fluid at rest.
    pub initial: Option<VelocityProfile<D>>,
    /// Times at which the rates of gaits jump, if they ever do.
    pub rate_discontinuities: Option<RateDiscontinuities>,
}

impl<const D: usize> Problem<D> {
    /// The rigid motions bodies have.
    #[must_use]
    pub fn modes(&self) -> Modes {
        match (self.metric, D) {
            (Metric::Revolved, _) => Modes::AXISYMMETRIC,
            (Metric::Cartesian, 2) => Modes::PLANAR,
            (Metric::Cartesian, _) => Modes::SPATIAL,
        }
    }

    /// The coordinates each body has beside its pose, among those of all bodies.
    #[must_use]
    pub fn coordinates(&self) -> Vec<Range<usize>> {
        coordinate_ranges(&self.bodies)
    }

    /// Coordinates of all bodies together.
    #[must_use]
    pub fn n_coordinates(&self) -> usize {
        self.coordinates().last().map_or(0, |last| last.end)
    }

    /// Coordinates of all bodies at time zero.
    #[must_use]
    pub fn initial_coordinates(&self) -> Vec<f64> {
        initial_coordinates(&self.bodies)
    }

    /// Coordinates that are given at a time (s), numbered through all bodies.
    #[must_use]
    pub fn held_coordinates(&self, time: f64) -> Vec<Held> {
        let bodies = self.bodies.iter().zip(self.coordinates());
        let held = |(body, own): (&RigidBody, Range<usize>)| {
            let held = body.flexible().map(|flexible| flexible.held(time)).unwrap_or_default();
            let numbered =
                move |held: Held| Held { coordinate: own.start + held.coordinate, ..held };
            held.into_iter().map(numbered).collect::<Vec<_>>()
        };
        bodies.flat_map(held).collect()
    }

    /// Gives coordinates of bodies that are fixed to others, among these of all bodies, what they are with bodies at poses.
    pub fn follow_attachments(&self, poses: &[Pose], coordinates: &mut [f64]) {
        for AttachedCoordinate { coordinate, own, to, given } in self.attached_coordinates() {
            coordinates[coordinate] = given.value(&self.bodies[own].pose, &poses[to]);
        }
    }

    /// Coordinates of bodies that are fixed to others.
    #[must_use]
    pub fn attached_coordinates(&self) -> Vec<AttachedCoordinate> {
        let bodies = self.bodies.iter().enumerate().zip(self.coordinates());
        let of_body = |((own, body), range): ((usize, &RigidBody), Range<usize>)| {
            let attachment = body.attachment.clone();
            let to = attachment.as_ref().map_or(own, |attachment| attachment.to);
            let all = attachment.map(|attachment| attachment.coordinates).unwrap_or_default();
            let numbered = move |given: OnBody| AttachedCoordinate {
                coordinate: range.start + given.coordinate,
                own,
                to,
                given,
            };
            all.into_iter().map(numbered)
        };
        bodies.flat_map(of_body).collect()
    }

    /// Kinetic energy (J) of a body by the rates of its coordinates among those of all bodies; zero of a rigid one, and
    /// without inertia.
    #[must_use]
    pub fn kinetic_energy_of_coordinates(&self, body: usize, rates: &[f64]) -> f64 {
        let Some(flexible) = self.bodies[body].flexible().filter(|_| self.has_inertia) else {
            return 0.0;
        };
        let rates = DVector::from_column_slice(&rates[self.coordinates()[body].clone()]);
        0.5 * rates.dot(&(flexible.mass() * &rates))
    }

    /// Elastic energy (J) of a body at a time (s) with its coordinates among these of all bodies; zero of a rigid one.
    #[must_use]
    pub fn elastic_energy(&self, body: usize, coordinates: &[f64], time: f64) -> f64 {
        let Some(flexible) = self.bodies[body].flexible() else { return 0.0 };
        let own = DVector::from_column_slice(&coordinates[self.coordinates()[body].clone()]);
        flexible.elastic_energy(&own, time)
    }

    /// Puts bodies with coordinates as far from where they started as these of all bodies have their centres.
    pub fn follow_coordinates(&self, poses: &mut [Pose], coordinates: &[f64]) {
        let bodies = self.bodies.iter().zip(self.coordinates());
        for ((body, own), pose) in bodies.zip(poses) {
            let Some(flexible) = body.flexible() else { continue };
            let own = DVector::from_column_slice(&coordinates[own]);
            let way = flexible.way_of_center(&own);
            pose.center = body.pose.center + body.pose.to_world(&way);
        }
    }

    /// The viscosity of a system in which a law is taken at the strain of a velocity at the nodes (m/s), with or without its
    /// tangent.
    #[must_use]
    pub fn viscosity_at<'a>(
        &self,
        velocity: &'a [Point<D>],
        has_tangent: bool,
    ) -> ViscosityTerm<'a, D> {
        match self.viscosity {
            Viscosity::Newtonian(value) => ViscosityTerm::Constant(value),
            law => ViscosityTerm::Local(LocalViscosity { law, velocity, has_tangent }),
        }
    }

    /// Whether some body is free, or hangs on a joint that is.
    #[must_use]
    pub fn gives_way(&self) -> bool {
        self.bodies.iter().any(|body| {
            body.drives.iter().any(|drive| matches!(drive, Drive::Free))
                || body.joint.as_ref().is_some_and(Joint::is_free)
        })
    }

    /// Whether no boundary fixes the level of the pressure.
    #[must_use]
    pub fn is_enclosed(&self) -> bool {
        !self.sides.iter().flatten().any(Side::is_open)
    }

    /// Along which coordinates nothing holds fluid and bodies: without inertia, walls, given
    /// velocities and springs only differences of velocities are determined.
    ///
    /// There the mean velocity of fluid and bodies together is zero: no net volume crosses the cell.
    #[must_use]
    pub fn free_translations(&self) -> [bool; D] {
        let is_loose = |body: &RigidBody, axis: usize| {
            let mode = Mode::along(axis);
            let spring = body.spring.as_ref();
            let is_held =
                spring.is_some_and(|s| s.stiffness[mode] != 0.0 || s.damping[mode] != 0.0);
            let hangs = body.joint.as_ref().is_some_and(|joint| joint.parent.is_none());
            !matches!(body.drive(mode), Drive::Given(_) | Drive::Held) && !is_held && !hangs
        };
        let sides = || self.sides.iter().flatten();
        let has_periods = sides().any(|side| matches!(side, Side::Periodic));
        std::array::from_fn(|axis| {
            !self.metric.is_revolved()
                && !self.has_inertia
                && has_periods
                && sides().all(|side| side.lets_slide(axis))
                && self.bodies.iter().all(|body| is_loose(body, axis))
        })
    }

    /// Whether forces or tractions on the fluid are given.
    #[must_use]
    pub fn has_given_loads(&self) -> bool {
        let has_traction =
            |side: &Side<D>| matches!(side, Side::Pressure { .. } | Side::Traction { .. });
        self.force.is_some() || self.sides.iter().flatten().any(has_traction)
    }

    /// What is given of the mean flow at a time (s).
    #[must_use]
    pub fn mean_flow_at(&self, time: f64) -> MeanFlowAt<D> {
        let mean_flow = self.mean_flow.as_ref();
        let given = mean_flow.map_or_else(MeanFlowAt::default, |mean_flow| mean_flow.at(time));
        MeanFlowAt { time, ..given }
    }

    /// Whether the power of bodies depends on the level of the pressure, which nothing fixes, by the
    /// small net flux that interpolated gaits carry.
    #[must_use]
    pub fn power_depends_on_pressure_level(&self) -> bool {
        self.is_enclosed()
            && self.bodies.iter().any(|body| body.gait.is_some() || body.shape.is_some())
    }

    /// The velocity given at a point (m, s) on these boundaries, bodies left out; a wall's value
    /// counts where boundaries meet.
    #[must_use]
    pub fn given_velocity(
        &self,
        boundaries: &[BoundaryId],
        point: &Point<D>,
        time: f64,
    ) -> Option<Point<D>> {
        let given = |walls: bool| {
            boundaries.iter().find_map(|&boundary| match &self.sides[boundary] {
                Some(Side::Velocity { profile, is_wall }) if *is_wall == walls => Some(profile),
                _ => None,
            })
        };
        given(true).or_else(|| given(false)).map(|profile| profile(point, time))
    }

    /// Coordinates along which there is no velocity on these boundaries by symmetry.
    pub fn symmetry_axes(&self, boundaries: &[BoundaryId]) -> impl Iterator<Item = usize> {
        boundaries.iter().filter_map(|&boundary| match self.sides[boundary] {
            Some(Side::Symmetry { normal_axis }) => Some(normal_axis),
            _ => None,
        })
    }

    /// Sides with terms of their own in the equations of the fluid.
    #[must_use]
    pub fn open_sides(&self) -> Vec<OpenSide> {
        let open = |(boundary, side): (usize, &Option<Side<D>>)| {
            let side = side.as_ref()?;
            let (is_developed, backflow) = (side.is_developed(), side.backflow());
            (is_developed || backflow > 0.0).then_some(OpenSide {
                boundary,
                is_developed,
                backflow,
            })
        };
        self.sides.iter().enumerate().filter_map(open).collect()
    }

    /// Velocity of the frame with these velocities of the bodies (m/s); none in the laboratory.
    #[must_use]
    pub fn frame_velocity(&self, twists: &[Twist]) -> Point<D> {
        self.frame.map_or(Point::<D>::zeros(), |body| on_mesh(&twists[body].linear))
    }

    /// Whether a body is rigid, hangs on no other one and carries none.
    #[must_use]
    pub fn is_alone(&self, body: usize) -> bool {
        let RigidBody { joint, shape, .. } = &self.bodies[body];
        let mut joints = self.bodies.iter().filter_map(|other| other.joint.as_ref());
        joint.is_none() && shape.is_none() && joints.all(|joint| joint.parent != Some(body))
    }

    /// A mass matrix of a body without the motions that are held or given.
    #[must_use]
    pub fn free_inertia(&self, body: usize, inertia: &Matrix6<f64>) -> Matrix6<f64> {
        let is_free = |index: usize| {
            let drive = self.bodies[body].drive(Mode::ALL[index]);
            self.modes().iter().any(|mode| mode.index() == index)
                && matches!(drive, Drive::Free | Drive::Linked)
        };
        Matrix6::from_fn(|i, j| if is_free(i) && is_free(j) { inertia[(i, j)] } else { 0.0 })
    }

    /// Whether any body hangs on another.
    #[must_use]
    pub fn has_joints(&self) -> bool {
        self.bodies.iter().any(|body| body.joint.is_some())
    }

    /// Pairs of bodies that share a pivot, or of which one is fixed to the other.
    #[must_use]
    pub fn pairs_on_pivots(&self) -> Vec<[usize; 2]> {
        let pair = |(child, body): (usize, &RigidBody)| {
            if let Some(attachment) = &body.attachment {
                return Some([attachment.to, child]);
            }
            let joint = body.joint.as_ref().filter(|joint| joint.arm.is_none())?;
            Some([joint.parent?, child])
        };
        self.bodies.iter().enumerate().filter_map(pair).collect()
    }

    /// How convection is linearised by Newton's method: with the frame's velocity among the unknowns
    /// where a frame travels.
    #[must_use]
    pub fn newton_convection(&self) -> Convection {
        match (self.has_convection, self.frame.is_some()) {
            (false, _) => Convection::None,
            (true, false) => Convection::Newton,
            (true, true) => Convection::NewtonInFrame,
        }
    }
}

/// A coordinate of a body that is fixed to another one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AttachedCoordinate {
    /// Its number among those of all bodies.
    pub coordinate: usize,
    /// The body it is of.
    pub own: usize,
    /// The body it is fixed to.
    pub to: usize,
    /// What it is.
    pub given: OnBody,
}

/// Coordinates of all these bodies at time zero.
#[must_use]
pub fn initial_coordinates(bodies: &[RigidBody]) -> Vec<f64> {
    let flexible = bodies.iter().filter_map(RigidBody::flexible);
    flexible.flat_map(|body| body.initial().as_slice().to_vec()).collect()
}

/// The coordinates each body has beside its pose, among those of all these bodies.
#[must_use]
pub fn coordinate_ranges(bodies: &[RigidBody]) -> Vec<Range<usize>> {
    let mut end = 0;
    let next = |body: &RigidBody| {
        let start = end;
        end += body.flexible().map_or(0, |flexible| flexible.n_coordinates());
        start..end
    };
    bodies.iter().map(next).collect()
}
