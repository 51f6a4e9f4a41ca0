//! `Task`: what is observed, done and paid in an environment, and the samples of its case.

use alewife_mesh::whole;

use super::EnvironmentError;
use super::episode::Episode;
use super::reason::Reason;
use crate::case::{
    CaseFile, Column, Diagnostic, Ending, EnvironmentSpec, Expression, Input, Mistake, Observation,
    RewardTerm, ScaledObservation, Severity, SignalAction, Signals, SplitMix64, TimeSettings,
    WrittenNumber, check,
};

/// What separates the numbers of samples from those of episodes.
const SAMPLES: u64 = 0x5a3b_1e0f_9c7d_2a41;

/// Part of an interval that is rounding.
const ROUNDING: f64 = 1e-6;

/// A task, the same for all environments of a case.
#[derive(Debug, Clone)]
pub struct Task {
    spec: EnvironmentSpec,
    signals: Signals,
    observations: Vec<ScaledObservation>,
    weights: Vec<f64>,
    n_decisions: usize,
    n_steps: usize,
    step: f64,
}

/// An observation that is no number.
#[derive(Debug, Clone, Copy)]
pub(super) struct Unseen {
    pub observation: usize,
    pub value: f64,
}

/// What becomes of an interval.
#[derive(Debug, Clone, Copy)]
pub(super) struct Verdict {
    pub reward: f64,
    pub reason: Reason,
}

/// Whether it is a number, in single precision too, which learners take.
fn is_number(value: f64) -> bool {
    value.abs() <= f64::from(f32::MAX)
}

fn mistaken(mistake: Mistake) -> EnvironmentError {
    let Mistake { key, message, help } = mistake;
    let severity = Severity::Error;
    EnvironmentError::Mistake(Box::new(Diagnostic { severity, key, message, help, location: None }))
}

impl Task {
    /// That of a case that has been checked.
    ///
    /// # Errors
    /// When there is no `[environment]`, or something in it is wrong.
    pub fn new(file: &CaseFile) -> Result<Self, EnvironmentError> {
        let model = &file.model;
        let spec = model.case.environment.clone().ok_or(EnvironmentError::None)?;
        let signals = Signals::new(model, &spec).map_err(|mistakes| {
            mistakes.into_iter().next().map_or(EnvironmentError::None, mistaken)
        })?;
        let TimeSettings::Unsteady(time) = &model.case.time else {
            return Err(EnvironmentError::Number(
                "a steady case has no time to decide in".to_owned(),
            ));
        };
        let ratio = |long: f64, short: f64| whole(long / short + ROUNDING).max(1);
        Ok(Self {
            observations: spec.observations.iter().map(Observation::scaled).collect(),
            weights: spec.reward.iter().map(|term| term.weight).collect(),
            n_decisions: ratio(time.end, spec.interval),
            n_steps: ratio(spec.interval, time.step),
            step: time.step,
            spec,
            signals,
        })
    }

    /// Names of observations.
    #[must_use]
    pub fn observations(&self) -> Vec<&str> {
        self.observations.iter().map(|one| one.of.as_str()).collect()
    }

    /// Lowest and highest value of each observation.
    #[must_use]
    pub fn bounds(&self) -> Vec<[f64; 2]> {
        let all = [f64::NEG_INFINITY, f64::INFINITY];
        self.observations.iter().map(|one| one.bounds.unwrap_or(all)).collect()
    }

    /// Actions: commands with what -1 and 1 ask for.
    #[must_use]
    pub fn actions(&self) -> &[SignalAction] {
        &self.signals.actions
    }

    /// Names of the terms of the reward, with `end` behind them.
    #[must_use]
    pub fn terms(&self) -> Vec<&str> {
        let own = self.spec.reward.iter().map(RewardTerm::shown);
        own.chain(["end"]).collect()
    }

    /// Names of targets.
    #[must_use]
    pub fn targets(&self) -> Vec<&str> {
        self.spec.target.keys().map(String::as_str).collect()
    }

    /// What is said of the end of an episode, by the codes of reasons.
    #[must_use]
    pub fn reasons(&self) -> Vec<&str> {
        let always = ["", "end of the case", "the motion fails", "a number is not finite"];
        let own = self.spec.terminate.iter().chain(&self.spec.truncate);
        always.into_iter().chain(own.map(Ending::shown)).collect()
    }

    /// Number of conditions that end an episode for good.
    #[must_use]
    pub fn n_terminate(&self) -> usize {
        self.spec.terminate.len()
    }

    /// The code of a reason.
    #[must_use]
    pub fn code(&self, reason: Reason) -> usize {
        reason.code(self.spec.terminate.len())
    }

    /// Decisions in an episode, at most.
    #[must_use]
    pub fn n_decisions(&self) -> usize {
        self.n_decisions
    }

    /// Steps in an interval.
    #[must_use]
    pub fn n_steps(&self) -> usize {
        self.n_steps
    }

    /// Time (s) after so many decisions.
    #[must_use]
    pub fn time(&self, decisions: usize) -> f64 {
        self.step * (decisions * self.n_steps) as f64
    }

    /// Seed of samples and of episodes.
    #[must_use]
    pub fn seed(&self) -> u64 {
        self.spec.seed
    }

    /// The quantities that have to be measured.
    pub(super) fn columns(&self) -> Vec<Column> {
        let column = |input: &Input| match input {
            Input::Quantity(column) => Some(column.clone()),
            _ => None,
        };
        self.signals.inputs.iter().filter_map(column).collect()
    }

