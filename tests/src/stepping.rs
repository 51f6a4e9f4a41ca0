//! Flows of problems made by hand, steady and step by step.

use alewife_core::body::MeshPoses;
use alewife_core::case::{Convection, Steady};
use alewife_core::coupling::{
    BodiesAt, BodyShapes, Configuration, FluidSystem, MeanFlowAt, Problem, RigidBodyEquations,
    Solution, SolveError,
};
use alewife_core::flow::{self, FlowTerms};
use alewife_core::state::State;
use alewife_core::step::{
    MeshPath, SteadyFlow, SteadyTask, StepReport, StepResult, TimeStepper, Workspace, solve_steady,
};
use alewife_core::time::Bdf;
use alewife_core::timing::{Stage, Timing};
use alewife_mesh::{Mesh, Point};

/// What steps of a problem on a mesh work with, its bodies at their poses at time zero.
#[must_use]
pub fn workspace<const D: usize>(problem: &Problem<D>, mesh: &Mesh<D>) -> Workspace<D> {
    let poses = start_poses(problem);
    let system = FluidSystem::new(problem, mesh, &poses, false);
    Workspace::new(system, mesh.clone())
}

fn start_poses<const D: usize>(problem: &Problem<D>) -> MeshPoses {
    MeshPoses::of(problem.bodies.iter().map(|body| body.pose))
}

/// The steady flow at time zero, with convection if the problem has it.
///
/// # Panics
/// When it is not found.
#[must_use]
pub fn steady<const D: usize>(
    problem: &Problem<D>,
    mesh: &Mesh<D>,
    settings: &Steady,
) -> SteadyFlow<D> {
    let mut work = workspace(problem, mesh);
    let has_convection = problem.has_convection;
    steady_with(&mut work, problem, settings, has_convection)
}

/// The steady flow at time zero on the mesh of a workspace.
///
/// # Panics
/// When it is not found.
#[must_use]
pub fn steady_with<const D: usize>(
    work: &mut Workspace<D>,
    problem: &Problem<D>,
    settings: &Steady,
    has_convection: bool,
) -> SteadyFlow<D> {
    let poses = start_poses(problem);
    let shapes = BodyShapes::at(&problem.bodies, 0.0).expect("gaits have shapes");
    let equations = RigidBodyEquations::steady(problem, &poses, 0.0);
    let bodies = BodiesAt { poses: &poses, shapes: &shapes };
    let task = SteadyTask { bodies, equations: &equations, settings, has_convection, stop: None };
    solve_steady(work, problem, &task).map_err(|failure| failure.error).expect("the flow converges")
}

/// The flow after one linear system from rest, whose rates have the factor `rate` of the new velocity
/// (1/s).
///
/// # Errors
/// When the system is not solved.
pub fn one_system_from_rest<const D: usize>(
    system: &mut FluidSystem<D>,
    problem: &Problem<D>,
    mesh: &Mesh<D>,
    rate: f64,
    timing: &mut Timing,
) -> Result<Solution<D>, SolveError> {
    let poses = start_poses(problem);
    let shapes = BodyShapes::rigid(poses.len());
    let bodies = BodiesAt { poses: &poses, shapes: &shapes };
    let constraints = system.constraints(problem, mesh, bodies);
    let equations = RigidBodyEquations::steady(problem, &poses, 0.0);
    let at = Configuration {
        problem,
        mesh,
        constraints: &constraints,
        bodies: &equations,
        mean_flow: MeanFlowAt::default(),
    };
    let history = vec![Point::<D>::zeros(); mesh.n_nodes()];
    let terms = FlowTerms {
        viscosity: problem.viscosity_at(&[], false),
        density: problem.density,
        rate,
        history: &history,
        convecting_velocity: &[],
        convection: flow::Convection::None,
    };
    let start = system.at_rest(&constraints);
    let raw = timing.measure(Stage::Assembly, || system.fluid_residual(&at, &terms, &start));
    let reduced = system.reduced_residual(&at, &start, &raw);
    system.newton_step(&at, &terms, &start, &reduced, None, timing)
}

/// A problem without contact that is stepped in time.
pub struct Stepping<'a, const D: usize> {
    /// How it is stepped.
    pub stepper: TimeStepper<'a, D>,
    /// What evolves.
    pub state: State<D>,
    work: Workspace<D>,
}

impl<'a, const D: usize> Stepping<'a, D> {
    /// At rest at time zero on a mesh.
    #[must_use]
    pub fn new(
        problem: &'a Problem<D>,
        mesh: &Mesh<D>,
        convection: Convection,
        path: MeshPath<'a, D>,
    ) -> Self {
        let stepper = TimeStepper { problem, convection, path, contact: None, stop: None };
        let state = State::at_rest(problem, mesh.clone());
        Self { stepper, state, work: workspace(problem, mesh) }
    }

    /// One step.
    ///
    /// # Panics
    /// When it cannot be made.
    pub fn advance(&mut self, bdf: Bdf) -> StepReport {
        let made = self.stepper.advance(&mut self.work, &self.state, bdf);
        let StepResult { level, report } = made.expect("the step is solved");
        self.state.accept(self.stepper.problem, level);
        report
    }
}
