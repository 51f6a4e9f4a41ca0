//! The quantities of probes: velocity and pressure at points of the fluid.

use alewife_mesh::{CellId, Locator, Mesh, Point};

use nalgebra::Vector3;

use super::value::Value;
use crate::body::{Pose, in_space};
use crate::case::{Case, Model, ProbeQuantity};
use crate::coupling::Problem;
use crate::run::RunError;
use crate::space::{p1_values, p2_values};
use crate::state::State;

/// One value of a probe's point: where it is in the mesh, and with which sign it counts.
struct ProbePoint<const D: usize> {
    cell: CellId,
    xi: Point<D>,
    sign: f64,
}

/// The points of each probe; `None` where there is no fluid, as where a body covers the point.
pub(super) struct Probes<const D: usize>(Vec<Vec<Option<ProbePoint<D>>>>);

/// Where the points of all probes are at the start (m), and which bodies they ride on.
pub(super) struct ProbePlaces {
    start: Vec<Vec<Vec<f64>>>,
    bodies: Vec<Option<usize>>,
}

impl ProbePlaces {
    /// Those of a case.
    pub(super) fn of(model: &Model) -> Self {
        Self { start: model.probe_points(), bodies: model.probe_bodies() }
    }

    /// Whether any rides on a body.
    pub(super) fn ride(&self) -> bool {
        self.bodies.iter().any(Option::is_some)
    }

    /// Where they are with bodies at poses in the mesh (m).
    pub(super) fn now<const D: usize>(
        &self,
        problem: &Problem<D>,
        poses: &[Pose],
    ) -> Vec<Vec<Vec<f64>>> {
        let carried = |(points, body): (&Vec<Vec<f64>>, &Option<usize>)| match *body {
            None => points.clone(),
            Some(body) => {
                let (start, now) = (&problem.bodies[body].pose, &poses[body]);
                let carry = |point: &Vec<f64>| {
                    let at = Vector3::from_fn(|axis, _| point.get(axis).copied().unwrap_or(0.0));
                    let own = start.to_body(&(at - start.center));
                    (now.center + now.to_world(&own)).as_slice()[..D].to_vec()
                };
                points.iter().map(carry).collect()
            }
        };
        self.start.iter().zip(&self.bodies).map(carried).collect()
    }
}

/// Velocity (m/s) and pressure (Pa) of a probe; not numbers where there is no fluid.
pub(super) struct ProbeMeasurement {
    velocity: Vector3<f64>,
    pressure: f64,
}

impl ProbeMeasurement {
    pub(super) fn value(&self, quantity: ProbeQuantity) -> Value {
        match quantity {
            ProbeQuantity::Velocity => self.velocity.into(),
            ProbeQuantity::Pressure => self.pressure.into(),
        }
    }
}

impl<const D: usize> Probes<D> {
    /// The points of all probes at places (m) in a mesh, or in its images by these shifts (m).
    pub(super) fn find(
        case: &Case,
        places: &[Vec<Vec<f64>>],
        mesh: &Mesh<D>,
        images: &[Point<D>],
    ) -> Self {
        if places.is_empty() {
            return Self(Vec::new());
        }
        let locator = Locator::new(mesh);
        // A point on an exact curve may lie outside the quadratic geometry.
        let reach = 0.01 * case.mesh.surface.unwrap_or(case.mesh.size);
        let find = |point: &[f64], sign: f64| {
            let point = Point::<D>::from_fn(|axis, _| point[axis]);
            // The sides of a periodic mesh may be elsewhere than those of the domain
            let found = images.iter().filter_map(|shift| locator.nearest(point + shift));
            let found = found.min_by(|a, b| a.distance.total_cmp(&b.distance));
            let found = found.filter(|found| found.distance <= reach);
            found.map(|found| ProbePoint { cell: found.cell, xi: found.reference.into(), sign })
        };
        let of_probe = |points: &Vec<Vec<f64>>| {
            points.iter().zip([1.0, -1.0]).map(|(point, sign)| find(point, sign)).collect()
        };
        Self(places.iter().map(of_probe).collect())
    }

    /// The same, where all of them must be in the fluid.
    ///
    /// # Errors
    /// When one is not.
    pub(super) fn in_fluid(
        case: &Case,
        places: &ProbePlaces,
        mesh: &Mesh<D>,
        images: &[Point<D>],
    ) -> Result<Self, RunError> {
        let probes = Self::find(case, &places.start, mesh, images);
        for (probe, points) in case.probe.iter().zip(&probes.0) {
            if let Some(missing) = points.iter().position(Option::is_none) {
                let point = if missing == 0 { &probe.point } else { &probe.minus };
                return Err(RunError::Unsupported(format!(
                    "probe `{}`: point {point:?} is not in the fluid",
                    probe.name
                )));
            }
        }
        Ok(probes)
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Values of a scalar, given at the nodes, at all probes; not numbers where there is no fluid.
    pub(super) fn of_scalar(&self, state: &State<D>, values: &[f64]) -> Vec<f64> {
        let at = |point: &ProbePoint<D>| {
            let nodes = state.mesh.cell(point.cell).iter().zip(p2_values(&point.xi));
            point.sign * nodes.fold(0.0, |sum, (&node, phi)| sum + phi * values[node.index()])
        };
        let of_point = |point: &Option<ProbePoint<D>>| point.as_ref().map_or(f64::NAN, at);
        self.0.iter().map(|points| points.iter().map(of_point).sum()).collect()
    }

    pub(super) fn values(&self, state: &State<D>) -> Vec<ProbeMeasurement> {
        self.0.iter().map(|points| measure(state, points)).collect()
    }
}

/// Velocity and pressure of a probe.
fn measure<const D: usize>(state: &State<D>, points: &[Option<ProbePoint<D>>]) -> ProbeMeasurement {
    let (mut velocity, mut pressure) = (Point::<D>::zeros(), 0.0);
    for point in points {
        let Some(point) = point else {
            let velocity = Vector3::repeat(f64::NAN);
            return ProbeMeasurement { velocity, pressure: f64::NAN };
        };
        let nodes = state.mesh.cell(point.cell);
        for (&node, phi) in nodes.iter().zip(p2_values(&point.xi)) {
            velocity += state.now.velocity[node] * (point.sign * phi);
        }
        for (&node, psi) in nodes.iter().zip(p1_values(&point.xi)) {
            pressure += point.sign * psi * state.now.pressure[node];
        }
    }
    ProbeMeasurement { velocity: in_space(&velocity), pressure }
}
