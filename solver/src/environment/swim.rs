//! `Swim`: one environment of the reduced model.

use std::fmt;

use super::common::{Bench, Common, Member, Stepped};
use super::task::Task;
use super::{Environment, EnvironmentError, Info, Observed, Outcome};
use crate::case::CaseFile;

/// One environment of the reduced model.
pub struct Swim {
    common: Common,
    member: Member,
    bench: Bench,
    observation: Vec<f64>,
    terms: Vec<f64>,
}

impl fmt::Debug for Swim {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Swim").field("task", &self.common.task).finish_non_exhaustive()
    }
}

impl Swim {
    /// That of a case that has been checked.
    ///
    /// # Errors
    /// As `Batch::open`.
    pub fn open(file: &CaseFile) -> Result<Self, EnvironmentError> {
        let common = Common::open(file)?;
        let task = &common.task;
        let member = common.member(task.seed());
        let observation = vec![0.0; task.observations().len()];
        let terms = vec![0.0; task.terms().len()];
        Ok(Self { member, bench: Bench::default(), observation, terms, common })
    }

    fn info(&self, time: f64, message: String) -> Info {
        let episode = &self.member.episode;
        Info {
            time,
            sample: episode.sample,
            targets: episode.targets.to_vec(),
            terms: self.terms.clone(),
            reason: episode.reason,
            message,
        }
    }
}

impl Environment for Swim {
    fn task(&self) -> &Task {
        &self.common.task
    }

    fn reset(&mut self, seed: Option<u64>) -> Result<Observed, EnvironmentError> {
        if let Some(seed) = seed {
            self.member.episode.seed(seed);
        }
        self.common.start(&mut self.member, &mut self.bench, &mut self.observation)?;
        self.terms.fill(0.0);
        let observation = self.observation.clone();
        Ok(Observed { observation, info: self.info(0.0, String::new()) })
    }

    fn step(&mut self, action: &[f64]) -> Result<Outcome, EnvironmentError> {
        let each = self.common.task.actions().len();
        if action.len() != each {
            return Err(EnvironmentError::Shape { found: action.len(), environments: 1, each });
        }
        self.common.task.accept(0, action)?;
        if self.member.episode.is_over() {
            return Err(EnvironmentError::Over { environment: 0 });
        }
        let places = [&mut self.observation[..], &mut self.terms[..]];
        let Stepped { head, message } =
            self.common.step(&mut self.member, &mut self.bench, action, places);
        Ok(Outcome {
            observation: self.observation.clone(),
            reward: head.reward,
            terminated: head.reason.terminates(),
            truncated: head.reason.truncates(),
            info: self.info(head.time, message),
        })
    }
}
