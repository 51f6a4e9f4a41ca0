//! `Command`: a function of time that is asked for while a run goes on, through limits and a filter.
//!
//! What is asked for, clipped, is followed at a limited rate by a reference r, and r by
//! y'' + 2 w y' + w² y = w² r with w = 1 / filter: y is a mean of r with a positive kernel, so it keeps the limits, and
//! its rate those of the rate. r is a straight line from piece to piece, on which y is a line and an exponential.

use std::fmt;
use std::sync::{Arc, PoisonError, RwLock};

use serde::{Deserialize, Serialize};

#[cfg(test)]
use crate::spec::number::Positive;

/// `command`: it waits for what a session or a recording asks for.
///
/// Clones share what has been asked for, until [`Self::disconnect`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Command {
    /// Value until something is asked for.
    #[serde(default)]
    pub start: f64,
    /// Lowest and highest value; what is asked for beyond them is clipped. None if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limits: Option<[f64; 2]>,
    /// Largest rate (1/s); any if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub rate: Option<f64>,
    /// Time constant of the critically damped filter of second order (s): a jump is followed to 26 % after it, to
    /// 59 % after twice, and to 96 % after five times of it.
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub filter: f64,
    #[serde(skip)]
    track: Track,
}

/// A value that was asked for, from a time (s) on.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Asked {
    time: f64,
    target: f64,
}

/// From a start (s) on: a straight line, and what follows it.
#[derive(Debug, Clone, Copy)]
struct Piece {
    start: f64,
    reference: f64,
    slope: f64,
    value: f64,
    rate: f64,
}

/// What was asked for, and what follows from it.
#[derive(Debug, Default)]
struct History {
    asked: Vec<Asked>,
    pieces: Vec<Piece>,
}

/// A history that all clones of a command share; it is no part of the case.
#[derive(Clone, Default)]
struct Track(Arc<RwLock<History>>);

impl fmt::Debug for Track {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Track")
    }
}

impl PartialEq for Track {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Track {
    fn read<R>(&self, read: impl FnOnce(&History) -> R) -> R {
        read(&self.0.read().unwrap_or_else(PoisonError::into_inner))
    }
}

impl Piece {
    /// Value and rate a time (s) after its start.
    #[inline]
    fn after(&self, time: f64, frequency: f64) -> [f64; 2] {
        let lag = 2.0 * self.slope / frequency;
        let first = self.value - self.reference + lag;
        let second = self.rate - self.slope + frequency * first;
        let decay = (-frequency * time).exp();
        let transient = if decay == 0.0 { 0.0 } else { (first + second * time) * decay };
        let value = self.reference + self.slope * time - lag + transient;
        [value, self.slope + second * decay - frequency * transient]
    }
}

impl Command {
    /// A command with nothing asked for.
    #[must_use]
    pub fn new(start: f64, limits: Option<[f64; 2]>, rate: Option<f64>, filter: f64) -> Self {
        Self { start, limits, rate, filter, track: Track::default() }
    }

    /// Forgets what was asked for, and what is asked for from its clones.
    pub fn disconnect(&mut self) {
        self.track = Track::default();
    }

    /// Asks for a target from a time (s) on that is not before the last one; another one of the same time is replaced.
    pub fn ask(&self, time: f64, target: f64) {
        let mut history = self.track.0.write().unwrap_or_else(PoisonError::into_inner);
        // From the end: what is there before is long, and does not change
        let before = history.asked.partition_point(|asked| asked.time < time);
        history.asked.truncate(before);
        let before = history.pieces.partition_point(|piece| piece.start < time);
        history.pieces.truncate(before);
        let before = history.pieces.last().copied();
        let [value, rate] = self.on(before.as_ref(), time);
        let reference =
            before.map_or(self.start, |piece| piece.reference + piece.slope * (time - piece.start));
        let target = self.clipped(target);
        history.asked.push(Asked { time, target });
        let way = target - reference;
        let rest = match self.rate {
            Some(most) if way != 0.0 => {
                let slope = most.copysign(way);
                let piece = Piece { start: time, reference, slope, value, rate };
                history.pieces.push(piece);
                let start = time + way / slope;
                let [value, rate] = self.on(Some(&piece), start);
                Piece { start, reference: target, slope: 0.0, value, rate }
            }
            _ => Piece { start: time, reference: target, slope: 0.0, value, rate },
        };
        history.pieces.push(rest);
    }

