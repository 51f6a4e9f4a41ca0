//! A steady flow, or the instantaneous flow of the Stokes model.
//!
//! Newton's method from the Stokes flow; where it stalls, the density is raised from 0 to its
//! value in steps that halve on failure and double on success (continuation in the Reynolds
//! number).

use alewife_mesh::Point;

use super::{
    Criterion, Flow, FlowEquations, Forcing, Iterate, NewtonFailure, NewtonStop, flow_residual,
    newton,
};
use crate::case::Steady;
use crate::coupling::{BodiesAt, Configuration, Problem, RigidBodyEquations, Solution, SolveError};
use crate::flow::{Convection, FlowTerms};
use crate::step::{FlowError, StopRequest, Workspace};

/// Residuals relative to that at rest that count as rounding once they stop falling.
const ROUNDING: f64 = 1e-8;
/// Change of the velocities of a Stokes flow over their size that is rounding: the pressure of a thin
/// film beside a wide region is so large that residuals are not small beside those of a fluid at rest.
const STATIONARY: f64 = 1e-8;
/// Smallest step of the continuation, as a part of the whole density.
const SMALLEST_STEP: f64 = 1.0 / 64.0;
/// Residual of a Stokes flow that is only a start.
const START: f64 = 1e-4;
/// Growth of the residual from which there is no return.
const DIVERGENCE: f64 = 1e4;

/// A steady flow that is asked for.
#[derive(Clone, Copy)]
pub struct SteadyTask<'a> {
    /// Where bodies are and what moves their surfaces.
    pub bodies: BodiesAt<'a>,
    /// Newton's and Euler's equations.
    pub equations: &'a RigidBodyEquations,
    /// Accuracy.
    pub settings: &'a Steady,
    /// Whether the fluid is convected.
    pub has_convection: bool,
    /// What to ask whether the run is to end.
    pub stop: Option<&'a StopRequest>,
}

/// A converged flow.
#[derive(Debug, Clone)]
pub struct SteadyFlow<const D: usize> {
    /// The fields and rigid velocities.
    pub solution: Solution<D>,
    /// Raw residual of the fluid's equations at it.
    pub residual: Vec<f64>,
    /// Linear systems solved.
    pub iterations: usize,
}

/// A flow that was not found.
#[derive(Debug)]
pub struct SteadyFailure<const D: usize> {
    /// Why.
    pub error: Box<FlowError>,
    /// The last iterate.
    pub last: Solution<D>,
}

/// The equations with a part of the density, 0 for Stokes flow.
struct SteadyEquations<'a, const D: usize> {
    problem: &'a Problem<D>,
    part: f64,
    stop: Option<&'a StopRequest>,
}

impl<const D: usize> FlowEquations<D> for SteadyEquations<'_, D> {
    /// The velocity seen from the frame.
    fn convecting_velocity(&self, solution: &Solution<D>) -> Vec<Point<D>> {
        if self.part == 0.0 {
            return Vec::new();
        }
        let frame = self.problem.frame_velocity(&solution.twists);
        solution.velocity.iter().map(|velocity| velocity - frame).collect()
    }

    fn terms<'a>(&'a self, convecting_velocity: &'a [Point<D>]) -> FlowTerms<'a, D> {
        let problem = self.problem;
        let convection =
            if self.part > 0.0 { problem.newton_convection() } else { Convection::None };
        FlowTerms {
            viscosity: problem.viscosity,
            density: problem.density * self.part,
            rate: 0.0,
            history: &[],
            convecting_velocity,
            convection,
            body_force: problem.body_force,
        }
    }

    fn on_iteration(&self, iteration: usize, residual: f64) {
        tracing::info!(density_part = self.part, iteration, residual, "newton");
    }

    fn wants_stop(&self) -> bool {
        self.stop.is_some_and(|stop| stop())
    }
}

/// Solves for a steady flow on the mesh of `work`.
///
/// # Errors
/// When the system is singular or Newton's method stalls at the smallest step of continuation.
pub fn solve_steady<const D: usize>(
    work: &mut Workspace<D>,
    problem: &Problem<D>,
    task: &SteadyTask<'_>,
) -> Result<SteadyFlow<D>, SteadyFailure<D>> {
    let constraints = work.system.constraints(problem, &work.mesh, task.bodies);
    let mut continuation = Continuation { problem, task, scale: None, iterations: 0 };
    let mesh = work.mesh.clone();
    let mean_flow = problem.mean_flow_at(task.bodies.shapes.time());
    let (constraints, bodies) = (&constraints, task.equations);
    let at = Configuration { problem, mesh: &mesh, constraints, bodies, mean_flow };
    let mut flow = continuation.solve(work, &at)?;
    work.system.center_pressure(problem, &mut flow.solution);
    if problem.power_depends_on_pressure_level() {
        let part = if task.has_convection { 1.0 } else { 0.0 };
        let equations = SteadyEquations { problem, part, stop: None };
        flow.residual = flow_residual(&work.system, &at, &equations, &flow.solution);
    }
    let Flow { solution, residual, .. } = flow;
    Ok(SteadyFlow { solution, residual, iterations: continuation.iterations })
}

