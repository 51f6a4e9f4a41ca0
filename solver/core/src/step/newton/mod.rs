//! Newton's method for the flow on one configuration of the mesh, steady or in a step.

use alewife_mesh::Point;

mod steady;
mod tangents;

pub use steady::{
    SteadyFailure, SteadyFlow, SteadyTask, solve_steady, steady_convection, steady_terms,
};

pub(super) use tangents::Tangents;

use super::error::FlowError;
use super::stepper::Step;
use crate::coupling::{Configuration, FluidSystem, Solution, SolveError};
use crate::flow::FlowTerms;
use crate::timing::{Stage, Timing};

/// The equations of the fluid as a function of the solution they are linearised at.
pub(super) trait FlowEquations<const D: usize> {
    /// What convects at the nodes (m/s); none without convection.
    fn convecting_velocity(&self, solution: &Solution<D>) -> Vec<Point<D>>;

    /// The terms with this convecting velocity, linearised at a solution.
    fn terms<'a>(
        &'a self,
        convecting_velocity: &'a [Point<D>],
        solution: &'a Solution<D>,
    ) -> FlowTerms<'a, D>;

    /// Called with each residual, relative to the scale of the criterion.
    fn on_iteration(&self, _iteration: usize, _residual: f64) {}

    /// Whether the run is to end; asked in each iteration.
    fn wants_stop(&self) -> bool {
        false
    }
}

/// The raw residual of the fluid at a solution.
pub(super) fn flow_residual<const D: usize>(
    system: &FluidSystem<D>,
    at: &Configuration<'_, D>,
    equations: &impl FlowEquations<D>,
    solution: &Solution<D>,
) -> Vec<f64> {
    let convecting_velocity = equations.convecting_velocity(solution);
    system.fluid_residual(at, &equations.terms(&convecting_velocity, solution), solution)
}

/// When Newton's method ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct Criterion {
    /// Residual relative to the scale that counts as converged.
    pub tolerance: f64,
    /// Residuals relative to the scale that count as rounding once they stop falling.
    pub rounding: f64,
    /// Change of the velocities over their size that is rounding, if that ends the iteration.
    pub stationary: Option<f64>,
    /// Most iterations.
    pub max_iterations: usize,
    /// What residuals are relative to; the first one if not given.
    pub scale: Option<f64>,
    /// Whether the first iterate may be the solution.
    pub accepts_start: bool,
    /// Whether one linear system gives the solution.
    pub is_linear: bool,
    /// Whether steps that enlarge the residual are shortened.
    pub is_damped: bool,
    /// Growth of the residual over the least one from which there is no return, if that is looked for.
    pub divergence: Option<f64>,
    /// How far iterations solve the linear systems.
    pub forcing: Forcing,
    /// For how long derivatives of the equations of coordinates are kept, with the factors they are in.
    pub tangents: Tangents,
}

/// The forcing term of inexact Newton methods: the part of a residual that the solution of a linear system by
/// iterations leaves. It is chosen before the solve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Forcing {
    /// A part of what a step changes: of its first residual.
    OfStep {
        /// The first residual of the first iteration for the poses; none in that iteration.
        first: Option<f64>,
        /// The smallest part of the residual of this iteration.
        least: f64,
    },
    /// As much as the tolerance allows: the equations are linear.
    ToTolerance,
    /// What the next step of Newton's method would leave anyway, were the system solved exactly
    /// (@eisenstat1996).
    Inexact,
}

/// Part of a residual that the linear equations of a step leave, which start from the last solution: the
/// error of all steps together is this part of the change of the flow, far below that of the scheme,
/// which is of second order in the step over the time of change.
const OF_STEP: f64 = 1e-6;
/// Part of the first residual that further iterations for the poses leave at least: less than a difference of forces
/// shows, which are compared with rates of momentum to 1e-6 (`tests/spatial/deforming.rs`). With contact, which
/// ends that iteration early, it is left at once.
const OF_ITERATION: f64 = 1e-7;
/// Largest part that the solution of a linear system leaves.
const LARGEST_FORCING: f64 = 0.1;
/// Part that the first system of Newton's method leaves, and what stands for the square of the last
/// residual over the one before.
const FIRST_FORCING: f64 = 1e-2;
const QUADRATIC: f64 = 0.9;
/// Part of the tolerance that iterations are to reach: it is in another norm than theirs.
const MARGIN: f64 = 0.5;
/// Smallest part: beyond that there is rounding.
const SMALLEST_FORCING: f64 = 1e-12;

impl Criterion {
    /// For the flow of one iteration for the poses, of which the first had this first residual.
    pub fn of_step(is_linear: bool, first: Option<f64>, has_contact: bool) -> Self {
        let least = if has_contact { OF_ITERATION } else { OF_STEP };
        Self {
            tolerance: 1e-10,
            rounding: 1e-7,
            stationary: Some(1e-13),
            max_iterations: 20,
            scale: None,
            accepts_start: false,
            is_linear,
            is_damped: false,
            divergence: None,
            forcing: if is_linear { Forcing::OfStep { first, least } } else { Forcing::Inexact },
            tangents: if first.is_some() { Tangents::Step } else { Tangents::Pass },
        }
    }
}

