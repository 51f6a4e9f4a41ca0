//! The nearest discretely divergence-free velocity to a given one, with its boundary values.
//!
//! What is interpolated from mesh to mesh is no longer divergence-free; without this projection
//! the pressure of the next step would have to correct that at once, as a spike in the forces.

use alewife_mesh::{BoundaryKind, Mesh, NodeId, Point};

use super::boundaries::{Boundaries, BoundaryNode};
use super::constrain::Constrainer;
use super::linear_system::{
    Coefficients, Discretised, NewSystem, SolverChoice, SystemSolver, saddle_point, system_solver,
};
use super::pressure_mean::PressureMean;
use super::problem::{Problem, Side};
use super::surface::RestPlaces;
use super::uniform_flows::{UniformFlows, integral, node_integrals};

use crate::algebra::{AffineConstraints, ConstraintBuilder, LinearError};
use crate::flow::{Assembly, Convection, Fields, FlowTerms, ViscosityTerm, assemble, residual};
use crate::space::{DofLayout, Metric, straight_cell};
use crate::timing::Timing;

/// Minimises ||v - u|| in L2 over the v with div v = 0 (tested with all pressures) that agree with
/// u where the problem gives velocities: on bodies, walls and inflows, and in the normal component
/// on symmetry planes.
///
/// With v = u + d: [M B^T; B 0] [d; q] = [m; -B u] on the free unknowns, m zero unless the velocity
/// to be projected is another one within the cells. On open sides q = 0.
pub struct DivergenceFreeProjection<const D: usize> {
    layout: DofLayout<D>,
    constraints: AffineConstraints,
    assembly: Assembly<D>,
    linear: Box<dyn SystemSolver>,
    /// Distributes a net flux where the flow is enclosed.
    enclosed: Option<PressureMean>,
    /// Coordinates along which nothing but a period may bound the fluid: its momentum is no matter of boundaries.
    open_axes: usize,
}

/// What the flows that change the momentum leave of their equations: they are small parts of the flow.
const ACCURACY: f64 = 1e-6;

/// Viscosity (Pa s) over density, rate and the square of an edge length that preconditions a fluid without any:
/// its part in the pressures is lost beside that of the mass.
const NEARLY_INVISCID: f64 = 1e-6;

/// Neither stress nor convection, and as much mass as asked for.
fn terms<'a, const D: usize>(density: f64) -> FlowTerms<'a, D> {
    FlowTerms {
        viscosity: ViscosityTerm::Constant(0.0),
        density,
        rate: 1.0,
        history: &[],
        convecting_velocity: &[],
        convection: Convection::None,
    }
}

impl<const D: usize> DivergenceFreeProjection<D> {
    /// Assembles the projection of a problem on a mesh.
    #[must_use]
    pub fn new(problem: &Problem<D>, mesh: &Mesh<D>) -> Self {
        let layout = DofLayout::new(mesh, 0, 0);
        let constraints = hold_given_velocities(problem, mesh, &layout);
        let assembly = Assembly::new(mesh, layout, &constraints, problem.metric, &[], None);
        let saddle_point = saddle_point(&layout, &constraints, problem.modes(), &[]);
        let system = NewSystem { constraints: &constraints, saddle_point, blocks: Vec::new() };
        let linear = system_solver(&assembly, system, SolverChoice::Automatic);
        let has_periods = problem.sides.iter().any(|side| matches!(side, Some(Side::Periodic)));
        let open_axes = match (problem.is_enclosed() && has_periods, problem.metric) {
            (false, _) => 0,
            (true, Metric::Revolved) => 1,
            (true, Metric::Cartesian) => D,
        };
        let mut projection =
            Self { layout, constraints, assembly, linear, enclosed: None, open_axes };
        projection.move_to(problem, mesh);
        projection
    }