/// Newton's method by way of Stokes flow.
struct Continuation<'a, const D: usize> {
    problem: &'a Problem<D>,
    task: &'a SteadyTask<'a>,
    /// Size of the residual of a fluid at rest, which all others are relative to.
    scale: Option<f64>,
    iterations: usize,
}

/// What came of one part of the density.
enum Attempt<const D: usize> {
    Converged(Flow<D>),
    /// A smaller part may be found.
    Stalled(Box<Iterate<D>>),
}

impl<const D: usize> Continuation<'_, D> {
    fn solve(
        &mut self,
        work: &mut Workspace<D>,
        at: &Configuration<'_, D>,
    ) -> Result<Flow<D>, SteadyFailure<D>> {
        let at_rest = work.system.at_rest(at.constraints);
        let mut flow = match self.attempt(work, at, at_rest, 0.0)? {
            Attempt::Converged(flow) => flow,
            Attempt::Stalled(end) => return Err(self.undetermined(*end)),
        };
        if !self.task.has_convection {
            return Ok(flow);
        }
        let (mut part, mut increment) = (0.0, 1.0f64);
        while part < 1.0 {
            let target = (part + increment).min(1.0);
            match self.attempt(work, at, flow.solution.clone(), target)? {
                Attempt::Converged(found) => {
                    flow = found;
                    part = target;
                    increment *= 2.0;
                }
                Attempt::Stalled(end) if increment <= SMALLEST_STEP => {
                    return Err(self.stalled(*end));
                }
                Attempt::Stalled(_) => increment /= 2.0,
            }
        }
        Ok(flow)
    }

    /// Iterates with a part of the density, 0 for Stokes flow.
    fn attempt(
        &mut self,
        work: &mut Workspace<D>,
        at: &Configuration<'_, D>,
        start: Solution<D>,
        part: f64,
    ) -> Result<Attempt<D>, SteadyFailure<D>> {
        let is_stokes = part == 0.0;
        // Where iterations give it, the Stokes flow that convection is added to is not better than needed
        let is_iterative = work.system.is_iterative();
        let is_start = is_stokes && self.task.has_convection && is_iterative;
        let tolerance = self.task.settings.tolerance;
        let criterion = Criterion {
            tolerance: if is_start { tolerance.max(START) } else { tolerance },
            rounding: ROUNDING,
            stationary: is_stokes.then_some(STATIONARY),
            max_iterations: self.task.settings.max_iterations,
            scale: self.scale,
            accepts_start: true,
            // Iterations end by a norm of their own, in which equations of all sizes of cells weigh the same
            is_linear: is_stokes && is_iterative,
            divergence: Some(DIVERGENCE),
            forcing: if is_stokes { Forcing::ToTolerance } else { Forcing::Inexact },
        };
        let equations = SteadyEquations { problem: self.problem, part, stop: self.task.stop };
        let Workspace { system, timing, .. } = work;
        match newton(system, timing, at, &equations, &criterion, start) {
            Ok(flow) => {
                self.take(flow.iterations, flow.scale);
                Ok(Attempt::Converged(flow))
            }
            Err(NewtonFailure { reason, end }) => {
                self.take(end.iterations, end.scale);
                let time = self.task.bodies.shapes.time();
                let error = match reason {
                    NewtonStop::Stalled => return Ok(Attempt::Stalled(end)),
                    NewtonStop::Solve(SolveError::NotFinite { .. }) if part > 0.0 => {
                        return Ok(Attempt::Stalled(end));
                    }
                    NewtonStop::Solve(error) => FlowError::from_solve(error, 0, time),
                    NewtonStop::Requested => FlowError::Stopped { step: 0, time },
                };
                Err(SteadyFailure { error: Box::new(error), last: end.solution })
            }
        }
    }

    fn take(&mut self, iterations: usize, scale: f64) {
        self.iterations += iterations;
        self.scale = Some(scale).filter(|scale| *scale > 0.0);
    }

    /// Without convection the equations are linear: one solve is all there is to it.
    fn undetermined(&self, end: Iterate<D>) -> SteadyFailure<D> {
        let reason = format!(
            "the Stokes flow leaves a residual of {:.1e}: perhaps nothing balances the force on a free \
             body or fixes its velocity, or numbers overflow in these units",
            end.residual
        );
        let time = self.task.bodies.shapes.time();
        let error = FlowError::Singular { step: 0, time, reason };
        SteadyFailure { error: Box::new(error), last: end.solution }
    }

    fn stalled(&self, end: Iterate<D>) -> SteadyFailure<D> {
        let error = FlowError::NewtonStalled {
            step: 0,
            time: self.task.bodies.shapes.time(),
            residual: end.residual,
            iterations: self.iterations,
        };
        SteadyFailure { error: Box::new(error), last: end.solution }
    }
}