    /// Whether it is a clone of another one, with which it shares what is asked for.
    #[must_use]
    pub fn is_clone_of(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.track.0, &other.track.0)
    }

    /// The nearest value within the limits.
    #[inline]
    #[must_use]
    pub fn clipped(&self, target: f64) -> f64 {
        self.limits.map_or(target, |[least, most]| target.max(least).min(most))
    }

    /// Value and rate at a time (s).
    #[must_use]
    pub fn at(&self, time: f64) -> [f64; 2] {
        self.track.read(|history| {
            let after = history.pieces.partition_point(|piece| piece.start <= time);
            self.on(after.checked_sub(1).map(|nth| &history.pieces[nth]), time)
        })
    }

    /// Value and rate on a piece at a time (s); before the first one all is at rest.
    #[inline]
    fn on(&self, piece: Option<&Piece>, time: f64) -> [f64; 2] {
        let Some(piece) = piece else { return [self.start, 0.0] };
        let [value, rate] = piece.after(time - piece.start, 1.0 / self.filter);
        // Rounding may lead beyond a limit
        [self.clipped(value), rate]
    }

    /// What is asked for at present, clipped.
    #[must_use]
    pub fn target(&self) -> f64 {
        self.track.read(|history| history.asked.last().map_or(self.start, |asked| asked.target))
    }

    /// The time (s) from which on something was asked for last.
    #[must_use]
    pub fn last_asked(&self) -> Option<f64> {
        self.track.read(|history| history.asked.last().map(|asked| asked.time))
    }

    /// Times (s) up to which derivatives higher than the first jump, ascending: where something is asked for, and
    /// where the reference gets there.
    #[must_use]
    pub fn kinks(&self) -> Vec<f64> {
        self.track.read(|history| history.pieces.iter().map(|piece| piece.start).collect())
    }

    /// Smallest and largest value.
    #[must_use]
    pub fn range(&self) -> [f64; 2] {
        self.limits.unwrap_or([f64::NEG_INFINITY, f64::INFINITY])
    }

    /// A rate that is not exceeded (1/s): that it is limited to, or that of a jump from limit to limit.
    #[must_use]
    pub fn largest_rate(&self) -> f64 {
        let [least, most] = self.range();
        let jump = (most - least) / (std::f64::consts::E * self.filter);
        self.rate.map_or(jump, |rate| rate.min(jump))
    }
}

/// A command that somebody follows for himself, without all that was asked for before.
#[derive(Debug, Clone, Copy)]
pub struct Follower {
    /// The piece there is now, and the one that comes after it.
    now: Option<Piece>,
    next: Option<Piece>,
}

impl Follower {
    /// At rest at the start of its command.
    #[must_use]
    pub fn new() -> Self {
        Self { now: None, next: None }
    }

    /// Asks for a target of its command from a time (s) on that is not before the last one.
    pub fn ask(&mut self, command: &Command, time: f64, target: f64) {
        let before = self.at_time(time);
        let [value, rate] = command.on(before.as_ref(), time);
        let reference = before
            .map_or(command.start, |piece| piece.reference + piece.slope * (time - piece.start));
        let target = command.clipped(target);
        let way = target - reference;
        match command.rate {
            Some(most) if way != 0.0 => {
                let slope = most.copysign(way);
                let piece = Piece { start: time, reference, slope, value, rate };
                let start = time + way / slope;
                let [value, rate] = command.on(Some(&piece), start);
                self.now = Some(piece);
                self.next = Some(Piece { start, reference: target, slope: 0.0, value, rate });
            }
            _ => {
                self.now = Some(Piece { start: time, reference: target, slope: 0.0, value, rate });
                self.next = None;
            }
        }
    }

    /// Value and rate of its command at a time (s) that is not before the last time something was asked for.
    #[inline]
    #[must_use]
    pub fn at(&self, command: &Command, time: f64) -> [f64; 2] {
        command.on(self.at_time(time).as_ref(), time)
    }

    #[inline]
    fn at_time(&self, time: f64) -> Option<Piece> {
        self.next.filter(|next| next.start <= time).or(self.now)
    }
}

