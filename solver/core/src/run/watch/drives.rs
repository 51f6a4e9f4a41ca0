//! What drives fluid and bodies: the work done on them, and the speeds it gives by itself.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use alewife_mesh::BoundaryId;

use crate::body::{Mode, Pose, in_space};
use crate::contact::MinimumGap;
use crate::coupling::{
    Drive, Joint, JointReport, Length, MeanFlowAlong, RigidBody, ShapeError, Side, SurfaceLoads,
    Turn, flexible_report,
};
use crate::run::measure::{flexible_states, measure_joints};
use crate::run::simulation::Simulation;
use crate::state::{Drives, LoadStep};

/// Drag coefficient below those of all bodies that are not streamlined: it makes terminal speeds too high.
const LOW_DRAG: f64 = 0.1;

/// Radius over the radius of gyration, about that of a sphere.
const RADIUS: f64 = 1.6;

/// A body and as much fluid as it displaces, roughly: what accelerates with it.
struct Bulk {
    /// Mass (kg; kg/m planar).
    mass: f64,
    /// Radius (m).
    radius: f64,
}

impl Bulk {
    /// That of a body in fluid of a density (kg/m3).
    fn new(body: &RigidBody, density: f64) -> Self {
        let volume = body.volume.mass;
        let gyration = body.volume.tensor.diagonal().max() / volume;
        Self { mass: body.inertia.mass + density * volume, radius: RADIUS * gyration.sqrt() }
    }
}

/// The largest power where it is work that is done, and not taken.
fn supplied(power: f64) -> f64 {
    power.max(0.0)
}

impl<const D: usize> Simulation<D> {
    /// Notes what drives fluid and bodies in a step that has been made, with these loads of the fluid.
    ///
    /// # Errors
    /// When a gait gives its body no shape.
    pub(in crate::run) fn record_drives(&mut self, loads: &SurfaceLoads) -> Result<(), ShapeError> {
        if !self.problem.has_inertia {
            return Ok(());
        }
        let drives = Drives {
            // By the rule of the implicit scheme, for which the balance of energy is an inequality
            work: self.state.last_step * self.power(loads)?,
            given_speed: self.given_speed(),
            loads: self.load_steps(),
            gradient: self.gradient(),
        };
        self.state.record_drives(&drives);
        Ok(())
    }

    /// Rate of work on fluid and bodies (W), without what is taken from them again.
    fn power(&self, loads: &SurfaceLoads) -> Result<f64, ShapeError> {
        let Self { problem, state, work, .. } = self;
        let mut power = supplied(loads.sides_power) + self.energy_inflow();
        power += supplied(work.system.power_of_given_loads(
            problem,
            &state.mesh,
            &state.now,
            state.time,
        ));
        let mean_flow = work.system.mean_flow(&problem.mean_flow_at(state.time), &state.now);
        let counted = self.counted();
        power += mean_flow.map_or(0.0, |report| supplied(report.power));
        let flexible = flexible_states(state, &loads.bodies);
        for (index, body) in problem.bodies.iter().enumerate() {
            let (twist, pose) = (state.now.twists[index].to_vector(), &state.poses[index]);
            let fluid = loads.bodies[index];
            if let Some(report) = flexible_report(problem, index, &flexible) {
                power += supplied(report.inner.activation) + supplied(report.inner.ends);
                // What a body does whose energy is counted comes from it
                let is_outer =
                    body.attachment.as_ref().is_none_or(|attachment| !counted[attachment.to]);
                let base = report.base.filter(|_| is_outer);
                power += base.map_or(0.0, |base| supplied(base.power));
            }
            if counted[index] {
                power += supplied(body.external(state.time, pose).dot(&twist));
                // That of its surface on the fluid beside its motion as a whole
                if body.gait.is_some() {
                    power += supplied(fluid.power + fluid.load.to_vector().dot(&twist));
                }
            } else {
                power += supplied(fluid.power);
                power += supplied(-state.contact.wrenches[index].to_vector().dot(&twist));
            }
        }
        for joint in measure_joints(problem, state, &loads.bodies)? {
            if counted[joint.child]
                && let Some(hinge) = &problem.bodies[joint.child].joint
            {
                power += supplied(actuator_power(hinge, &joint, state.time));
            }
        }
        Ok(power)
    }

