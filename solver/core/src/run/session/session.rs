//! `Session`: a run that waits: what its strokes do is asked for from outside, step by step.

use std::fmt;

use alewife_mesh::{Mesh, Point};

use crate::case::{Model, Recording, TimeSettings, Unsteady, several_nearest};
use crate::run::RunError;
use crate::run::case_mesh::{CaseMesh, Dimension};
use crate::run::resume::SavedState;
use crate::run::run::{Run, RunSummary};
use crate::run::snapshot::{Observer, Recorded};
use crate::step::{FlowError, StopRequest};

/// Who looks on.
pub type Observers<const D: usize> = Vec<Box<dyn Observer<D>>>;

/// The flow at present.
#[derive(Debug, Clone, Copy)]
pub struct Fields<'a, const D: usize> {
    /// The mesh, with positions of its nodes (m), in the laboratory.
    pub mesh: &'a Mesh<D>,
    /// Velocity at the P2 nodes (m/s), in the laboratory.
    pub velocity: &'a [Point<D>],
    /// Pressure at the vertices (Pa).
    pub pressure: &'a [f64],
}

/// A run that waits for what is asked of it.
///
/// Each has commands of its own, and many may be open in one process. What is asked for is part of the state.
pub struct Session<const D: usize> {
    pub(super) run: Run<'static, D>,
    pub(super) settings: Unsteady,
    /// Why it does not go on.
    failure: Option<String>,
}

impl<const D: usize> fmt::Debug for Session<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Session").field("time", &self.time()).finish_non_exhaustive()
    }
}

pub(super) fn refused(reason: String) -> RunError {
    RunError::Session(reason)
}

impl<const D: usize> Session<D> {
    /// Opens a session of a case: meshed, and with the flow at time zero, or at a saved state.
    pub(in crate::run) fn begin(
        model: &Model,
        saved: Option<&SavedState<D>>,
        observers: Observers<D>,
    ) -> Result<Self, RunError>
    where
        Dimension<D>: CaseMesh<D>,
    {
        let TimeSettings::Unsteady(settings) = &model.case.time else {
            return Err(refused(
                "a session needs time to go on in, and this case asks for a steady solution: write \
                 [time.unsteady]"
                    .to_owned(),
            ));
        };
        let run = Run::open(model, saved, observers)?;
        let mut session = Self { run, settings: settings.clone(), failure: None };
        let recording = session.run.recording.clone();
        let begun = session.run.hearing(|run| {
            run.tell(Recorded::Before(&recording))?;
            if saved.is_none() { run.begin(settings) } else { Ok(()) }
        });
        session.noted(begun)?;
        Ok(session)
    }

    /// Makes all steps up to a time (s), and pauses.
    pub(in crate::run) fn make_steps(&mut self, until: f64) -> Result<(), RunError> {
        let settings = self.settings.clone();
        let before = self.time();
        let made = self.run.hearing(|run| {
            run.advance(&settings, until)?;
            if run.simulation.state.time > before { run.pause() } else { Ok(()) }
        });
        self.noted(made)
    }

    /// Notes why it does not go on; after a request to stop it may.
    fn noted(&mut self, result: Result<(), RunError>) -> Result<(), RunError> {
        if let Err(error) = &result
            && !matches!(error, RunError::Flow(FlowError::Stopped { .. }))
        {
            self.failure = Some(error.to_string());
            self.run.notify_of_failure(error);
        }
        result
    }

    pub(super) fn check_goes_on(&self) -> Result<(), RunError> {
        match &self.failure {
            None => Ok(()),
            Some(why) => Err(refused(format!(
                "this session has failed before ({why}); restore a saved state, or open another one"
            ))),
        }
    }
}

impl<const D: usize> Session<D> {
    /// Asks for a target of a command from now on. Another one at the same time takes its place.
    ///
    /// # Errors
    /// When there is no such command, or the target is no finite number.
    pub fn command(&mut self, name: &str, target: f64) -> Result<(), RunError> {
        self.check_goes_on()?;
        self.run.ask(name, target)
    }

    /// What it is a session of.
    #[must_use]
    pub fn model(&self) -> &Model {
        &self.run.model
    }

    /// Has it stop at its next step where it is asked to; it may go on afterwards.
    pub fn stop_when(&mut self, asks: StopRequest) {
        self.run.simulation.stop = Some(asks);
    }

    /// Names of all commands.
    #[must_use]
    pub fn commands(&self) -> Vec<String> {
        self.run.model.commands.names()
    }

    /// Value and rate (1/s) of a command at present, and the target that is asked for.
    ///
    /// # Errors
    /// When there is no such command.
    pub fn commanded(&self, name: &str) -> Result<[f64; 3], RunError> {
        let command = self.run.model.commands.get(name)?;
        let [value, rate] = command.at(self.time());
        Ok([value, rate, command.target()])
    }

    /// Time (s).
    #[must_use]
    pub fn time(&self) -> f64 {
        self.run.simulation.state.time
    }

    /// Steps made.
    #[must_use]
    pub fn step(&self) -> usize {
        self.run.simulation.state.step
    }

    /// Time at which the case ends (s).
    #[must_use]
    pub fn end(&self) -> f64 {
        self.settings.end
    }

    /// Whether it has come to its end.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.run.is_over
    }

    /// Names of all quantities.
    #[must_use]
    pub fn quantities(&self) -> &[String] {
        &self.run.series.names
    }

    /// Quantities at present, by their names in `series.csv`; `time` is one, too.
    ///
    /// # Errors
    /// When there is no quantity of a name.
    pub fn observe(&self, names: &[&str]) -> Result<Vec<f64>, RunError> {
        let series = &self.run.series;
        let value = |name: &&str| {
            if *name == "time" {
                return Ok(self.time());
            }
            let column = series.names.iter().position(|known| known == name);
            let value = column.zip(series.rows.last()).and_then(|(nth, row)| row.get(nth));
            value.copied().ok_or_else(|| {
                let known: Vec<&str> = series.names.iter().map(String::as_str).collect();
                let nearest = several_nearest(name, &known);
                let nearest = if nearest.is_empty() { known } else { nearest };
                refused(format!("there is no quantity `{name}`; {}", nearest.join(", ")))
            })
        };
        names.iter().map(value).collect()
    }

    /// The flow at present.
    #[must_use]
    pub fn fields(&self) -> Fields<'_, D> {
        let state = &self.run.simulation.state;
        Fields { mesh: &state.mesh, velocity: &state.now.velocity, pressure: &state.now.pressure }
    }

    /// All that was asked for, and where it paused.
    #[must_use]
    pub fn recording(&self) -> &Recording {
        &self.run.recording
    }

    /// All that evolves, to go back to, or to write to a file.
    ///
    /// # Errors
    /// When the case cannot be written.
    pub fn save(&self) -> Result<SavedState<D>, RunError> {
        Ok(self.run.saved()?)
    }

    /// Ends it. Observers are told whether it came to its end, or was stopped on its way.
    ///
    /// # Errors
    /// When an observer cannot write.
    pub fn close(mut self) -> Result<RunSummary, RunError> {
        if !self.run.is_over && self.failure.is_none() {
            let (step, time) = (self.step(), self.time());
            self.run.notify_of_failure(&FlowError::Stopped { step, time }.into());
            self.run.observers.clear();
        }
        if self.failure.is_some() {
            self.run.observers.clear();
        }
        self.run.close()
    }
}
