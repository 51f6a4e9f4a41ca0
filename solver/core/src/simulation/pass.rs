//! `Pass`: the configuration of mesh and bodies for which the flow of a step is solved.

use alewife_mesh::{Mesh, Point};

use super::history::StepHistory;
use super::newton::FlowEquations;
use super::state::State;
use super::stepper::TimeStepper;
use super::workspace::Workspace;
use crate::algebra::AffineConstraints;
use crate::body::Pose;
use crate::case::Convection as ConvectionChoice;
use crate::coupling::{BodiesAt, Configuration, MeanFlowAt, Problem, RigidBodyEquations, Solution};
use crate::flow::{Convection, FlowTerms};

/// Where mesh and bodies are put.
#[derive(Debug, Clone)]
pub struct Placement<const D: usize> {
    /// Positions of the nodes seen from the frame (m).
    pub nodes: Vec<Point<D>>,
    /// Poses of the bodies, in the laboratory.
    pub poses: Vec<Pose>,
}

/// Mesh and bodies of one pass.
pub struct Pass<const D: usize> {
    /// Poses of the bodies, in the laboratory.
    pub poses: Vec<Pose>,
    /// Velocity of the nodes seen from the frame (m/s); none where it makes no difference.
    pub mesh_velocity: Vec<Point<D>>,
    /// Boundary conditions and bodies.
    pub constraints: AffineConstraints,
    /// Newton's and Euler's equations.
    pub bodies: RigidBodyEquations,
    /// What is given of the mean flow.
    pub mean_flow: MeanFlowAt<D>,
}

impl<const D: usize> Pass<D> {
    /// With mesh and bodies placed, the mesh in `work` as well.
    pub fn new(
        stepper: &TimeStepper<'_, D>,
        work: &mut Workspace<D>,
        state: &State<D>,
        history: &StepHistory<D>,
        placement: Placement<D>,
    ) -> Self {
        let problem = stepper.problem;
        let Placement { nodes, poses } = placement;
        if !stepper.path.is_fixed() {
            work.system.move_to(problem, &work.mesh);
        }
        let in_mesh = state.in_mesh(&poses);
        let bodies = BodiesAt { poses: &in_mesh, shapes: history.boundary_shapes() };
        let constraints = work.system.constraints(problem, &work.mesh, bodies);
        work.system.fit_to(problem, &work.mesh, &constraints);
        let mesh_velocity = if stepper.path.is_fixed() || !problem.has_inertia {
            Vec::new()
        } else {
            let older = state.nodes.iter().zip(&state.nodes_before);
            let bdf = &history.step.bdf;
            nodes
                .iter()
                .zip(older)
                .map(|(next, (now, before))| bdf.rate(*next, *now, *before))
                .collect()
        };
        Self {
            constraints,
            bodies: history.body_equations(problem, &poses),
            mean_flow: problem.mean_flow_at(history.boundary_shapes().time()),
            poses,
            mesh_velocity,
        }
    }

    /// All that defines the linear system.
    pub fn at<'a>(&'a self, problem: &'a Problem<D>, mesh: &'a Mesh<D>) -> Configuration<'a, D> {
        let Self { constraints, bodies, mean_flow, .. } = self;
        Configuration { problem, mesh, constraints, bodies, mean_flow: *mean_flow }
    }
}

/// The equations of the flow in one pass.
pub(super) struct PassEquations<'a, const D: usize> {
    pub problem: &'a Problem<D>,
    pub convection: ConvectionChoice,
    pub history: &'a StepHistory<D>,
    pub pass: &'a Pass<D>,
}

impl<'a, const D: usize> PassEquations<'a, D> {
    /// Those of a stepper.
    pub fn new(
        stepper: &TimeStepper<'a, D>,
        history: &'a StepHistory<D>,
        pass: &'a Pass<D>,
    ) -> Self {
        Self { problem: stepper.problem, convection: stepper.convection, history, pass }
    }

    /// Whether one linear system gives the flow.
    pub fn is_linear(&self) -> bool {
        !(self.convection == ConvectionChoice::Newton && self.problem.has_convection)
    }
}

impl<const D: usize> FlowEquations<D> for PassEquations<'_, D> {
    fn convecting_velocity(&self, solution: &Solution<D>) -> Vec<Point<D>> {
        let mesh_velocity = &self.pass.mesh_velocity;
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