    /// Kinetic energy that enters through the sides (W).
    fn energy_inflow(&self) -> f64 {
        let Self { problem, state, work, .. } = self;
        if !problem.has_convection {
            return 0.0;
        }
        let stress = work.system.surface_stress(problem, &state.mesh, &state.now);
        let frame = problem.frame_velocity(&state.now.twists);
        let sides = problem.sides.iter().enumerate().filter(|(_, side)| {
            matches!(
                side,
                Some(
                    Side::Velocity { is_wall: false, .. }
                        | Side::DoNothing
                        | Side::TractionFree
                        | Side::Pressure { .. }
                        | Side::Traction { .. }
                )
            )
        });
        let inflow = |(side, _): (usize, &Option<Side<D>>)| {
            problem.density * stress.energy_inflow(BoundaryId::new(side), &frame)
        };
        sides.map(inflow).sum()
    }

    /// Whether what acts on each body is known, so that its energy is counted: where it is moved, or deforms,
    /// or hangs on such a body, only its work on the fluid is.
    fn counted(&self) -> Vec<bool> {
        let bodies = &self.problem.bodies;
        let root = |mut body: usize| {
            while let Some(parent) = bodies[body].joint.as_ref().and_then(|joint| joint.parent) {
                body = parent;
            }
            body
        };
        let roots: Vec<usize> = (0..bodies.len()).map(root).collect();
        let is_moved =
            |body: &RigidBody| body.drives.iter().any(|drive| matches!(drive, Drive::Given(_)));
        let mut is_known: Vec<bool> = bodies.iter().map(|body| !is_moved(body)).collect();
        for (body, &root) in bodies.iter().zip(&roots) {
            is_known[root] &= body.shape.is_none() || body.flexible().is_some();
        }
        roots.into_iter().map(|root| is_known[root]).collect()
    }

    /// The largest speed that is given (m/s).
    fn given_speed(&self) -> f64 {
        let Self { problem, state, .. } = self;
        let mean = |along: MeanFlowAlong| match along {
            MeanFlowAlong::Velocity(speed) => speed.abs(),
            _ => 0.0,
        };
        let mean_flow = problem.mean_flow_at(state.time).along.map(mean);
        let surfaces = self.surface_speeds();
        let bodies = problem.bodies.iter().zip(surfaces).map(|(body, surface)| {
            let radius = Bulk::new(body, problem.density).radius;
            let given = |mode: Mode| {
                let length = if mode.is_rotation() { radius } else { 1.0 };
                length * body.drive(mode).given(state.time).unwrap_or(0.0).abs()
            };
            let moved: f64 = Mode::ALL.into_iter().map(given).sum();
            let stroke =
                body.joint.as_ref().map_or(0.0, |joint| stroke_speed(joint, radius, state.time));
            moved + stroke + surface
        });
        let given = bodies.chain(mean_flow).fold(0.0, f64::max);
        given.max(self.side_speed())
    }

    /// Largest speed of the surface of each body relative to it (m/s); zero of rigid ones without slip.
    fn surface_speeds(&self) -> Vec<f64> {
        let Self { problem, state, .. } = self;
        let mut speeds = vec![0.0; problem.bodies.len()];
        let moves = |body: &RigidBody| body.gait.is_some() || body.shape.is_some();
        let own = problem.bodies.iter().enumerate().filter(|(_, body)| moves(body));
        let own: BTreeMap<BoundaryId, usize> =
            own.map(|(index, body)| (body.boundary, index)).collect();
        if own.is_empty() {
            return speeds;
        }
        let poses = state.in_mesh(&state.poses);
        for facet in &state.mesh.facets {
            let Some(&body) = own.get(&facet.boundary) else { continue };
            let (Pose { center, .. }, twist) = (poses[body], state.now.twists[body]);
            for node in state.mesh.facet_nodes(facet) {
                let lever = in_space(&state.mesh.nodes[node]) - center;
                let speed = in_space(&state.now.velocity[node]) - twist.velocity_at(&lever);
                speeds[body] = f64::max(speeds[body], speed.norm());
            }
        }
        speeds
    }

    /// Largest speed of the sides with a given velocity (m/s).
    fn side_speed(&self) -> f64 {
        let sides = &self.problem.sides;
        let is_given =
            |boundary: BoundaryId| matches!(sides[boundary], Some(Side::Velocity { .. }));
        let Self { state, .. } = self;
        let facets = state.mesh.facets.iter().filter(|facet| is_given(facet.boundary));
        let nodes = facets.flat_map(|facet| state.mesh.facet_nodes(facet));
        nodes.map(|node| state.now.velocity[node].norm()).fold(0.0, f64::max)
    }

