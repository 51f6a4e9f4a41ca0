//! `Common`: what all environments of a case share, and how one of them starts and goes on.

use super::EnvironmentError;
use super::episode::Episode;
use super::reason::Reason;
use super::task::{Task, Unseen};
use crate::case::{CaseFile, Severity, check_reduced};
use crate::reduced::{Player, Playing, Scratch};

/// What became of a step of one environment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Head {
    /// The reward.
    pub reward: f64,
    /// Time since the start of the episode (s), before a reset in the same step.
    pub time: f64,
    /// Why the episode is over; before a reset in the same step.
    pub reason: Reason,
    /// Whether this step started an episode.
    pub was_reset: bool,
}

/// A step, and what the solver says of it.
pub(super) struct Stepped {
    pub head: Head,
    pub message: String,
}

/// A motion and its episode.
pub(super) struct Member {
    pub playing: Playing,
    pub episode: Episode,
}

/// What is the same for all environments of a batch.
pub(super) struct Common {
    pub task: Task,
    /// One for each sample.
    pub players: Vec<Player>,
}

/// What a thread needs while it works.
#[derive(Default)]
pub(super) struct Bench {
    scratch: Scratch,
    quantities: Vec<f64>,
    row: Vec<f64>,
}

impl Common {
    /// That of a case that has been checked.
    pub fn open(file: &CaseFile) -> Result<Self, EnvironmentError> {
        let task = Task::new(file)?;
        let commands: Vec<&str> = task.actions().iter().map(|one| one.command.as_str()).collect();
        let columns = task.columns();
        if let Some(wrong) =
            check_reduced(file).into_iter().find(|one| one.severity == Severity::Error)
        {
            return Err(EnvironmentError::Mistake(Box::new(wrong)));
        }
        let samples = task.samples(file)?;
        let players = samples.iter().map(|sample| Player::new(&sample.model, &commands, &columns));
        let players = players.collect::<Result<Vec<_>, _>>()?;
        if let Some(other) = players.iter().position(|player| !player.is_like(&players[0])) {
            return Err(EnvironmentError::Sample {
                numbers: format!("sample {other}"),
                what: "it has other bodies or joints than the first one".to_owned(),
            });
        }
        Ok(Self { task, players })
    }

    /// Starts an episode.
    pub fn start(
        &self,
        member: &mut Member,
        bench: &mut Bench,
        observation: &mut [f64],
    ) -> Result<(), EnvironmentError> {
        let Member { playing, episode } = member;
        self.task.begin(episode, self.players.len());
        let player = &self.players[episode.sample];
        *playing = player.playing();
        self.measure(player, member, bench);
        self.task.observe(&bench.row, observation).map_err(|Unseen { observation: nth, value }| {
            member.episode.reason = Reason::NotFinite;
            EnvironmentError::Start { name: self.task.name(nth), value }
        })
    }

    /// A motion without an episode, by a seed.
    pub fn member(&self, seed: u64) -> Member {
        Member { playing: self.players[0].playing(), episode: self.task.episode(seed) }
    }

    fn measure(&self, player: &Player, member: &mut Member, bench: &mut Bench) {
        let Bench { scratch, quantities, row } = bench;
        let n = self.n_quantities();
        quantities.resize(n, 0.0);
        player.measure(&mut member.playing, scratch, quantities);
        self.task.fill(&member.episode, quantities, row);
    }

    fn n_quantities(&self) -> usize {
        self.players.first().map_or(0, Player::n_quantities)
    }

    /// An interval; why it failed, where it did.
    pub fn step(
        &self,
        member: &mut Member,
        bench: &mut Bench,
        action: &[f64],
        [observation, terms]: [&mut [f64]; 2],
    ) -> Stepped {
        let Member { playing, episode } = member;
        let player = &self.players[episode.sample];
        episode.act(action);
        for (nth, one) in self.task.actions().iter().enumerate() {
            player.ask(playing, nth, one.target(episode.action[nth]));
        }
        let time = self.task.time(episode.n_decisions);
        let sample = episode.sample;
        let moved = player.advance(playing, &mut bench.scratch, sample, self.task.n_steps());
        let (reward, reason, message) = match moved {
            Err(error) => (0.0, Reason::Failure, error.to_string()),
            Ok(()) => {
                self.measure(player, member, bench);
                let verdict = self.task.judge(&member.episode, &bench.row, terms);
                match self.task.observe(&bench.row, observation) {
                    _ if verdict.reason == Reason::NotFinite => {
                        (0.0, verdict.reason, "the reward is no finite number".to_owned())
                    }
                    Ok(()) => (verdict.reward, verdict.reason, String::new()),
                    Err(Unseen { observation: nth, value }) => {
                        let message = format!("{} is {value}", self.task.name(nth));
                        (0.0, Reason::NotFinite, message)
                    }
                }
            }
        };
        if matches!(reason, Reason::Failure | Reason::NotFinite) {
            terms.fill(0.0);
        }
        member.episode.reason = reason;
        Stepped { head: Head { reward, time, reason, was_reset: false }, message }
    }
}
