//! Tracks of bodies by the reduced model, and the coefficients that make them those of records.

use alewife_reduced::tree::compiled::Compiled;
use alewife_reduced::tree::{Dual64, Number, Pose, Residuals, Tree, TreeError, real};
use rayon::prelude::*;

use super::record::Record;
use super::sought::Sought;
use crate::reduced::lift;
use crate::reduced::mover::Mover;
use crate::reduced::part::pose;

/// Tracks of some records.
pub struct Swims<'a> {
    pub records: &'a [&'a Record],
    pub sought: &'a Sought,
}

impl Swims<'_> {
    fn left<T: Compiled>(&self, parameters: &[T]) -> Result<Vec<T>, TreeError> {
        // Each by itself: the sum is in their order
        let of_each: Result<Vec<Vec<T>>, TreeError> =
            self.records.par_iter().map(|record| self.left_of(record, parameters)).collect();
        Ok(of_each?.concat())
    }

    fn left_of<T: Compiled>(&self, record: &Record, parameters: &[T]) -> Result<Vec<T>, TreeError> {
        let found: Vec<f64> = parameters.iter().map(|one| one.re()).collect();
        let record = &*record.at(self.sought, &found)?;
        let made = motion(record, |body, own| self.sought.filled(body, own, parameters))?;
        let mut left = Vec::new();
        for (track, made) in record.tracks.iter().zip(made) {
            let lever = if track.axis == 3 { lever(record) } else { 1.0 };
            let rows = made.iter().zip(&track.values);
            left.extend(rows.map(|(made, seen)| (*made - *seen) * lever));
        }
        Ok(left)
    }
}

impl Residuals for Swims<'_> {
    fn residuals(&self, parameters: &[Dual64]) -> Result<Vec<Dual64>, TreeError> {
        self.left(parameters)
    }

    fn differences(&self) -> Option<f64> {
        self.sought.differences
    }

    fn values(&self, parameters: &[f64]) -> Result<Vec<f64>, TreeError> {
        self.left(parameters)
    }
}

/// What a radian of an angle weighs (m): half the size of the swimmer.
pub fn lever(record: &Record) -> f64 {
    let poses = record.reduced.tree.poses(&record.reduced.start);
    let at = |k: usize| {
        let part = &record.reduced.parts[k];
        poses[part.link].then(&part.inside).position
    };
    let size = (0..record.reduced.parts.len()).fold(0.0_f64, |most, k| {
        let reach = record.reduced.parts[k].law.reach();
        most.max((at(k) - at(0)).norm() + reach)
    });
    0.5 * size
}

/// Tracks at the times of a record by the model with other coefficients, in between linear over its steps.
pub fn motion<T: Compiled>(
    record: &Record,
    coefficients: impl Fn(usize, &[f64]) -> Vec<T>,
) -> Result<Vec<Vec<T>>, TreeError> {
    let reduced = &record.reduced;
    let tree = reduced.tree_with(coefficients)?;
    let mut state = lift::state(&reduced.start);
    let mut mover = Mover::new(reduced, tree.clone(), &mut state)?;
    let step = record.step();
    let mut made: Vec<Vec<T>> = vec![Vec::new(); record.tracks.len()];
    let mut now = places(record, &tree, &state, None);
    let mut before = (0.0, now.clone());
    let mut number = 0.0;
    for time in &record.times {
        while state.time < time - 1e-9 * step {
            before = (state.time, now.clone());
            number += 1.0;
            mover.step(reduced, &mut state, step * number)?;
            now = places(record, &tree, &state, Some(&now));
        }
        let length = state.time - before.0;
        let part = if length > 0.0 { (time - before.0) / length } else { 0.0 };
        for (k, made) in made.iter_mut().enumerate() {
            made.push(before.1[k] + (now[k] - before.1[k]) * part);
        }
    }
    for made in made.iter_mut().filter(|_| record.is_relative) {
        let first = made[0];
        made.iter_mut().for_each(|value| *value -= first);
    }
    Ok(made)
}

/// Tracks at a state, angles continued from those before.
fn places<T: Number>(
    record: &Record,
    tree: &Tree<T>,
    state: &alewife_reduced::tree::State<T>,
    before: Option<&Vec<T>>,
) -> Vec<T> {
    let poses = tree.poses(state);
    let value = |(k, track): (usize, &super::record::Track)| {
        let part = &record.reduced.parts[track.body];
        let inside: Pose<T> = pose(&part.inside);
        let pose = poses[part.link].then(&inside);
        if track.axis < 3 {
            return pose.position[track.axis];
        }
        let heading = pose.rotation[(1, 0)].atan2(pose.rotation[(0, 0)]);
        let near = before.map_or(record.model.bodies[track.body].angle, |before| before[k].re());
        let turns = ((near - heading.re()) / std::f64::consts::TAU).round();
        heading + real::<T>(turns * std::f64::consts::TAU)
    };
    record.tracks.iter().enumerate().map(value).collect()
}
