//! `Simulation`: problem, state and workspace; a step of a given size, on a new mesh where needed.

mod new_mesh;

use alewife_interrupt::Stopped;
use alewife_mesh::{CellId, NodeId};
use rayon::prelude::*;

use crate::case::{Convection, Scheme};
use crate::contact::{ContactError, Law};
use crate::coupling::{
    BodiesAt, BodyLoads, BodyShapes, FluidSystem, MeshedBodies, Problem, ResidualAt, RestPlaces,
    SolverChoice, SurfaceLoads,
};
use crate::motion::MovingMesh;
use crate::run::build::{Scalars, Tracers};
use crate::run::error::RunError;
use crate::run::step_control::StepControl;
use crate::run::watch::CellBound;
use crate::scalar::Level;
use crate::state::{NewLevel, State};
use crate::step::{
    FlowError, MeshPath, StepError, StepReport, StepResult, StopRequest, TimeStepper, Workspace,
};
use crate::time::Bdf;
use crate::timing::{Stage, Timing};

/// Error over the tolerance above which a step is rejected.
const REJECTED: f64 = 2.0;

/// What is solved, where it is, and what it is solved with.
pub struct Simulation<const D: usize> {
    /// What never changes during a run.
    pub problem: Problem<D>,
    /// What evolves.
    pub state: State<D>,
    /// What is still to be made of the present step, and the size of the next.
    pub control: StepControl,
    /// What steps work with.
    pub work: Workspace<D>,
    /// Moves the mesh, where bodies move in it.
    pub moving_mesh: Option<MovingMesh<D>>,
    /// The law of contact, if any.
    pub law: Option<Law>,
    /// How steps are made.
    pub scheme: StepScheme,
    /// What new meshes are measured by.
    pub cell_bound: CellBound,
    /// Whether no step has been made on this mesh.
    pub is_fresh: bool,
    /// What the flow carries, if anything.
    pub tracers: Option<Tracers<D>>,
    /// What it carries and what diffuses, if anything.
    pub scalars: Option<Scalars<D>>,
    /// What to ask whether the run is to end.
    pub stop: Option<StopRequest>,
}

/// How steps are made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepScheme {
    /// The method in time.
    pub method: Scheme,
    /// How convection is taken.
    pub convection: Convection,
    /// Whether the frame's velocity is an unknown of the convection.
    pub unknown_frame: bool,
}

/// How fast the fluid crosses the cells, seen from the mesh.
#[derive(Debug, Clone, Copy, Default)]
pub struct CellCrossing {
    /// Largest velocity over the shortest edge of a cell (1/s).
    pub rate: f64,
    /// Largest velocity times the longest edge of a cell (m2/s).
    pub reach: f64,
}

/// What came of an attempt to make a step.
pub enum Attempt {
    /// The state has moved on.
    Made(StepReport),
    /// Time has not advanced, though the mesh may have been replaced; a shorter step may help.
    Rejected(StepError),
}

/// The linear system of a state on its mesh, with what moves that; `look` is called between its parts.
///
/// # Errors
/// When coordinates of a body give it no shape, and those of `look`.
pub(in crate::run) fn fluid_system<const D: usize>(
    problem: &Problem<D>,
    state: &State<D>,
    moving: Option<&MovingMesh<D>>,
    unknown_frame: bool,
    look: impl Fn() -> Result<(), Stopped>,
) -> Result<FluidSystem<D>, RunError> {
    let poses = &state.in_mesh(&state.poses);
    let choice = SolverChoice::default();
    let Some(moving) = moving.filter(|_| problem.n_coordinates() > 0) else {
        // Which unknowns are constrained does not depend on how bodies deform
        let shapes = &BodyShapes::rigid(problem.bodies.len());
        let bodies =
            MeshedBodies { at: BodiesAt { poses, shapes }, rest_places: RestPlaces::new() };
        let mesh = &state.mesh;
        return Ok(FluidSystem::with_bodies(problem, mesh, bodies, unknown_frame, choice, look)?);
    };
    let shapes = &BodyShapes::with(&problem.bodies, state.time, &state.shapes.now)?;
    let rest_places = moving.rest_places(shapes);
    let bodies = MeshedBodies { at: BodiesAt { poses, shapes }, rest_places };
    Ok(FluidSystem::with_bodies(problem, &state.mesh, bodies, unknown_frame, choice, look)?)
}

/// What makes the steps of a simulation.
pub(in crate::run) fn stepper<'a, const D: usize>(
    problem: &'a Problem<D>,
    scheme: StepScheme,
    moving: Option<&'a MovingMesh<D>>,
    contact: Option<&'a Law>,
    stop: Option<&'a StopRequest>,
) -> TimeStepper<'a, D> {
    let path = moving.map_or(MeshPath::Fixed, MeshPath::FollowsBodies);
    TimeStepper { problem, convection: scheme.convection, path, contact, stop }
}