    /// Moves to another configuration of the same mesh.
    pub fn move_to(&mut self, problem: &Problem<D>, mesh: &Mesh<D>) {
        let velocity = vec![Point::<D>::zeros(); self.layout.n_nodes];
        let pressure = vec![0.0; self.layout.n_vertices];
        let fields = Fields { velocity: &velocity, pressure: &pressure };
        let (assembly, constraints) = (&self.assembly, &self.constraints);
        self.linear.assemble(&mut |scatter| {
            assemble(assembly, mesh, constraints, &terms(1.0), &fields, scatter);
        });
        let edge = (volume(mesh) / mesh.n_cells() as f64).powf(1.0 / D as f64);
        let viscosity = NEARLY_INVISCID * edge * edge;
        let coefficients = Coefficients { viscosity, inertia: 1.0, has_convection: false };
        let tables = self.assembly.tables();
        let discretised =
            Discretised { mesh, layout: &self.layout, constraints, tables, local: None };
        self.linear.forget_weights();
        let weights = &|| discretised.weights(coefficients);
        self.linear.prepare(coefficients, weights, &mut Timing::default());
        self.enclosed =
            problem.is_enclosed().then(|| PressureMean::new(mesh, self.assembly.tables()));
    }

    /// -int psi div u dx for each vertex (m3/s; m2/s planar), the net flux of an enclosed flow
    /// distributed over the domain as the solver does: what [`Self::project`] makes zero.
    #[must_use]
    pub fn defect(&self, mesh: &Mesh<D>, velocity: &[Point<D>]) -> Vec<f64> {
        let pressure = vec![0.0; self.layout.n_vertices];
        let fields = Fields { velocity, pressure: &pressure };
        let raw = residual(&self.assembly, mesh, &terms(0.0), &fields);
        let mut defect = raw[self.layout.pressures()].to_vec();
        if let Some(mean) = &self.enclosed {
            mean.make_compatible(&mut defect);
        }
        // A pressure of one side of a periodic pair tests both
        for pair in &mesh.periodic {
            if pair.copy.index() < self.layout.n_vertices {
                defect[pair.original] += std::mem::take(&mut defect[pair.copy]);
            }
        }
        defect
    }

    /// The projection of a velocity (m/s at the nodes) on the mesh it was assembled for.
    ///
    /// # Errors
    /// When the system cannot be solved, as for velocities that are not finite.
    pub fn project(
        &mut self,
        mesh: &Mesh<D>,
        velocity: &[Point<D>],
    ) -> Result<Vec<Point<D>>, LinearError> {
        self.project_with(mesh, velocity, &[])
    }

    /// The nearest divergence-free velocity not to the one at the nodes but to one that differs from
    /// it within the cells: `residual` is int phi times the difference dx of each node (m3/s; m4/s in
    /// axisymmetric problems).
    ///
    /// # Errors
    /// As [`Self::project`].
    pub fn project_with(
        &mut self,
        mesh: &Mesh<D>,
        velocity: &[Point<D>],
        residual: &[Point<D>],
    ) -> Result<Vec<Point<D>>, LinearError> {
        let mut raw = vec![0.0; self.layout.n_raw()];
        for (node, residual) in self.layout.nodes().zip(residual) {
            for axis in 0..D {
                raw[self.layout.velocity(node, axis)] = residual[axis];
            }
        }
        for (vertex, value) in self.layout.vertices().zip(self.defect(mesh, velocity)) {
            raw[self.layout.pressure(vertex)] = -value;
        }
        let mut free = self.constraints.restrict(&raw);
        if free.iter().all(|value| *value == 0.0) {
            return Ok(velocity.to_vec());
        }
        self.linear.solve(&mut free, None, &mut Timing::default())?;
        let correction = self.at_nodes(&free);
        Ok(velocity.iter().zip(&correction).map(|(velocity, part)| velocity + part).collect())
    }

    /// The divergence-free velocity of least kinetic energy with the boundary values of a velocity (m/s at the
    /// nodes): what an impulse makes of fluid at rest (Kelvin).
    ///
    /// # Errors
    /// As [`Self::project`].
    pub fn potential_flow(
        &mut self,
        mesh: &Mesh<D>,
        velocity: &[Point<D>],
    ) -> Result<Vec<Point<D>>, LinearError> {
        let pressure = vec![0.0; self.layout.n_vertices];
        let fields = Fields { velocity, pressure: &pressure };
        let raw = residual(&self.assembly, mesh, &terms(1.0), &fields);
        let momentum = |node| Point::<D>::from_fn(|axis, _| -raw[self.layout.velocity(node, axis)]);
        let to_rest: Vec<Point<D>> = self.layout.nodes().map(momentum).collect();
        self.project_with(mesh, velocity, &to_rest)
    }

