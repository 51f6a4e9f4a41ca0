//! A steady flow, or the instantaneous flow of the Stokes model.
//!
//! Newton's method from the Stokes flow; where it stalls, the density is raised from 0 to its
//! value in steps that halve on failure and double on success (continuation in the Reynolds
//! number).

use alewife_mesh::{Mesh, Point};

use super::{RunError, Stage, Timing};
use crate::algebra::AffineConstraints;
use crate::body::Pose;
use crate::case::Steady;
use crate::coupling::{
    BodyShapes, FluidSystem, Levels, Problem, Solution, SolveError, embed, newton_convection,
};
use crate::flow::{Convection, FlowTerms};

/// A converged flow.
#[derive(Debug, Clone)]
pub struct SteadyFlow {
    /// The fields and rigid velocities.
    pub solution: Solution,
    /// Raw residual of the fluid's equations at it.
    pub residual: Vec<f64>,
    /// Linear systems solved.
    pub iterations: usize,
}

/// A flow that was not found.
#[derive(Debug)]
pub struct SteadyFailure {
    /// Why.
    pub error: RunError,
    /// The last iterate.
    pub last: Solution,
}

/// One attempt of Newton's method.
enum Attempt {
    Converged(Solution, Vec<f64>),
    Stalled { residual: f64 },
}

/// Residuals relative to the first that count as rounding once they stop falling.
const ROUNDING: f64 = 1e-8;
/// Smallest step of the continuation, as a part of the whole density.
const SMALLEST_STEP: f64 = 1.0 / 64.0;

/// What stays the same over the iterations.
struct Newton<'a> {
    system: &'a mut FluidSystem,
    problem: &'a Problem,
    mesh: &'a Mesh<2>,
    constraints: &'a AffineConstraints,
    levels: &'a Levels,
    settings: &'a Steady,
    timing: &'a mut Timing,
    /// Size of the residual of a fluid at rest, which all others are relative to.
    scale: f64,
    iterations: usize,
    /// The last iterate, to be looked at when no more can be found.
    last: Solution,
}

/// Solves for a steady flow at a time (s) with the bodies at these poses, under the loads of `levels`.
///
/// # Errors
/// When the system is singular, a gait fails, or Newton's method stalls at the smallest step of
/// continuation.
pub fn solve_steady(
    system: &mut FluidSystem,
    problem: &Problem,
    mesh: &Mesh<2>,
    poses: &[Pose],
    (time, levels): (f64, &Levels),
    settings: &Steady,
    timing: &mut Timing,
) -> Result<SteadyFlow, SteadyFailure> {
    let shapes = match BodyShapes::at(&problem.bodies, time) {
        Ok(shapes) => shapes,
        Err(error) => {
            let last = Solution::at_rest(&system.layout);
            return Err(SteadyFailure { error: error.into(), last });
        }
    };
    let constraints = system.constraints(problem, mesh, poses, &shapes);
    let at_rest = embed(&system.layout, &constraints.expand(&vec![0.0; constraints.n_unknowns()]));
    let mut newton = Newton {
        system,
        problem,
        mesh,
        constraints: &constraints,
        levels,
        settings,
        timing,
        scale: 0.0,
        iterations: 0,
        last: at_rest.clone(),
    };
    match newton.solve(at_rest, time) {
        Err(error) => Err(SteadyFailure { error, last: newton.last }),
        Ok((mut solution, mut residual)) => {
            let iterations = newton.iterations;
            newton.system.center_pressure(problem, &mut solution);
            if problem.works_on_level() {
                let part = if problem.has_convection { 1.0 } else { 0.0 };
                let crossing = newton.crossing(&solution, part);
                let terms = terms(problem, &crossing, part);
                residual = newton.system.fluid_residual(mesh, &terms, &solution);
            }
            Ok(SteadyFlow { solution, residual, iterations })
        }
    }
}

/// The equations with a part of the density, 0 for Stokes flow.
fn terms<'a>(problem: &'a Problem, crossing: &'a [Point<2>], part: f64) -> FlowTerms<'a, 2> {
    FlowTerms {
        viscosity: problem.viscosity,
        density: problem.density * part,
        rate: 0.0,
        history: &[],
        crossing,
        convection: if part > 0.0 { newton_convection(problem) } else { Convection::None },
        body_force: problem.body_force,
    }
}

