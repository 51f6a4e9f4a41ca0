//! The load of the fluid on a boundary by integrating its stress: a cross-check of lower order.

use std::collections::BTreeMap;

use alewife_mesh::{BoundaryId, Mesh, NodeId, Point};
use nalgebra::SMatrix;

use super::super::boundaries::Boundaries;
use super::super::problem::Side;
use crate::body::Wrench;
use crate::flow::{Fields, Viscosity, squared_shear};
use crate::space::{FacetRule, Metric};

/// A flow whose stress is integrated over boundaries.
#[derive(Debug, Clone, Copy)]
pub struct SurfaceStress<'a, const D: usize> {
    /// The mesh.
    pub mesh: &'a Mesh<D>,
    /// Its boundaries.
    pub boundaries: &'a Boundaries,
    /// Quadrature on facets.
    pub rule: &'a FacetRule<D>,
    /// Cartesian, or revolved about x.
    pub metric: Metric,
    /// Dynamic viscosity (Pa s), or its law.
    pub viscosity: Viscosity,
    /// Velocity and pressure.
    pub fields: Fields<'a, D>,
}

/// What tractions of sides depend on beside their place and the flow.
#[derive(Debug, Clone, Copy)]
pub struct SidesAt<const D: usize> {
    /// Time (s).
    pub time: f64,
    /// Density of a fluid that convects (kg/m3), else zero.
    pub density: f64,
    /// Velocity of the frame (m/s).
    pub frame_velocity: Point<D>,
}

/// Which traction is integrated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Traction {
    /// sigma n.
    Whole,
    /// mu (grad u)^T n: what is left of it where mu du/dn - p n = 0.
    OfDevelopedFlow,
}

/// What crosses a side, and the pressure on it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SideFlow {
    /// Integral of (u - u_frame) . n with n into the fluid (m3/s; m2/s planar).
    pub influx: f64,
    /// Integral of the pressure (N).
    pub pressure: f64,
    /// Area (m2; m planar).
    pub area: f64,
}

/// The stress at one quadrature point of a boundary.
#[derive(Debug, Clone, Copy)]
pub(super) struct SurfacePoint<const D: usize> {
    /// Position (m).
    pub position: Point<D>,
    /// - sigma n ds with n out of the fluid: the force on the body (N).
    pub force: Point<D>,
    /// Velocity of the fluid (m/s).
    pub velocity: Point<D>,
}