/// Residual over the scale at which a least residual counts when divergence is looked for.
const LARGE: f64 = 1e-3;

/// Linear systems after which rates of coordinates are as exact as they get.
const SETTLED: usize = 4;

/// A part of the last residual that is no progress any more.
const NO_PROGRESS: f64 = 0.3;

/// A flow with its raw residual.
pub(super) struct Flow<const D: usize> {
    pub solution: Solution<D>,
    /// Raw residual of the fluid's equations.
    pub residual: Vec<f64>,
    /// Linear systems solved.
    pub iterations: usize,
    /// What residuals were relative to.
    pub scale: f64,
}

/// An iterate that is no solution.
pub(super) struct Iterate<const D: usize> {
    pub solution: Solution<D>,
    /// Residual relative to the scale.
    pub residual: f64,
    /// Linear systems solved.
    pub iterations: usize,
    /// What residuals were relative to.
    pub scale: f64,
}

/// What stops Newton's method before a solution.
#[derive(Debug)]
pub(super) enum NewtonStop {
    /// The residual did not get small.
    Stalled,
    /// A linear system could not be solved.
    Solve(SolveError),
    /// The run is to end.
    Requested,
}

/// Why Newton's method ended without a solution.
pub(super) struct NewtonFailure<const D: usize> {
    /// What stopped it.
    pub reason: NewtonStop,
    /// The last iterate.
    pub end: Box<Iterate<D>>,
}

impl<const D: usize> NewtonFailure<D> {
    /// The error of a run that ends with it in a step.
    pub fn in_step(self, step: &Step) -> FlowError {
        let Step { number, time, .. } = *step;
        let Iterate { residual, iterations, .. } = *self.end;
        match self.reason {
            NewtonStop::Solve(error) => FlowError::from_solve(error, number, time),
            NewtonStop::Stalled => {
                FlowError::NewtonStalled { step: number, time, residual, iterations, found: None }
            }
            NewtonStop::Requested => FlowError::Stopped { step: number, time },
        }
    }
}

/// Solves R(u) = 0 for fluid and bodies from a first iterate that meets the constraints.
pub(super) fn newton<const D: usize>(
    system: &mut FluidSystem<D>,
    timing: &mut Timing,
    at: &Configuration<'_, D>,
    equations: &impl FlowEquations<D>,
    criterion: &Criterion,
    start: Solution<D>,
) -> Result<Flow<D>, NewtonFailure<D>> {
    let mut solution = system.with_given_gradients(at, start);
    let mut progress = Progress::new(criterion);
    // What rounding is does not change as the solution is found
    let roundings = system.roundings(at, &solution);
    let rounding = roundings.iter().map(|of_body| of_body.amax()).fold(0.0, f64::max);
    loop {
        let iterations = progress.iterations;
        let convecting_velocity = equations.convecting_velocity(&solution);
        let terms = equations.terms(&convecting_velocity, &solution);
        // The second residual of a linear system is for the loads only
        let is_for_loads = criterion.is_linear && iterations == 1;
        let stage = if is_for_loads { Stage::Loads } else { Stage::Assembly };
        let residual = timing.measure(stage, || system.fluid_residual(at, &terms, &solution));
        if is_for_loads {
            return Ok(Flow { solution, residual, iterations, scale: progress.scale() });
        }
        let reduced = system.reduced_residual(at, &solution, &residual);
        let size = system.largest_lack(at, &reduced, &roundings);
        // What stiff bodies round to moves them, and the fluid with them: nothing smaller is a measure
        let least = system.mean_force(&solution).max(rounding);
        let relative = progress.relative(size, least);
        equations.on_iteration(iterations, relative);
        let scale = progress.scale();
        // The largest entry says nothing of those that are no numbers: a linear solution finds them
        let is_finite = reduced.iter().all(|value| value.is_finite());
        let may_end = is_finite && (iterations >= SETTLED || !system.has_rounded_rates());
        if may_end && progress.is_converged(relative) && system.meets_mean_velocity(at, &solution) {
            return Ok(Flow { solution, residual, iterations, scale });
        }
        let end = |solution, iterations| {
            Box::new(Iterate { solution, residual: relative, iterations, scale })
        };
        if progress.is_hopeless(relative) {
            return Err(NewtonFailure {
                reason: NewtonStop::Stalled,
                end: end(solution, iterations),
            });
        }
        if equations.wants_stop() {
            let end = end(solution, iterations);
            return Err(NewtonFailure { reason: NewtonStop::Requested, end });
        }
        if criterion.tangents.are_renewed(iterations) || !system.keeps_factors() {
            system.renew_tangents();
        }
        let forcing = Some(progress.forcing(relative));
        let next = match system.newton_step(at, &terms, &solution, &reduced, forcing, timing) {
            Ok(next) => next,
            Err(error) => {
                let end = end(solution, iterations + 1);
                return Err(NewtonFailure { reason: NewtonStop::Solve(error), end });
            }
        };
        let next = if criterion.is_damped {
            timing.measure(Stage::Assembly, || {
                shortened(system, at, equations, [&solution, &next], norm(&reduced))
            })
        } else {
            next
        };
        progress.take(relative, &solution, &next);
        solution = next;
    }
}

