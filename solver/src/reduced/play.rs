//! `Player`: a reduced model that is asked for something while it moves, many motions of it side by side.

use alewife_reduced::tree::{Command as Asked, Inputs, State, TreeError, Wrench};
use nalgebra::Matrix3;

use super::ReducedError;
use super::acting::Acting;
use super::build::Reduced;
use super::inputs::pushes::{Propeller, PropellerMemory};
use super::inputs::told::Told;
use super::measure::{Last, Moving, Value, bodies_after, is_load, joint};
use super::mover::Rule;
use super::swimmer::Now;
use crate::case::{
    BodyQuantity, Column, Command, Follower, JointQuantity, Model, Source, Stroke, SwimmerQuantity,
    TimeSettings,
};

/// A reduced model with commands, and the quantities that are measured of it. It does not change.
#[derive(Debug, Clone)]
pub struct Player {
    reduced: Reduced,
    commands: Vec<Command>,
    /// The command that each link waits for, by its number.
    waits: Vec<Option<usize>>,
    /// The same of each thruster.
    pushes: Vec<Option<usize>>,
    columns: Vec<Column>,
    /// Links below joints, in the order of the bodies that are their children.
    below: Vec<usize>,
    swimmers: Vec<Vec<usize>>,
    needs: Needs,
    step: f64,
    start: State<f64>,
}

/// What has to be known for the quantities that are measured.
#[derive(Debug, Clone, Copy, Default)]
struct Needs {
    bodies: bool,
    loads: bool,
    accelerations: bool,
}

/// A motion of a player, as small as it can be.
#[derive(Debug, Clone)]
pub struct Playing {
    state: State<f64>,
    /// Steps made.
    n_steps: usize,
    followers: Vec<Follower>,
    /// Of each body over all turns (rad).
    angles: Vec<f64>,
    /// Of each thruster.
    memories: Vec<PropellerMemory>,
}

/// What a motion needs while it is moved, and not between: one for many of them.
#[derive(Default)]
pub struct Scratch {
    /// One for all trees with inertia, and one each for those without.
    rules: Vec<Option<Rule<f64>>>,
    /// Of each sample.
    propellers: Vec<Option<Vec<Propeller>>>,
    /// Commands at the beginning, the middle and the end of a step.
    values: Vec<[[f64; 2]; 3]>,
    before: Vec<Moving>,
}

/// Commands of a motion over a step.
struct Heard<'a> {
    player: &'a Player,
    followers: &'a [Follower],
    times: [f64; 3],
    values: &'a [[[f64; 2]; 3]],
    propellers: &'a [Propeller],
}

impl Inputs<f64> for Heard<'_> {
    fn command(&self, time: f64, link: usize) -> Asked<f64> {
        let Some(nth) = self.player.waits[link] else {
            return self.player.reduced.command(time, link);
        };
        // Bits are compared: these are the same sums that a step takes
        let known = self.times.iter().position(|one| one.to_bits() == time.to_bits());
        let [place, rate] = match known {
            Some(known) => self.values[nth][known],
            None => self.followers[nth].at(&self.player.commands[nth], time),
        };
        match self.player.reduced.told[link] {
            Told::Effort(_) => Asked { effort: place, ..Asked::none() },
            _ => Asked { place, rate, ..Asked::none() },
        }
    }

    fn wrench(&self, time: f64, link: usize, rotation: &Matrix3<f64>) -> Option<Wrench<f64>> {
        let reduced = &self.player.reduced;
        Acting { reduced, propellers: self.propellers, asked: None }.wrench(time, link, rotation)
    }
}

