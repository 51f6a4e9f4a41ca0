//! The quantities of bodies and of the joints they hang by.

use nalgebra::{DVector, Vector3};

use super::value::Value;
use crate::body::{Twist, Wrench, on_mesh};
use crate::case::{BodyQuantity, Case, Geometry, JointQuantity};
use crate::coupling::{
    BaseReport, BodyLoads, BodyShapes, BodyStates, FlexibleReport, FlexibleStates, JointReport,
    Problem, RigidBody, ShapeError, flexible_report, joint_reports,
};
use crate::gait::RecoilCorrection;
use crate::run::RunError;
use crate::run::simulation::Simulation;
use crate::run::snapshot::BodyReport;
use crate::state::State;
use crate::structure::Bend;

/// Factors that make coefficients of loads; not numbers without `[scales]`.
pub(super) struct Coefficients {
    /// Coefficient per force (1/N).
    pub(super) force: f64,
    /// Coefficient per torque (1/(N m)).
    pub(super) moment: f64,
}

impl Coefficients {
    /// c = 2 F / (rho U^2 A) and the same with a length for torques.
    pub(super) fn of(case: &Case) -> Self {
        let Some(scales) = case.scales.filter(|_| case.has_coefficients()) else {
            return Self { force: f64::NAN, moment: f64::NAN };
        };
        let area = scales.area.unwrap_or(match case.geometry {
            Geometry::Planar => scales.length,
            Geometry::Axisymmetric | Geometry::Spatial => {
                std::f64::consts::PI * scales.length.powi(2) / 4.0
            }
        });
        let force = 2.0 / (case.fluid.density * scales.velocity.powi(2) * area);
        Self { force, moment: force / scales.length }
    }
}

/// What a field does to a body with a magnetic moment.
pub(super) struct MagneticReport {
    /// Force and torque of the field.
    load: Wrench,
    /// Angle from the moment to the field (rad).
    lag: f64,
}

impl MagneticReport {
    /// Of a body, if it has a moment.
    pub(super) fn of<const D: usize>(
        problem: &Problem<D>,
        state: &State<D>,
        body: usize,
    ) -> Option<Self> {
        let (magnet, pose) = (problem.bodies[body].magnet.as_ref()?, &state.poses[body]);
        let lag = magnet.lag(state.time, pose, D == 2);
        Some(Self { load: magnet.load(state.time, pose), lag })
    }
}

/// The rod a body is.
#[derive(Clone, Copy)]
pub(super) struct RodReport {
    energies: FlexibleReport,
    bend: Bend,
}

impl RodReport {
    /// Of a body, if it is one, with the loads of the fluid on all bodies.
    pub(super) fn of<const D: usize>(
        problem: &Problem<D>,
        state: &State<D>,
        loads: &[BodyLoads],
        body: usize,
    ) -> Option<Self> {
        let energies = flexible_report(problem, body, &flexible_states(state, loads))?;
        let (rigid, pose) = (&problem.bodies[body], &state.poses[body]);
        let flexible = rigid.flexible()?;
        let own = problem.coordinates()[body].clone();
        let coordinates = DVector::from_column_slice(&state.shapes.now[own]);
        let bend = flexible.bend(&coordinates)?;
        // Places are seen from where the body was put, its pose from where its centre is
        let from_center = bend.tip - flexible.way_of_center(&coordinates);
        let tip = pose.center + pose.to_world(&from_center);
        Some(Self { energies, bend: Bend { tip, ..bend } })
    }
}

/// Bodies with coordinates in a state, with the loads of the fluid on all bodies.
pub(in crate::run) fn flexible_states<'a, const D: usize>(
    state: &'a State<D>,
    loads: &'a [BodyLoads],
) -> FlexibleStates<'a> {
    FlexibleStates {
        time: state.time,
        coordinates: &state.shapes.now,
        rates: &state.now.rates,
        accelerations: &state.shapes.accelerations,
        poses: &state.poses,
        loads,
        contact: &state.contact.wrenches,
    }
}

/// A body as it moves, with its loads.
pub(super) struct BodyMotion<'a> {
    pub report: &'a BodyReport,
    /// Angle over all turns (rad).
    pub angle: f64,
    pub acceleration: &'a Twist,
    pub coefficients: &'a Coefficients,
    pub magnetic: Option<MagneticReport>,
    pub rod: Option<RodReport>,
}