/// Scalars after a step, and the differences it was made by.
struct Carried {
    levels: Vec<Level>,
    bdf: Bdf,
}

/// The scalars at a level: they follow the flow that was found, which does not know of them.
fn carry<const D: usize>(
    scalars: &mut Scalars<D>,
    problem: &Problem<D>,
    state: &State<D>,
    level: &NewLevel<D>,
    timing: &mut Timing,
) -> Result<Carried, StepError> {
    let bdf = Bdf::after(level.step, state.last_step);
    let levels = timing.measure(Stage::Solve, || scalars.advance(problem, state, level, &bdf));
    let levels =
        levels.map_err(|error| FlowError::from_solve(error.into(), state.step + 1, level.time))?;
    Ok(Carried { levels, bdf })
}

impl<const D: usize> Simulation<D> {
    /// Time spent so far.
    #[must_use]
    pub fn timing(&self) -> &Timing {
        &self.work.timing
    }

    /// Tries a step of a size (s) whose error is within a tolerance, if need be on a new mesh.
    ///
    /// # Errors
    /// What no shorter step would help against.
    pub fn try_step(&mut self, size: f64, tolerance: f64) -> Result<Attempt, RunError> {
        // Not after the step before: what was measured belongs to its mesh
        if !self.is_fresh {
            self.remesh_where_needed(tolerance)?;
        }
        loop {
            let (step, time) = (self.state.step + 1, self.state.time + size);
            match self.attempt(size, tolerance) {
                Ok(report) => return Ok(Attempt::Made(report)),
                Err(StepError::Flow(error))
                    if !matches!(error, FlowError::NewtonStalled { .. }) =>
                {
                    return Err(error.into());
                }
                Err(StepError::Contact(reason @ ContactError::TooWeak { .. })) => {
                    return Err(RunError::Contact { step, time, reason: Box::new(reason) });
                }
                Err(error @ StepError::DegenerateCell { .. }) if !self.is_fresh => {
                    self.remesh(&error.to_string(), tolerance)?;
                }
                Err(error) => {
                    tracing::info!(step, time, size, %error, "step rejected");
                    return Ok(Attempt::Rejected(error));
                }
            }
        }
    }

    /// Makes a step of a size (s) on the present mesh, or leaves the state where it is.
    ///
    /// # Errors
    /// Why no step was made.
    pub fn step_on_this_mesh(&mut self, size: f64) -> Result<StepReport, StepError> {
        self.attempt(size, f64::INFINITY)
    }

    /// Makes a step, or leaves the state where it is.
    fn attempt(&mut self, size: f64, tolerance: f64) -> Result<StepReport, StepError> {
        let Self { problem, state, work, moving_mesh, law, scheme, stop, .. } = self;
        let stepper = stepper(problem, *scheme, moving_mesh.as_ref(), law.as_ref(), stop.as_ref());
        let before = if scheme.method == Scheme::Bdf2 { state.last_step } else { 0.0 };
        let bdf = Bdf::after(size, before);
        let StepResult { level, report } = match scheme.method {
            Scheme::Rk3 => {
                // The first flow of a run knows nothing of contact
                let is_known = state.time == 0.0 && law.is_none();
                let rates_jump = state.last_step == 0.0 && !is_known;
                stepper.advance_explicitly(work, state, size, rates_jump)?
            }
            Scheme::Bdf2 | Scheme::Bdf1 => stepper.advance(work, state, bdf)?,
        };
        let (error, contact_error) = (report.error, report.contact_error);
        if error > REJECTED * tolerance {
            return Err(StepError::LocalErrorTooLarge { error, tolerance });
        }
        if contact_error > REJECTED {
            return Err(StepError::ContactNotResolved { excess: contact_error });
        }
        let jumps = state.last_step == 0.0;
        let carried = match &mut self.scalars {
            Some(scalars) => Some(carry(scalars, problem, state, &level, &mut work.timing)?),
            None => None,
        };
        state.accept(problem, level);
        if let Some(Carried { levels, bdf }) = carried {
            state.accept_scalars(levels, Some(&bdf));
        }
        if let Some(tracers) = &self.tracers {
            let moving = moving_mesh.as_ref();
            work.timing.measure(Stage::Loads, || tracers.carry(problem, state, moving, jumps));
        }
        state.record_step_errors(&report.errors);
        // As a run has it that resumes from this state
        work.system.fit_to_poses(problem, &work.mesh, &state.in_mesh(&state.poses));
        work.system.mark_solver();
        self.is_fresh = false;
        self.record_drives(&report.loads)?;
        self.record_forces(&report.loads, &bdf);
        Ok(report)
    }

