//! `run_case`: a run is opened, makes its steps, with what was recorded if it repeats a session, and is closed.

use std::sync::Arc;

use alewife_interrupt::{Heard, hearing};

use super::case_mesh::{CaseMesh, Dimension};
use super::prepare::{Prepared, prepare};
use super::reports::LoadErrors;
use super::resume::{ResumeError, SavedState};
use super::run::{Run, RunSummary, Warned, notify_all};
use super::simulation::Simulation;
use super::snapshot::{Borrowed, Observer, Recorded};
use super::watch::Pace;
use super::{RunError, Series};
use crate::case::{Asked, Model, Recording, TimeSettings, Unsteady};
use crate::step::{FlowError, StopRequest};

/// Part of a step, or of a run with adaptive ones, within which two times are one.
const SAME_TIME: f64 = 1e-7;

/// What a run begins with.
#[derive(Debug, Clone, Copy, Default)]
pub struct Start<'a, const D: usize> {
    /// A state it resumes from, if there is one.
    pub saved: Option<&'a SavedState<D>>,
    /// What is asked for while it goes on, if it repeats a session.
    pub recording: Option<&'a Recording>,
}

/// Runs a case to its end.
///
/// # Errors
/// Whatever stops the run; observers are notified before it is returned.
pub(super) fn run_case<const D: usize>(
    model: &Model,
    start: Start<'_, D>,
    observers: &mut [Box<dyn Observer<D>>],
) -> Result<RunSummary, RunError>
where
    Dimension<D>: CaseMesh<D>,
{
    let borrowed = observers.iter_mut().map(|one| Borrowed(one.as_mut()));
    let mut observers: Vec<Box<dyn Observer<D> + '_>> = Vec::new();
    borrowed.for_each(|one| observers.push(Box::new(one)));
    if let Err(error) = check_commands(model, start.recording) {
        notify_all(&mut observers, &error, None);
        return Err(error);
    }
    let mut run = Run::open(model, start.saved, observers)?;
    let result = run.hearing(|run| run.make(start));
    if let Err(error) = &result {
        run.notify_of_failure(error);
    }
    result?;
    run.close()
}

/// Whether somebody gives all commands of a case, and only those.
fn check_commands(model: &Model, recording: Option<&Recording>) -> Result<(), RunError> {
    match recording {
        None if model.commands.is_empty() => Ok(()),
        None => Err(RunError::Waits { commands: model.commands.names() }),
        Some(recording) => {
            let mut asked = recording.asked.iter();
            Ok(asked.try_for_each(|asked| model.commands.get(&asked.command).map(drop))?)
        }
    }
}

/// What work came to that hears a request to stop; where it was ended, the run is stopped at a step and its time (s).
fn unless_stopped<R>(
    heard: Heard<Result<R, RunError>>,
    step: usize,
    time: f64,
) -> Result<R, RunError> {
    match heard.result {
        Err(_) if heard.was_ended => Err(FlowError::Stopped { step, time }.into()),
        result => result,
    }
}

impl<'a, const D: usize> Run<'a, D> {
    /// A run of a case, at its start or at a saved state, with commands of its own.
    ///
    /// # Errors
    /// When it cannot be set up; observers are notified before it is returned.
    pub(super) fn open(
        model: &Model,
        saved: Option<&SavedState<D>>,
        mut observers: Vec<Box<dyn Observer<D> + 'a>>,
    ) -> Result<Self, RunError>
    where
        Dimension<D>: CaseMesh<D>,
    {
        let requests: Vec<StopRequest> =
            observers.iter().filter_map(|observer| observer.stop_request()).collect();
        let stop: StopRequest = Arc::new(move || requests.iter().any(|request| request()));
        let (step, time) = saved.map_or((0, 0.0), |saved| (saved.step(), saved.time()));
        let model = Arc::new(model.disconnected());
        let recording = saved.map(|saved| saved.recording().clone()).unwrap_or_default();
        let prepared = hearing(Arc::clone(&stop), || {
            recording.asked.iter().try_for_each(|asked| model.commands.ask(asked))?;
            prepare(&model, saved)
        });
        let Prepared { mut simulation, measure } = match unless_stopped(prepared, step, time) {
            Ok(prepared) => prepared,
            Err(error) => {
                notify_all(&mut observers, &error, None);
                return Err(error);
            }
        };
        let mut series = Series { names: measure.names().to_vec(), ..Series::default() };
        if let Some(saved) = saved {
            let earlier = saved.series();
            if earlier.names == series.names {
                series = earlier;
            } else {
                tracing::warn!(
                    "other quantities than before: statistics begin where the run resumes"
                );
            }
        }
        simulation.stop = Some(stop);
        let mut load_errors = LoadErrors::new(&simulation, &series.names);
        load_errors.resume(&series);
        Ok(Self {
            model,
            observers,
            series,
            recording,
            is_over: false,
            simulation,
            measure,
            warned: Warned::default(),
            pace: Pace::default(),
            sound: None,
            load_errors,
            forces: Vec::new(),
            cycles: Vec::new(),
        })
    }

