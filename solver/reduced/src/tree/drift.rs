//! `Drift`: a tree without inertia whose joints are all given: its root goes where no force is left.

use super::connection::magnus;
use super::equations::{Equations, Inputs, Stage, singular};
use super::error::TreeError;
use super::link::Drive;
use super::spatial::{Number, Symmetric, Twist, real};
use super::state::State;
use super::step::root_twist;
use super::topology::Tree;

/// A tree in Stokes flow, with the scratch its equations need. The laws of loads have to be linear.
#[derive(Debug, Clone)]
pub struct Drift<T: Number> {
    tree: Tree<T>,
    equations: Equations<T>,
    stage: Stage<T>,
}

impl<T: Number> Drift<T> {
    /// The same tree without masses.
    ///
    /// # Errors
    /// `TreeError::Link` when a joint is not given: it takes masses or springs, and a stepper.
    pub fn new(mut tree: Tree<T>) -> Result<Self, TreeError> {
        tree.masses.fill(Symmetric::zero());
        for link in tree.moved[tree.n_root()..].iter().copied() {
            if tree.links[link].joint.drive != Drive::Given {
                let what = "its joint is not given, so that it takes a step with masses".to_owned();
                return Err(TreeError::Link { link, what });
            }
        }
        let zeros = vec![real(0.0); tree.n_velocities()];
        let (shift, lag) = (zeros.clone(), zeros);
        let stage = Stage { implicit: real(1.0), shift, lag, is_late: false };
        Ok(Self { equations: Equations::new(&tree), tree, stage })
    }

    /// The tree.
    #[must_use]
    pub fn tree(&self) -> &Tree<T> {
        &self.tree
    }

    /// The twist of the root in its frame with its joints as commanded at a time, and in `state` all velocities,
    /// coordinates and what the joints take then. Where the root is does not matter.
    ///
    /// # Errors
    /// `TreeError::Singular` when nothing resists a motion of the root.
    pub fn twist(
        &mut self,
        state: &mut State<T>,
        time: f64,
        inputs: &impl Inputs<T>,
    ) -> Result<Twist<T>, TreeError> {
        let n_root = self.tree.n_root();
        for velocity in n_root..self.tree.n_velocities() {
            let command = inputs.command(time, self.tree.moved[velocity]);
            state.coordinates[velocity] = command.place;
            state.velocities[velocity] = command.rate;
        }
        state.velocities[..n_root].fill(real(0.0));
        let placed = std::mem::replace(&mut state.root, super::placement::Placement::identity());
        // Resistances are linear: with the change of velocities that ends the forces they are ended exactly
        self.equations.assemble(&self.tree, state, &self.stage, inputs);
        state.root = placed;
        let mut changes = vec![real(0.0); self.tree.n_velocities()];
        self.equations
            .solve(&self.tree, real(1.0), &mut changes, &mut state.efforts)
            .map_err(|coordinate| singular(time, coordinate))?;
        state.velocities[..n_root].copy_from_slice(&changes[..n_root]);
        Ok(root_twist(self.tree.root, &changes))
    }

    /// Advances a state by a step (s), at fourth order.
    ///
    /// # Errors
    /// `TreeError::Singular` when nothing resists a motion of the root.
    pub fn step(
        &mut self,
        state: &mut State<T>,
        step: T,
        inputs: &impl Inputs<T>,
    ) -> Result<(), TreeError> {
        let (root, time) = (state.root, state.time);
        let moved = magnus(&root, time, step, |at| self.twist(state, at, inputs))?;
        state.time = time + step.re();
        state.root = moved;
        let end = state.time;
        self.twist(state, end, inputs)?;
        Ok(())
    }
}
