//! `BaseFlow`: the steady flow of a case, its quantities and their adjoints.

use std::rc::Rc;

use alewife_mesh::Mesh;
use nalgebra::Vector3;

use super::error::GradientError;
use super::mesh_of_bodies::{Made, MeshOfBodies};
use super::moment::Moment;
use super::objective::Weights;
use super::point::CasePoint;
use super::refusals::refuse;
use crate::case::{CaseFile, Column, Model, Steady};
use crate::coupling::{
    BodyLoads, FluidSystem, LoadDerivatives, Problem, ResidualAt, ResidualOnMesh, Solution,
    SurfaceLoads, load_derivatives,
};
use crate::run::{
    BodiesInFlow, CaseMesh, CellBound, Dimension, Places, RunError, by_key, simulation_on,
    simulation_with, steady_value,
};
use crate::step::{
    SteadyFlow, SteadyTask, Workspace, solve_steady, steady_convection, steady_terms,
};

/// The steady flow of a case.
pub(super) struct BaseFlow<const D: usize> {
    /// The mesh for other numbers.
    pub mesh: Rc<MeshOfBodies<D>>,
    /// The case.
    pub point: CasePoint<D>,
    /// The system on its mesh.
    pub work: Workspace<D>,
    columns: Vec<Column>,
    solution: Solution<D>,
    /// Raw residual of the fluid's equations at it.
    residual: Vec<f64>,
    free: Vec<f64>,
    values: Vec<f64>,
    sizes: Vec<f64>,
}

/// What a flow is solved with.
pub(super) struct PreparedFlow<const D: usize> {
    /// The mesh, for all numbers.
    pub mesh: Rc<MeshOfBodies<D>>,
    /// The system on it.
    pub work: Workspace<D>,
    /// What other meshes are measured by.
    pub cell_bound: CellBound,
}

/// Largest residual of a flow relative to that at rest.
const TOLERANCE: f64 = 1e-11;

impl<const D: usize> BaseFlow<D>
where
    Dimension<D>: CaseMesh<D>,
{
    /// Solves for the flow of a case.
    pub fn solve(file: &CaseFile, columns: Vec<Column>) -> Result<Self, GradientError> {
        let model = &file.model;
        let simulation = simulation_with::<D>(model, |_| Ok(()))?;
        let (problem, work, shifts) =
            (simulation.problem, simulation.work, simulation.state.image_shifts.clone());
        refuse(file, &problem)?;
        let mesh = Rc::new(of_the_start(model, &problem, &work.mesh, &shifts)?);
        let mesh_now = work.mesh.clone();
        let point = CasePoint::new(file.clone(), problem, mesh_now, &shifts, &Moment::START)?;
        Self::at(mesh, point, work, columns)
    }

    /// The mesh of a case, and the system on it.
    pub fn prepared(file: &CaseFile) -> Result<PreparedFlow<D>, GradientError> {
        let simulation = simulation_with::<D>(&file.model, |_| Ok(()))?;
        let (problem, mesh) = (&simulation.problem, &simulation.work.mesh);
        refuse(file, problem)?;
        let shifts = &simulation.state.image_shifts;
        let mesh = Rc::new(of_the_start(&file.model, problem, mesh, shifts)?);
        Ok(PreparedFlow { mesh, work: simulation.work, cell_bound: simulation.cell_bound })
    }

    /// Solves for the flow of a case on a mesh that has followed its bodies.
    pub fn on(
        mesh: Rc<MeshOfBodies<D>>,
        point: CasePoint<D>,
        columns: Vec<Column>,
    ) -> Result<Self, GradientError> {
        let simulation = simulation_on::<D>(&point.model, point.mesh.clone())?;
        Self::at(mesh, point, simulation.work, columns)
    }

    /// Solves for the flow of a case with the system of its mesh.
    pub fn at(
        mesh: Rc<MeshOfBodies<D>>,
        point: CasePoint<D>,
        mut work: Workspace<D>,
        columns: Vec<Column>,
    ) -> Result<Self, GradientError> {
        let SteadyFlow { solution, residual, .. } = steady_flow(&mut work, &point)?;
        let constraints = work.system.constraints(&point.problem, &point.mesh, point.bodies());
        let free = work.system.free_unknowns(&point.problem, &constraints, &solution);
        let loads = surface_loads(&work.system, &point, &solution, &residual);
        let values = values(&columns, &point, &solution, &loads.bodies);
        let sizes = Vec::new();
        Ok(Self { mesh, point, work, columns, solution, residual, free, values, sizes })
    }
}

/// A mesh that was made for the bodies of a case as it has them.
fn of_the_start<const D: usize>(
    model: &Model,
    problem: &Problem<D>,
    mesh: &Mesh<D>,
    shifts: &[Vector3<f64>],
) -> Result<MeshOfBodies<D>, GradientError>
where
    Dimension<D>: CaseMesh<D>,
{
    let poses = Moment::START.poses(problem);
    MeshOfBodies::new(model, problem, Made { mesh, shifts, poses: &poses })
}

/// The steady flow of a case on the mesh of a workspace.
pub(super) fn steady_flow<const D: usize>(
    work: &mut Workspace<D>,
    point: &CasePoint<D>,
) -> Result<SteadyFlow<D>, GradientError> {
    let settings =
        Steady { tolerance: point.settings.tolerance.min(TOLERANCE), ..point.settings.clone() };
    let task = SteadyTask {
        bodies: point.bodies(),
        equations: point.equations(),
        settings: &settings,
        has_convection: point.problem.has_convection,
        stop: None,
    };
    let flow = solve_steady(work, &point.problem, &task);
    let places =
        Places { mesh: &point.mesh, bodies: &point.problem.bodies, poses: point.in_mesh.clone() };
    let by_key = |error| by_key(&point.model.case, &places, RunError::from(error));
    Ok(flow.map_err(|failure| by_key(*failure.error))?)
}

