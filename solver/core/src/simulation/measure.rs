//! The quantities of a run: loads and motions of bodies, probes, integrals of the flow.

use alewife_mesh::{CellId, Locator, Mesh, Point};
use nalgebra::SMatrix;

use super::advance::Simulation;
use super::energy::EnergyRecord;
use super::propulsion_history::PropulsionHistory;
use super::snapshot::BodyReport;
use super::state::State;
use super::{RunError, Stage};
use crate::body::{Twist, Wrench, on_mesh};
use crate::case::{Case, Geometry, Model, Probe, TimeSettings, known_quantities};
use crate::coupling::{
    BodyLoads, BodyShapes, BodyStates, Group, JointReport, Problem, PropulsionPower, group_load,
    joint_reports, mean_motion,
};
use crate::space::{CellValues, Tables, p1_values, p2_values};

/// One value of a probe's point: where it is in the mesh, and with which sign it counts.
struct ProbePoint {
    cell: CellId,
    xi: Point<2>,
    sign: f64,
}

/// Measures a run; made once a mesh.
pub(super) struct Measure {
    names: Vec<String>,
    /// The points of each probe; `None` where there is no fluid, as where a body is in its place.
    probes: Vec<Vec<Option<ProbePoint>>>,
    /// Force coefficient per force, moment coefficient per torque; none without `[scales]`.
    coefficients: Option<[f64; 2]>,
    has_contact: bool,
    balances_energy: bool,
    is_unsteady: bool,
}

/// What is reported of a state.
pub(super) struct Measured {
    /// All bodies.
    pub bodies: Vec<BodyReport>,
    /// The values of all quantities, in the order of their names.
    pub values: Vec<f64>,
}

/// The points of all probes in a mesh.
fn find_probes(case: &Case, mesh: &Mesh<2>) -> Vec<Vec<Option<ProbePoint>>> {
    if case.probe.is_empty() {
        return Vec::new();
    }
    let locator = Locator::new(mesh);
    // A point on an exact curve may lie outside the quadratic geometry.
    let reach = 0.01 * case.mesh.surface.unwrap_or(case.mesh.size);
    // The sides of a periodic mesh may be elsewhere than those of the domain
    let images = case.mesh_domain().images_around(mesh.nodes.iter().copied());
    let find = |point: &[f64], sign: f64| {
        let point = Point::<2>::new(point[0], point[1]);
        let found = images.iter().filter_map(|shift| locator.nearest(point + shift));
        let found = found.min_by(|a, b| a.distance.total_cmp(&b.distance));
        let found = found.filter(|found| found.distance <= reach);
        found.map(|found| ProbePoint { cell: found.cell, xi: found.reference.into(), sign })
    };
    let of_probe = |probe: &Probe| {
        let minus = (!probe.minus.is_empty()).then(|| find(&probe.minus, -1.0));
        std::iter::once(find(&probe.point, 1.0)).chain(minus).collect()
    };
    case.probe.iter().map(of_probe).collect()
}

/// Integrals over the flow.
#[derive(Debug, Clone, Copy, Default)]
struct Integrals {
    dissipation: f64,
    kinetic_energy: f64,
    mass_defect: f64,
}

impl Measure {
    /// Finds the probes in the mesh and names the quantities.
    pub(super) fn new(model: &Model, mesh: &Mesh<2>) -> Result<Self, RunError> {
        let case = &model.case;
        let probes = find_probes(case, mesh);
        for (probe, points) in case.probe.iter().zip(&probes) {
            if let Some(missing) = points.iter().position(Option::is_none) {
                let point = if missing == 0 { &probe.point } else { &probe.minus };
                return Err(RunError::Unsupported(format!(
                    "probe `{}`: point {point:?} is not in the fluid",
                    probe.name
                )));
            }
        }
        let scales = case.scales.filter(|_| case.has_coefficients());
        let coefficients = scales.map(|scales| {
            let area = scales.area.unwrap_or(match case.geometry {
                Geometry::Planar => scales.length,
                Geometry::Axisymmetric => std::f64::consts::PI * scales.length.powi(2) / 4.0,
            });
            let force = 2.0 / (case.fluid.density * scales.velocity.powi(2) * area);
            [force, force / scales.length]
        });
        let has_contact = case.contact.is_some();
        let balances_energy = model.balances_energy();
        let is_unsteady = matches!(case.time, TimeSettings::Unsteady(_));
        let names = known_quantities(model);
        Ok(Self { names, probes, coefficients, has_contact, balances_energy, is_unsteady })
    }

