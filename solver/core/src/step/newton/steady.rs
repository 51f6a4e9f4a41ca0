//! A steady flow, or the instantaneous flow of the Stokes model.
//!
//! Newton's method from the Stokes flow of a Newtonian fluid. A viscosity that depends on the rate of shear comes first,
//! then the density: where Newton's method stalls, the law (its index, time or yield stress) or the density is raised
//! from 0 to its value in steps that halve on failure and double on success (continuation in the law, and in the
//! Reynolds number).

use alewife_mesh::Point;

use super::{
    Criterion, Flow, FlowEquations, Forcing, Iterate, NewtonFailure, NewtonStop, Tangents,
    flow_residual, newton,
};
use crate::case::Steady;
use crate::coupling::{BodiesAt, Configuration, Problem, RigidBodyEquations, Solution, SolveError};
use crate::flow::{Convection, FlowTerms, LocalViscosity, Viscosity, ViscosityTerm};
use crate::step::error::FoundWith;
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

/// What is raised to its value.
const DENSITY: &str = "convection";
const LAW: &str = "change of the viscosity with shear";

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
    /// The last flow that was found with less convection, or the last iterate.
    pub last: Solution<D>,
}

/// The parts of what is not linear: 0 for the Stokes flow of a Newtonian fluid.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Parts {
    /// Of the density.
    density: f64,
    /// Of the law of the viscosity.
    law: f64,
}

/// The equations with parts of the density and of the law of the viscosity.
struct SteadyEquations<'a, const D: usize> {
    problem: &'a Problem<D>,
    parts: Parts,
    stop: Option<&'a StopRequest>,
}

impl<const D: usize> FlowEquations<D> for SteadyEquations<'_, D> {
    /// The velocity seen from the frame.
    fn convecting_velocity(&self, solution: &Solution<D>) -> Vec<Point<D>> {
        if self.parts.density == 0.0 {
            return Vec::new();
        }
        let frame = self.problem.frame_velocity(&solution.twists);
        solution.velocity.iter().map(|velocity| velocity - frame).collect()
    }

    fn terms<'a>(
        &'a self,
        convecting_velocity: &'a [Point<D>],
        solution: &'a Solution<D>,
    ) -> FlowTerms<'a, D> {
        terms_with(self.problem, self.parts, convecting_velocity, solution)
    }

    fn on_iteration(&self, iteration: usize, residual: f64) {
        let Parts { density, law } = self.parts;
        if self.problem.viscosity.is_newtonian() {
            tracing::info!(density_part = density, iteration, residual, "newton");
        } else {
            tracing::info!(density_part = density, law_part = law, iteration, residual, "newton");
        }
    }

    fn wants_stop(&self) -> bool {
        self.stop.is_some_and(|stop| stop())
    }
}

/// The terms with these parts of the density and of the law of the viscosity, linearised at a solution.
fn terms_with<'a, const D: usize>(
    problem: &Problem<D>,
    parts: Parts,
    convecting_velocity: &'a [Point<D>],
    solution: &'a Solution<D>,
) -> FlowTerms<'a, D> {
    let viscosity = match problem.viscosity.part(parts.law) {
        Viscosity::Newtonian(value) => ViscosityTerm::Constant(value),
        law if parts.law == 0.0 => ViscosityTerm::Constant(law.zero_shear()),
        law => ViscosityTerm::Local(LocalViscosity {
            law,
            velocity: &solution.velocity,
            has_tangent: true,
        }),
    };
    let convection =
        if parts.density > 0.0 { problem.newton_convection() } else { Convection::None };
    FlowTerms {
        viscosity,
        density: problem.density * parts.density,
        rate: 0.0,
        history: &[],
        convecting_velocity,
        convection,
    }
}

/// What convects at the nodes (m/s) of a steady flow; none without convection.
#[must_use]
pub fn steady_convection<const D: usize>(
    problem: &Problem<D>,
    solution: &Solution<D>,
) -> Vec<Point<D>> {
    SteadyEquations { problem, parts: whole(problem.has_convection), stop: None }
        .convecting_velocity(solution)
}