impl<const D: usize> SurfaceStress<'_, D> {
    /// The viscosity (Pa s) where the velocity (m/s) has a gradient (1/s).
    fn viscosity_at(
        &self,
        gradient: &SMatrix<f64, D, D>,
        velocity: &Point<D>,
        position: &Point<D>,
    ) -> f64 {
        if let Viscosity::Newtonian(value) = self.viscosity {
            return value;
        }
        let hoop = self.metric.hoop_strain(velocity, position);
        self.viscosity.at(squared_shear(gradient, hoop)).value
    }

    /// Visits the quadrature points of a boundary.
    pub(super) fn for_each_point(
        &self,
        boundary: BoundaryId,
        mut visit: impl FnMut(&SurfacePoint<D>),
    ) {
        let Self { mesh, fields, .. } = self;
        for &facet in self.boundaries.facets_on(boundary) {
            let facet = &mesh.facets[facet];
            let nodes = mesh.cell(facet.cell);
            self.rule.for_each_point(mesh, facet, |at| {
                let mut velocity = Point::<D>::zeros();
                let mut gradient = SMatrix::<f64, D, D>::zeros();
                for (a, &node) in nodes.iter().enumerate() {
                    let nodal = fields.velocity[node];
                    velocity += nodal * at.phi[a];
                    gradient += nodal * at.grad_phi[a].transpose();
                }
                let pressure: f64 =
                    nodes.iter().zip(at.psi).map(|(&node, psi)| fields.pressure[node] * psi).sum();
                let viscosity = self.viscosity_at(&gradient, &velocity, &at.position);
                let traction = (gradient + gradient.transpose()) * at.normal_ds * viscosity
                    - at.normal_ds * pressure;
                visit(&SurfacePoint { position: at.position, force: -traction, velocity });
            });
        }
    }

    /// Integrals of a traction times the basis of the nodes of a boundary that are wanted (N), n out of the fluid.
    pub(super) fn nodal_tractions(
        &self,
        boundary: BoundaryId,
        traction: Traction,
        is_wanted: impl Fn(NodeId) -> bool,
    ) -> BTreeMap<NodeId, Point<D>> {
        let Self { mesh, fields, .. } = self;
        let mut sums = BTreeMap::new();
        for &facet in self.boundaries.facets_on(boundary) {
            let facet = &mesh.facets[facet];
            let wanted: Vec<NodeId> = mesh.facet_nodes(facet).filter(|&n| is_wanted(n)).collect();
            if wanted.is_empty() {
                continue;
            }
            let nodes = mesh.cell(facet.cell);
            self.rule.for_each_point(mesh, facet, |at| {
                let mut velocity = Point::<D>::zeros();
                let mut gradient = SMatrix::<f64, D, D>::zeros();
                for (a, &node) in nodes.iter().enumerate() {
                    velocity += fields.velocity[node] * at.phi[a];
                    gradient += fields.velocity[node] * at.grad_phi[a].transpose();
                }
                let viscosity = self.viscosity_at(&gradient, &velocity, &at.position);
                let mut force = gradient.transpose() * at.normal_ds * viscosity;
                if traction == Traction::Whole {
                    let vertices = nodes.iter().zip(at.psi);
                    let pressure: f64 =
                        vertices.map(|(&node, psi)| fields.pressure[node] * psi).sum();
                    force += gradient * at.normal_ds * viscosity - at.normal_ds * pressure;
                }
                for (&node, phi) in nodes.iter().zip(at.phi) {
                    if wanted.contains(&node) {
                        *sums.entry(node).or_insert_with(Point::<D>::zeros) += force * *phi;
                    }
                }
            });
        }
        sums
    }

    /// Integrals over an open side of the traction that it is given, with that of a developed flow beside a pressure, and
    /// what it takes of the momentum of fluid that enters (N).
    pub(super) fn given_tractions(
        &self,
        boundary: BoundaryId,
        side: &Side<D>,
        when: SidesAt<D>,
    ) -> BTreeMap<NodeId, Point<D>> {
        let SidesAt { time, density, frame_velocity } = when;
        let mesh = self.mesh;
        let mut sums = if side.is_developed() {
            self.nodal_tractions(boundary, Traction::OfDevelopedFlow, |_| true)
        } else {
            BTreeMap::new()
        };
        for &facet in self.boundaries.facets_on(boundary) {
            let facet = &mesh.facets[facet];
            let (nodes, own): (_, Vec<NodeId>) =
                (mesh.cell(facet.cell), mesh.facet_nodes(facet).collect());
            self.rule.for_each_point(mesh, facet, |at| {
                let area = at.normal_ds.norm();
                let normal = if area > 0.0 { at.normal_ds / area } else { Point::zeros() };
                let given = side.given_traction(&at.position, &normal, time);
                let velocity = at.value(nodes, self.fields.velocity);
                let influx = (velocity - frame_velocity).dot(&at.normal_ds).min(0.0);
                let force = given.unwrap_or_else(Point::zeros) * area
                    + velocity * (density * side.backflow() * influx);
                for (&node, phi) in nodes.iter().zip(at.phi).filter(|(node, _)| own.contains(node))
                {
                    *sums.entry(node).or_insert_with(Point::<D>::zeros) += force * *phi;
                }
            });
        }
        sums
    }

    /// What crosses a side that goes with a frame, and the pressure on it.
    #[must_use]
    pub fn side_flow(&self, boundary: BoundaryId, frame_velocity: &Point<D>) -> SideFlow {
        let Self { mesh, fields, .. } = self;
        let mut flow = SideFlow::default();
        for &facet in self.boundaries.facets_on(boundary) {
            let facet = &mesh.facets[facet];
            let nodes = mesh.cell(facet.cell);
            self.rule.for_each_point(mesh, facet, |at| {
                let nodal =
                    nodes.iter().zip(at.phi).map(|(&node, phi)| fields.velocity[node] * *phi);
                let velocity: Point<D> = nodal.sum();
                let vertices = nodes.iter().zip(at.psi);
                let pressure: f64 = vertices.map(|(&node, psi)| fields.pressure[node] * psi).sum();
                let area = at.normal_ds.norm();
                flow.influx -= (velocity - frame_velocity).dot(&at.normal_ds);
                flow.pressure += pressure * area;
                flow.area += area;
            });
        }
        flow
    }

    /// Rate at which the fluid carries kinetic energy over its density in through a boundary that goes with a frame
    /// (m5/s3; m4/s3 planar).
    #[must_use]
    pub fn energy_inflow(&self, boundary: BoundaryId, frame_velocity: &Point<D>) -> f64 {
        let Self { mesh, fields, .. } = self;
        let mut inflow = 0.0;
        for &facet in self.boundaries.facets_on(boundary) {
            let facet = &mesh.facets[facet];
            let nodes = mesh.cell(facet.cell);
            self.rule.for_each_point(mesh, facet, |at| {
                let nodal =
                    nodes.iter().zip(at.phi).map(|(&node, phi)| fields.velocity[node] * *phi);
                let velocity: Point<D> = nodal.sum();
                let flux = (velocity - frame_velocity).dot(&at.normal_ds);
                inflow += 0.5 * velocity.norm_squared() * (-flux).max(0.0);
            });
        }
        inflow
    }

    /// Integral over a boundary of the size of the viscous stress (N).
    #[must_use]
    pub fn friction(&self, boundary: BoundaryId) -> f64 {
        let Self { mesh, fields, .. } = self;
        let mut friction = 0.0;
        for &facet in self.boundaries.facets_on(boundary) {
            let facet = &mesh.facets[facet];
            let nodes = mesh.cell(facet.cell);
            self.rule.for_each_point(mesh, facet, |at| {
                let mut velocity = Point::<D>::zeros();
                let mut gradient = SMatrix::<f64, D, D>::zeros();
                for (a, &node) in nodes.iter().enumerate() {
                    velocity += fields.velocity[node] * at.phi[a];
                    gradient += fields.velocity[node] * at.grad_phi[a].transpose();
                }
                let size = ((gradient + gradient.transpose()) * at.normal_ds).norm();
                friction += match self.viscosity {
                    Viscosity::Newtonian(_) => size,
                    _ => size * self.viscosity_at(&gradient, &velocity, &at.position),
                };
            });
        }
        if let Viscosity::Newtonian(value) = self.viscosity { value * friction } else { friction }
    }

    /// Force and torque about `center` of the fluid on a boundary:
    /// F = - int sigma n ds with n out of the fluid.
    #[must_use]
    pub fn load(&self, boundary: BoundaryId, metric: Metric, center: &Point<D>) -> Wrench {
        let mut load = Wrench::default();
        self.for_each_point(boundary, |at| {
            load.force += metric.total_force(&at.force);
            load.torque += metric.total_torque(&(at.position - center), &at.force);
        });
        load
    }
}
