//! `Solve`: what the program asks of each dimension, compiled here with all optimisation.
//!
//! Generic code is compiled in the package that names its types, and the program has little
//! optimisation: it calls the methods of this trait, whose implementations name them here.

use alewife_mesh::{Mesh, Point, Quality};
use nalgebra::Vector3;

use super::case_mesh::{CaseMesh, Dimension};
use super::resume::SavedState;
use super::run_case::{Start, run_case};
use super::session::{Observers, Session};
use super::timed_step::{TimedStep, time_step};
use super::{Observer, RunError, RunSummary};
use crate::case::Model;
use crate::flow;

/// Runs cases of a dimension, and tells of their meshes and flows.
pub trait Solve<const D: usize>: CaseMesh<D> {
    /// Runs a case to its end, from a saved state if there is one.
    ///
    /// # Errors
    /// Whatever stops the run; observers are notified before it is returned.
    fn simulate(
        model: &Model,
        start: Start<'_, D>,
        observers: &mut [Box<dyn Observer<D>>],
    ) -> Result<RunSummary, RunError>;

    /// Opens a session.
    ///
    /// # Errors
    /// As [`Session::open`].
    fn open(
        model: &Model,
        saved: Option<&SavedState<D>>,
        observers: Observers<D>,
    ) -> Result<Session<D>, RunError>;

    /// Makes the steps of a session up to a time (s).
    ///
    /// # Errors
    /// As [`Session::advance_to`].
    fn advance(session: &mut Session<D>, until: f64) -> Result<(), RunError>;

    /// How good a mesh is.
    fn quality(mesh: &Mesh<D>) -> Quality<D>;

    /// Makes one step of a case on its mesh, to see what a step takes.
    ///
    /// # Errors
    /// When the mesh does not fit into memory, or the flow at the start is not found.
    fn time_step(model: &Model, mesh: Mesh<D>) -> Result<TimedStep<D>, RunError>;

    /// Vorticity at the P2 nodes (1/s), see [`flow::nodal_vorticity`].
    fn vorticity(mesh: &Mesh<D>, velocity: &[Point<D>]) -> Vec<Vector3<f64>>;

    /// Pressure at the P2 nodes (Pa), see [`flow::nodal_pressure`].
    fn pressure(mesh: &Mesh<D>, at_vertices: &[f64]) -> Vec<f64>;
}

macro_rules! solve_in {
    ($dimension:literal) => {
        impl Solve<$dimension> for Dimension<$dimension> {
            fn simulate(
                model: &Model,
                start: Start<'_, $dimension>,
                observers: &mut [Box<dyn Observer<$dimension>>],
            ) -> Result<RunSummary, RunError> {
                run_case(model, start, observers)
            }

            fn open(
                model: &Model,
                saved: Option<&SavedState<$dimension>>,
                observers: Observers<$dimension>,
            ) -> Result<Session<$dimension>, RunError> {
                Session::begin(model, saved, observers)
            }

            fn advance(session: &mut Session<$dimension>, until: f64) -> Result<(), RunError> {
                session.make_steps(until)
            }

            fn quality(mesh: &Mesh<$dimension>) -> Quality<$dimension> {
                Quality::of(mesh)
            }

            fn time_step(
                model: &Model,
                mesh: Mesh<$dimension>,
            ) -> Result<TimedStep<$dimension>, RunError> {
                time_step(model, mesh)
            }

            fn vorticity(
                mesh: &Mesh<$dimension>,
                velocity: &[Point<$dimension>],
            ) -> Vec<Vector3<f64>> {
                flow::nodal_vorticity(mesh, velocity)
            }

            fn pressure(mesh: &Mesh<$dimension>, at_vertices: &[f64]) -> Vec<f64> {
                flow::nodal_pressure(mesh, at_vertices)
            }
        }
    };
}

solve_in!(2);
solve_in!(3);

/// Runs a case from beginning to end.
///
/// # Errors
/// Whatever stops the run; observers are notified before it is returned.
pub fn simulate<const D: usize>(
    model: &Model,
    observers: &mut [Box<dyn Observer<D>>],
) -> Result<RunSummary, RunError>
where
    Dimension<D>: Solve<D>,
{
    Dimension::<D>::simulate(model, Start::default(), observers)
}

/// Runs a case to its end, from a saved state if there is one.
///
/// # Errors
/// Whatever stops the run; observers are notified before it is returned.
pub fn simulate_from<const D: usize>(
    model: &Model,
    saved: Option<&SavedState<D>>,
    observers: &mut [Box<dyn Observer<D>>],
) -> Result<RunSummary, RunError>
where
    Dimension<D>: Solve<D>,
{
    Dimension::<D>::simulate(model, Start { saved, ..Start::default() }, observers)
}

/// Runs a case to its end while what is recorded is asked for, from a saved state if there is one.
///
/// # Errors
/// Whatever stops the run; observers are notified before it is returned.
pub fn replay<const D: usize>(
    model: &Model,
    start: Start<'_, D>,
    observers: &mut [Box<dyn Observer<D>>],
) -> Result<RunSummary, RunError>
where
    Dimension<D>: Solve<D>,
{
    Dimension::<D>::simulate(model, start, observers)
}
