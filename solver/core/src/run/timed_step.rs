//! `TimedStep`: one step of a run, made on its first mesh to see what a step takes.

use std::time::{Duration, Instant};

use alewife_mesh::{Mesh, Point};

use super::build::Scalars;
use super::case_mesh::{CaseMesh, Dimension};
use super::control::n_pieces;
use super::error::RunError;
use super::prepare::simulation_on;
use super::resume::SavedState;
use super::series::Series;
use super::simulation::Simulation;
use super::start::check_memory;
use crate::case::{Model, Recording, Scheme, TimeSettings, Unsteady};
use crate::state::InitialLevels;
use crate::step::StepError;
use crate::timing::cpu_seconds;

/// Time on the clock after which a first step stands for all others: it takes longer than they do
/// where bodies start suddenly, but who waits for it has waited long enough.
const PATIENCE: Duration = Duration::from_secs(10);

/// What something took.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Effort {
    /// CPU time of all threads (s).
    pub cpu: f64,
    /// Time on the clock (s).
    pub wall: f64,
    /// Linear systems solved.
    pub systems: usize,
}

/// What one step took, and what it left.
#[derive(Debug)]
pub struct TimedStep<const D: usize> {
    /// Free unknowns.
    pub unknowns: usize,
    /// What comes before the first step: the system is built, and the flow at the start solved for.
    /// Of a steady solution it is that without convection.
    pub start: Effort,
    /// A step of the size `step`, or why none was made; none of a steady solution.
    pub step: Option<Result<Effort, StepError>>,
    /// Such steps of a run of fixed steps: the pieces that its first step and those behind jumps of rates are made in count each.
    pub pieces: Option<usize>,
    /// Where it led to.
    pub mesh: Mesh<D>,
    /// Velocity at the P2 nodes (m/s).
    pub velocity: Vec<Point<D>>,
    /// Pressure at the vertices (Pa).
    pub pressure: Vec<f64>,
    /// All of it, as a run writes it; none of a steady solution.
    pub saved: Option<SavedState<D>>,
}

/// Makes one step of a run on its mesh, without replacing it.
///
/// # Errors
/// When the mesh does not fit into memory, the flow at the start is not found, or an expression of the case
/// has no finite value.
pub(super) fn time_step<const D: usize>(
    model: &Model,
    mesh: Mesh<D>,
) -> Result<TimedStep<D>, RunError>
where
    Dimension<D>: CaseMesh<D>,
{
    check_memory(&mesh)?;
    let begun = Begun::now();
    let mut simulation = simulation_on(model, mesh)?;
    simulation.scalars = Scalars::of(model, &simulation.problem, &simulation.state.mesh)?;
    let systems = match &model.case.time {
        TimeSettings::Steady(settings) => {
            let equations = simulation.steady_equations();
            let flow = simulation.solve_at_start(settings, &equations, false);
            let flow = flow.map_err(|error| simulation.by_key(&model.case, error))?;
            simulation.state.begin(InitialLevels::steady(flow.solution));
            let scalars = simulation.solve_steady_scalars();
            scalars.map_err(|error| simulation.by_key(&model.case, error))?;
            flow.iterations
        }
        TimeSettings::Unsteady(settings) => {
            let begun = simulation.begin(settings);
            let begun = begun.map_err(|error| simulation.by_key(&model.case, error))?;
            simulation.begin_scalars();
            begun.iterations
        }
    };
    let start = begun.effort(systems);
    let (step, saved) = match &model.case.time {
        TimeSettings::Steady(_) => (None, None),
        TimeSettings::Unsteady(settings) => {
            let step = match one_of_many(&mut simulation, settings) {
                // No shorter step makes such an expression finite
                Err(StepError::Flow(error)) => match simulation.by_key(&model.case, error.into()) {
                    RunError::Flow(error) => Err(StepError::Flow(error)),
                    found => return Err(found),
                },
                step => step,
            };
            let (made, whole) = (simulation.state.time, settings.step.min(settings.end));
            // Of a step that takes long only the half was made
            if step.is_ok() && made < whole {
                simulation.check_later(&model.case, [made, whole])?;
            }
            let none = (&Series::default(), &Recording::default());
            (Some(step), Some(SavedState::of(&model.case, &simulation, none.0, none.1)?))
        }
    };
    let pieces = pieces(&simulation, &model.case.time);
    let Simulation { state, work, .. } = simulation;
    let (velocity, pressure) = (state.now.velocity.clone(), state.now.pressure.clone());
    let unknowns = work.system.n_unknowns;
    let mesh = state.mesh.clone();
    Ok(TimedStep { unknowns, start, step, pieces, mesh, velocity, pressure, saved })
}

/// The pieces of all fixed steps.
fn pieces<const D: usize>(simulation: &Simulation<D>, time: &TimeSettings) -> Option<usize> {
    let TimeSettings::Unsteady(settings) = time else { return None };
    let jumps = simulation.problem.rate_discontinuities.as_ref();
    let jumps = jumps.map_or_else(Vec::new, |jumps| jumps(0.0, settings.end));
    settings.adaptive.is_none().then(|| n_pieces(settings, &jumps))
}

/// Makes a step as those in the midst of a run are: of second order, if it is, after one of half
/// its size.
fn one_of_many<const D: usize>(
    simulation: &mut Simulation<D>,
    settings: &Unsteady,
) -> Result<Effort, StepError> {
    let size = settings.step.min(settings.end);
    let mut timed = |size: f64| {
        let begun = Begun::now();
        simulation.step_on_this_mesh(size).map(|report| begun.effort(report.iterations))
    };
    if settings.scheme == Scheme::Rk3 {
        return timed(size);
    }
    let first = timed(0.5 * size)?;
    if first.wall > PATIENCE.as_secs_f64() { Ok(first) } else { timed(size) }
}

/// When something began.
struct Begun {
    cpu: f64,
    wall: Instant,
}

impl Begun {
    fn now() -> Self {
        Self { cpu: cpu_seconds(), wall: Instant::now() }
    }

    /// What it has taken.
    fn effort(&self, systems: usize) -> Effort {
        let cpu = cpu_seconds() - self.cpu;
        Effort { cpu, wall: self.wall.elapsed().as_secs_f64(), systems }
    }
}
