//! `Batch`: many environments of the reduced model side by side, in threads.

use std::fmt;

use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::EnvironmentError;
use super::common::{Bench, Common, Head, Member};
use super::reason::Reason;
use super::task::Task;
use crate::case::CaseFile;

/// Parts of the work for each thread.
const PARTS: usize = 8;

/// When an environment whose episode is over starts the next one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Autoreset {
    /// At the next step, which takes no action and pays nothing.
    NextStep,
    /// At once: the last observation of the episode is kept beside the first one of the next.
    SameStep,
    /// When it is asked for.
    Disabled,
}

/// What episodes have drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawn {
    /// Number of the sample of each environment.
    pub samples: Vec<usize>,
    /// Targets, environment by environment.
    pub targets: Vec<f64>,
}

/// Many environments of one case by its reduced model. Each is the same whatever the others do, and however many
/// threads there are.
pub struct Batch {
    common: Common,
    members: Vec<Member>,
    pool: ThreadPool,
    observations: Vec<f64>,
    /// Observations at the ends of episodes that another one follows in the same step.
    finals: Vec<f64>,
    terms: Vec<f64>,
    heads: Vec<Head>,
}

/// A step of one environment.
struct Work<'a> {
    member: &'a mut Member,
    action: &'a [f64],
    observation: &'a mut [f64],
    last: &'a mut [f64],
    terms: &'a mut [f64],
    head: &'a mut Head,
}

impl Work<'_> {
    fn done(
        self,
        common: &Common,
        bench: &mut Bench,
        mode: Autoreset,
    ) -> Result<(), EnvironmentError> {
        let Self { member, action, observation, last, terms, head } = self;
        if member.episode.is_over() {
            terms.fill(0.0);
            *head = Head { reward: 0.0, time: 0.0, reason: Reason::Goes, was_reset: true };
            return common.start(member, bench, observation);
        }
        let found = common.step(member, bench, action, [&mut *observation, terms]).head;
        *head = found;
        if mode == Autoreset::SameStep && found.reason != Reason::Goes {
            last.copy_from_slice(observation);
            head.was_reset = true;
            common.start(member, bench, observation)?;
        }
        Ok(())
    }
}

impl fmt::Debug for Batch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Batch").field("environments", &self.members.len()).finish_non_exhaustive()
    }
}

impl Batch {
    /// So many environments of a case that has been checked, in so many threads. None has an episode yet.
    ///
    /// # Errors
    /// When the case has no `[environment]`, or something that the reduced model does not know.
    pub fn open(file: &CaseFile, n: usize, threads: usize) -> Result<Self, EnvironmentError> {
        if n == 0 || threads == 0 {
            let message = format!("{n} environments in {threads} threads: one of each at least");
            return Err(EnvironmentError::Number(message));
        }
        let common = Common::open(file)?;
        let pool = ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .map_err(|error| EnvironmentError::Number(error.to_string()))?;
        let task = &common.task;
        let member = |nth: usize| common.member(task.seed().wrapping_add(nth as u64));
        let members: Vec<Member> = (0..n).map(member).collect();
        let (n_observations, n_terms) = (task.observations().len(), task.terms().len());
        let head = Head { reward: 0.0, time: 0.0, reason: Reason::Goes, was_reset: true };
        Ok(Self {
            observations: vec![0.0; n * n_observations],
            finals: vec![0.0; n * n_observations],
            terms: vec![0.0; n * n_terms],
            heads: vec![head; n],
            members,
            pool,
            common,
        })
    }

    /// What the task is.
    #[must_use]
    pub fn task(&self) -> &Task {
        &self.common.task
    }

    /// Number of environments.
    #[must_use]
    pub fn n_environments(&self) -> usize {
        self.members.len()
    }

    /// Observations, environment by environment.
    #[must_use]
    pub fn observations(&self) -> &[f64] {
        &self.observations
    }

    /// Observations at the ends of episodes after which the last step started others; those of all other
    /// environments mean nothing.
    #[must_use]
    pub fn finals(&self) -> &[f64] {
        &self.finals
    }