impl Player {
    /// The reduced model of a case, which waits for commands by their names, and of which quantities are measured.
    ///
    /// # Errors
    /// When the case has what a reduced model does not know, or a quantity is known of a flow alone.
    pub fn new(model: &Model, commands: &[&str], columns: &[Column]) -> Result<Self, ReducedError> {
        let unknown = |what: String| ReducedError::Unknown(what);
        let TimeSettings::Unsteady(time) = &model.case.time else {
            return Err(unknown("a steady flow".to_owned()));
        };
        let reduced = Reduced::new(model)?;
        let silent = columns.iter().find(|one| is_load(one.source));
        if let Some(column) = silent.filter(|_| reduced.connection.is_some()) {
            let name = &column.name;
            return Err(unknown(format!("`{name}`: a connection has no loads")));
        }
        let all: Vec<Command> =
            commands.iter().filter_map(|name| model.commands.get(name).ok().cloned()).collect();
        let number = |stroke: &Stroke| match stroke {
            Stroke::Command(own) => all.iter().position(|one| one.is_clone_of(own)),
            _ => None,
        };
        let waits = reduced.told.iter().map(|told| match told {
            Told::Given(stroke) | Told::Effort(stroke) => number(stroke),
            _ => None,
        });
        let waits: Vec<Option<usize>> = waits.collect();
        let pushes = reduced.propellers.iter().map(|one| number(one.drive()));
        let pushes: Vec<Option<usize>> = pushes.collect();
        let is_heard = |nth: usize| waits.contains(&Some(nth)) || pushes.contains(&Some(nth));
        if let Some(nth) = (0..commands.len()).find(|nth| !is_heard(*nth)) {
            let what =
                format!("the command `{}`: it moves no joint and no thruster", commands[nth]);
            return Err(unknown(what));
        }
        let joined = (0..model.bodies.len()).filter(|body| model.joint_above(*body).is_some());
        let below = joined.map(|body| reduced.parts[body].link).collect();
        let swimmers = model.swimmers.iter().map(|swimmer| swimmer.bodies.clone()).collect();
        let start = reduced.start.clone();
        let mut player = Self {
            commands: all,
            waits,
            pushes,
            columns: columns.to_vec(),
            below,
            swimmers,
            needs: needs(columns),
            step: time.step,
            start,
            reduced,
        };
        let mut playing = player.playing();
        player.begin(&mut playing)?;
        player.start = playing.state.clone();
        let mut row = vec![0.0; columns.len()];
        let missing = player.measured(&mut playing, &mut Scratch::default(), &mut row);
        if let Some(column) = missing {
            let name = &columns[column].name;
            return Err(unknown(format!("`{name}`, which the full solver alone measures")));
        }
        Ok(player)
    }

    fn begin(&self, playing: &mut Playing) -> Result<(), TreeError> {
        let values = vec![[[0.0; 2]; 3]; self.commands.len()];
        let times = [f64::NAN; 3];
        let Playing { state, followers, .. } = playing;
        let heard = Heard { player: self, followers, times, values: &values, propellers: &[] };
        Rule::new(&self.reduced, &self.reduced.tree)?.begin(&self.reduced, state, &heard)
    }

    /// How many quantities are measured.
    #[must_use]
    pub fn n_quantities(&self) -> usize {
        self.columns.len()
    }

    /// A motion at its start.
    #[must_use]
    pub fn playing(&self) -> Playing {
        let followers = vec![Follower::new(); self.commands.len()];
        let state = self.start.clone();
        let memories = self.reduced.propellers.iter().map(Propeller::memory).collect();
        let mut playing = Playing { state, n_steps: 0, followers, angles: Vec::new(), memories };
        let bodies = bodies_after(&self.reduced, &playing.state, self.step, &|_| None, false);
        playing.angles = bodies.iter().map(|body| body.angle).collect();
        playing
    }

    /// Whether a motion of this player may go on in another one.
    #[must_use]
    pub fn is_like(&self, other: &Self) -> bool {
        let n = |player: &Self| (player.start.velocities.len(), player.reduced.parts.len());
        n(self) == n(other)
            && self.waits == other.waits
            && self.pushes == other.pushes
            && self.reduced.has_inertia == other.reduced.has_inertia
    }

    /// Asks for a target of a command, by its number, from now on.
    pub fn ask(&self, playing: &mut Playing, command: usize, target: f64) {
        let time = playing.state.time;
        playing.followers[command].ask(&self.commands[command], time, target);
    }

    /// Makes steps; `sample` is the number of this player among those the scratch is used for.
    ///
    /// # Errors
    /// When a step fails, or a number is no number any more. The motion is of no use then.
    pub fn advance(
        &self,
        playing: &mut Playing,
        scratch: &mut Scratch,
        sample: usize,
        n_steps: usize,
    ) -> Result<(), ReducedError> {
        let slot = if self.reduced.has_inertia { 0 } else { sample };
        if scratch.rules.len() <= slot {
            scratch.rules.resize_with(slot + 1, || None);
        }
        if scratch.propellers.len() <= sample {
            scratch.propellers.resize(sample + 1, None);
        }
        let Scratch { rules, propellers, values, before } = scratch;
        let rule = match &mut rules[slot] {
            Some(rule) => rule,
            empty => empty.insert(Rule::new(&self.reduced, &self.reduced.tree)?),
        };
        let propellers = propellers[sample].get_or_insert_with(|| self.reduced.propellers.clone());
        for (one, memory) in propellers.iter_mut().zip(&playing.memories) {
            one.remember(memory);
        }
        for nth in 0..n_steps {
            if self.needs.accelerations && nth + 1 == n_steps {
                *before = self.moving(playing, false);
            }
            let end = self.step * (playing.n_steps + 1) as f64;
            let (start, step) = (playing.state.time, end - playing.state.time);
            let times = [start, start + 0.5 * step, start + step];
            values.clear();
            values.extend(
                self.commands
                    .iter()
                    .zip(&playing.followers)
                    .map(|(command, follower)| times.map(|time| follower.at(command, time))),
            );
            for (one, push) in propellers.iter_mut().zip(&self.pushes) {
                // A step of one length: what a lag goes on by is made for that, whoever shares it
                match push {
                    Some(nth) => one.advance_by(values[*nth][1][0], self.step),
                    None => one.advance(start, self.step),
                }
            }
            let Playing { state, followers, .. } = playing;
            let heard = Heard { player: self, followers, times, values, propellers };
            rule.step(&self.reduced, &self.reduced.tree, state, step, &heard)?;
            state.time = end;
            playing.n_steps += 1;
        }
        for (memory, one) in playing.memories.iter_mut().zip(propellers.iter()) {
            *memory = one.memory();
        }
        let state = &playing.state;
        let place = state.root.position.iter().chain(&state.root.quaternion);
        let all = place.chain(&state.coordinates).chain(&state.velocities);
        if all.into_iter().all(|value| value.is_finite()) {
            return Ok(());
        }
        Err(TreeError::BlowUp { time: state.time }.into())
    }

