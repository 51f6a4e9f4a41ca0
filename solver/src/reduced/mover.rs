//! `Mover`: what moves the tree of a case from step to step.

use alewife_interrupt::{Stopped, is_requested};
use alewife_reduced::tree::{
    Command, Connection, Drift, Inputs, Number, Scheme, State, Stepper, Tree, TreeError, Twist,
    compiled::Compiled, magnus, real,
};

use super::acting::{Acting, Asked};
use super::build::Reduced;
use super::inputs::pushes::Propeller;

/// By which equations a tree moves.
pub(super) enum Rule<T: Number> {
    /// Steps with inertia.
    Steps(Box<Stepper<T>>),
    /// The balance of forces without.
    Drift(Box<Drift<T>>),
    /// The table of a connection.
    Table,
}

impl<T: Compiled> Rule<T> {
    /// That of a case.
    ///
    /// # Errors
    /// `TreeError` when nothing resists a motion.
    pub fn new(reduced: &Reduced, tree: &Tree<T>) -> Result<Self, TreeError> {
        Ok(if reduced.connection.is_some() {
            Self::Table
        } else if reduced.has_inertia {
            Self::Steps(Box::new(Stepper::new(tree, Scheme::Midpoint)))
        } else {
            Self::Drift(Box::new(Drift::new(tree.clone())?))
        })
    }

    /// Finds the velocities of a state, where there is no inertia: they follow from where the joints are.
    ///
    /// # Errors
    /// `TreeError` when a joint is outside of a table.
    pub fn begin(
        &mut self,
        reduced: &Reduced,
        state: &mut State<T>,
        inputs: &impl Inputs<T>,
    ) -> Result<(), TreeError> {
        let time = state.time;
        match (self, &reduced.connection) {
            (Self::Table, Some((table, links))) => {
                connect(reduced, table, links, state, &|link| inputs.command(time, link))?;
            }
            (Self::Drift(drift), _) => {
                drift.twist(state, time, inputs)?;
            }
            _ => {}
        }
        Ok(())
    }

    /// Advances a state by a step (s); its time stays.
    ///
    /// # Errors
    /// `TreeError` when the step fails.
    pub fn step(
        &mut self,
        reduced: &Reduced,
        tree: &Tree<T>,
        state: &mut State<T>,
        step: T,
        inputs: &dyn Inputs<T>,
    ) -> Result<(), TreeError> {
        match (self, &reduced.connection) {
            (Self::Steps(stepper), _) => T::advance(stepper, tree, state, step, inputs),
            (Self::Drift(drift), _) => T::drift(drift, state, step, inputs),
            (Self::Table, Some((table, links))) => {
                let (root, time) = (state.root, state.time);
                let mut twist = |at: f64| {
                    connect(reduced, table, links, state, &|link| inputs.command(at, link))
                };
                let moved = magnus(&root, time, step, &mut twist)?;
                twist(time + step.re())?;
                state.root = moved;
                Ok(())
            }
            (Self::Table, None) => Ok(()),
        }
    }
}

/// What moves a tree, with what its thrusters remember.
pub(super) struct Mover<'a, T: Number> {
    tree: Tree<T>,
    rule: Rule<T>,
    propellers: Vec<Propeller>,
    asked: Option<Asked<'a, T>>,
    /// What all times are multiplied by: 1, with the derivatives that times have.
    pace: T,
}

impl<'a, T: Compiled> Mover<'a, T> {
    /// Of a tree of a case in the state that it starts from, whose velocities it finds where there is no inertia.
    ///
    /// # Errors
    /// `TreeError` when nothing resists a motion, or a joint is outside of a table.
    pub fn new(reduced: &Reduced, tree: Tree<T>, state: &mut State<T>) -> Result<Self, TreeError> {
        Self::asked(reduced, tree, state, None, real(1.0))
    }

    /// The same where joints are asked for something else, and times have derivatives.
    ///
    /// # Errors
    /// Those of [`Self::new`].
    pub fn asked(
        reduced: &Reduced,
        tree: Tree<T>,
        state: &mut State<T>,
        asked: Option<Asked<'a, T>>,
        pace: T,
    ) -> Result<Self, TreeError> {
        let propellers = reduced.propellers.clone();
        let acting = Acting { reduced, propellers: &propellers, asked };
        let mut rule = Rule::new(reduced, &tree)?;
        rule.begin(reduced, state, &acting)?;
        Ok(Self { tree, rule, propellers, asked, pace })
    }

    /// The tree it moves.
    pub fn tree(&self) -> &Tree<T> {
        &self.tree
    }

    /// Advances a state to a time (s).
    ///
    /// # Errors
    /// `TreeError` when the step fails, or it is to make none any more.
    pub fn step(
        &mut self,
        reduced: &Reduced,
        state: &mut State<T>,
        end: f64,
    ) -> Result<(), TreeError> {
        if is_requested() {
            return Err(Stopped.into());
        }
        let step = end - state.time;
        for propeller in &mut self.propellers {
            propeller.advance(state.time, step);
        }
        let acting = Acting { reduced, propellers: &self.propellers, asked: self.asked };
        self.rule.step(reduced, &self.tree, state, self.pace * step, &acting)?;
        state.time = end;
        Ok(())
    }
}

/// The twist of the root by a table and commands, with all coordinates and velocities of the state as they are then.
fn connect<T: Number>(
    reduced: &Reduced,
    table: &Connection,
    links: &[usize],
    state: &mut State<T>,
    asked: &dyn Fn(usize) -> Command<T>,
) -> Result<Twist<T>, TreeError> {
    let (mut places, mut rates) = (Vec::new(), Vec::new());
    for link in links {
        let command = asked(*link);
        places.push(command.place);
        rates.push(command.rate);
        if let Some(velocity) = reduced.tree.velocity_of(*link) {
            state.coordinates[velocity] = command.place;
            state.velocities[velocity] = command.rate;
        }
    }
    let twist = table.twist(&places, &rates)?;
    let (v, w) = (twist.linear, twist.angular);
    let velocities = if reduced.tree.n_root() == 3 {
        vec![v.x, v.y, w.z]
    } else {
        vec![v.x, v.y, v.z, w.x, w.y, w.z]
    };
    state.velocities[..velocities.len()].copy_from_slice(&velocities);
    Ok(twist)
}
