//! The run: build, solve or step in time, measure, notify the observers.

use std::sync::Arc;

use alewife_mesh::interrupt::{self, Heard};

use super::case_mesh::{CaseMesh, Dimension};
use super::measure::Measure;
use super::prepare::{Prepared, prepare};
use super::reports::{CycleReport, LoadErrors, StepErrorReport};
use super::resume::SavedState;
use super::simulation::{CellCrossing, Simulation};
use super::snapshot::{LastState, Observer, Snapshot};
use super::watch::{ForceAgreement, Pace, SoundState};
use super::{RunError, Series};
use crate::case::{Case, Model, Steady, TimeSettings, Unsteady};
use crate::coupling::SurfaceLoads;
use crate::state::InitialLevels;
use crate::step::{FlowError, StopRequest};
use crate::timing::{Stage, Timing};

/// What a finished run leaves in memory.
#[derive(Debug, Clone)]
pub struct RunSummary {
    /// All quantities at all steps.
    pub series: Series,
    /// Time spent.
    pub timing: Timing,
    /// Free unknowns of the linear system.
    pub n_dofs: usize,
    /// Steps made.
    pub steps: usize,
    /// First cycles of swimmers without inertia that ended in this run.
    pub cycles: Vec<CycleReport>,
    /// What its steps leave; none of a steady solution.
    pub step_errors: Option<StepErrorReport>,
}

/// Runs a case to its end, from a saved state if there is one.
///
/// # Errors
/// Whatever stops the run; observers are notified before it is returned.
pub(super) fn run_case<const D: usize>(
    model: &Model,
    saved: Option<&SavedState<D>>,
    observers: &mut [Box<dyn Observer<D>>],
) -> Result<RunSummary, RunError>
where
    Dimension<D>: CaseMesh<D>,
{
    let requests: Vec<StopRequest> =
        observers.iter().filter_map(|observer| observer.stop_request()).collect();
    let stop: StopRequest = Arc::new(move || requests.iter().any(|request| request()));
    let (step, time) = saved.map_or((0, 0.0), |saved| (saved.step(), saved.time()));
    let prepared = interrupt::hearing(Arc::clone(&stop), || prepare(model, saved));
    let Prepared { mut simulation, measure } = match meshed(prepared, step, time) {
        Ok(prepared) => prepared,
        Err(error) => {
            notify_all(observers, &error, None);
            return Err(error);
        }
    };
    let mut series = Series { names: measure.names().to_vec(), ..Series::default() };
    if let Some(saved) = saved {
        let earlier = saved.series();
        if earlier.names == series.names {
            series = earlier;
        } else {
            tracing::warn!("other quantities than before: statistics begin where the run resumes");
        }
    }
    simulation.stop = Some(Arc::clone(&stop));
    let case = &model.case;
    let mut load_errors = LoadErrors::new(&simulation, &series.names);
    load_errors.resume(&series);
    let mut run = Run {
        case,
        observers,
        series,
        simulation,
        measure,
        warned: Warned::default(),
        pace: Pace::default(),
        sound: None,
        load_errors,
        forces: Vec::new(),
        cycles: Vec::new(),
    };
    let made = interrupt::hearing(Arc::clone(&stop), || run.make(saved.is_some()));
    let result = meshed(made, run.simulation.state.step, run.simulation.state.time);
    if let Err(error) = &result {
        run.notify_of_failure(error);
    }
    let steps = result?;
    run.warn_at_end();
    let timing = *run.simulation.timing();
    if let Err(error) = run.observers.iter_mut().try_for_each(|observer| observer.on_end(&timing)) {
        let error = RunError::from(error);
        run.notify_of_failure(&error);
        return Err(error);
    }
    let step_errors = run.step_errors();
    let Run { simulation: Simulation { work, .. }, series, cycles, .. } = run;
    let n_dofs = work.system.n_unknowns;
    Ok(RunSummary { series, timing: work.timing, n_dofs, steps, cycles, step_errors })
}

/// What work came to in which meshing hears a request to stop; where it was ended, the run is stopped at a step and
/// its time (s).
fn meshed<R>(heard: Heard<Result<R, RunError>>, step: usize, time: f64) -> Result<R, RunError> {
    match heard.result {
        Err(_) if heard.was_ended => Err(FlowError::Stopped { step, time }.into()),
        result => result,
    }
}

