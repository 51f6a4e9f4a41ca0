//! The quantities of a run: loads and motions of bodies, probes, integrals of the flow.

use alewife_mesh::{CellId, Locator, Mesh, Point};
use nalgebra::SMatrix;

use super::snapshot::BodyReport;
use super::state::{State, Swim};
use crate::body::{Pose, Twist, Wrench};
use crate::case::{Case, Geometry, Model, Probe, TimeSettings, known_quantities};
use crate::coupling::{
    BodyLoads, BodyShapes, BodyStates, Effort, FluidSystem, Group, JointReport, Problem,
    ShapeError, Solution, group_load, joint_reports, mean_motion, surface_load,
};
use crate::space::{CellValues, p1_values, p2_values};

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
    energy: Option<Energy>,
    is_march: bool,
}

/// Where the work of the bodies goes, since the first measurement.
#[derive(Debug, Clone, Copy, Default)]
struct Energy {
    /// Time (s), power of the bodies, dissipation (W) and kinetic energy (J) of the last measurement.
    last: Option<[f64; 4]>,
    /// Work without dissipation and change of kinetic energy so far (J).
    defect: f64,
    /// Work, or dissipation where that is larger, so far (J).
    turnover: f64,
}

impl Energy {
    /// The defect over the turnover; where the flow has no memory, of the rates of the present.
    fn defect(&mut self, has_memory: bool, now: [f64; 4]) -> f64 {
        let [time, power, dissipation, kinetic] = now;
        let before = self.last.replace(now);
        if !has_memory {
            return (power - dissipation) / power.abs().max(dissipation);
        }
        if let Some([then, old_power, old_dissipation, old_kinetic]) = before {
            let half = 0.5 * (time - then);
            let change = kinetic - old_kinetic;
            self.defect += half * (power - dissipation + old_power - old_dissipation) - change;
            self.turnover +=
                half * (power.abs().max(dissipation) + old_power.abs().max(old_dissipation));
        }
        if self.turnover > 0.0 { self.defect / self.turnover } else { 0.0 }
    }
}

/// What is told of a mesh that moves.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moving {
    /// Meshes made since the first.
    pub remeshes: usize,
}