    /// Finds the probes in a mesh that has moved, seen from the frame.
    pub(super) fn find_probes(&mut self, case: &Case, mesh: &Mesh<2>) {
        self.probes = find_probes(case, mesh);
    }

    pub(super) fn names(&self) -> &[String] {
        &self.names
    }

    /// Reports of all bodies and the values of all quantities.
    ///
    /// # Errors
    /// When a gait fails.
    pub(super) fn measure(
        &mut self,
        case: &Case,
        simulation: &mut Simulation<2>,
        loads: &[BodyLoads],
    ) -> Result<Measured, RunError> {
        if simulation.moving_mesh.is_some() && !self.probes.is_empty() {
            let seen = simulation.state.mesh_in_frame();
            simulation.work.timing.measure(Stage::Loads, || self.find_probes(case, &seen));
        }
        let mut timing = simulation.work.timing;
        let measured = timing.measure(Stage::Loads, || self.values(simulation, loads));
        simulation.work.timing = timing;
        measured
    }

    fn values(
        &self,
        simulation: &mut Simulation<2>,
        loads: &[BodyLoads],
    ) -> Result<Measured, RunError> {
        let bodies = body_reports(simulation, loads);
        let Simulation { problem, state, work, moving_mesh, .. } = simulation;
        let mut values = Vec::with_capacity(self.names.len());
        for (body, report) in bodies.iter().enumerate() {
            let (angle, acceleration) = (state.poses[body].angle(), &state.accelerations[body]);
            values.extend(body_values(report, angle, acceleration));
            if let Some([force, moment]) = self.coefficients {
                let Wrench { force: load, torque } = report.load;
                values.extend([load.x * force, load.y * force, torque.z * moment]);
            }
            if self.has_contact {
                let Wrench { force, torque } = report.contact;
                values.extend([force.x, force.y, torque.z]);
            }
        }
        let joints = joints(problem, state, loads)?;
        values.extend(
            joints
                .iter()
                .flat_map(|joint| [joint.coordinate, joint.rate, joint.load, joint.power()]),
        );
        for (group, history) in problem.groups.iter().zip(&state.propulsion) {
            values.extend(group_values(problem, state, group, history, loads));
        }
        for points in &self.probes {
            values.extend(probe_values(state, points));
        }
        let integrals = integrate(work.system.tables(), problem, state);
        values.extend([integrals.dissipation, integrals.kinetic_energy, integrals.mass_defect]);
        if self.balances_energy {
            let now = EnergyRecord {
                time: state.time,
                power: loads.iter().map(|load| load.power).sum(),
                dissipation: integrals.dissipation,
                kinetic_energy: integrals.kinetic_energy,
            };
            values.push(state.energy.add(self.is_unsteady && problem.has_inertia, now));
        }
        if moving_mesh.is_some() {
            let gap = state.contact.minimum_gap.map_or(f64::INFINITY, |minimum| minimum.gap);
            values.extend([gap, state.mesh.n_cells() as f64, state.remeshes as f64]);
        }
        Ok(Measured { bodies, values })
    }
}

/// Reports of all bodies.
fn body_reports(simulation: &Simulation<2>, loads: &[BodyLoads]) -> Vec<BodyReport> {
    let Simulation { problem, state, work, .. } = simulation;
    let stress = work.system.surface_stress(problem, &state.mesh, &state.now);
    let in_mesh = state.in_mesh(&state.poses);
    let report = |(body, rigid): (usize, &crate::coupling::RigidBody)| BodyReport {
        name: rigid.name.clone(),
        pose: state.poses[body],
        twist: state.now.twists[body],
        load: loads[body].load,
        surface_load: stress.load(rigid.boundary, problem.metric, &on_mesh(&in_mesh[body].center)),
        contact: state.contact.wrenches[body],
        power: loads[body].power,
    };
    problem.bodies.iter().enumerate().map(report).collect()
}