/// The loads of a flow with the raw residual of its equations.
pub(super) fn surface_loads<const D: usize>(
    system: &FluidSystem<D>,
    point: &CasePoint<D>,
    solution: &Solution<D>,
    residual: &[f64],
) -> SurfaceLoads {
    let found = ResidualAt { solution, residual, time: point.time() };
    system.surface_loads(&point.problem, &point.mesh, &point.in_mesh, found)
}

/// The values of quantities of a flow.
pub(super) fn values<const D: usize>(
    columns: &[Column],
    point: &CasePoint<D>,
    solution: &Solution<D>,
    loads: &[BodyLoads],
) -> Vec<f64> {
    let bodies = BodiesInFlow {
        problem: &point.problem,
        poses: &point.poses,
        twists: &solution.twists,
        loads,
    };
    let value = |column| steady_value(&point.model.case, column, &bodies).unwrap_or(f64::NAN);
    columns.iter().map(value).collect()
}

impl<const D: usize> BaseFlow<D> {
    /// The system on the mesh, for another flow.
    pub fn into_work(self) -> Workspace<D> {
        self.work
    }

    /// The values of the quantities.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// How large the loads, powers or velocities are that each quantity is made of, once there are adjoints.
    pub fn sizes(&self) -> &[f64] {
        &self.sizes
    }

    /// The columns of the quantities.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The adjoint of each quantity, by free unknowns.
    pub fn adjoints(&mut self) -> Result<Vec<Vec<f64>>, GradientError> {
        let weights: Vec<Weights> =
            self.columns.iter().map(|column| self.weights(column)).collect();
        self.sizes = weights.iter().map(|weights| weights.size).collect();
        let derivatives: Vec<Vec<f64>> =
            weights.iter().map(|weights| self.derivative(weights)).collect();
        let Self { point, work, solution, .. } = self;
        let Workspace { system, timing, .. } = work;
        let constraints = system.constraints(&point.problem, &point.mesh, point.bodies());
        let convection = steady_convection(&point.problem, solution);
        let terms = steady_terms(&point.problem, &convection, solution);
        let at = point.configuration(&constraints);
        Ok(system.adjoints(&at, &terms, solution, &derivatives, timing)?)
    }

    /// What loads and velocities count in a quantity.
    fn weights(&self, column: &Column) -> Weights {
        let Self { point, work, solution, residual, .. } = self;
        let loads = surface_loads(&work.system, point, solution, residual);
        let bodies = BodiesInFlow {
            problem: &point.problem,
            poses: &point.poses,
            twists: &solution.twists,
            loads: &loads.bodies,
        };
        Weights::of(&point.model.case, column, &bodies)
    }

    /// The derivative by the raw unknowns of a quantity with these weights.
    fn derivative(&self, weights: &Weights) -> Vec<f64> {
        let Self { point, work, solution, residual, .. } = self;
        let system = &work.system;
        let flow = ResidualOnMesh {
            mesh: &point.mesh,
            layout: &system.layout,
            boundaries: &system.boundaries,
            velocity: &solution.velocity,
            residual,
        };
        let LoadDerivatives { by_residual, by_solution: mut derivative } =
            load_derivatives(&point.problem, &point.in_mesh, &flow, &weights.loads);
        let constraints = system.constraints(&point.problem, &point.mesh, point.bodies());
        let convection = steady_convection(&point.problem, solution);
        let terms = steady_terms(&point.problem, &convection, solution);
        let at = point.configuration(&constraints);
        let by_flow = system.derivative_of_residual(&at, &terms, solution, &by_residual);
        derivative.iter_mut().zip(&by_flow).for_each(|(sum, value)| *sum += value);
        for (body, twist) in weights.twists.iter().enumerate() {
            for (position, mode) in point.problem.modes().iter().enumerate() {
                derivative[system.layout.rigid(body, position)] += twist[mode];
            }
        }
        derivative
    }

    /// Each quantity less the product of its adjoint with the residual, of a case with other numbers and the free unknowns
    /// of this flow.
    pub fn lagrangians(
        &mut self,
        at: &CasePoint<D>,
        adjoints: &[Vec<f64>],
    ) -> Result<Vec<f64>, GradientError> {
        let Self { work, columns, free, .. } = self;
        let system = &mut work.system;
        system.move_to(&at.problem, &at.mesh);
        let constraints = system.constraints(&at.problem, &at.mesh, at.bodies());
        let solution = system.solution_of(&at.problem, &constraints, free);
        let convection = steady_convection(&at.problem, &solution);
        let terms = steady_terms(&at.problem, &convection, &solution);
        let configuration = at.configuration(&constraints);
        let residual = system.fluid_residual(&configuration, &terms, &solution);
        let reduced = system.reduced_residual(&configuration, &solution, &residual);
        let loads = surface_loads(system, at, &solution, &residual);
        let values = values(columns, at, &solution, &loads.bodies);
        let less = |(value, adjoint): (f64, &Vec<f64>)| {
            let product: f64 = adjoint.iter().zip(&reduced).map(|(one, other)| one * other).sum();
            value - product
        };
        Ok(values.into_iter().zip(adjoints).map(less).collect())
    }
}
