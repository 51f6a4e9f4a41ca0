//! What acts on a tree besides the fluid: joints that are told, forces from outside, thrusters.

use alewife_reduced::tree::{Command, Inputs, Number, Wrench, real};
use nalgebra::Matrix3;

use super::build::Reduced;
use super::inputs::pushes::Propeller;

/// What joints are asked for at a time, by the numbers of their links, in place of what the case alone says.
pub(super) type Asked<'a, T> = &'a dyn Fn(f64, usize) -> Command<T>;

/// All that acts on a tree over a step.
pub(super) struct Acting<'a, T: Number> {
    pub reduced: &'a Reduced,
    pub propellers: &'a [Propeller],
    /// What joints are asked for, where it has derivatives.
    pub asked: Option<Asked<'a, T>>,
}

impl<T: Number> Inputs<T> for Acting<'_, T> {
    fn command(&self, time: f64, link: usize) -> Command<T> {
        if let Some(asked) = self.asked {
            return asked(time, link);
        }
        let Command { place, rate, effort } = self.reduced.command(time, link);
        Command { place: real(place), rate: real(rate), effort: real(effort) }
    }

    fn wrench(&self, time: f64, link: usize, rotation: &Matrix3<T>) -> Option<Wrench<T>> {
        let pulls = self.reduced.pulls.iter().filter(|pull| pull.link == link);
        let pushes = self.propellers.iter().filter(|one| one.link == link);
        let lifted = |one: &Propeller| Wrench {
            force: one.wrench.force.map(real::<T>),
            torque: one.wrench.torque.map(real::<T>),
        };
        let all = pulls.map(|pull| pull.wrench(time, rotation)).chain(pushes.map(lifted));
        all.reduce(|sum, one| sum.plus(&one, real(1.0)))
    }
}
