//! Steps of trees of plain numbers, and where their links are: compiled here, with all optimisation.
//!
//! What is generic is compiled where it is used, and the packages that use it are compiled in a hurry: there the same step
//! takes a hundred times as long.

use nalgebra::Matrix3;

use super::drift::Drift;
use super::equations::Inputs;
use super::error::TreeError;
use super::link::Command;
use super::spatial::{Pose, Twist, Wrench};
use super::state::State;
use super::step::Stepper;
use super::topology::Tree;

/// Commands of any kind.
struct Any<'a>(&'a dyn Inputs<f64>);

impl Inputs<f64> for Any<'_> {
    fn command(&self, time: f64, link: usize) -> Command<f64> {
        self.0.command(time, link)
    }

    fn wrench(&self, time: f64, link: usize, rotation: &Matrix3<f64>) -> Option<Wrench<f64>> {
        self.0.wrench(time, link, rotation)
    }
}

/// Where links are, how they move, and what the fluid does to them.
#[derive(Debug, Clone, Default)]
pub struct Looked {
    /// As `Tree::poses` has them.
    pub poses: Vec<Pose<f64>>,
    /// As `Tree::twists` has them.
    pub twists: Vec<Twist<f64>>,
    /// As `Tree::fluid_wrenches` has them; none where they are not asked for.
    pub wrenches: Vec<Wrench<f64>>,
}

/// `Stepper::step` of plain numbers.
///
/// # Errors
/// As it has them.
pub fn advance(
    stepper: &mut Stepper<f64>,
    tree: &Tree<f64>,
    state: &mut State<f64>,
    step: f64,
    inputs: &dyn Inputs<f64>,
) -> Result<(), TreeError> {
    stepper.step(tree, state, step, &Any(inputs))
}

/// `Drift::step` of plain numbers.
///
/// # Errors
/// As it has them.
pub fn drift(
    drift: &mut Drift<f64>,
    state: &mut State<f64>,
    step: f64,
    inputs: &dyn Inputs<f64>,
) -> Result<(), TreeError> {
    drift.step(state, step, &Any(inputs))
}

/// Where the links of a tree are, with or without what the fluid does to them.
#[must_use]
pub fn look(tree: &Tree<f64>, state: &State<f64>, has_loads: bool) -> Looked {
    Looked {
        poses: tree.poses(state),
        twists: tree.twists(state),
        wrenches: if has_loads { tree.fluid_wrenches(state) } else { Vec::new() },
    }
}