    /// Loads on the bodies, and what they do by themselves.
    fn load_steps(&self) -> Vec<LoadStep> {
        let Self { problem, state, .. } = self;
        let step = |(body, pose): (&RigidBody, &Pose)| {
            let Bulk { mass, radius } = Bulk::new(body, problem.density);
            let external = body.external(state.time, pose);
            let [force, torque] =
                [0, 3].map(|first| external.fixed_rows::<3>(first).into_owned().norm());
            let motor =
                body.joint.as_ref().map_or(0.0, |joint| motor_load(joint, radius, state.time));
            // However it is turned: the torque of a field that it is turned along may be any later
            let magnet = body.magnet.as_ref();
            let magnetic = magnet.map_or(0.0, |magnet| magnet.largest_torque(state.time, pose));
            let buoyant = body.buoyancy.map_or(0.0, |lever| lever.largest_torque());
            let ends = body.given_load_at_ends(state.time).size(radius);
            let load = force + (torque + magnetic + buoyant) / radius + motor + ends;
            LoadStep { load, acceleration: load / mass }
        };
        problem.bodies.iter().zip(&state.poses).map(step).collect()
    }

    /// Force per volume on the fluid, over its density (m/s2).
    fn gradient(&self) -> f64 {
        let mean_flow = self.problem.mean_flow_at(self.state.time);
        let gradient = |along: MeanFlowAlong| match along {
            MeanFlowAlong::PressureGradient(gradient) => gradient,
            _ => 0.0,
        };
        let force = mean_flow.along.map(gradient).map(f64::abs).into_iter().sum::<f64>();
        (force + mean_flow.body_force.norm() + self.given_loads()) / self.problem.density
    }

    /// The speed that is given, or that what drives gives by itself to a fluid or a body (m/s): loads by free fall, or
    /// by terminal speeds where those are lower; of a steady flow by these alone.
    pub(in crate::run) fn drive_speed(&self, is_steady: bool) -> f64 {
        let Self { problem, state, .. } = self;
        let supply = &state.supply;
        let density = problem.density;
        let bodies = problem.bodies.iter().zip(&supply.loads).map(|(body, history)| {
            let radius = Bulk::new(body, density).radius;
            let area = if D == 2 && !problem.metric.is_revolved() {
                2.0 * radius
            } else {
                PI * radius * radius
            };
            let viscosity = problem.viscosity.at_stress(history.largest / (2.0 * PI * area));
            let slow = history.largest / (2.0 * PI * viscosity * area / radius);
            let fast = (2.0 * history.largest / (LOW_DRAG * density * area)).sqrt();
            let terminal = slow.min(fast);
            if is_steady { terminal } else { terminal.min(history.free_fall) }
        });
        let loads = bodies.fold(0.0, f64::max);
        // Between walls as far apart as the domain is long
        let extent = self.extent();
        let pull = supply.largest_gradient * density * extent;
        let viscosity = problem.viscosity.at_stress(pull);
        let viscous = supply.largest_gradient * density * extent * extent / viscosity;
        let gradient = if is_steady { viscous } else { viscous.min(supply.gradient_speed) };
        supply.given_speed + loads + gradient + supply.initial_speed
    }

    /// The speed of fluid and bodies (m/s), and that which an energy (J) gives the lightest body.
    pub(super) fn start_speed(&self, energy: f64) -> f64 {
        let Self { problem, state, .. } = self;
        let masses = problem.bodies.iter().map(|body| Bulk::new(body, problem.density).mass);
        let lightest = masses.fold(f64::INFINITY, f64::min);
        state.now.top_speed() + (2.0 * energy / lightest).sqrt()
    }

    /// Kinetic energy of the bodies that are counted (J).
    pub(super) fn kinetic_energy_of_bodies(&self) -> f64 {
        let Self { problem, state, .. } = self;
        let of_body = |(index, body): (usize, &RigidBody)| {
            body.inertia.kinetic_energy(&state.poses[index], &state.now.twists[index])
                + problem.kinetic_energy_of_coordinates(index, &state.now.rates)
        };
        let (bodies, counted) = (problem.bodies.iter().enumerate(), self.counted());
        bodies.filter(|(index, _)| counted[*index]).map(of_body).sum()
    }