    /// The same with an integral over the fluid (m4/s; m3/s planar), as far as boundaries leave that open: along periods
    /// neither they nor the divergence determine the momentum, and boundary values that are held change it.
    ///
    /// # Errors
    /// As [`Self::project`].
    pub fn project_with_integral(
        &mut self,
        mesh: &Mesh<D>,
        velocity: &[Point<D>],
        residual: &[Point<D>],
        wanted: &Point<D>,
    ) -> Result<Vec<Point<D>>, LinearError> {
        let mut projected = self.project_with(mesh, velocity, residual)?;
        if self.open_axes > 0 {
            self.uniform_flows(mesh)?.give(wanted, &mut projected);
        }
        Ok(projected)
    }

    /// The integral of a velocity (m/s at the nodes) over the fluid (m4/s; m3/s planar).
    #[must_use]
    pub fn integral(&self, mesh: &Mesh<D>, velocity: &[Point<D>]) -> Point<D> {
        integral(&node_integrals(mesh, self.assembly.tables()), velocity)
    }

    fn uniform_flows(&mut self, mesh: &Mesh<D>) -> Result<UniformFlows<D>, LinearError> {
        let integrals = node_integrals(mesh, self.assembly.tables());
        let mut flows = Vec::with_capacity(self.open_axes);
        for axis in 0..self.open_axes {
            let mut raw = vec![0.0; self.layout.n_raw()];
            for (node, integral) in self.layout.nodes().zip(&integrals) {
                raw[self.layout.velocity(node, axis)] = *integral;
            }
            let mut free = self.constraints.restrict(&raw);
            self.linear.solve(&mut free, Some(ACCURACY), &mut Timing::default())?;
            flows.push(self.at_nodes(&free));
        }
        Ok(UniformFlows::new(integrals, flows))
    }

    /// The velocities at the nodes that free unknowns give.
    fn at_nodes(&self, free: &[f64]) -> Vec<Point<D>> {
        let raw = self.constraints.expand(free);
        let at = |node| Point::<D>::from_fn(|axis, _| raw[self.layout.velocity(node, axis)]);
        self.layout.nodes().map(at).collect()
    }
}

/// Volume of a mesh with straight cells (m3; m2 planar).
fn volume<const D: usize>(mesh: &Mesh<D>) -> f64 {
    mesh.cell_ids().map(|cell| straight_cell(mesh, cell).measure).sum()
}

/// No correction where velocities are given; equal ones at periodic pairs; one pressure pinned
/// when no side is open.
fn hold_given_velocities<const D: usize>(
    problem: &Problem<D>,
    mesh: &Mesh<D>,
    layout: &DofLayout<D>,
) -> AffineConstraints {
    let mut builder = ConstraintBuilder::new(layout.n_raw());
    for BoundaryNode { node, boundaries, .. } in Boundaries::new(mesh).nodes() {
        for boundary in boundaries {
            let is_body = matches!(mesh.boundaries[boundary].kind, BoundaryKind::Body(_));
            let mut hold = |node: NodeId, axis: usize| {
                builder.fix(layout.velocity(node, axis), 0.0);
            };
            match &problem.sides[boundary] {
                Some(Side::Symmetry { normal_axis }) if !is_body => hold(node, *normal_axis),
                Some(Side::Velocity { .. }) => (0..D).for_each(|axis| hold(node, axis)),
                _ if is_body => (0..D).for_each(|axis| hold(node, axis)),
                _ => {}
            }
        }
    }
    let rest_places = &RestPlaces::new();
    Constrainer { problem, mesh, layout, rest_places }.close_pressures_and_periods(&mut builder);
    builder.build()
}