    /// Releases the tracers that are there at the start.
    pub(in crate::run) fn begin_tracers(&mut self) {
        if let Some(tracers) = &self.tracers {
            self.state.carry_tracers(|state, clouds| tracers.begin(state, clouds));
        }
    }

    /// Gives scalars their values at the start.
    pub(in crate::run) fn begin_scalars(&mut self) {
        if let Some(scalars) = &self.scalars {
            let fields = scalars.at_start(&self.state);
            self.state.begin_scalars(fields);
        }
    }

    /// Finds the scalars that a steady flow leads to.
    ///
    /// # Errors
    /// When nothing determines them.
    pub(in crate::run) fn solve_steady_scalars(&mut self) -> Result<(), RunError> {
        self.begin_scalars();
        let Self { problem, state, work, scalars: Some(scalars), .. } = self else {
            return Ok(());
        };
        let solved = work.timing.measure(Stage::Solve, || scalars.steady(problem, state));
        let levels = solved.map_err(|error| FlowError::from_solve(error.into(), 0, 0.0))?;
        state.accept_scalars(levels, None);
        Ok(())
    }

    /// Whether rates of gaits jump within `near` (s) of the present.
    #[must_use]
    pub fn is_at_discontinuity(&self, near: f64) -> bool {
        let time = self.state.time;
        let times = self.problem.rate_discontinuities.as_ref();
        times.is_some_and(|times| !times(time - near, time + near).is_empty())
    }

    /// Loads of the fluid by the raw residual at the present solution.
    #[must_use]
    pub fn loads(&self, residual: &[f64]) -> SurfaceLoads {
        let Self { problem, state, work, .. } = self;
        let poses = state.in_mesh(&state.poses);
        let at = ResidualAt { solution: &state.now, residual, time: state.time };
        work.system.surface_loads(problem, &state.mesh, &poses, at)
    }

    /// How fast the fluid crosses the cells.
    #[must_use]
    pub fn cell_crossing(&self) -> CellCrossing {
        let state = &self.state;
        let frame = state.origin_at(&self.problem, &state.poses)
            - state.origin_at(&self.problem, &state.previous_poses);
        let frame = crate::body::on_mesh::<D>(&frame);
        let of_cell = |cell: usize| {
            let cell = CellId::new(cell);
            let length = |edge: alewife_mesh::Edge<'_>| {
                let [from, to] = edge.ends;
                (state.nodes[to] - state.nodes[from]).norm()
            };
            let (mut shortest, mut longest) = (f64::INFINITY, 0.0f64);
            for length in state.mesh.cell_edges(cell).map(length) {
                (shortest, longest) = (shortest.min(length), longest.max(length));
            }
            let passing = |&node: &NodeId| {
                let mut passing = state.now.velocity[node];
                if state.last_step > 0.0 {
                    let way = state.nodes[node] - state.nodes_before[node] + frame;
                    passing -= way / state.last_step;
                }
                passing.norm()
            };
            let fastest = state.mesh.cell(cell).iter().map(passing).fold(0.0, f64::max);
            CellCrossing { rate: fastest / shortest, reach: fastest * longest }
        };
        let least = CellCrossing { rate: f64::MIN_POSITIVE, reach: 0.0 };
        let larger = |one: CellCrossing, other: CellCrossing| CellCrossing {
            rate: one.rate.max(other.rate),
            reach: one.reach.max(other.reach),
        };
        let cells = (0..state.mesh.n_cells()).into_par_iter().with_min_len(1024);
        cells.map(of_cell).reduce(|| least, larger)
    }

    /// Largest extent of the domain along a coordinate (m).
    #[must_use]
    pub fn extent(&self) -> f64 {
        let along = |axis: usize| {
            let start = [f64::INFINITY, f64::NEG_INFINITY];
            let [least, most] =
                self.state.nodes.iter().fold(start, |[least, most], node| {
                    [least.min(node[axis]), most.max(node[axis])]
                });
            most - least
        };
        (0..D).map(along).fold(0.0, f64::max)
    }

    /// Records where swimmers are, and at the start what they do.
    pub fn record_propulsion(&mut self, loads: &[BodyLoads]) {
        let Self { problem, state, work, .. } = self;
        if problem.groups.is_empty() {
            return;
        }
        if state.last_step == 0.0 {
            let stress = work.system.surface_stress(problem, &state.mesh, &state.now);
            let twists = &state.now.twists;
            let powers = state.propulsion_powers(problem, &state.poses, twists, loads, &stress);
            state.start_propulsion(&powers);
        }
        state.record_cycles(problem);
    }
}
