//! `Stepper`: time steps of a tree, of first or second order, with resistances taken implicitly.

use super::equations::{Equations, Inputs, Stage, singular};
use super::error::TreeError;
use super::link::Drive;
use super::spatial::{Number, Twist, real, vector};
use super::state::State;
use super::topology::{Root, Tree};

/// A rule for steps in time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scheme {
    /// First order: velocities from loads linear about the beginning of the step and taken at its end, then
    /// coordinates from the new velocities. Stiff springs and strong drag are damped as they should be.
    Euler,
    /// Second order: the same to the middle of the step, then over it with masses and loads of the middle.
    Midpoint,
}

/// Steps of one tree, with the scratch they need.
#[derive(Debug, Clone)]
pub struct Stepper<T: Number> {
    scheme: Scheme,
    equations: Equations<T>,
    stage: Stage<T>,
    middle: Option<State<T>>,
    mean: Vec<T>,
    changes: Vec<T>,
}

impl<T: Number> Stepper<T> {
    /// A stepper of a tree.
    #[must_use]
    pub fn new(tree: &Tree<T>, scheme: Scheme) -> Self {
        let zeros = vec![real(0.0); tree.n_velocities()];
        let (shift, lag) = (zeros.clone(), zeros.clone());
        let stage = Stage { implicit: real(0.0), shift, lag, is_late: false };
        Self {
            scheme,
            equations: Equations::new(tree),
            stage,
            middle: Some(tree.rest()),
            mean: zeros.clone(),
            changes: zeros,
        }
    }

    /// Advances a state of the tree by a step (s), whose derivatives are those of all times in proportion: what is asked
    /// for at a time is asked for at its real part.
    ///
    /// # Errors
    /// `TreeError::Singular` when nothing holds a velocity, `TreeError::BlowUp` when one is no number any more;
    /// the state is then of no use.
    pub fn step(
        &mut self,
        tree: &Tree<T>,
        state: &mut State<T>,
        step: T,
        inputs: &impl Inputs<T>,
    ) -> Result<(), TreeError> {
        match self.scheme {
            Scheme::Euler => self.half(tree, state, step, inputs)?,
            Scheme::Midpoint => self.midpoint(tree, state, step, inputs)?,
        }
        tree.check_finite(state)
    }

    /// Changes of given velocities until a time (s).
    fn give(&mut self, tree: &Tree<T>, from: &[T], time: f64, inputs: &impl Inputs<T>) {
        for velocity in tree.n_root()..tree.n_velocities() {
            if tree.given[velocity] {
                let rate = inputs.command(time, tree.moved[velocity]).rate;
                self.changes[velocity] = rate - from[velocity];
            }
        }
    }

    /// A step of first order.
    fn half(
        &mut self,
        tree: &Tree<T>,
        state: &mut State<T>,
        step: T,
        inputs: &impl Inputs<T>,
    ) -> Result<(), TreeError> {
        self.stage.implicit = step;
        self.stage.is_late = false;
        for (shift, velocity) in self.stage.shift.iter_mut().zip(&state.velocities) {
            *shift = *velocity * step;
        }
        self.equations.assemble(tree, state, &self.stage, inputs);
        let time = state.time + step.re();
        self.give(tree, &state.velocities, time, inputs);
        self.equations
            .solve(tree, step, &mut self.changes, &mut state.efforts)
            .map_err(|coordinate| singular(state.time, coordinate))?;
        for (k, change) in self.changes.iter().enumerate() {
            state.velocities[k] += *change;
            state.accelerations[k] = *change / step;
        }
        self.mean.copy_from_slice(&state.velocities);
        displace(tree, state, &self.mean, step, inputs);
        Ok(())
    }

    fn midpoint(
        &mut self,
        tree: &Tree<T>,
        state: &mut State<T>,
        step: T,
        inputs: &impl Inputs<T>,
    ) -> Result<(), TreeError> {
        let mut middle = self.middle.take().unwrap_or_else(|| tree.rest());
        middle.clone_from(state);
        self.half(tree, &mut middle, step * 0.5, inputs)?;
        for k in 0..state.velocities.len() {
            let late = middle.velocities[k] - state.velocities[k];
            self.stage.lag[k] = late;
            self.stage.shift[k] = late * (step * -0.5);
        }
        self.stage.is_late = true;
        self.equations.assemble(tree, &middle, &self.stage, inputs);
        self.give(tree, &state.velocities, state.time + step.re(), inputs);
        self.equations
            .solve(tree, step, &mut self.changes, &mut state.efforts)
            .map_err(|coordinate| singular(middle.time, coordinate))?;
        for (k, change) in self.changes.iter().enumerate() {
            self.mean[k] = state.velocities[k] + *change * 0.5;
            state.velocities[k] += *change;
            state.accelerations[k] = *change / step;
        }
        displace(tree, state, &self.mean, step, inputs);
        self.middle = Some(middle);
        Ok(())
    }
}

/// The twist of the root in its frame.
pub(super) fn root_twist<T: Number>(root: Root, velocities: &[T]) -> Twist<T> {
    let mut twist = Twist { linear: vector([0.0; 3]), angular: vector([0.0; 3]) };
    match root {
        Root::Held => {}
        Root::Planar => {
            twist.linear.x = velocities[0];
            twist.linear.y = velocities[1];
            twist.angular.z = velocities[2];
        }
        Root::Free => {
            for k in 0..3 {
                twist.linear[k] = velocities[k];
                twist.angular[k] = velocities[3 + k];
            }
        }
    }
    twist
}

/// Moves coordinates by velocities over a step, given ones to where they are then.
fn displace<T: Number>(
    tree: &Tree<T>,
    state: &mut State<T>,
    velocities: &[T],
    step: T,
    inputs: &impl Inputs<T>,
) {
    state.time += step.re();
    state.root = state.root.moved(&root_twist(tree.root, velocities), step);
    for k in tree.n_root()..tree.n_velocities() {
        if tree.links[tree.moved[k]].joint.drive == Drive::Given {
            state.coordinates[k] = inputs.command(state.time, tree.moved[k]).place;
        } else {
            state.coordinates[k] += velocities[k] * step;
        }
    }
}
