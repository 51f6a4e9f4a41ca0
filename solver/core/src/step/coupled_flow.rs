//! `FlowUnderLoads`: the flow of a configuration as contact sees it; `CoupledFlow`: with the contact that was found.

use nalgebra::DMatrix;

use super::configuration::StepConfiguration;
use super::context::StepContext;
use super::elastic::Beyond;
use super::error::{FlowError, StepError};
use super::newton::{Flow, flow_residual};
use super::placement::Placement;
use super::workspace::Workspace;
use crate::body::{BodyLoad, LoadedBody, Pose, Twist};
use crate::contact::{ContactLoads, InnerForces, LoadedFlow};
use crate::coupling::{
    AddedLoads, PropulsionPower, ResidualAt, Solution, SolveError, SurfaceLoads,
};
use crate::timing::Stage;

/// The flow and the contact of one configuration.
pub(super) struct CoupledFlow<const D: usize> {
    pub solution: Solution<D>,
    /// Raw residual of the fluid's equations; none since loads of contact have changed it.
    residual: Option<Vec<f64>>,
    pub contact: ContactLoads,
    /// Initial residual of the first iteration for the poses.
    pub scale: f64,
    /// Linear systems of the flow solved, without those for contact.
    pub n_systems: usize,
}

/// Loads of the fluid on bodies, and the powers of groups.
pub(super) struct FluidLoads {
    pub surfaces: SurfaceLoads,
    pub propulsion: Vec<PropulsionPower>,
}

/// A flow to which loads on its bodies are added.
pub(super) struct FlowUnderLoads<'a, const D: usize> {
    step: &'a StepContext<'a, D>,
    configuration: &'a StepConfiguration<D>,
    work: &'a mut Workspace<D>,
    flow: Flow<D>,
    /// Whether loads have been added.
    has_changed: bool,
}

impl<'a, const D: usize> FlowUnderLoads<'a, D> {
    /// A flow as it has been solved for on a configuration.
    pub fn new(
        step: &'a StepContext<'a, D>,
        configuration: &'a StepConfiguration<D>,
        work: &'a mut Workspace<D>,
        flow: Flow<D>,
    ) -> Self {
        Self { step, configuration, work, flow, has_changed: false }
    }

    /// The flow with the loads of contact that it has.
    pub fn with_contact(self, contact: ContactLoads) -> CoupledFlow<D> {
        let Flow { solution, residual, scale, iterations } = self.flow;
        let residual = (!self.has_changed).then_some(residual);
        CoupledFlow { solution, residual, contact, scale, n_systems: iterations }
    }

    fn failure(&self, error: SolveError) -> StepError {
        let step = &self.step.history.step;
        FlowError::from_solve(error, step.number, step.time).into()
    }
}

impl<const D: usize> LoadedFlow for FlowUnderLoads<'_, D> {
    type Error = StepError;

    fn twists(&self) -> &[Twist] {
        &self.flow.solution.twists
    }

    fn rates(&self) -> &[f64] {
        &self.flow.solution.rates
    }

    fn inner_forces(&self) -> Box<dyn InnerForces> {
        let equations = &self.configuration.bodies.flexible;
        Box::new(Beyond(self.work.system.forces_beyond(equations, self.rates())))
    }

    fn reached_coordinates(&self) -> Vec<f64> {
        self.step.history.coordinates_with(self.step.state, self.rates())
    }

    fn reached(&self) -> Vec<Pose> {
        // The displacement of the frame is no part of the unknowns
        let StepContext { stepper, state, .. } = self.step;
        let origin = state.origin_at(stepper.problem, &self.configuration.placement.poses);
        state.in_frame(&origin, &self.step.integrated_poses(self.twists())).into_vec()
    }

    fn poses_have_converged(&self, contact: &ContactLoads) -> bool {
        let solved_at = &self.configuration.placement;
        let poses = self.step.integrated_poses(self.twists());
        let reached = Placement { poses, ..solved_at.clone() };
        self.step.stepper.path.has_converged(solved_at, &reached, contact)
    }

    fn free_motions(&self, bodies: &[LoadedBody]) -> DMatrix<f64> {
        self.work.system.free_motions(&self.configuration.constraints, bodies)
    }

    fn mobility(
        &mut self,
        bodies: &[LoadedBody],
        with_coordinates: bool,
    ) -> Result<DMatrix<f64>, StepError> {
        let Workspace { system, timing, .. } = &mut *self.work;
        let constraints = &self.configuration.constraints;
        let mobility = system.mobility(constraints, bodies, with_coordinates, timing);
        mobility.map_err(|error| self.failure(error))
    }

    fn add_loads(
        &mut self,
        on_bodies: &[BodyLoad],
        on_coordinates: &[f64],
        tolerance: Option<f64>,
    ) -> Result<(), StepError> {
        if on_bodies.is_empty() && on_coordinates.iter().all(|load| *load == 0.0) {
            return Ok(());
        }
        let loads = AddedLoads { on_bodies, on_coordinates };
        let Workspace { system, timing, .. } = &mut *self.work;
        let (constraints, solution) = (&self.configuration.constraints, &mut self.flow.solution);
        let added = system.apply_body_loads(constraints, loads, tolerance, solution, timing);
        added.map_err(|error| self.failure(error))?;
        self.has_changed = true;
        Ok(())
    }
}

impl<const D: usize> StepContext<'_, D> {
    /// Gives the pressure of a flow its level, and finds its loads.
    pub fn loads(
        &self,
        work: &mut Workspace<D>,
        configuration: &StepConfiguration<D>,
        flow: &mut CoupledFlow<D>,
    ) -> FluidLoads {
        let (state, problem) = (self.state, self.stepper.problem);
        let equations = self.equations(configuration);
        let Workspace { system, mesh, timing } = work;
        let at = configuration.system(problem, mesh);
        let mut residual_of = |solution: &Solution<D>| {
            timing.measure(Stage::Loads, || flow_residual(system, &at, &equations, solution))
        };
        let residual = if problem.power_depends_on_pressure_level() {
            system.center_pressure(problem, &mut flow.solution);
            residual_of(&flow.solution)
        } else {
            let found = flow.residual.take().unwrap_or_else(|| residual_of(&flow.solution));
            system.center_pressure(problem, &mut flow.solution);
            found
        };
        let (poses, solution) = (&configuration.placement.poses, &flow.solution);
        let in_mesh = state.in_mesh(poses);
        let time = at.mean_flow.time;
        let found = ResidualAt { solution, residual: &residual, time };
        let surfaces = system.surface_loads(problem, mesh, &in_mesh, found);
        let stress = system.surface_stress(problem, mesh, solution);
        let twists = &solution.twists;
        let propulsion = state.propulsion_powers(problem, poses, twists, &surfaces.bodies, &stress);
        FluidLoads { surfaces, propulsion }
    }
}