/// A run under way.
pub(super) struct Run<'a, const D: usize> {
    case: &'a Case,
    observers: &'a mut [Box<dyn Observer<D>>],
    series: Series,
    pub simulation: Simulation<D>,
    measure: Measure<D>,
    /// How fast its flow is.
    pub pace: Pace,
    /// Errors of the forces on bodies.
    load_errors: LoadErrors,
    /// How well two evaluations of the forces on bodies agree.
    pub forces: Vec<ForceAgreement>,
    /// The last state kept in which the flow was sound.
    pub sound: Option<SoundState<D>>,
    /// What it has warned of.
    pub warned: Warned,
    /// First cycles that ended.
    cycles: Vec<CycleReport>,
}

/// How near bodies have come without contact.
#[derive(Debug, Clone, Default)]
pub(super) struct Nearness {
    /// Largest minimum gap so far (m).
    pub largest_gap: f64,
    /// Number of meshes when they came near, while they are.
    pub since_mesh: Option<usize>,
    /// Whether contact was proposed.
    pub is_told: bool,
}

/// What a run has warned of; each is told once.
#[derive(Debug, Clone, Default)]
pub(super) struct Warned {
    /// Steps too long for extrapolated convection.
    pub of_cfl: bool,
    /// A gap far below the range of contact.
    pub of_gap: bool,
    /// Bodies that stay near each other without contact.
    pub nearness: Nearness,
    /// Bodies that leave through an open side.
    pub left: Vec<usize>,
}

impl Warned {
    /// Whether it was told that a body leaves.
    pub fn has_left(&self, body: usize) -> bool {
        self.left.contains(&body)
    }
}

/// What is reported of a step besides loads.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct StepSummary {
    /// Linear systems solved.
    pub iterations: usize,
    /// Size of the step (s).
    pub time_step: f64,
    /// Whether the run ends with it.
    pub is_last: bool,
    /// How fast the fluid crosses the cells, where that is known already.
    pub crossing: Option<CellCrossing>,
}

impl<const D: usize> Run<'_, D> {
    /// What is run.
    pub(super) fn case(&self) -> &Case {
        self.case
    }

    /// Makes the run; the number of its steps.
    fn make(&mut self, is_resumed: bool) -> Result<usize, RunError> {
        let case = self.case;
        match &case.time {
            TimeSettings::Steady(settings) => self.steady(settings),
            TimeSettings::Unsteady(settings) => {
                if !is_resumed {
                    self.begin(settings)?;
                }
                match &settings.adaptive {
                    None => self.fixed_steps(settings),
                    Some(adaptive) => self.adaptive_steps(settings, adaptive),
                }
            }
        }
    }

    /// What the steps so far leave; none of a steady solution.
    fn step_errors(&self) -> Option<StepErrorReport> {
        let TimeSettings::Unsteady(_) = &self.case.time else { return None };
        let errors = &self.simulation.state.step_errors;
        Some(StepErrorReport {
            velocity: errors.of_flow(),
            ways: errors.of_ways(),
            loads: self.load_errors.largest(),
        })
    }

    /// Warns of steps and cells that are too large for what was found.
    fn warn_at_end(&self) {
        if let (TimeSettings::Unsteady(settings), Some(errors)) =
            (&self.case.time, self.step_errors())
            && settings.adaptive.is_none()
        {
            errors.log(settings, self.simulation.longest_step_of_vortices());
        }
        self.warn_of_resolution();
    }

    /// Tells the observers why the run ends, with what can be saved of it.
    fn notify_of_failure(&mut self, error: &RunError) {
        let Simulation { state, .. } = &self.simulation;
        let saved = match self.case.time {
            TimeSettings::Steady(_) => None,
            // Before the flow at the start is known there is nothing to resume from
            TimeSettings::Unsteady(_) if self.series.times.is_empty() => None,
            // No step leads on from a flow that is wrong
            TimeSettings::Unsteady(_) if matches!(error, RunError::BlownUp { .. }) => {
                self.sound.take().map(|sound| sound.saved(&self.series))
            }
            TimeSettings::Unsteady(_) => {
                let saved = SavedState::of(self.case, &self.simulation, &self.series);
                saved.inspect_err(|error| tracing::error!(%error, "no state is left")).ok()
            }
        };
        let last = LastState {
            saved: saved.as_ref(),
            time: state.time,
            mesh: &state.mesh,
            velocity: &state.now.velocity,
            pressure: &state.now.pressure,
        };
        notify_all(self.observers, error, Some(&last));
    }
}

