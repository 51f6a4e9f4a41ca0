//! `Environment`: what a controller that learns deals with, whichever solver moves the swimmer.

use super::EnvironmentError;
use super::reason::Reason;
use super::task::Task;

/// What is observed at the start of an episode.
#[derive(Debug, Clone, PartialEq)]
pub struct Observed {
    /// Observations, as the case orders them.
    pub observation: Vec<f64>,
    /// What else is known.
    pub info: Info,
}

/// What an action leads to.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Observations at the end of the interval.
    pub observation: Vec<f64>,
    /// The reward of the interval.
    pub reward: f64,
    /// Whether the episode is over by what the task is.
    pub terminated: bool,
    /// Whether it is broken off.
    pub truncated: bool,
    /// What else is known.
    pub info: Info,
}

/// What is known besides observations and reward.
#[derive(Debug, Clone, PartialEq)]
pub struct Info {
    /// Time since the start of the episode (s).
    pub time: f64,
    /// Number of the sample of the case.
    pub sample: usize,
    /// Targets, in the order of their names.
    pub targets: Vec<f64>,
    /// Terms of the reward with their weights, and then what the end pays.
    pub terms: Vec<f64>,
    /// Why the episode is over, if it is.
    pub reason: Reason,
    /// What the solver says of it.
    pub message: String,
}

/// A task to be learnt: decisions at equal intervals.
///
/// Same seed and same actions, same bits: of observations, of rewards and of where an episode ends.
pub trait Environment {
    /// What the task is.
    fn task(&self) -> &Task;

    /// Starts an episode: by a seed, or as the next one after the last seed.
    ///
    /// # Errors
    /// When the swimmer cannot be set up, or an observation is no number there.
    fn reset(&mut self, seed: Option<u64>) -> Result<Observed, EnvironmentError>;

    /// Takes an action, a number from -1 to 1 for each command, to which it is clipped, for an interval.
    ///
    /// # Errors
    /// When an action is no number, or the episode is over. A motion that fails is no error: it truncates the
    /// episode, with the observations before and a reward of 0.
    fn step(&mut self, action: &[f64]) -> Result<Outcome, EnvironmentError>;
}