/// Velocity and pressure of a probe; not a number where there is no fluid.
fn probe_values(state: &State<2>, points: &[Option<ProbePoint>]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for point in points {
        let Some(point) = point else { return [f64::NAN; 3] };
        let nodes = state.mesh.cell(point.cell);
        for (&node, phi) in nodes.iter().zip(p2_values(&point.xi)) {
            sum[0] += point.sign * phi * state.now.velocity[node][0];
            sum[1] += point.sign * phi * state.now.velocity[node][1];
        }
        for (&node, psi) in nodes.iter().zip(p1_values(&point.xi)) {
            sum[2] += point.sign * psi * state.now.pressure[node];
        }
    }
    sum
}

/// The joints of all bodies.
fn joints(
    problem: &Problem<2>,
    state: &State<2>,
    loads: &[BodyLoads],
) -> Result<Vec<JointReport>, RunError> {
    if !problem.has_joints() {
        return Ok(Vec::new());
    }
    let contact = &state.contact.wrenches;
    let loads: Vec<Wrench> =
        loads.iter().zip(contact).map(|(fluid, contact)| fluid.load + *contact).collect();
    let now = BodyStates {
        shapes: &BodyShapes::at(&problem.bodies, state.time)?,
        poses: &state.poses,
        twists: &state.now.twists,
        accelerations: &state.accelerations,
        loads: &loads,
    };
    Ok(joint_reports(problem, &now))
}

/// Values of a group in the order of [`known_quantities`].
fn group_values(
    problem: &Problem<2>,
    state: &State<2>,
    group: &Group,
    history: &PropulsionHistory,
    loads: &[BodyLoads],
) -> Vec<f64> {
    let mean = mean_motion(problem, group, &state.poses, &state.now.twists);
    let PropulsionPower { power, shape_power, expended_power, thrust, drag, .. } = history.power();
    let linear = mean.twist.linear;
    let mut values = Vec::new();
    if group.bodies.len() > 1 {
        let load = group_load(group, &mean.center, &state.poses, loads);
        let angle = state.poses[group.bodies[0]].angle();
        values.extend([mean.center.x, mean.center.y, angle, linear.x, linear.y]);
        values.extend([mean.twist.angular.z, load.force.x, load.force.y, load.torque.z, power]);
    }
    values.extend([shape_power, expended_power, thrust, drag]);
    match group.period {
        Some(period) => {
            let means = history.cycles.means(period, group.resistance);
            values.extend(means.displacement);
            values.extend([means.speed, means.power, means.cost_of_transport]);
            values.extend([means.efficiency, means.drift]);
            values.extend(group.resistance.map(|_| means.lighthill_efficiency));
        }
        None => {
            let towing = |force: f64| force * linear.norm_squared() / power;
            values.extend(group.resistance.map(towing));
        }
    }
    values
}

/// Values in the order of [`known_quantities`].
fn body_values(report: &BodyReport, angle: f64, acceleration: &Twist) -> [f64; 15] {
    [
        report.pose.center.x,
        report.pose.center.y,
        angle,
        report.twist.linear.x,
        report.twist.linear.y,
        report.twist.angular.z,
        acceleration.linear.x,
        acceleration.linear.y,
        report.load.force.x,
        report.load.force.y,
        report.load.torque.z,
        report.surface_load.force.x,
        report.surface_load.force.y,
        report.surface_load.torque.z,
        report.power,
    ]
}

/// Dissipation int 2 mu D : D, kinetic energy int rho u^2 / 2, and int div u.
fn integrate(tables: &Tables<2>, problem: &Problem<2>, state: &State<2>) -> Integrals {
    let mut sums = Integrals::default();
    let mut workspace = CellValues::default();
    for cell in state.mesh.cell_ids() {
        let nodes = state.mesh.cell(cell);
        workspace.for_each_point(tables, &state.mesh, cell, |at| {
            let mut velocity = Point::<2>::zeros();
            let mut gradient = SMatrix::<f64, 2, 2>::zeros();
            for (a, &node) in nodes.iter().enumerate() {
                let nodal = &state.now.velocity[node];
                velocity += nodal * at.phi[a];
                gradient += nodal * at.grad_phi[a].transpose();
            }
            let rate = (gradient + gradient.transpose()) / 2.0;
            let stretch = problem.metric.hoop_strain(&velocity, &at.position);
            sums.dissipation +=
                2.0 * problem.viscosity * (rate.norm_squared() + stretch * stretch) * at.dx;
            sums.kinetic_energy += problem.density * velocity.norm_squared() / 2.0 * at.dx;
            sums.mass_defect += (gradient.trace() + stretch) * at.dx;
        });
    }
    sums
}