/// The terms of the equations of a steady flow with what convects at the nodes (m/s), linearised at a solution.
#[must_use]
pub fn steady_terms<'a, const D: usize>(
    problem: &Problem<D>,
    convecting_velocity: &'a [Point<D>],
    solution: &'a Solution<D>,
) -> FlowTerms<'a, D> {
    terms_with(problem, whole(problem.has_convection), convecting_velocity, solution)
}

/// All of the density where the fluid is convected, and all of the law.
fn whole(has_convection: bool) -> Parts {
    Parts { density: if has_convection { 1.0 } else { 0.0 }, law: 1.0 }
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
        let parts = whole(task.has_convection);
        let equations = SteadyEquations { problem, parts, stop: None };
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
        let newtonian = Parts { density: 0.0, law: 0.0 };
        let mut flow = match self.attempt(work, at, at_rest, newtonian)? {
            Attempt::Converged(flow) => flow,
            Attempt::Stalled(end) => return Err(self.undetermined(*end)),
        };
        if !self.problem.viscosity.is_newtonian() {
            flow = self.follow(work, at, flow, LAW, |law| Parts { density: 0.0, law })?;
        }
        if self.task.has_convection {
            flow = self.follow(work, at, flow, DENSITY, |density| Parts { density, law: 1.0 })?;
        }
        Ok(flow)
    }

    /// Continuation from a flow without a part of the equations to that with all of it.
    fn follow(
        &mut self,
        work: &mut Workspace<D>,
        at: &Configuration<'_, D>,
        mut flow: Flow<D>,
        of: &'static str,
        parts: impl Fn(f64) -> Parts,
    ) -> Result<Flow<D>, SteadyFailure<D>> {
        let (mut part, mut increment) = (0.0, 1.0f64);
        while part < 1.0 {
            let target = (part + increment).min(1.0);
            match self.attempt(work, at, flow.solution.clone(), parts(target))? {
                Attempt::Converged(found) => {
                    flow = found;
                    part = target;
                    increment *= 2.0;
                }
                Attempt::Stalled(end) if increment <= SMALLEST_STEP => {
                    return Err(self.stalled(&end, flow, FoundWith { part, of }));
                }
                Attempt::Stalled(_) => increment /= 2.0,
            }
        }
        Ok(flow)
    }

    /// Iterates with parts of the density and of the law of the viscosity.
    fn attempt(
        &mut self,
        work: &mut Workspace<D>,
        at: &Configuration<'_, D>,
        start: Solution<D>,
        parts: Parts,
    ) -> Result<Attempt<D>, SteadyFailure<D>> {
        let is_newtonian = self.problem.viscosity.is_newtonian();
        let is_stokes = parts.density == 0.0;
        let is_linear = is_stokes && (is_newtonian || parts.law == 0.0);
        // Where iterations give it, the Stokes flow that convection is added to is not better than needed
        let is_iterative = work.system.is_iterative();
        let is_start = is_linear && (self.task.has_convection || !is_newtonian) && is_iterative;
        let is_on_the_way = !is_newtonian && parts.law < 1.0;
        let tolerance = self.task.settings.tolerance;
        let criterion = Criterion {
            tolerance: if is_start || is_on_the_way { tolerance.max(START) } else { tolerance },
            rounding: ROUNDING,
            stationary: is_stokes.then_some(STATIONARY),
            max_iterations: self.task.settings.max_iterations,
            scale: self.scale,
            accepts_start: true,
            // Iterations end by a norm of their own, in which equations of all sizes of cells weigh the same
            is_linear: is_linear && is_iterative,
            is_damped: !is_linear && !is_newtonian,
            divergence: Some(DIVERGENCE),
            forcing: if is_linear { Forcing::ToTolerance } else { Forcing::Inexact },
            tangents: Tangents::System,
        };
        let equations = SteadyEquations { problem: self.problem, parts, stop: self.task.stop };
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
                    NewtonStop::Solve(SolveError::NotFinite { .. }) if !is_linear => {
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

    /// What diverges says nothing: what is left is the last flow that was found.
    fn stalled(&self, end: &Iterate<D>, flow: Flow<D>, found: FoundWith) -> SteadyFailure<D> {
        let error = FlowError::NewtonStalled {
            step: 0,
            time: self.task.bodies.shapes.time(),
            residual: end.residual,
            iterations: self.iterations,
            found: Some(found),
        };
        SteadyFailure { error: Box::new(error), last: flow.solution }
    }
}