    /// Energy of the springs of bodies and joints that are counted (J).
    ///
    /// # Errors
    /// When a gait gives its body no shape.
    pub(super) fn elastic_energy(&self) -> Result<f64, ShapeError> {
        let Self { problem, state, .. } = self;
        let (mut energy, counted) = (0.0, self.counted());
        for (index, body) in problem.bodies.iter().enumerate() {
            if !counted[index] {
                continue;
            }
            if let Some(spring) = &body.spring {
                let way = state.poses[index].displacement_from(&spring.rest);
                energy += 0.5 * spring.stiffness.component_mul(&way).dot(&way);
            }
            energy += problem.elastic_energy(index, &state.shapes.now, state.time);
        }
        let no_loads = SurfaceLoads::none(problem.bodies.len()).bodies;
        for joint in measure_joints(problem, state, &no_loads)? {
            if counted[joint.child]
                && let Some(hinge) = &problem.bodies[joint.child].joint
            {
                energy += elastic_energy(hinge, joint.coordinate);
            }
        }
        Ok(energy)
    }

    /// Energy of contact at the start (J): of every body as of the pair with the smallest gap.
    pub(in crate::run) fn contact_energy(&self) -> f64 {
        let Self { problem, state, law, .. } = self;
        match (law, state.contact.minimum_gap) {
            (Some(law), Some(MinimumGap { gap, .. })) if gap > 0.0 => {
                problem.bodies.len() as f64 * law.energy(gap)
            }
            _ => 0.0,
        }
    }

    /// Largest speed of a body as a whole (m/s).
    pub(in crate::run) fn fastest_body(&self) -> f64 {
        let Self { problem, state, .. } = self;
        let speed = |(body, twist): (&RigidBody, &crate::body::Twist)| {
            twist.linear.norm() + twist.angular.norm() * Bulk::new(body, problem.density).radius
        };
        problem.bodies.iter().zip(&state.now.twists).map(speed).fold(0.0, f64::max)
    }
}

/// Rate of work (W) of what moves a joint: a stroke or a motor, without spring and damper.
fn actuator_power(joint: &Joint, report: &JointReport, time: f64) -> f64 {
    let law = match (&joint.arm, &joint.turn) {
        (Some(arm), _) => match &arm.length {
            Length::Given(_) => return report.power,
            Length::Free(law) => law,
        },
        (None, Turn::Given { .. }) => return report.power,
        (None, Turn::Free(pivot)) => &pivot.law,
    };
    law.motor.as_ref().map_or(0.0, |motor| motor(time)) * report.rate
}

/// Energy (J) of the spring of a joint.
fn elastic_energy(joint: &Joint, coordinate: f64) -> f64 {
    let law = match (&joint.arm, &joint.turn) {
        (Some(arm), _) => match &arm.length {
            Length::Given(_) => return 0.0,
            Length::Free(law) => law,
        },
        (None, Turn::Given { .. }) => return 0.0,
        (None, Turn::Free(pivot)) => &pivot.law,
    };
    0.5 * law.stiffness * (coordinate - law.rest).powi(2)
}

/// The speed a stroke gives the far end of a body of a radius (m/s).
fn stroke_speed(joint: &Joint, radius: f64, time: f64) -> f64 {
    let arm = joint.arm.as_ref().map_or(0.0, |arm| match &arm.length {
        Length::Given(length) => length(time)[1].abs(),
        Length::Free(_) => 0.0,
    });
    let turn = match &joint.turn {
        Turn::Given { angle, .. } => angle(time)[1].abs() * 2.0 * (joint.on_child.norm() + radius),
        Turn::Free(_) => 0.0,
    };
    arm + turn
}

/// The force of a motor (N), of a torque that at the radius of the body.
fn motor_load(joint: &Joint, radius: f64, time: f64) -> f64 {
    let load =
        |law: &crate::coupling::JointLaw| law.motor.as_ref().map_or(0.0, |motor| motor(time).abs());
    let arm = joint.arm.as_ref().map_or(0.0, |arm| match &arm.length {
        Length::Free(law) => load(law),
        Length::Given(_) => 0.0,
    });
    let turn = match &joint.turn {
        Turn::Free(pivot) => load(&pivot.law) / radius,
        Turn::Given { .. } => 0.0,
    };
    arm + turn
}