    fn moving(&self, playing: &Playing, has_loads: bool) -> Vec<Moving> {
        let last = |body: usize| {
            let angle = *playing.angles.get(body)?;
            Some(Last { angle, velocity: nalgebra::Vector3::zeros() })
        };
        bodies_after(&self.reduced, &playing.state, self.step, &last, has_loads)
    }

    /// What the motor of a joint does besides what it begins with, where it waits for a command.
    fn motor(&self, playing: &Playing, link: usize) -> f64 {
        match (self.waits[link], &self.reduced.told[link]) {
            (Some(nth), Told::Effort(_)) => {
                let command = &self.commands[nth];
                playing.followers[nth].at(command, playing.state.time)[0] - command.start
            }
            _ => 0.0,
        }
    }

    /// Quantities at present, in the order they were asked for.
    pub fn measure(&self, playing: &mut Playing, scratch: &mut Scratch, row: &mut [f64]) {
        self.measured(playing, scratch, row);
    }

    /// The number of a quantity that is known of a flow alone, if there is one.
    fn measured(
        &self,
        playing: &mut Playing,
        scratch: &mut Scratch,
        row: &mut [f64],
    ) -> Option<usize> {
        let mut now =
            if self.needs.bodies { self.moving(playing, self.needs.loads) } else { Vec::new() };
        for (nth, body) in now.iter_mut().enumerate() {
            playing.angles[nth] = body.angle;
            let before = scratch.before.get(nth).filter(|_| playing.n_steps > 0);
            body.acceleration = before.map_or_else(nalgebra::Vector3::zeros, |before| {
                (body.twist.linear - before.twist.linear) / self.step
            });
        }
        let mut missing = None;
        for (nth, (column, place)) in self.columns.iter().zip(row).enumerate() {
            let value = match column.source {
                Source::Body(body, quantity) => now[body].value(quantity),
                Source::Joint(joint_number, quantity) => {
                    let link = self.below[joint_number];
                    let value = joint(&self.reduced, &playing.state, link, quantity);
                    let more = self.motor(playing, link);
                    let value = match quantity {
                        JointQuantity::Torque | JointQuantity::Force => value + more,
                        JointQuantity::Power => {
                            let rate = JointQuantity::Rate;
                            value + more * joint(&self.reduced, &playing.state, link, rate)
                        }
                        _ => value,
                    };
                    Some(Value::Scalar(value))
                }
                Source::Swimmer(swimmer, quantity) => {
                    Now::of(&self.swimmers[swimmer], &self.reduced, &now).value(quantity)
                }
                Source::Probe(..)
                | Source::Tracer(..)
                | Source::Scalar(..)
                | Source::ScalarSurface(..)
                | Source::ScalarProbe(..)
                | Source::Flow(_)
                | Source::Side(..) => None,
            };
            match value {
                Some(value) => *place = value.component(column.component),
                None => missing = missing.or(Some(nth)),
            }
        }
        missing
    }
}

fn needs(columns: &[Column]) -> Needs {
    let mut needs = Needs::default();
    for column in columns {
        match column.source {
            Source::Body(_, quantity) => {
                needs.bodies = true;
                needs.loads |= matches!(
                    quantity,
                    BodyQuantity::Force | BodyQuantity::Torque | BodyQuantity::Power
                );
                needs.accelerations |= quantity == BodyQuantity::Acceleration;
            }
            Source::Swimmer(_, quantity) => {
                needs.bodies = true;
                needs.loads |= matches!(
                    quantity,
                    SwimmerQuantity::Force
                        | SwimmerQuantity::Torque
                        | SwimmerQuantity::Power
                        | SwimmerQuantity::ShapePower
                );
            }
            Source::Joint(..)
            | Source::Probe(..)
            | Source::Tracer(..)
            | Source::Scalar(..)
            | Source::ScalarSurface(..)
            | Source::ScalarProbe(..)
            | Source::Flow(_)
            | Source::Side(..) => {}
        }
    }
    needs
}