/// The points of all probes in a mesh.
fn find_probes(case: &Case, mesh: &Mesh<2>) -> Vec<Vec<Option<ProbePoint>>> {
    if case.probe.is_empty() {
        return Vec::new();
    }
    let locator = Locator::new(mesh);
    // A point on an exact curve may lie outside the quadratic geometry by a trifle.
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
    pub(super) fn new(model: &Model, mesh: &Mesh<2>) -> Result<Self, String> {
        let case = &model.case;
        let probes = find_probes(case, mesh);
        for (probe, points) in case.probe.iter().zip(&probes) {
            if let Some(missing) = points.iter().position(Option::is_none) {
                let point = if missing == 0 { &probe.point } else { &probe.minus };
                return Err(format!("probe `{}`: point {point:?} is not in the fluid", probe.name));
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
        let energy = model.balances_energy().then(Energy::default);
        let is_march = matches!(case.time, TimeSettings::Unsteady(_));
        let names = known_quantities(model);
        Ok(Self { names, probes, coefficients, has_contact, energy, is_march })
    }

    /// Finds the probes in a mesh that has moved, seen from the frame.
    pub(super) fn follow(&mut self, case: &Case, mesh: &Mesh<2>) {
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
        system: &FluidSystem,
        problem: &Problem,
        state: &State,
        loads: &[BodyLoads],
        moving: Option<Moving>,
    ) -> Result<(Vec<BodyReport>, Vec<f64>), ShapeError> {
        let Solution { velocity, pressure, twists } = &state.now;
        let (poses, in_mesh) = (state.poses(), state.poses_in_mesh());
        let mut reports = Vec::new();
        let mut values = Vec::with_capacity(self.names.len());
        for (body, rigid) in problem.bodies.iter().enumerate() {
            let center = &in_mesh[body].center;
            let surface = surface_load(
                &state.mesh,
                rigid.boundary,
                &state.now.fields(),
                problem.viscosity,
                problem.metric,
                Point::<2>::new(center.x, center.y),
            );
            let report = BodyReport {
                name: rigid.name.clone(),
                pose: poses[body],
                twist: twists[body],
                load: loads[body].load,
                surface_load: surface,
                contact: state.contact.wrenches[body],
                power: loads[body].power,
            };
            let acceleration = &state.accelerations[body];
            values.extend(body_values(&report, state.places[body][2], acceleration));
            if let Some([force, moment]) = self.coefficients {
                let Wrench { force: load, torque } = report.load;
                values.extend([load.x * force, load.y * force, torque.z * moment]);
            }
            if self.has_contact {
                let Wrench { force, torque } = report.contact;
                values.extend([force.x, force.y, torque.z]);
            }
            reports.push(report);
        }
        let joints = joints(problem, state, loads)?;
        values.extend(
            joints
                .iter()
                .flat_map(|joint| [joint.coordinate, joint.rate, joint.load, joint.power()]),
        );
        for (group, swim) in problem.groups.iter().zip(&state.swims) {
            values.extend(group_values(problem, state, group, swim, (&poses, loads)));
        }
        for points in &self.probes {
            let mut sum = [0.0; 3];
            for point in points {
                let Some(point) = point else {
                    sum = [f64::NAN; 3];
                    break;
                };
                let nodes = state.mesh.cell(point.cell);
                for (&node, phi) in nodes.iter().zip(p2_values(&point.xi)) {
                    sum[0] += point.sign * phi * velocity[node][0];
                    sum[1] += point.sign * phi * velocity[node][1];
                }
                for (&node, psi) in nodes.iter().zip(p1_values(&point.xi)) {
                    sum[2] += point.sign * psi * pressure[node];
                }
            }
            values.extend(sum);
        }
        let integrals = integrate(system, problem, state);
        values.extend([integrals.dissipation, integrals.kinetic_energy, integrals.mass_defect]);
        if let Some(energy) = &mut self.energy {
            let power: f64 = loads.iter().map(|load| load.power).sum();
            let now = [state.time, power, integrals.dissipation, integrals.kinetic_energy];
            values.push(energy.defect(self.is_march && problem.has_inertia, now));
        }
        if let Some(Moving { remeshes }) = moving {
            let gap = state.contact.minimum_gap.map_or(f64::INFINITY, |least| least.gap);
            values.extend([gap, state.mesh.n_cells() as f64, remeshes as f64]);
        }
        Ok((reports, values))
    }
}

/// The joints of all bodies.
fn joints(
    problem: &Problem,
    state: &State,
    loads: &[BodyLoads],
) -> Result<Vec<JointReport>, ShapeError> {
    if !problem.has_links() {
        return Ok(Vec::new());
    }
    let in_plane = |twists: &[Twist]| twists.iter().map(Twist::in_plane).collect::<Vec<_>>();
    let contact = &state.contact.wrenches;
    let loads =
        loads.iter().zip(contact).map(|(fluid, contact)| (fluid.load + *contact).in_plane());
    let now = BodyStates {
        shapes: &BodyShapes::at(&problem.bodies, state.time)?,
        places: &state.places,
        velocities: &in_plane(&state.now.twists),
        accelerations: &in_plane(&state.accelerations),
        loads: &loads.collect::<Vec<_>>(),
    };
    Ok(joint_reports(problem, &now))
}

/// Values of a group in the order of [`known_quantities`].
fn group_values(
    problem: &Problem,
    state: &State,
    group: &Group,
    swim: &Swim,
    (poses, loads): (&[Pose], &[BodyLoads]),
) -> Vec<f64> {
    let mean = mean_motion(problem, group, poses, &state.now.twists);
    let Effort { power, shape_power, spent_power, thrust, drag, .. } = swim.effort();
    let linear = mean.twist.linear;
    let mut values = Vec::new();
    if group.bodies.len() > 1 {
        let load = group_load(group, &mean.center, poses, loads);
        let angle = state.places[group.bodies[0]][2];
        values.extend([mean.center.x, mean.center.y, angle, linear.x, linear.y]);
        values.extend([mean.twist.angular.z, load.force.x, load.force.y, load.torque.z, power]);
    }
    values.extend([shape_power, spent_power, thrust, drag]);
    match group.period {
        Some(period) => {
            let means = swim.cycles.means(period, group.resistance);
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
fn integrate(system: &FluidSystem, problem: &Problem, state: &State) -> Integrals {
    let mut sums = Integrals::default();
    let mut workspace = CellValues::default();
    for cell in state.mesh.cell_ids() {
        let nodes = state.mesh.cell(cell);
        workspace.for_each_point(system.tables(), &state.mesh, cell, |at| {
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
