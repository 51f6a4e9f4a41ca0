//! `StepConfiguration`: mesh and bodies for which the flow of a step is solved; `StepEquations`: of that flow.

use alewife_mesh::{Mesh, Point};

use super::history::StepHistory;
use super::newton::FlowEquations;
use super::placement::Placement;
use crate::algebra::AffineConstraints;
use crate::case::Convection as ConvectionChoice;
use crate::coupling::{Configuration, MeanFlowAt, Problem, RigidBodyEquations, Solution};
use crate::flow::{Convection, FlowTerms};

/// Mesh and bodies in one iteration for the poses.
pub(super) struct StepConfiguration<const D: usize> {
    /// Where bodies are.
    pub placement: Placement,
    /// Positions of the nodes seen from the frame (m).
    pub nodes: Vec<Point<D>>,
    /// Velocity of the nodes seen from the frame (m/s); none where it makes no difference.
    pub mesh_velocity: Vec<Point<D>>,
    /// Boundary conditions and bodies.
    pub constraints: AffineConstraints,
    /// Newton's and Euler's equations.
    pub bodies: RigidBodyEquations,
    /// What is given of the mean flow.
    pub mean_flow: MeanFlowAt<D>,
}

impl<const D: usize> StepConfiguration<D> {
    /// All that defines the linear system.
    pub fn system<'a>(
        &'a self,
        problem: &'a Problem<D>,
        mesh: &'a Mesh<D>,
    ) -> Configuration<'a, D> {
        let Self { constraints, bodies, mean_flow, .. } = self;
        Configuration { problem, mesh, constraints, bodies, mean_flow: *mean_flow }
    }
}

/// The equations of the flow on one configuration.
pub(super) struct StepEquations<'a, const D: usize> {
    pub problem: &'a Problem<D>,
    pub convection: ConvectionChoice,
    pub history: &'a StepHistory<D>,
    pub configuration: &'a StepConfiguration<D>,
    /// Whether bodies may be in contact.
    pub has_contact: bool,
}

impl<const D: usize> StepEquations<'_, D> {
    /// Whether one linear system gives flow and bodies.
    pub fn is_linear(&self) -> bool {
        self.has_linear_flow() && self.problem.n_coordinates() == 0
    }

    /// Whether only equations of coordinates are not linear.
    pub fn has_linear_flow(&self) -> bool {
        !self.convects_by_newton() && !self.shears_by_newton()
    }

    fn convects_by_newton(&self) -> bool {
        self.convection == ConvectionChoice::Newton && self.problem.has_convection
    }

    /// Whether a viscosity that depends on the rate of shear is that of the flow itself: always of a flow without a past.
    pub fn shears_by_newton(&self) -> bool {
        let has_past = !self.history.extrapolated.velocity.is_empty();
        !self.problem.viscosity.is_newtonian()
            && (self.convection == ConvectionChoice::Newton || !has_past)
    }
}

impl<const D: usize> FlowEquations<D> for StepEquations<'_, D> {
    fn on_iteration(&self, iteration: usize, residual: f64) {
        tracing::debug!(iteration, residual, "newton");
    }

    fn convecting_velocity(&self, solution: &Solution<D>) -> Vec<Point<D>> {
        let mesh_velocity = &self.configuration.mesh_velocity;
        let mut convecting: Vec<Point<D>> = if !self.problem.has_convection {
            vec![Point::<D>::zeros(); mesh_velocity.len()]
        } else if !self.convects_by_newton() {
            let frame = self.history.frame_velocity;
            self.history.extrapolated.velocity.iter().map(|u| u - frame).collect()
        } else {
            let frame = self.problem.frame_velocity(&solution.twists);
            solution.velocity.iter().map(|u| u - frame).collect()
        };
        convecting.iter_mut().zip(mesh_velocity).for_each(|(u, w)| *u -= w);
        convecting
    }

    fn terms<'a>(
        &'a self,
        convecting_velocity: &'a [Point<D>],
        solution: &'a Solution<D>,
    ) -> FlowTerms<'a, D> {
        let convection = if convecting_velocity.is_empty() {
            Convection::None
        } else if !self.convects_by_newton() {
            Convection::Oseen
        } else {
            self.problem.newton_convection()
        };
        // Linearised about the extrapolated strain, or about that of the flow itself: a step of Newton's method from there.
        // In contact velocities jump from step to step, and a linearised stress may drive the flow
        let sheared = if self.shears_by_newton() {
            &solution.velocity
        } else {
            &self.history.extrapolated.velocity
        };
        let has_tangent = self.shears_by_newton() || !self.has_contact;
        FlowTerms {
            viscosity: self.problem.viscosity_at(sheared, has_tangent),
            density: self.problem.density,
            rate: self.history.step.bdf.next,
            history: &self.history.derivative,
            convecting_velocity,
            convection,
        }
    }
}
