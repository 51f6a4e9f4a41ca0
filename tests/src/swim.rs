//! A case stepped in time on a mesh that is given.

use alewife_core::body::Twist;
use alewife_core::case::{Convection, Model, Scheme, Steady};
use alewife_core::coupling::{Problem, SurfaceLoads};
use alewife_core::run::{Simulation, simulation_on};
use alewife_core::state::{InitialLevels, State};
use alewife_mesh::{Mesh, Point};
use nalgebra::Vector3;

use crate::steady_with;

/// A simulation on one mesh, which follows its bodies.
pub struct Swim {
    /// What is solved and what evolves.
    pub simulation: Simulation<2>,
    /// Loads of the fluid after the last step.
    pub loads: SurfaceLoads,
}

impl Swim {
    /// A case on a mesh of it, at rest at time zero.
    ///
    /// # Panics
    /// When the case makes no problem on this mesh.
    #[must_use]
    pub fn new(model: &Model, mesh: Mesh<2>) -> Self {
        let mut simulation = simulation_on(model, mesh).expect("the case is a problem");
        simulation.scheme.convection = Convection::Extrapolated;
        simulation.scheme.method =
            if simulation.problem.has_inertia { Scheme::Bdf2 } else { Scheme::Rk3 };
        let loads = SurfaceLoads::none(simulation.problem.bodies.len());
        Self { simulation, loads }
    }

    /// What is solved.
    #[must_use]
    pub fn problem(&self) -> &Problem<2> {
        &self.simulation.problem
    }

    /// What evolves.
    #[must_use]
    pub fn state(&self) -> &State<2> {
        &self.simulation.state
    }

    /// Gives fluid and bodies the same velocity (m/s).
    pub fn stream(&mut self, velocity: Point<2>) {
        let linear = Vector3::new(velocity.x, velocity.y, 0.0);
        let state = &mut self.simulation.state;
        let mut flow = state.now.clone();
        flow.velocity.fill(velocity);
        flow.twists.fill(Twist { linear, angular: Vector3::zeros() });
        state.begin(InitialLevels::steady(flow));
    }

    /// The Stokes flow at time zero.
    ///
    /// # Panics
    /// When it is not found.
    pub fn begin(&mut self) {
        let Simulation { problem, state, work, .. } = &mut self.simulation;
        let settings = Steady { tolerance: 1e-10, max_iterations: 5 };
        let flow = steady_with(work, problem, &settings, problem.has_convection);
        state.begin(InitialLevels::steady(flow.solution));
        self.loads = self.simulation.loads(&flow.residual);
    }

    /// One step (s): explicit without inertia, else by BDF2, the first one by backward Euler.
    ///
    /// # Panics
    /// When the step cannot be made.
    pub fn step(&mut self, step: f64) {
        match self.simulation.step_on_this_mesh(step) {
            Ok(report) => self.loads = report.loads,
            Err(error) => panic!("the step is made: {error}"),
        }
    }

    /// Rate of work of all bodies on the fluid (W).
    #[must_use]
    pub fn power(&self) -> f64 {
        self.loads.bodies.iter().map(|load| load.power).sum()
    }
}
