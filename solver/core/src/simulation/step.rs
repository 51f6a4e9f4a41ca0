//! One time step: BDF for fluid and bodies together, convection extrapolated or by Newton.
//!
//! Where bodies will be is predicted to second order, the mesh follows them there, and fluid, bodies
//! and contact are solved for on it. The velocities that come out give where the bodies get to; where
//! that is elsewhere by more than the tolerance, the step is solved again there.
//!
//! The mesh velocity w is the backward difference of the positions of the nodes, the same as for the
//! flow: a uniform flow stays uniform, and on the surface of a body w has the body's velocity (that of
//! its centre where it is round: its mesh does not turn). The mesh may also travel with a body as a
//! whole (`frame`); the unknown stays the velocity seen from the laboratory, so that no inertial force
//! appears.

use alewife_mesh::Mesh;

use super::Timing;
use super::contact_step::PassContact;
use super::error::StepError;
use super::error_estimate::local_error;
use super::fluid_loads::{FluidLoads, SolvedConfiguration};
use super::history::StepHistory;
use super::mesh_path::MeshPath;
use super::new_level::Arrival;
use super::newton::{Criterion, Flow, newton};
use super::pass::{Pass, PassEquations, Placement};
use super::predict::{integrate_poses, limit_by_gaps, predict_poses};
use super::state::{NewLevel, State};
use crate::case::Convection;
use crate::contact::Law;
use crate::coupling::{BodyLoads, FluidSystem, Problem, Solution};
use crate::time::Bdf;

/// Most passes until the bodies are where the flow was solved for.
const MAX_PASSES: usize = 12;

/// What stays the same from step to step while the mesh lasts.
#[derive(Clone, Copy)]
pub struct TimeStepper<'a, const D: usize> {
    /// What is solved.
    pub problem: &'a Problem<D>,
    /// How convection is taken.
    pub convection: Convection,
    /// How the mesh moves.
    pub path: MeshPath<'a, D>,
    /// The law of contact, if any.
    pub contact: Option<&'a Law>,
}

/// What a step works with; nothing in it is read before it is written.
pub struct Workspace<const D: usize> {
    /// The linear system on the mesh.
    pub system: FluidSystem<D>,
    /// The mesh of the present pass, in the laboratory.
    pub mesh: Mesh<D>,
    /// Time spent in each stage.
    pub timing: Timing,
}

/// A step in time.
#[derive(Debug, Clone, Copy)]
pub struct Step {
    /// Its number, from one.
    pub number: usize,
    /// The new time (s).
    pub time: f64,
    /// Backward differences at the new time.
    pub bdf: Bdf,
}

impl Step {
    /// The step from a state by some backward differences.
    #[must_use]
    pub fn from<const D: usize>(state: &State<D>, bdf: Bdf) -> Self {
        Self { number: state.step + 1, time: state.time + bdf.step, bdf }
    }
}

/// What a step leaves for measurements and for the choice of the next step.
#[derive(Debug, Clone)]
pub struct StepReport {
    /// Loads of the fluid on the bodies, where the flow was solved for.
    pub loads: Vec<BodyLoads>,
    /// Linear systems solved.
    pub iterations: usize,
    /// Estimate of the error of the step, relative to the size of the velocities; zero for a step of
    /// first order.
    pub error: f64,
}

impl<const D: usize> TimeStepper<'_, D> {
    /// The level a step of `bdf` leads to from a state, which [`State::accept`] takes on.
    ///
    /// # Errors
    /// When the system is singular, the solution not finite, Newton's method stalls, the mesh
    /// degenerates, a gait fails, or contact forces or poses of bodies are not found.
    pub fn advance(
        &self,
        work: &mut Workspace<D>,
        state: &State<D>,
        bdf: Bdf,
    ) -> Result<(NewLevel<D>, StepReport), StepError> {
        let problem = self.problem;
        let step = Step::from(state, bdf);
        let history = StepHistory::new(self, state, step)?;
        let gaps = self.path.gaps(&history.shapes);
        let gaps = gaps.as_deref();
        let mut apart = state.poses.clone();
        let mut poses = predict_poses(self, state, &step);
        let mut guess = history.extrapolated.clone();
        let mut iterations = 0;
        for _ in 0..MAX_PASSES {
            poses = limit_by_gaps(problem, gaps, state, &apart, poses);
            let nodes = self.path.move_mesh(work, problem, state, &poses, &history.shapes)?;
            let pass = Pass::new(self, work, state, &history, Placement { nodes, poses });
            let equations = PassEquations::new(self, &history, &pass);
            let mut flow = self.solve(work, &equations, guess)?;
            iterations += flow.iterations;
            let contact = PassContact { stepper: self, state, gaps, equations: &equations }
                .apply(work, &mut flow)?;
            let reached = integrate_poses(self, state, &step, &flow.solution.twists);
            if self.path.resolves(&pass.poses, &reached) {
                let loads = self.loads(work, state, &equations, &mut flow);
                let error = local_error(self, state, &step, &flow.solution);
                let end = Arrival { poses: reached, solution: flow.solution, contact };
                let level = self.new_level(work, state, &history, &pass, end, &loads.propulsion)?;
                return Ok((level, StepReport { loads: loads.bodies, iterations, error }));
            }
            (apart, poses, guess) = (pass.poses, reached, flow.solution);
        }
        Err(StepError::CouplingNotConverged { passes: MAX_PASSES })
    }

    /// The flow on the mesh of a pass, without contact, from a first guess.
    pub(super) fn solve(
        &self,
        work: &mut Workspace<D>,
        equations: &PassEquations<'_, D>,
        guess: Solution<D>,
    ) -> Result<Flow<D>, StepError> {
        let Workspace { system, mesh, timing } = work;
        let at = equations.pass.at(self.problem, mesh);
        let start = system.constrained(at.constraints, &guess);
        let criterion = Criterion::of_step(equations.is_linear());
        newton(system, timing, &at, equations, &criterion, start)
            .map_err(|failure| failure.in_step(&equations.history.step).into())
    }

    /// Loads of the flow of a pass, its pressure at its level.
    pub(super) fn loads(
        &self,
        work: &mut Workspace<D>,
        state: &State<D>,
        equations: &PassEquations<'_, D>,
        flow: &mut Flow<D>,
    ) -> FluidLoads {
        let Workspace { system, mesh, timing } = work;
        let at = equations.pass.at(self.problem, mesh);
        SolvedConfiguration { system, at, state, poses: &equations.pass.poses }
            .loads(equations, flow, timing)
    }
}