/// Halvings of a step of Newton's method at most.
const MOST_HALVINGS: i32 = 8;

/// The end of a step of Newton's method, or a point on the way from its start at which the norm of the residual is not larger
/// than at the start: near that all entries fall.
fn shortened<const D: usize>(
    system: &FluidSystem<D>,
    at: &Configuration<'_, D>,
    equations: &impl FlowEquations<D>,
    [start, end]: [&Solution<D>; 2],
    size: f64,
) -> Solution<D> {
    let mut trial = end.clone();
    for halving in 1..=MOST_HALVINGS {
        let residual = flow_residual(system, at, equations, &trial);
        if norm(&system.reduced_residual(at, &trial, &residual)) <= size {
            return trial;
        }
        trial = start.towards(end, 0.5f64.powi(halving));
    }
    trial
}

/// The root of the sum of squares.
fn norm(residual: &[f64]) -> f64 {
    residual.iter().map(|value| value * value).sum::<f64>().sqrt()
}

/// How the residual has fallen so far.
struct Progress<'a> {
    criterion: &'a Criterion,
    scale: Option<f64>,
    iterations: usize,
    last: f64,
    least: f64,
    is_stationary: bool,
}

impl<'a> Progress<'a> {
    fn new(criterion: &'a Criterion) -> Self {
        Self {
            criterion,
            scale: criterion.scale,
            iterations: 0,
            last: f64::INFINITY,
            least: f64::INFINITY,
            is_stationary: false,
        }
    }

    /// The size of a residual relative to the scale, which is at least `least`: the largest entry of the mean pressure
    /// gradient, or the rounding of stiff bodies.
    fn relative(&mut self, size: f64, least: f64) -> f64 {
        // A fluid at rest has no residual where a mean velocity is given: the force that brings it
        // about is the measure then
        let scale = match self.scale {
            None => size.max(least),
            Some(0.0) => least,
            Some(scale) => scale,
        };
        self.scale = Some(scale);
        if scale > 0.0 { size / scale } else { 0.0 }
    }

    fn scale(&self) -> f64 {
        self.scale.unwrap_or(0.0)
    }

    fn is_converged(&self, relative: f64) -> bool {
        let Criterion { tolerance, rounding, accepts_start, .. } = *self.criterion;
        let is_rounding = relative < rounding && relative > NO_PROGRESS * self.last;
        let may_end = accepts_start || self.iterations > 0;
        may_end && (relative <= tolerance || is_rounding || self.is_stationary)
    }

    /// What is to be left of this residual by the next linear system.
    fn forcing(&self, relative: f64) -> f64 {
        let enough = MARGIN * self.criterion.tolerance / relative;
        let wanted = match self.criterion.forcing {
            Forcing::OfStep { first, least } => {
                let scale = self.scale();
                let part = first.filter(|_| scale > 0.0).map_or(0.0, |first| first / scale);
                return (OF_ITERATION * part).clamp(least, FIRST_FORCING);
            }
            Forcing::ToTolerance => enough,
            Forcing::Inexact if self.iterations == 0 => enough.max(FIRST_FORCING),
            Forcing::Inexact => enough.max(QUADRATIC * (relative / self.last).powi(2)),
        };
        wanted.clamp(SMALLEST_FORCING, LARGEST_FORCING)
    }

    fn is_hopeless(&self, relative: f64) -> bool {
        let least = self.least.min(relative).max(LARGE);
        let diverges = |growth: f64| !relative.is_finite() || relative > growth * least;
        self.iterations == self.criterion.max_iterations
            || self.criterion.divergence.is_some_and(diverges)
    }

    fn take<const D: usize>(&mut self, relative: f64, from: &Solution<D>, to: &Solution<D>) {
        self.least = self.least.min(relative);
        self.last = relative;
        self.iterations += 1;
        // Where the first residual is rounding already, no other is small beside it
        let is_rounding = |limit| change(from, to) <= limit;
        self.is_stationary = self.criterion.stationary.is_some_and(is_rounding);
    }
}

/// Largest change of a velocity over the largest velocity.
fn change<const D: usize>(from: &Solution<D>, to: &Solution<D>) -> f64 {
    let most = |sizes: &mut dyn Iterator<Item = f64>| sizes.fold(0.0, f64::max);
    let pairs = from.velocity.iter().zip(&to.velocity);
    let change = most(&mut pairs.map(|(from, to)| (to - from).amax()));
    let size = most(&mut to.velocity.iter().map(|velocity| velocity.amax()));
    if change > 0.0 { change / size } else { 0.0 }
}