    /// The case with the numbers of each sample; the case itself where nothing differs.
    ///
    /// # Errors
    /// When a sample makes no sense.
    pub(super) fn samples(&self, file: &CaseFile) -> Result<Vec<CaseFile>, EnvironmentError> {
        if self.spec.randomise.is_empty() {
            return Ok(vec![file.clone()]);
        }
        let mut random = SplitMix64(self.spec.seed ^ SAMPLES);
        let mut sample = || {
            let mut numbers: Vec<WrittenNumber> = Vec::new();
            for one in &self.spec.randomise {
                let value = one.law.draw([random.uniform(), random.uniform()]);
                numbers.push(WrittenNumber { path: one.key.clone(), value });
            }
            let wrong = |what: String| {
                let shown: Vec<String> =
                    numbers.iter().map(|one| format!("{} = {}", one.path, one.value)).collect();
                EnvironmentError::Sample { numbers: shown.join(", "), what }
            };
            let other = file.with_numbers(&numbers).map_err(|error| wrong(error.to_string()))?;
            let found = check(&other);
            match found.iter().find(|one| one.severity == Severity::Error) {
                None => Ok(other),
                Some(error) => {
                    Err(wrong(format!("{}: {}; {}", error.key, error.message, error.help)))
                }
            }
        };
        (0..self.spec.samples).map(|_| sample()).collect()
    }

    /// No episode yet, by a seed.
    pub(super) fn episode(&self, seed: u64) -> Episode {
        Episode::new(self.spec.target.len(), self.signals.actions.len(), seed)
    }

    /// Draws sample and targets of the next episode.
    pub(super) fn begin(&self, episode: &mut Episode, n_samples: usize) {
        let random = &mut episode.random;
        episode.sample = whole(random.uniform() * n_samples as f64).min(n_samples - 1);
        for (place, law) in episode.targets.iter_mut().zip(self.spec.target.values()) {
            *place = law.draw([random.uniform(), random.uniform()]);
        }
        episode.action.fill(0.0);
        episode.n_decisions = 0;
        episode.reason = Reason::Goes;
    }

    /// The row of all numbers, from the quantities that were measured.
    pub(super) fn fill(&self, episode: &Episode, quantities: &[f64], row: &mut Vec<f64>) {
        row.clear();
        row.resize(self.signals.n_numbers(), f64::NAN);
        let mut measured = quantities.iter();
        for (place, input) in row.iter_mut().zip(&self.signals.inputs) {
            *place = match input {
                Input::Quantity(_) => measured.next().copied().unwrap_or(f64::NAN),
                Input::Time => self.time(episode.n_decisions),
                Input::Target(nth) => episode.targets[*nth],
                Input::Action(nth) => episode.action[*nth],
            };
        }
        self.signals.complete(row);
    }

    /// Observations of a row into `observation`; the number of the first one that is no number, and its value, in
    /// place of them.
    pub(super) fn observe(&self, row: &[f64], observation: &mut [f64]) -> Result<(), Unseen> {
        let value = |nth: usize| {
            let ScaledObservation { scale, bounds, .. } = &self.observations[nth];
            let value = self.signals.observations[nth].at(row) / scale;
            bounds.map_or(
                value,
                |[low, high]| if value.is_nan() { value } else { value.clamp(low, high) },
            )
        };
        let all = (0..observation.len()).map(|nth| Unseen { observation: nth, value: value(nth) });
        if let Some(bad) = all.into_iter().find(|one| !is_number(one.value)) {
            return Err(bad);
        }
        observation.iter_mut().enumerate().for_each(|(nth, place)| *place = value(nth));
        Ok(())
    }

    /// Reward, its terms and the end, after an interval.
    pub(super) fn judge(&self, episode: &Episode, row: &[f64], terms: &mut [f64]) -> Verdict {
        let mut reward = 0.0;
        for (nth, term) in self.signals.rewards.iter().enumerate() {
            terms[nth] = self.weights[nth] * term.at(row);
            reward += terms[nth];
        }
        let holds = |one: &Expression| {
            let value = one.at(row);
            value != 0.0 && !value.is_nan()
        };
        let terminated = self.signals.terminate.iter().position(holds);
        let truncated = self.signals.truncate.iter().position(holds);
        let (reason, paid) = match (terminated, truncated) {
            (Some(nth), _) => (Reason::Terminated(nth), self.spec.terminate[nth].reward),
            (None, Some(nth)) => (Reason::Truncated(nth), self.spec.truncate[nth].reward),
            _ if episode.n_decisions >= self.n_decisions => (Reason::End, 0.0),
            _ => (Reason::Goes, 0.0),
        };
        if let Some(end) = terms.last_mut() {
            *end = paid;
        }
        reward += paid;
        if is_number(reward) {
            return Verdict { reward, reason };
        }
        terms.fill(0.0);
        Verdict { reward: 0.0, reason: Reason::NotFinite }
    }

    /// The name of an observation, for messages.
    pub(super) fn name(&self, observation: usize) -> String {
        format!("environment.observations.{observation}, `{}`,", self.observations[observation].of)
    }

    /// Refuses an action that is no number.
    ///
    /// # Errors
    /// `EnvironmentError::Action`, with the number of the environment.
    pub fn accept(&self, environment: usize, action: &[f64]) -> Result<(), EnvironmentError> {
        match action.iter().zip(self.actions()).find(|(value, _)| !value.is_finite()) {
            None => Ok(()),
            Some((value, one)) => {
                let command = one.command.clone();
                Err(EnvironmentError::Action { environment, command, value: *value })
            }
        }
    }
}
