//! Steps of trees of the numbers in use, and where their links are: compiled here, with all optimisation.
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
use super::{Dual64, Number};

/// Commands of any kind.
struct Any<'a, T: Number>(&'a dyn Inputs<T>);

impl<T: Number> Inputs<T> for Any<'_, T> {
    fn command(&self, time: f64, link: usize) -> Command<T> {
        self.0.command(time, link)
    }

    fn wrench(&self, time: f64, link: usize, rotation: &Matrix3<T>) -> Option<Wrench<T>> {
        self.0.wrench(time, link, rotation)
    }
}

/// Numbers for which steps are compiled here.
pub trait Compiled: Number {
    /// `Stepper::step`.
    ///
    /// # Errors
    /// As it has them.
    fn advance(
        stepper: &mut Stepper<Self>,
        tree: &Tree<Self>,
        state: &mut State<Self>,
        step: Self,
        inputs: &dyn Inputs<Self>,
    ) -> Result<(), TreeError>;

    /// `Drift::step`.
    ///
    /// # Errors
    /// As it has them.
    fn drift(
        drift: &mut Drift<Self>,
        state: &mut State<Self>,
        step: Self,
        inputs: &dyn Inputs<Self>,
    ) -> Result<(), TreeError>;

    /// Where the links of a tree are, with or without what the fluid does to them.
    fn look(tree: &Tree<Self>, state: &State<Self>, has_loads: bool) -> Looked<Self>;
}

macro_rules! compiled {
    ($($number:ty),*) => { $(
        impl Compiled for $number {
            fn advance(
                stepper: &mut Stepper<Self>,
                tree: &Tree<Self>,
                state: &mut State<Self>,
                step: Self,
                inputs: &dyn Inputs<Self>,
            ) -> Result<(), TreeError> {
                stepper.step(tree, state, step, &Any(inputs))
            }

            fn drift(
                drift: &mut Drift<Self>,
                state: &mut State<Self>,
                step: Self,
                inputs: &dyn Inputs<Self>,
            ) -> Result<(), TreeError> {
                drift.step(state, step, &Any(inputs))
            }

            fn look(tree: &Tree<Self>, state: &State<Self>, has_loads: bool) -> Looked<Self> {
                let wrenches = if has_loads { tree.fluid_wrenches(state) } else { Vec::new() };
                Looked { poses: tree.poses(state), twists: tree.twists(state), wrenches }
            }
        }
    )* };
}

compiled!(f64, Dual64);

/// Where links are, how they move, and what the fluid does to them.
#[derive(Debug, Clone)]
pub struct Looked<T: Number> {
    /// As `Tree::poses` has them.
    pub poses: Vec<Pose<T>>,
    /// As `Tree::twists` has them.
    pub twists: Vec<Twist<T>>,
    /// As `Tree::fluid_wrenches` has them; none where they are not asked for.
    pub wrenches: Vec<Wrench<T>>,
}
