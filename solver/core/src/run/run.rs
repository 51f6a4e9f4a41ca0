//! The run: build, solve or step in time, measure, notify the observers.

use std::sync::Arc;

use super::measure::Measure;
use super::reports::{CycleReport, LoadErrors, StepErrorReport};
use super::resume::{ResumeError, SavedState};
use super::simulation::{CellCrossing, Simulation};
use super::snapshot::{LastState, Observer, Snapshot};
use super::watch::{ForceAgreement, Pace, SoundState};
use super::{RunError, Series};
use crate::case::{Case, Model, Recording, Steady, TimeSettings, Unsteady};
use crate::coupling::SurfaceLoads;
use crate::state::InitialLevels;
use crate::step::FlowError;
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

/// A run under way.
pub(super) struct Run<'a, const D: usize> {
    /// What is run, with commands of its own.
    pub model: Arc<Model>,
    /// All who look on.
    pub observers: Vec<Box<dyn Observer<D> + 'a>>,
    /// All quantities of all steps so far.
    pub series: Series,
    /// What was asked for so far, and where it paused.
    pub recording: Recording,
    /// Whether it has come to its end.
    pub is_over: bool,
    pub simulation: Simulation<D>,
    /// What is measured.
    pub measure: Measure<D>,
    /// How fast its flow is.
    pub pace: Pace,
    /// Errors of the forces on bodies.
    pub load_errors: LoadErrors,
    /// How well two evaluations of the forces on bodies agree.
    pub forces: Vec<ForceAgreement>,
    /// The last state kept in which the flow was sound.
    pub sound: Option<SoundState<D>>,
    /// What it has warned of.
    pub warned: Warned,
    /// First cycles that ended.
    pub cycles: Vec<CycleReport>,
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
    /// A rod that is near itself.
    pub meets_itself: bool,
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
    /// All that evolves, as it is written.
    pub(super) fn saved(&self) -> Result<SavedState<D>, ResumeError> {
        let Self { simulation, series, recording, .. } = self;
        SavedState::of(self.case(), simulation, series, recording)
    }

    /// What is run.
    pub(super) fn case(&self) -> &Case {
        &self.model.case
    }

    /// What the steps so far leave; none of a steady solution.
    pub(super) fn step_errors(&self) -> Option<StepErrorReport> {
        let TimeSettings::Unsteady(_) = &self.model.case.time else { return None };
        let errors = &self.simulation.state.step_errors;
        let rounding = self.simulation.rounding_of_motion();
        Some(StepErrorReport {
            velocity: errors.of_flow(rounding.flow),
            ways: errors.of_ways(rounding.way),
            loads: self.load_errors.largest(&rounding.loads),
        })
    }

    /// Warns of steps and cells that are too large for what was found.
    pub(super) fn warn_at_end(&self) {
        if let (TimeSettings::Unsteady(settings), Some(errors)) =
            (&self.model.case.time, self.step_errors())
            && settings.adaptive.is_none()
        {
            errors.log(settings, self.simulation.longest_step_of_vortices());
        }
        self.warn_of_resolution();
    }

    /// Tells the observers why the run ends, with what can be saved of it.
    pub(super) fn notify_of_failure(&mut self, error: &RunError) {
        let Simulation { state, .. } = &self.simulation;
        let saved = match self.model.case.time {
            TimeSettings::Steady(_) => None,
            // Before the flow at the start is known there is nothing to resume from
            TimeSettings::Unsteady(_) if self.series.times.is_empty() => None,
            // No step leads on from a flow that is wrong
            TimeSettings::Unsteady(_) if matches!(error, RunError::BlownUp { .. }) => {
                self.sound.take().map(|sound| sound.saved(&self.series))
            }
            TimeSettings::Unsteady(_) => {
                self.saved().inspect_err(|error| tracing::error!(%error, "no state is left")).ok()
            }
        };
        let last = LastState {
            saved: saved.as_ref(),
            time: state.time,
            mesh: &state.mesh,
            velocity: &state.now.velocity,
            pressure: &state.now.pressure,
            scalars: &state.scalars,
        };
        notify_all(&mut self.observers, error, Some(&last));
    }
}

/// Tells all observers why a run ends; where one cannot write of it, the first error stays the one
/// that is returned.
pub(super) fn notify_all<'a, const D: usize>(
    observers: &mut [Box<dyn Observer<D> + 'a>],
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
    pub(super) fn steady(&mut self, settings: &Steady) -> Result<(), RunError> {
        let simulation = &mut self.simulation;
        let has_convection = simulation.problem.has_convection;
        let equations = simulation.steady_equations();
        let flow = simulation.solve_at_start(settings, &equations, has_convection)?;
        simulation.state.begin(InitialLevels::steady(flow.solution));
        let loads = simulation.loads(&flow.residual);
        simulation.solve_steady_scalars()?;
        let iterations = flow.iterations;
        let summary = StepSummary { iterations, is_last: true, ..StepSummary::default() };
        self.report(&loads, summary)
    }

    /// The flow an unsteady run starts from.
    pub(super) fn begin(&mut self, settings: &Unsteady) -> Result<(), RunError> {
        let start = self.simulation.begin(settings)?;
        self.simulation.begin_tracers();
        self.simulation.begin_scalars();
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
        if matches!(&self.model.case.time, TimeSettings::Unsteady(time) if time.adaptive.is_none())
        {
            ended.iter().for_each(|cycle| cycle.log(self.simulation.scheme.method));
        }
        self.cycles.extend(ended);
        let step_errors = self.step_errors();
        let Self { model, observers, series, simulation, measure, .. } = self;
        let case = &model.case;
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
            tracers: &state.tracers,
            scalars: &state.scalars,
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
        self.is_over = summary.is_last;
        self.load_errors.add(&self.series);
        self.compare_forces(&measured.bodies);
        self.check_soundness(&measured.flow)?;
        self.check_bodies_that_bend()?;
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
        let mut timing = self.simulation.work.timing;
        let shown = timing.measure(Stage::Output, || -> Result<(), RunError> {
            let state = Arc::new(self.saved()?);
            Ok(self.observers.iter_mut().try_for_each(|observer| observer.on_state(&state))?)
        });
        self.simulation.work.timing = timing;
        shown
    }
}