    /// Does work that hears a request to stop.
    pub(super) fn hearing<R>(
        &mut self,
        work: impl FnOnce(&mut Self) -> Result<R, RunError>,
    ) -> Result<R, RunError> {
        let stop = self.simulation.stop.clone().unwrap_or_else(|| Arc::new(|| false));
        let mut made = hearing(stop, || work(self));
        made.result = made.result.map_err(|error| self.simulation.by_key(self.case(), error));
        unless_stopped(made, self.simulation.state.step, self.simulation.state.time)
    }

    /// Makes the whole run.
    fn make(&mut self, start: Start<'_, D>) -> Result<(), RunError> {
        let model = Arc::clone(&self.model);
        match &model.case.time {
            TimeSettings::Steady(settings) => self.steady(settings),
            TimeSettings::Unsteady(settings) => {
                if start.saved.is_none() {
                    self.begin(settings)?;
                }
                if let Some(recording) = start.recording {
                    self.repeat(recording, settings)?;
                }
                self.advance(settings, f64::INFINITY)
            }
        }
    }

    /// Makes all steps up to a time (s).
    pub(super) fn advance(&mut self, settings: &Unsteady, until: f64) -> Result<(), RunError> {
        if self.is_over {
            return Ok(());
        }
        match &settings.adaptive {
            None => self.fixed_steps(settings, until),
            Some(adaptive) => self.adaptive_steps(settings, adaptive, until),
        }
    }

    /// Asks for a target of a command from now on.
    pub(super) fn ask(&mut self, command: &str, target: f64) -> Result<(), RunError> {
        let asked = Asked { time: self.simulation.state.time, command: command.to_owned(), target };
        self.model.commands.ask(&asked)?;
        self.tell(Recorded::Asked(&asked))?;
        self.recording.ask(asked);
        Ok(())
    }

    /// Notes that it pauses.
    pub(super) fn pause(&mut self) -> Result<(), RunError> {
        let time = self.simulation.state.time;
        self.recording.pause_at(time);
        self.tell(Recorded::Pause(time))
    }

    /// Tells the observers what is recorded.
    pub(super) fn tell(&mut self, recorded: Recorded<'_>) -> Result<(), RunError> {
        Ok(self.observers.iter_mut().try_for_each(|observer| observer.on_recorded(recorded))?)
    }

    /// Asks for what was recorded, at the times at which it was.
    fn repeat(&mut self, recording: &Recording, settings: &Unsteady) -> Result<(), RunError> {
        let earlier = self.recording.clone();
        self.tell(Recorded::Before(&earlier))?;
        let near = SAME_TIME * settings.step;
        let now = self.simulation.state.time - near;
        let is_before = |asked: &&Asked| asked.time < now;
        let [made, wanted] =
            [&earlier, recording].map(|one| one.asked.iter().filter(is_before).collect::<Vec<_>>());
        let is_same = |(made, wanted): (&&Asked, &&Asked)| {
            made.command == wanted.command
                && made.target == wanted.target
                && (made.time - wanted.time).abs() <= near
        };
        if made.len() != wanted.len() || !made.iter().zip(&wanted).all(is_same) {
            return Err(ResumeError::OtherCommands { time: self.simulation.state.time }.into());
        }
        let mut to_ask = recording.asked[wanted.len()..].iter().peekable();
        for pause in recording.pauses.iter().filter(|pause| **pause >= now) {
            let had_begun = self.simulation.state.time;
            self.advance(settings, *pause)?;
            if self.is_over {
                break;
            }
            if self.simulation.state.time > had_begun {
                self.pause()?;
            }
            while let Some(asked) = to_ask.next_if(|asked| asked.time <= *pause) {
                self.ask(&asked.command, asked.target)?;
            }
        }
        Ok(())
    }

    /// Ends a run that has come to its end.
    ///
    /// # Errors
    /// When an observer cannot write.
    pub(super) fn close(mut self) -> Result<RunSummary, RunError> {
        self.warn_at_end();
        let timing = *self.simulation.timing();
        let told = self.observers.iter_mut().try_for_each(|observer| observer.on_end(&timing));
        if let Err(error) = told {
            let error = RunError::from(error);
            self.notify_of_failure(&error);
            return Err(error);
        }
        let step_errors = self.step_errors();
        let steps = match self.model.case.time {
            TimeSettings::Steady(_) => 0,
            TimeSettings::Unsteady(_) => self.simulation.state.step,
        };
        let Run { simulation: Simulation { work, .. }, series, cycles, .. } = self;
        let n_dofs = work.system.n_unknowns;
        Ok(RunSummary { series, timing: work.timing, n_dofs, steps, cycles, step_errors })
    }
}