/// Tells all observers why a run ends; where one cannot write of it, the first error stays the one
/// that is returned.
fn notify_all<const D: usize>(
    observers: &mut [Box<dyn Observer<D>>],
    error: &RunError,
    last: Option<&LastState<'_, D>>,
) {
    for observer in observers.iter_mut() {
        if let Err(error) = observer.on_failure(error, last) {
            tracing::error!(%error, "while the run was ended");
        }
    }
}

impl<const D: usize> Run<'_, D> {
    fn steady(&mut self, settings: &Steady) -> Result<usize, RunError> {
        let simulation = &mut self.simulation;
        let has_convection = simulation.problem.has_convection;
        let equations = simulation.steady_equations();
        let flow = simulation.solve_at_start(settings, &equations, has_convection)?;
        simulation.state.begin(InitialLevels::steady(flow.solution));
        let loads = simulation.loads(&flow.residual);
        let iterations = flow.iterations;
        let summary = StepSummary { iterations, is_last: true, ..StepSummary::default() };
        self.report(&loads, summary)?;
        Ok(0)
    }

    /// The flow an unsteady run starts from.
    fn begin(&mut self, settings: &Unsteady) -> Result<(), RunError> {
        let start = self.simulation.begin(settings)?;
        self.report(&start.loads, StepSummary::default())
    }

    /// Ends the run where an observer asks for it.
    pub(super) fn check_signals(&self, is_last: bool) -> Result<(), RunError> {
        let Simulation { state, stop, .. } = &self.simulation;
        if !is_last && stop.as_ref().is_some_and(|stop| stop()) {
            return Err(FlowError::Stopped { step: state.step, time: state.time }.into());
        }
        Ok(())
    }

    /// Measures the present state and shows it to the observers.
    pub(super) fn report(
        &mut self,
        loads: &SurfaceLoads,
        summary: StepSummary,
    ) -> Result<(), RunError> {
        self.simulation.record_propulsion(&loads.bodies);
        self.simulation.work.system.mark_solver();
        let ended = self.simulation.first_cycles_that_end();
        if matches!(&self.case.time, TimeSettings::Unsteady(time) if time.adaptive.is_none()) {
            ended.iter().for_each(|cycle| cycle.log(self.simulation.scheme.method));
        }
        self.cycles.extend(ended);
        let step_errors = self.step_errors();
        let Self { case, observers, series, simulation, measure, .. } = self;
        let measured = measure.measure(case, simulation, loads, summary.crossing)?;
        let Simulation { state, work, .. } = simulation;
        series.times.push(state.time);
        let timing = work.timing;
        let snapshot = Snapshot {
            case,
            step: state.step,
            time: state.time,
            time_step: summary.time_step,
            mesh: &state.mesh,
            velocity: &state.now.velocity,
            pressure: &state.now.pressure,
            bodies: &measured.bodies,
            names: measure.names(),
            values: &measured.values,
            n_dofs: work.system.n_unknowns,
            iterations: summary.iterations,
            step_errors,
            timing: &timing,
            is_last: summary.is_last,
        };
        work.timing.measure(Stage::Output, || {
            observers.iter_mut().try_for_each(|observer| observer.on_step(&snapshot))
        })?;
        // Each is asked
        let wanted =
            observers.iter_mut().filter_map(|one| one.wants_state(&snapshot).then_some(()));
        let is_wanted = wanted.count() > 0;
        series.rows.push(measured.values);
        self.load_errors.add(&self.series);
        self.compare_forces(&measured.bodies);
        self.check_soundness(&measured.flow)?;
        self.keep_sound_state()?;
        self.propose_contact();
        if is_wanted { self.show_state() } else { Ok(()) }
    }

    /// Notes a piece of a step in which bodies may touch, which has no row.
    pub(super) fn note_piece(&mut self, loads: &SurfaceLoads) {
        let Self { simulation, measure, .. } = self;
        // The pieces of the first step are those of a start
        if simulation.law.is_some() && simulation.state.step > 0 {
            measure.balance_piece(simulation, loads);
        }
    }

    /// Gives the observers the whole state.
    fn show_state(&mut self) -> Result<(), RunError> {
        let Self { case, observers, series, simulation, .. } = self;
        let mut timing = simulation.work.timing;
        let shown = timing.measure(Stage::Output, || -> Result<(), RunError> {
            let state = Arc::new(SavedState::of(case, simulation, series)?);
            Ok(observers.iter_mut().try_for_each(|observer| observer.on_state(&state))?)
        });
        simulation.work.timing = timing;
        shown
    }
}
