//! `Mover`: what moves the tree of a case from step to step.

use alewife_interrupt::{Stopped, is_requested};
use alewife_reduced::tree::{
    Connection, Drift, Number, Scheme, State, Stepper, Tree, TreeError, Twist, compiled::Compiled,
    magnus, real,
};

use super::acting::Acting;
use super::build::Reduced;
use super::inputs::pushes::Propeller;

/// By which equations a tree moves.
enum Rule<T: Number> {
    /// Steps with inertia.
    Steps(Box<Stepper<T>>),
    /// The balance of forces without.
    Drift(Box<Drift<T>>),
    /// The table of a connection.
    Table(Connection, Vec<usize>),
}

/// What moves a tree, with what its thrusters remember.
pub(super) struct Mover<T: Number> {
    tree: Tree<T>,
    rule: Rule<T>,
    propellers: Vec<Propeller>,
}

impl<T: Compiled> Mover<T> {
    /// Of a tree of a case in the state that it starts from, whose velocities it finds where there is no inertia.
    ///
    /// # Errors
    /// `TreeError` when nothing resists a motion, or a joint is outside of a table.
    pub fn new(reduced: &Reduced, tree: Tree<T>, state: &mut State<T>) -> Result<Self, TreeError> {
        let propellers = reduced.propellers.clone();
        let acting = Acting { reduced, propellers: &propellers };
        let rule = match &reduced.connection {
            Some((table, links)) => {
                let time = state.time;
                connect(reduced, table, links, state, time)?;
                Rule::Table(table.clone(), links.clone())
            }
            None if reduced.has_inertia => {
                Rule::Steps(Box::new(Stepper::new(&tree, Scheme::Midpoint)))
            }
            None => {
                let mut drift = Drift::new(tree.clone())?;
                let time = state.time;
                drift.twist(state, time, &acting)?;
                Rule::Drift(Box::new(drift))
            }
        };
        Ok(Self { tree, rule, propellers })
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
        let acting = Acting { reduced, propellers: &self.propellers };
        match &mut self.rule {
            Rule::Steps(stepper) => T::advance(stepper, &self.tree, state, step, &acting)?,
            Rule::Drift(drift) => T::drift(drift, state, step, &acting)?,
            Rule::Table(table, links) => {
                let (root, time) = (state.root, state.time);
                let twist = |at: f64| connect(reduced, table, links, state, at);
                let moved = magnus(&root, time, step, twist)?;
                state.root = moved;
                connect(reduced, table, links, state, end)?;
            }
        }
        state.time = end;
        Ok(())
    }
}

/// The twist of the root by a table at a time, with all coordinates and velocities of the state as they are then.
fn connect<T: Number>(
    reduced: &Reduced,
    table: &Connection,
    links: &[usize],
    state: &mut State<T>,
    time: f64,
) -> Result<Twist<T>, TreeError> {
    let (mut places, mut rates) = (Vec::new(), Vec::new());
    for link in links {
        let command = reduced.command(time, *link);
        places.push(real(command.place));
        rates.push(real(command.rate));
        if let Some(velocity) = reduced.tree.velocity_of(*link) {
            state.coordinates[velocity] = real(command.place);
            state.velocities[velocity] = real(command.rate);
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
