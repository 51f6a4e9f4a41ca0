//! `Problem`: what never changes during a run: fluid, sides of the domain, bodies.

use std::sync::Arc;

use alewife_mesh::{Moments, Point, SecondMoments};

use super::link::Link;
use super::swimming::Group;
use crate::body::{Pose, Wrench};
use crate::flow::BodyForce;
use crate::gait::{DeformedOutline, Gait, ShapeMotion};
use crate::space::Metric;

/// A velocity as a function of place and time (m, s, m/s).
pub type VelocityProfile = Box<dyn Fn(&Point<2>, f64) -> Point<2> + Send + Sync>;

/// A number as a function of time.
pub type TimeValue = Box<dyn Fn(f64) -> f64 + Send + Sync>;

/// Times (s) between two times, ascending.
pub type RateDiscontinuities = Box<dyn Fn(f64, f64) -> Vec<f64> + Send + Sync>;

/// What holds on a boundary that is not a body.
pub enum Side {
    /// Given velocity. Where two such sides meet, a wall's value counts.
    Velocity {
        /// The velocity.
        profile: VelocityProfile,
        /// Whether the side is a wall rather than an inflow.
        is_wall: bool,
    },
    /// mu du/dn - p n = 0.
    DoNothing,
    /// sigma n = 0.
    TractionFree,
    /// No velocity along this coordinate, no traction along the other.
    Symmetry {
        /// 0 for x, 1 for y.
        normal_axis: usize,
    },
    /// One of a periodic pair; the mesh knows the partner nodes.
    Periodic,
}

/// One of the three rigid velocities of a body: U_x, U_y, omega.
pub enum Drive {
    /// An unknown of the system.
    Free,
    /// Given in time (m/s or rad/s); the reaction is an output.
    Given(TimeValue),
    /// That of the bodies it hangs on.
    Linked,
}

/// A body in the fluid.
pub struct RigidBody {
    /// Name in the case file.
    pub name: String,
    /// Its boundary in the mesh.
    pub boundary: usize,
    /// Pose at time zero, the angle within (-pi, pi].
    pub pose: Pose,
    /// U_x, U_y, omega.
    pub drives: [Drive; 3],
    /// Mass (kg; kg/m planar).
    pub mass: f64,
    /// Moment of inertia about z through the centre of mass (kg m2; kg m planar).
    pub inertia: f64,
    /// Volume (m3; area planar, m2).
    pub volume: f64,
    /// Moment of inertia of a body of this shape with unit density.
    pub second_moment: f64,
    /// Weight less buoyancy.
    pub weight: Wrench,
    /// External load besides, at the time its factor is one.
    pub load: Wrench,
    /// Factor of the external load in time.
    pub load_factor: Option<TimeValue>,
    /// Spring and damper.
    pub spring: Option<Spring>,
    /// Slip of the surface.
    pub gait: Option<Box<dyn Gait>>,
    /// How its outline deforms.
    pub shape: Option<Arc<dyn ShapeMotion>>,
    /// The body it hangs on; its place and velocity, but for a free pivot's turn, follow from it.
    pub link: Option<Link>,
}

/// A linear spring and damper between a body and a place; entries for x, y and the turn.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Spring {
    /// Force per way (N/m), torque per angle (N m/rad).
    pub stiffness: [f64; 3],
    /// Force per velocity (N s/m), torque per angular velocity (N m s/rad).
    pub damping: [f64; 3],
    /// Where it is at rest (m, m, rad).
    pub rest: [f64; 3],
}

impl RigidBody {
    /// Centre and angle at time zero (m, rad).
    #[must_use]
    pub fn start(&self) -> [f64; 3] {
        [self.pose.center.x, self.pose.center.y, self.pose.heading()]
    }

    /// Force along x and y (N) and torque (N m) from outside, fluid, springs and contact left out.
    #[must_use]
    pub fn external(&self, time: f64) -> [f64; 3] {
        let factor = self.load_factor.as_ref().map_or(1.0, |factor| factor(time));
        let (weight, load) = (self.weight.in_plane(), self.load.in_plane());
        [0, 1, 2].map(|mode| weight[mode] + factor * load[mode])
    }

    /// Moment of inertia with an outline (kg m2; kg m planar), that at rest for a rigid body.
    #[must_use]
    pub fn inertia_with(&self, outline: Option<&DeformedOutline>) -> f64 {
        match outline {
            Some(outline) if self.inertia > 0.0 => {
                self.inertia * second_moment(&outline.moments) / self.second_moment
            }
            _ => self.inertia,
        }
    }
}