impl Newton<'_> {
    /// The flow and its raw residual, by way of Stokes flow.
    fn solve(&mut self, at_rest: Solution, time: f64) -> Result<(Solution, Vec<f64>), RunError> {
        let (mut reached, mut residual) = match self.attempt(at_rest, 0.0)? {
            Attempt::Converged(solution, residual) => (solution, residual),
            Attempt::Stalled { residual } => {
                // Without convection the equations are linear: one solve is all there is to it.
                let reason = format!(
                    "the Stokes flow leaves a residual of {residual:.1e}: perhaps nothing balances \
                     the force on a free body or fixes its velocity, or numbers overflow in these \
                     units"
                );
                return Err(RunError::Singular { step: 0, time, reason });
            }
        };
        if !self.problem.has_convection {
            return Ok((reached, residual));
        }
        let (mut part, mut increment) = (0.0, 1.0f64);
        while part < 1.0 {
            let target = (part + increment).min(1.0);
            match self.attempt(reached.clone(), target)? {
                Attempt::Converged(solution, raw) => {
                    (reached, residual) = (solution, raw);
                    part = target;
                    increment *= 2.0;
                }
                Attempt::Stalled { residual } if increment <= SMALLEST_STEP => {
                    return Err(self.stalled(residual, time));
                }
                Attempt::Stalled { .. } => increment /= 2.0,
            }
        }
        Ok((reached, residual))
    }

    /// Iterates with a part of the density, 0 for Stokes flow.
    fn attempt(&mut self, start: Solution, part: f64) -> Result<Attempt, RunError> {
        let mut solution = start;
        let mut last = f64::INFINITY;
        let mut best = f64::INFINITY;
        for iteration in 0..=self.settings.max_iterations {
            let crossing = self.crossing(&solution, part);
            let terms = terms(self.problem, &crossing, part);
            let raw = self.timing.measure(Stage::Assembly, || {
                self.system.fluid_residual(self.mesh, &terms, &solution)
            });
            let reduced = self.system.reduced_residual(
                self.problem,
                self.constraints,
                self.levels,
                &solution,
                raw.clone(),
            );
            let size = reduced.iter().fold(0.0f64, |most, value| most.max(value.abs()));
            if self.scale == 0.0 {
                self.scale = size;
            }
            let relative = if self.scale > 0.0 { size / self.scale } else { 0.0 };
            tracing::info!(density_part = part, iteration, residual = relative, "newton");
            let at_rounding = relative < ROUNDING && relative > 0.3 * last;
            if relative <= self.settings.tolerance || at_rounding {
                return Ok(Attempt::Converged(solution, raw));
            }
            best = best.min(relative);
            let hopeless = !relative.is_finite() || relative > 1e4 * best.max(1e-3);
            if iteration == self.settings.max_iterations || hopeless {
                return Ok(Attempt::Stalled { residual: relative });
            }
            last = relative;
            let step = self.system.newton_step(
                self.problem,
                self.mesh,
                self.constraints,
                &terms,
                self.levels,
                &solution,
                &reduced,
                self.timing,
            );
            self.iterations += 1;
            self.last = solution;
            solution = match step {
                Ok(next) => next,
                Err(SolveError::NotFinite { .. }) if part > 0.0 => {
                    return Ok(Attempt::Stalled { residual: relative });
                }
                Err(error) => return Err(RunError::from_solve(error, 0, 0.0)),
            };
        }
        unreachable!("the last iteration returns")
    }

    /// What convects: the velocity seen from the frame.
    fn crossing(&self, solution: &Solution, part: f64) -> Vec<Point<2>> {
        if part == 0.0 {
            return Vec::new();
        }
        let frame = self.problem.frame.map_or(Point::<2>::zeros(), |body| {
            let linear = &solution.twists[body].linear;
            Point::<2>::new(linear.x, linear.y)
        });
        solution.velocity.iter().map(|velocity| velocity - frame).collect()
    }

    fn stalled(&self, residual: f64, time: f64) -> RunError {
        RunError::NewtonStalled { step: 0, time, residual, iterations: self.iterations }
    }
}
