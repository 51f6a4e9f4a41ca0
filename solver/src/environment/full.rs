//! `Full`: the same environment by the full solver, slow and right.

use std::fmt;

use super::episode::Episode;
use super::reason::Reason;
use super::task::{Task, Unseen};
use super::{Environment, EnvironmentError, Info, Observed, Outcome};
use crate::case::{CaseFile, Model};
use crate::run::{Dimension, RunError, SavedState, Session, Solve};
use crate::step::StopRequest;

/// An environment of the full solver in D dimensions.
pub struct Full<const D: usize> {
    task: Task,
    samples: Vec<Model>,
    /// Where episodes of each sample start, once one has.
    starts: Vec<Option<SavedState<D>>>,
    session: Option<Session<D>>,
    stop: Option<StopRequest>,
    names: Vec<String>,
    episode: Episode,
    row: Vec<f64>,
    observation: Vec<f64>,
    terms: Vec<f64>,
}

/// What became of an interval.
struct Judged {
    reward: f64,
    reason: Reason,
    message: String,
}

impl<const D: usize> fmt::Debug for Full<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Full").field("task", &self.task).finish_non_exhaustive()
    }
}

impl<const D: usize> Full<D>
where
    Dimension<D>: Solve<D>,
{
    /// That of a case that has been checked.
    ///
    /// # Errors
    /// When the case has no `[environment]`, or a sample of it makes no sense.
    pub fn open(file: &CaseFile) -> Result<Self, EnvironmentError> {
        let task = Task::new(file)?;
        let samples: Vec<Model> =
            task.samples(file)?.into_iter().map(|sample| sample.model).collect();
        Ok(Self {
            starts: samples.iter().map(|_| None).collect(),
            samples,
            session: None,
            stop: None,
            names: task.columns().into_iter().map(|column| column.name).collect(),
            episode: task.episode(task.seed()),
            row: Vec::new(),
            observation: vec![0.0; task.observations().len()],
            terms: vec![0.0; task.terms().len()],
            task,
        })
    }

    /// Has it stop at its next step where it is asked to, with an error.
    pub fn stop_when(&mut self, asks: StopRequest) {
        if let Some(session) = &mut self.session {
            session.stop_when(asks.clone());
        }
        self.stop = Some(asks);
    }

    fn session(&self) -> Result<Session<D>, RunError> {
        let model = &self.samples[self.episode.sample];
        match &self.starts[self.episode.sample] {
            Some(start) => Session::resume(model, start, Vec::new()),
            None => Session::open(&model.disconnected(), Vec::new()),
        }
    }

    fn measure(&mut self) -> Result<(), RunError> {
        let names: Vec<&str> = self.names.iter().map(String::as_str).collect();
        let quantities = match &self.session {
            Some(session) => session.observe(&names)?,
            None => Vec::new(),
        };
        self.task.fill(&self.episode, &quantities, &mut self.row);
        Ok(())
    }

    fn info(&self, time: f64, message: String) -> Info {
        Info {
            time,
            sample: self.episode.sample,
            targets: self.episode.targets.to_vec(),
            terms: self.terms.clone(),
            reason: self.episode.reason,
            message,
        }
    }

    /// Asks for what an action means, and makes the steps of an interval.
    fn advance(&mut self) -> Result<(), RunError> {
        let time = self.task.time(self.episode.n_decisions);
        if let Some(session) = &mut self.session {
            for (one, action) in self.task.actions().iter().zip(&self.episode.action) {
                session.command(&one.command, one.target(*action))?;
            }
            session.advance_to(time.min(session.end()))?;
        }
        self.measure()
    }

    fn judged(&mut self) -> Judged {
        let verdict = self.task.judge(&self.episode, &self.row, &mut self.terms);
        if verdict.reason == Reason::NotFinite {
            let message = "the reward is no finite number".to_owned();
            return Judged { reward: 0.0, reason: verdict.reason, message };
        }
        match self.task.observe(&self.row, &mut self.observation) {
            Ok(()) => {
                let (reward, reason) = (verdict.reward, verdict.reason);
                Judged { reward, reason, message: String::new() }
            }
            Err(Unseen { observation: nth, value }) => {
                let message = format!("{} is {value}", self.task.name(nth));
                Judged { reward: 0.0, reason: Reason::NotFinite, message }
            }
        }
    }
}

impl<const D: usize> Environment for Full<D>
where
    Dimension<D>: Solve<D>,
{
    fn task(&self) -> &Task {
        &self.task
    }

    fn reset(&mut self, seed: Option<u64>) -> Result<Observed, EnvironmentError> {
        if let Some(seed) = seed {
            self.episode.seed(seed);
        }
        self.task.begin(&mut self.episode, self.samples.len());
        self.session = None;
        let mut session = self.session()?;
        if let Some(stop) = &self.stop {
            session.stop_when(stop.clone());
        }
        if self.starts[self.episode.sample].is_none() {
            self.starts[self.episode.sample] = Some(session.save()?);
        }
        self.session = Some(session);
        self.measure()?;
        self.terms.fill(0.0);
        if let Err(Unseen { observation: nth, value }) =
            self.task.observe(&self.row, &mut self.observation)
        {
            self.episode.reason = Reason::NotFinite;
            return Err(EnvironmentError::Start { name: self.task.name(nth), value });
        }
        let observation = self.observation.clone();
        Ok(Observed { observation, info: self.info(0.0, String::new()) })
    }

    fn step(&mut self, action: &[f64]) -> Result<Outcome, EnvironmentError> {
        let each = self.task.actions().len();
        if action.len() != each {
            return Err(EnvironmentError::Shape { found: action.len(), environments: 1, each });
        }
        self.task.accept(0, action)?;
        if self.episode.is_over() || self.session.is_none() {
            return Err(EnvironmentError::Over { environment: 0 });
        }
        self.episode.act(action);
        let Judged { reward, reason, message } = match self.advance() {
            Ok(()) => self.judged(),
            Err(error @ RunError::Flow(crate::step::FlowError::Stopped { .. })) => {
                self.episode.reason = Reason::Failure;
                return Err(error.into());
            }
            Err(error) => {
                Judged { reward: 0.0, reason: Reason::Failure, message: error.to_string() }
            }
        };
        if matches!(reason, Reason::Failure | Reason::NotFinite) {
            self.terms.fill(0.0);
        }
        self.episode.reason = reason;
        Ok(Outcome {
            observation: self.observation.clone(),
            reward,
            terminated: reason.terminates(),
            truncated: reason.truncates(),
            info: self.info(self.task.time(self.episode.n_decisions), message),
        })
    }
}
