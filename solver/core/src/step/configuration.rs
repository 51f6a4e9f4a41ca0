//! `StepConfiguration`: mesh and bodies for which the flow of a step is solved; `StepEquations`: of that flow.

use alewife_mesh::{Mesh, Point};

use super::context::StepContext;
use super::error::StepError;
use super::history::StepHistory;
use super::newton::FlowEquations;
use super::workspace::Workspace;
use crate::algebra::AffineConstraints;
use crate::body::Pose;
use crate::case::Convection as ConvectionChoice;
use crate::coupling::{BodiesAt, Configuration, MeanFlowAt, Problem, RigidBodyEquations, Solution};
use crate::flow::{Convection, FlowTerms};

/// Mesh and bodies in one iteration for the poses.
pub(super) struct StepConfiguration<const D: usize> {
    /// Poses of the bodies, in the laboratory.
    pub poses: Vec<Pose>,
    /// Positions of the nodes seen from the frame (m).
    pub nodes: Vec<Point<D>>,
    /// Velocity of the nodes seen from the frame (m/s); none where it makes no difference.
    mesh_velocity: Vec<Point<D>>,
    /// Boundary conditions and bodies.
    pub constraints: AffineConstraints,
    /// Newton's and Euler's equations.
    pub bodies: RigidBodyEquations,
    /// What is given of the mean flow.
    mean_flow: MeanFlowAt<D>,
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

impl<const D: usize> StepContext<'_, D> {
    /// Puts mesh and bodies where bodies have these poses, the mesh in `work` as well.
    ///
    /// # Errors
    /// When the equation of mesh motion cannot be solved, or a cell degenerates.
    pub fn place(
        &self,
        work: &mut Workspace<D>,
        poses: Vec<Pose>,
    ) -> Result<StepConfiguration<D>, StepError> {
        let Self { stepper, state, history, .. } = self;
        let problem = stepper.problem;
        let nodes = stepper.path.move_mesh(work, problem, state, &poses, &history.shapes)?;
        if !stepper.path.is_fixed() {
            work.system.move_to(problem, &work.mesh);
        }
        let in_mesh = state.in_mesh(&poses);
        let bodies = BodiesAt { poses: &in_mesh, shapes: history.boundary_shapes() };
        let constraints = work.system.constraints(problem, &work.mesh, bodies);
        work.system.fit_to(problem, &work.mesh, &constraints);
        Ok(StepConfiguration {
            constraints,
            mesh_velocity: self.mesh_velocity(&nodes),
            bodies: history.body_equations(problem, &poses),
            mean_flow: problem.mean_flow_at(history.boundary_shapes().time()),
            nodes,
            poses,
        })
    }

    /// The backward difference of the positions of the nodes (m/s); none where it makes no difference.
    fn mesh_velocity(&self, nodes: &[Point<D>]) -> Vec<Point<D>> {
        let Self { stepper, state, history, .. } = self;
        if stepper.path.is_fixed() || !stepper.problem.has_inertia {
            return Vec::new();
        }
        let bdf = &history.step.bdf;
        let levels = nodes.iter().zip(&state.nodes).zip(&state.nodes_before);
        levels.map(|((next, now), before)| bdf.rate(*next, *now, *before)).collect()
    }
}

/// The equations of the flow on one configuration.
pub(super) struct StepEquations<'a, const D: usize> {
    pub problem: &'a Problem<D>,
    pub convection: ConvectionChoice,
    pub history: &'a StepHistory<D>,
    pub configuration: &'a StepConfiguration<D>,
}

impl<const D: usize> StepEquations<'_, D> {
    /// Whether one linear system gives the flow.
    pub fn is_linear(&self) -> bool {
        !(self.convection == ConvectionChoice::Newton && self.problem.has_convection)
    }
}

impl<const D: usize> FlowEquations<D> for StepEquations<'_, D> {
    fn convecting_velocity(&self, solution: &Solution<D>) -> Vec<Point<D>> {
        let mesh_velocity = &self.configuration.mesh_velocity;
        let mut convecting: Vec<Point<D>> = if !self.problem.has_convection {
            vec![Point::<D>::zeros(); mesh_velocity.len()]
        } else if self.is_linear() {
            let frame = self.history.frame_velocity;
            self.history.extrapolated.velocity.iter().map(|u| u - frame).collect()
        } else {
            let frame = self.problem.frame_velocity(&solution.twists);
            solution.velocity.iter().map(|u| u - frame).collect()
        };
        convecting.iter_mut().zip(mesh_velocity).for_each(|(u, w)| *u -= w);
        convecting
    }

    fn terms<'a>(&'a self, convecting_velocity: &'a [Point<D>]) -> FlowTerms<'a, D> {
        let convection = if convecting_velocity.is_empty() {
            Convection::None
        } else if self.is_linear() {
            Convection::Oseen
        } else {
            self.problem.newton_convection()
        };
        FlowTerms {
            viscosity: self.problem.viscosity,
            density: self.problem.density,
            rate: self.history.step.bdf.next,
            history: &self.history.derivative,
            convecting_velocity,
            convection,
            body_force: self.problem.body_force,
        }
    }
}