impl Default for Follower {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COMMAND: [f64; 3] = [0.1, 3.0, 0.05];

    fn command(rate: Option<f64>) -> Command {
        let command = Command::new(COMMAND[0], Some([-0.5, 0.6]), rate, COMMAND[2]);
        for (time, target) in [(0.0, 0.3), (0.4, -0.2), (0.43, 2.0), (0.9, -3.0), (1.5, 0.0)] {
            command.ask(time, target);
        }
        command
    }

    /// The same law by many short steps of the midpoint rule.
    #[test]
    fn values_and_rates_are_those_of_the_law() {
        for rate in [None, Some(COMMAND[1])] {
            let command = command(rate);
            let targets = [(0.0, 0.3), (0.4, -0.2), (0.43, 0.6), (0.9, -0.5), (1.5, 0.0)];
            let n = 400_000_u32;
            let step = 2.0 / f64::from(n);
            let frequency = 1.0 / COMMAND[2];
            let (mut r, mut y, mut v) = (COMMAND[0], COMMAND[0], 0.0);
            for nth in 0..n {
                let time = step * f64::from(nth);
                let middle = time + 0.5 * step;
                let target =
                    targets.iter().rev().find(|asked| asked.0 <= middle).map_or(0.1, |a| a.1);
                let before = r;
                r = match rate {
                    Some(rate) => r + (target - r).clamp(-rate * step, rate * step),
                    None => target,
                };
                let reference = if rate.is_some() { 0.5 * (before + r) } else { r };
                let force = |y: f64, v: f64| frequency * (frequency * (reference - y) - 2.0 * v);
                let (ym, vm) = (y + 0.5 * step * v, v + 0.5 * step * force(y, v));
                (y, v) = (y + step * vm, v + step * force(ym, vm));
                if nth % 1000 == 999 {
                    let [value, speed] = command.at(time + step);
                    assert!(
                        (value - y).abs() < 2e-5 && (speed - v).abs() < 1e-3,
                        "{time} {value} {y}"
                    );
                }
            }
        }
    }

    #[test]
    fn value_and_rate_are_continuous_and_keep_their_limits() {
        for rate in [None, Some(COMMAND[1])] {
            let command = command(rate);
            let mut last = command.at(-0.1);
            for nth in 0..200_000 {
                let now = command.at(1e-5 * f64::from(nth));
                assert!((-0.5..=0.6).contains(&now[0]) && now[1].abs() <= command.largest_rate());
                assert!(
                    (now[0] - last[0]).abs() < 3e-4 && (now[1] - last[1]).abs() < 5e-3,
                    "{nth}"
                );
                last = now;
            }
        }
        let [value, rate] = command(None).at(1e9);
        assert_eq!([value, rate], [0.0, 0.0]);
    }

    /// What was asked for at the same time before does not count, nor does how often is looked at it.
    #[test]
    fn a_follower_is_where_its_command_is() {
        let asked = [(0.0, 0.3), (0.4, -0.2), (0.43, 2.0), (0.9, -3.0), (1.5, 0.0)];
        for rate in [None, Some(COMMAND[1])] {
            let whole = command(rate);
            let mut follower = Follower::new();
            for (nth, (time, target)) in asked.iter().enumerate() {
                follower.ask(&whole, *time, *target);
                let end = asked.get(nth + 1).map_or(2.0, |next| next.0);
                for part in 0..10 {
                    let time = time + 0.1 * f64::from(part) * (end - time);
                    let bits = |value: [f64; 2]| value.map(f64::to_bits);
                    assert_eq!(bits(follower.at(&whole, time)), bits(whole.at(time)));
                }
            }
        }
    }

    #[test]
    fn the_last_word_of_a_time_counts() {
        let (once, twice) = (command(Some(2.0)), command(Some(2.0)));
        twice.ask(1.7, 0.5);
        let _ = twice.at(1.9);
        for command in [&once, &twice] {
            command.ask(1.7, -0.3);
        }
        assert_eq!(once.at(2.5).map(f64::to_bits), twice.at(2.5).map(f64::to_bits));
        let mut own = once.clone();
        own.disconnect();
        assert_eq!((own.at(2.5), own == once), ([0.1, 0.0], true));
    }
}