/// The second moment that resists turning about an axis across the plane or the axis of revolution.
#[must_use]
pub fn second_moment(moments: &Moments) -> f64 {
    match moments.second {
        SecondMoments::Planar { polar } => polar,
        // On the axis a body does not turn.
        SecondMoments::Revolved { across, .. } => across,
    }
}

/// Everything that is given.
pub struct Problem {
    /// Cartesian, or revolved about x.
    pub metric: Metric,
    /// Density (kg/m3).
    pub density: f64,
    /// Dynamic viscosity (Pa s).
    pub viscosity: f64,
    /// Whether fluid and bodies have inertia (else quasi-steady Stokes flow).
    pub has_inertia: bool,
    /// Whether the fluid is convected.
    pub has_convection: bool,
    /// What holds on each boundary of the mesh; `None` for bodies.
    pub sides: Vec<Option<Side>>,
    /// The bodies, in the order of their boundaries.
    pub bodies: Vec<RigidBody>,
    /// Bodies that swim, as they are told of.
    pub groups: Vec<Group>,
    /// The body the frame travels with.
    pub frame: Option<usize>,
    /// Force per unit volume, for manufactured solutions.
    pub body_force: Option<BodyForce<'static, 2>>,
    /// Times at which the rates of gaits jump, if they ever do.
    pub rate_discontinuities: Option<RateDiscontinuities>,
}

impl Problem {
    /// Whether no boundary fixes the level of the pressure.
    #[must_use]
    pub fn is_enclosed(&self) -> bool {
        !self
            .sides
            .iter()
            .flatten()
            .any(|side| matches!(side, Side::DoNothing | Side::TractionFree))
    }

    /// Whether nothing holds fluid and bodies along x and along y: without inertia, walls, given
    /// velocities and springs only differences of velocities are determined.
    ///
    /// There the mean velocity of fluid and bodies together is zero: no net volume crosses the cell.
    #[must_use]
    pub fn drifts(&self) -> [bool; 2] {
        let is_loose = |body: &RigidBody, axis: usize| {
            let is_held =
                |spring: &Spring| spring.stiffness[axis] != 0.0 || spring.damping[axis] != 0.0;
            !matches!(body.drives[axis], Drive::Given(_))
                && !body.spring.as_ref().is_some_and(is_held)
        };
        let slides = |side: &Side, axis: usize| match side {
            Side::Periodic => true,
            Side::Symmetry { normal_axis } => *normal_axis != axis,
            _ => false,
        };
        let sides = || self.sides.iter().flatten();
        let has_periods = sides().any(|side| matches!(side, Side::Periodic));
        [0, 1].map(|axis| {
            !self.metric.is_revolved()
                && !self.has_inertia
                && has_periods
                && sides().all(|side| slides(side, axis))
                && self.bodies.iter().all(|body| is_loose(body, axis))
        })
    }

    /// Whether the work of bodies depends on the level of the pressure, which nothing fixes, by the
    /// trace of flux that interpolated gaits carry.
    #[must_use]
    pub fn works_on_level(&self) -> bool {
        self.is_enclosed()
            && self.bodies.iter().any(|body| body.gait.is_some() || body.shape.is_some())
    }

    /// The velocity given at a place (m, s) on these boundaries, bodies left out; a wall's value
    /// counts where boundaries meet.
    #[must_use]
    pub fn given_velocity(
        &self,
        boundaries: &[usize],
        place: &Point<2>,
        time: f64,
    ) -> Option<Point<2>> {
        let given = |walls: bool| {
            boundaries.iter().find_map(|&boundary| match &self.sides[boundary] {
                Some(Side::Velocity { profile, is_wall }) if *is_wall == walls => Some(profile),
                _ => None,
            })
        };
        given(true).or_else(|| given(false)).map(|profile| profile(place, time))
    }

    /// Coordinates along which there is no velocity on these boundaries by symmetry.
    pub fn symmetry_axes(&self, boundaries: &[usize]) -> impl Iterator<Item = usize> {
        boundaries.iter().filter_map(|&boundary| match self.sides[boundary] {
            Some(Side::Symmetry { normal_axis }) => Some(normal_axis),
            _ => None,
        })
    }

    /// Boundaries with the do-nothing condition.
    #[must_use]
    pub fn do_nothing_sides(&self) -> Vec<usize> {
        let is_open = |side: &Option<Side>| matches!(side, Some(Side::DoNothing));
        (0..self.sides.len()).filter(|&boundary| is_open(&self.sides[boundary])).collect()
    }
}