impl BodyMotion<'_> {
    fn magnetic_load(&self) -> Option<Wrench> {
        self.magnetic.as_ref().map(|report| report.load)
    }

    fn of_rod(&self, value: impl Fn(&RodReport) -> f64) -> Value {
        self.rod.as_ref().map_or(f64::NAN, value).into()
    }

    fn base(&self) -> Option<BaseReport> {
        self.rod.as_ref().and_then(|rod| rod.energies.base)
    }

    pub(super) fn value(&self, quantity: BodyQuantity) -> Value {
        let BodyReport { pose, twist, load, surface_load, contact, power, .. } = self.report;
        match quantity {
            BodyQuantity::Position => pose.center.into(),
            BodyQuantity::Angle => self.angle.into(),
            BodyQuantity::Orientation => Value::Quaternion(*pose.rotation().quaternion()),
            BodyQuantity::Direction => pose.to_world(&Vector3::x()).into(),
            BodyQuantity::Velocity => twist.linear.into(),
            BodyQuantity::AngularVelocity => twist.angular.into(),
            BodyQuantity::BodyAngularVelocity => pose.to_body(&twist.angular).into(),
            BodyQuantity::Acceleration => self.acceleration.linear.into(),
            BodyQuantity::Force => load.force.into(),
            BodyQuantity::Torque => load.torque.into(),
            BodyQuantity::SurfaceForce => surface_load.force.into(),
            BodyQuantity::SurfaceTorque => surface_load.torque.into(),
            BodyQuantity::Power => (*power).into(),
            BodyQuantity::DragCoefficient => (load.force.x * self.coefficients.force).into(),
            BodyQuantity::LiftCoefficient => (load.force.y * self.coefficients.force).into(),
            BodyQuantity::SideCoefficient => (load.force.z * self.coefficients.force).into(),
            BodyQuantity::MomentCoefficient => (load.torque.z * self.coefficients.moment).into(),
            BodyQuantity::MagneticTorque => Value::of(self.magnetic_load().map(|load| load.torque)),
            BodyQuantity::MagneticForce => Value::of(self.magnetic_load().map(|load| load.force)),
            BodyQuantity::MagneticLag => {
                self.magnetic.as_ref().map_or(f64::NAN, |report| report.lag).into()
            }
            BodyQuantity::MagneticPower => {
                let power = |load: Wrench| load.to_vector().dot(&twist.to_vector());
                self.magnetic_load().map_or(f64::NAN, power).into()
            }
            BodyQuantity::ElasticEnergy => self.of_rod(|rod| rod.energies.elastic_energy),
            BodyQuantity::KineticEnergy => self.of_rod(|rod| rod.energies.kinetic_energy),
            BodyQuantity::ActivationPower => self.of_rod(|rod| rod.energies.inner.activation),
            BodyQuantity::EndPower => self.of_rod(|rod| rod.energies.inner.ends),
            BodyQuantity::InternalDissipation => self.of_rod(|rod| rod.energies.inner.dissipation),
            BodyQuantity::BaseForce => Value::of(self.base().map(|base| base.load.force)),
            BodyQuantity::BaseTorque => Value::of(self.base().map(|base| base.load.torque)),
            BodyQuantity::BasePower => self.base().map_or(f64::NAN, |base| base.power).into(),
            BodyQuantity::Curvature => self.of_rod(|rod| rod.bend.curvature),
            BodyQuantity::Tip => Value::of(self.rod.as_ref().map(|rod| rod.bend.tip)),
            BodyQuantity::ContactForce => contact.force.into(),
            BodyQuantity::ContactTorque => contact.torque.into(),
        }
    }
}

pub(super) fn joint_value(joint: &JointReport, quantity: JointQuantity) -> Value {
    Value::Scalar(match quantity {
        JointQuantity::Angle | JointQuantity::Length => joint.coordinate,
        JointQuantity::Rate => joint.rate,
        JointQuantity::Torque | JointQuantity::Force => joint.load,
        JointQuantity::Power => joint.power,
    })
}

/// Reports of all bodies.
///
/// # Errors
/// When a gait fails.
pub(super) fn body_reports<const D: usize>(
    simulation: &Simulation<D>,
    loads: &[BodyLoads],
) -> Result<Vec<BodyReport>, RunError> {
    let Simulation { problem, state, work, .. } = simulation;
    let stress = work.system.surface_stress(problem, &state.mesh, &state.now);
    let in_mesh = state.in_mesh(&state.poses);
    let report = |(body, rigid): (usize, &RigidBody)| {
        Ok(BodyReport {
            name: rigid.name.clone(),
            pose: state.poses[body],
            twist: state.now.twists[body],
            load: loads[body].load,
            surface_load: stress.load(
                rigid.boundary,
                problem.metric,
                &on_mesh(&in_mesh[body].center),
            ) + work.system.mean_load(body, &state.now),
            friction: stress.friction(rigid.boundary),
            contact: state.contact.wrenches[body],
            power: loads[body].power,
            recoil: recoil(rigid, state.time)?,
        })
    };
    problem.bodies.iter().enumerate().map(report).collect()
}

/// What is subtracted from the gait of a body that deforms by itself.
fn recoil(rigid: &RigidBody, time: f64) -> Result<Option<RecoilCorrection>, ShapeError> {
    if rigid.flexible().is_some() {
        return Ok(None);
    }
    Ok(rigid.deformed_at(time, &[])?.map(|deformed| deformed.recoil))
}

/// The joints of all bodies, in the order of their children.
///
/// # Errors
/// When a gait fails.
pub(in crate::run) fn measure_joints<const D: usize>(
    problem: &Problem<D>,
    state: &State<D>,
    loads: &[BodyLoads],
) -> Result<Vec<JointReport>, ShapeError> {
    if !problem.has_joints() {
        return Ok(Vec::new());
    }
    let contact = &state.contact.wrenches;
    let loads: Vec<Wrench> =
        loads.iter().zip(contact).map(|(fluid, contact)| fluid.load + *contact).collect();
    let now = BodyStates {
        shapes: &BodyShapes::with(&problem.bodies, state.time, &state.shapes.now)?,
        poses: &state.poses,
        twists: &state.now.twists,
        accelerations: &state.accelerations,
        loads: &loads,
    };
    Ok(joint_reports(problem, &now))
}