    /// Terms of the last rewards, environment by environment.
    #[must_use]
    pub fn terms(&self) -> &[f64] {
        &self.terms
    }

    /// What became of the last step.
    #[must_use]
    pub fn heads(&self) -> &[Head] {
        &self.heads
    }

    /// Number of the sample of each environment, and its targets, environment by environment.
    #[must_use]
    pub fn drawn(&self) -> Drawn {
        let samples = self.members.iter().map(|member| member.episode.sample).collect();
        let targets = self.members.iter().flat_map(|member| member.episode.targets.iter().copied());
        Drawn { samples, targets: targets.collect() }
    }

    /// Starts episodes: in all environments or in those of a mask; by seeds, one each, or as the next ones.
    ///
    /// # Errors
    /// When an observation is no number there.
    pub fn reset(
        &mut self,
        seeds: Option<&[u64]>,
        mask: Option<&[bool]>,
    ) -> Result<(), EnvironmentError> {
        for (nth, member) in self.members.iter_mut().enumerate() {
            let is_chosen = mask.is_none_or(|mask| mask.get(nth) == Some(&true));
            if let Some(seed) = seeds.and_then(|seeds| seeds.get(nth)).filter(|_| is_chosen) {
                member.episode.seed(*seed);
            }
        }
        let n_observations = self.common.task.observations().len();
        let (common, least) = (&self.common, self.least());
        let work = self
            .members
            .par_iter_mut()
            .zip(self.observations.par_chunks_mut(n_observations))
            .zip(self.heads.par_iter_mut())
            .enumerate()
            .with_min_len(least);
        let start = |bench: &mut Bench, (nth, ((member, observation), head)): (usize, _)| {
            if mask.is_some_and(|mask| mask.get(nth) != Some(&true)) {
                return Ok(());
            }
            let head: &mut Head = head;
            *head = Head { reward: 0.0, time: 0.0, reason: Reason::Goes, was_reset: true };
            common.start(member, bench, observation)
        };
        self.pool.install(|| work.map_init(Bench::default, start).collect::<Result<(), _>>())
    }

    /// How many environments a thread works on at least before it asks for more.
    fn least(&self) -> usize {
        (self.members.len() / (PARTS * self.pool.current_num_threads())).max(1)
    }

    fn check(&self, actions: &[f64], mode: Autoreset) -> Result<(), EnvironmentError> {
        let (n, each) = (self.members.len(), self.common.task.actions().len());
        if actions.len() != n * each {
            let found = actions.len();
            return Err(EnvironmentError::Shape { found, environments: n, each });
        }
        for (nth, (member, action)) in self.members.iter().zip(actions.chunks(each)).enumerate() {
            let is_over = member.episode.is_over();
            if is_over && (mode != Autoreset::NextStep || member.episode.n_decisions == 0) {
                return Err(EnvironmentError::Over { environment: nth });
            }
            self.common.task.accept(nth, action)?;
        }
        Ok(())
    }

    /// Takes an action in each environment, one number for each command, environment by environment.
    ///
    /// # Errors
    /// When an action is no number, an episode is over that has to be reset, or an episode cannot start.
    pub fn step(&mut self, actions: &[f64], mode: Autoreset) -> Result<(), EnvironmentError> {
        self.check(actions, mode)?;
        let task = &self.common.task;
        let (n_observations, n_terms) = (task.observations().len(), task.terms().len());
        let n_actions = task.actions().len();
        let (common, least) = (&self.common, self.least());
        let work = self
            .members
            .par_iter_mut()
            .zip(actions.par_chunks(n_actions))
            .zip(self.observations.par_chunks_mut(n_observations))
            .zip(self.finals.par_chunks_mut(n_observations))
            .zip(self.terms.par_chunks_mut(n_terms))
            .zip(self.heads.par_iter_mut())
            .with_min_len(least)
            .map(|(((((member, action), observation), last), terms), head)| Work {
                member,
                action,
                observation,
                last,
                terms,
                head,
            });
        let step = |bench: &mut Bench, work: Work<'_>| work.done(common, bench, mode);
        self.pool.install(|| work.map_init(Bench::default, step).collect::<Result<(), _>>())
    }
}
