//! One linear system for the fluid and every body in it.
//!
//! A step of Newton's method on R(x) = 0 with x = P y + g: solve P^T J P dy = -P^T R(x). On the
//! rows of the velocities of a body, P^T gathers minus the fluid's load. To those of U and omega Newton and Euler add
//! m dU/dt - F_ext and d(I omega)/dt - T_ext, to those of its coordinates its structure adds M dv/dt + f(q, v, t): no
//! interface stress, no multiplier, and no added-mass instability at any density ratio.

mod adjoint;
mod coordinates;
mod diagnosis;
mod given_loads;
mod linearise;
mod mobility;
mod net_flux;
mod nullspace;
mod numbering;
mod rate_response;
mod refine;
mod residual;
mod rigid_unknowns;
mod solver_memory;

use std::convert::Infallible;

use alewife_mesh::{Mesh, Point};

pub use self::coordinates::ForcesBeyond;
pub use self::mobility::AddedLoads;
use self::nullspace::TranslationNullspace;
use self::numbering::{Numbering, blocks_of_bodies, free_velocities};
use self::rate_response::RateResponse;
use super::boundaries::Boundaries;
use super::constrain::{BodiesAt, Constrainer};
use super::error::SolveError;
use super::linear_system::{NewSystem, SolverChoice, SystemSolver, saddle_point, system_solver};
use super::loads::{
    ResidualOnMesh, SidesAt, SurfaceLoads, SurfaceStress, side_loads, surface_loads,
};
use super::mean_flow::{CellIntegrals, MeanFlowResponse};
use super::pressure_mean::{FluxWeight, PressureMean, flux_weights};
use super::problem::{MeanFlowAt, Problem};
use super::rigid_equations::RigidBodyEquations;
use super::shapes::BodyShapes;
use super::solution::Solution;
use super::surface::RestPlaces;
use crate::algebra::{Accuracy, AffineConstraints, SolverMemory, SparseMatrix, Unknowns};
use crate::body::{MeshPoses, Modes};
use crate::flow::{Assembly, FlowTerms};
use crate::space::{DofLayout, FacetRule, Tables};
use crate::timing::Timing;

/// Everything that defines the system on one configuration of the mesh.
#[derive(Clone, Copy)]
pub struct Configuration<'a, const D: usize> {
    /// What is solved.
    pub problem: &'a Problem<D>,
    /// The mesh.
    pub mesh: &'a Mesh<D>,
    /// Boundary conditions and bodies.
    pub constraints: &'a AffineConstraints,
    /// Newton's and Euler's equations.
    pub bodies: &'a RigidBodyEquations,
    /// What is given of the mean flow.
    pub mean_flow: MeanFlowAt<D>,
}

/// A solution at a time, with the raw residual of the fluid at it.
#[derive(Debug, Clone, Copy)]
pub struct ResidualAt<'a, const D: usize> {
    /// The solution.
    pub solution: &'a Solution<D>,
    /// The residual.
    pub residual: &'a [f64],
    /// The time (s).
    pub time: f64,
}

/// Bodies in a mesh, with what holds while the mesh lasts.
#[derive(Debug, Clone)]
pub struct MeshedBodies<'a> {
    /// Where they are.
    pub at: BodiesAt<'a>,
    /// Where nodes on bodies with coordinates are at rest (m).
    pub rest_places: RestPlaces,
}

/// Pattern, factorisation and workspace for the systems on one mesh.
pub struct FluidSystem<const D: usize> {
    /// Numbering of the raw unknowns.
    pub layout: DofLayout<D>,
    /// Boundaries of the mesh.
    pub boundaries: Boundaries,
    /// Number of free unknowns.
    pub n_unknowns: usize,
    pub(super) modes: Modes,
    /// Where nodes on bodies with coordinates are at rest (m).
    rest_places: RestPlaces,
    facet_rule: FacetRule<D>,
    assembly: Assembly<D>,
    pub(super) linear: Box<dyn SystemSolver>,
    /// What the solver kept when it was marked, if the unknowns have been numbered again since.
    kept_memory: Option<SolverMemory>,
    numbering: Numbering,
    pressure: PressureMean,
    /// Of nodes on bodies with coordinates in an enclosed fluid.
    flux_weights: Vec<FluxWeight<D>>,
    /// The common velocity of fluid and bodies, where nothing holds them.
    pub(super) nullspace: Option<TranslationNullspace<D>>,
    /// Integrals over a cell with a mean flow.
    pub(super) cell: Option<CellIntegrals<D>>,
    /// How the flow answered to pressure gradients in the last step of Newton's method.
    pub(super) response: MeanFlowResponse,
    /// How rates of coordinates answer to forces.
    rate_response: RateResponse,
}

impl<const D: usize> FluidSystem<D> {
    /// Analyses a problem on a mesh. `unknown_frame` makes the frame's velocity an unknown of the
    /// convection.
    #[must_use]
    pub fn new(
        problem: &Problem<D>,
        mesh: &Mesh<D>,
        poses: &MeshPoses,
        unknown_frame: bool,
    ) -> Self {
        Self::with_solver(problem, mesh, poses, unknown_frame, SolverChoice::default())
    }

    /// The same, with systems solved by a chosen method.
    #[must_use]
    pub fn with_solver(
        problem: &Problem<D>,
        mesh: &Mesh<D>,
        poses: &MeshPoses,
        unknown_frame: bool,
        choice: SolverChoice,
    ) -> Self {
        // Which unknowns are constrained does not depend on how bodies deform
        let shapes = BodyShapes::rigid(problem.bodies.len());
        let bodies = MeshedBodies {
            at: BodiesAt { poses, shapes: &shapes },
            rest_places: RestPlaces::new(),
        };
        let never = || Ok::<(), Infallible>(());
        let Ok(system) = Self::with_bodies(problem, mesh, bodies, unknown_frame, choice, never);
        system
    }

    /// The same with bodies that may have coordinates; `look` is called between its parts.
    ///
    /// # Errors
    /// Those of `look`.
    pub fn with_bodies<E>(
        problem: &Problem<D>,
        mesh: &Mesh<D>,
        bodies: MeshedBodies<'_>,
        unknown_frame: bool,
        choice: SolverChoice,
        look: impl Fn() -> Result<(), E>,
    ) -> Result<Self, E> {
        let MeshedBodies { at, rest_places } = bodies;
        let modes = problem.modes();
        let layout = DofLayout::new(mesh, problem.bodies.len(), modes.len())
            .with_coordinates(problem.n_coordinates());
        let boundaries = Boundaries::new(mesh);
        let constraints = Constrainer { problem, mesh, layout: &layout, rest_places: &rest_places }
            .constraints(&boundaries, at);
        look()?;
        let frame = problem.frame.filter(|_| unknown_frame);
        let assembly =
            Assembly::new(mesh, layout, &constraints, problem.metric, &problem.open_sides(), frame);
        look()?;
        let pressure = PressureMean::new(mesh, assembly.tables());
        let flux_weights = flux_weights(problem, mesh, assembly.tables(), &rest_places);
        let nullspace = TranslationNullspace::new(problem, mesh, assembly.tables());
        let driven = problem.mean_flow.as_ref();
        let cell = driven.map(|_| CellIntegrals::new(problem, mesh, assembly.tables()));
        let saddle_point = saddle_point(&layout, &constraints, modes, &problem.coordinates());
        let blocks = blocks_of_bodies(problem, &layout, &constraints);
        look()?;
        let system = NewSystem { constraints: &constraints, saddle_point, blocks };
        let linear = system_solver(&assembly, system, choice);
        look()?;
        let is_free = free_velocities(&layout, problem.bodies.len(), modes, &constraints);
        Ok(Self {
            layout,
            boundaries,
            kept_memory: None,
            numbering: Numbering { choice, frame, is_free },
            n_unknowns: constraints.n_unknowns(),
            modes,
            rest_places,
            facet_rule: FacetRule::new(problem.metric),
            assembly,
            linear,
            pressure,
            flux_weights,
            nullspace,
            cell,
            response: MeanFlowResponse::default(),
            rate_response: RateResponse::default(),
        })
    }

    /// Entries of the matrix.
    #[must_use]
    pub fn n_entries(&self) -> usize {
        self.linear.n_entries()
    }

    /// What the linear solver is given of each free unknown.
    #[must_use]
    pub fn unknowns(&self) -> &Unknowns {
        self.linear.unknowns()
    }

    /// How well the last system was solved for which the matrix was factorised.
    #[must_use]
    pub fn accuracy(&self) -> Accuracy {
        self.linear.accuracy()
    }

    /// Whether systems are solved by iterations: how accurately is then a choice.
    #[must_use]
    pub fn is_iterative(&self) -> bool {
        self.linear.is_iterative()
    }

    /// Memory of the preconditioner of an iterative solver (bytes).
    #[must_use]
    pub fn preconditioner_bytes(&self) -> usize {
        self.linear.preconditioner_bytes()
    }

    /// A copy of the matrix last assembled.
    #[must_use]
    pub fn matrix(&self) -> SparseMatrix {
        self.linear.matrix()
    }

    /// Basis tables, for measurements.
    #[must_use]
    pub fn tables(&self) -> &Tables<D> {
        self.assembly.tables()
    }

    /// The stress of a flow on the boundaries of the mesh.
    #[must_use]
    pub fn surface_stress<'a>(
        &'a self,
        problem: &Problem<D>,
        mesh: &'a Mesh<D>,
        solution: &'a Solution<D>,
    ) -> SurfaceStress<'a, D> {
        SurfaceStress {
            mesh,
            boundaries: &self.boundaries,
            rule: &self.facet_rule,
            metric: problem.metric,
            viscosity: problem.viscosity,
            fields: solution.fields(),
        }
    }

    /// Loads of a flow on the bodies at these poses in the mesh, and the work of the sides, from the
    /// raw residual at it.
    #[must_use]
    pub fn surface_loads(
        &self,
        problem: &Problem<D>,
        mesh: &Mesh<D>,
        poses: &MeshPoses,
        ResidualAt { solution, residual, time }: ResidualAt<'_, D>,
    ) -> SurfaceLoads {
        let flow = ResidualOnMesh {
            mesh,
            layout: &self.layout,
            boundaries: &self.boundaries,
            velocity: &solution.velocity,
            residual,
        };
        let mut loads = surface_loads(problem, poses, &flow);
        if problem.reports_sides {
            let stress = self.surface_stress(problem, mesh, solution);
            let when = SidesAt {
                time,
                density: if problem.has_convection { problem.density } else { 0.0 },
                frame_velocity: problem.frame_velocity(&solution.twists),
            };
            loads.sides = side_loads(problem, &flow, &stress, when);
        }
        if self.cell.is_some() {
            for (body, (loads, twist)) in loads.bodies.iter_mut().zip(&solution.twists).enumerate()
            {
                let mean = self.mean_load(body, solution);
                loads.power -= mean.force.dot(&twist.linear);
                loads.load = loads.load + mean;
            }
        }
        loads
    }

    /// Constraints with bodies at these poses, at the time of their shapes.
    #[must_use]
    pub fn constraints(
        &self,
        problem: &Problem<D>,
        mesh: &Mesh<D>,
        bodies: BodiesAt<'_>,
    ) -> AffineConstraints {
        let Self { layout, rest_places, boundaries, .. } = self;
        Constrainer { problem, mesh, layout, rest_places }.constraints(boundaries, bodies)
    }

    /// Takes note that the mesh has moved.
    pub fn move_to(&mut self, problem: &Problem<D>, mesh: &Mesh<D>) {
        if problem.is_enclosed() {
            let tables = self.assembly.tables();
            self.pressure = PressureMean::new(mesh, tables);
            self.flux_weights = flux_weights(problem, mesh, tables, &self.rest_places);
        }
        self.nullspace = TranslationNullspace::new(problem, mesh, self.assembly.tables());
        self.linear.forget_weights();
        if problem.mean_flow.is_some() {
            self.cell = Some(CellIntegrals::new(problem, mesh, self.assembly.tables()));
        }
    }

    /// One Newton step: assembles and factorises the Jacobian at `solution`, unless factors are kept with tangents of
    /// coordinates, and returns the next solution for a given reduced residual.
    ///
    /// Where systems are solved by iterations, what the linear equations leave of the residual is
    /// `reduction` (1), by default the tolerance of the solver.
    ///
    /// # Errors
    /// When the matrix is singular or the solution not finite.
    pub fn newton_step(
        &mut self,
        at: &Configuration<'_, D>,
        terms: &FlowTerms<'_, D>,
        solution: &Solution<D>,
        reduced: &[f64],
        reduction: Option<f64>,
        timing: &mut Timing,
    ) -> Result<Solution<D>, SolveError> {
        let mut free = at.constraints.pick(&self.pinned(solution).to_raw(self.modes));
        let mut step: Vec<f64> = reduced.iter().map(|value| -value).collect();
        // The flow of another pass is near: factors of this step lead to it without another matrix
        if !(self.rate_response.is_kept() && self.linear.substitute(&mut step, timing)) {
            self.linearise(at, terms, solution, timing)?;
            let solved = self.linear.solve_correction(&free, &mut step, reduction, timing);
            solved.map_err(|error| self.explain(at, error))?;
            self.keep_response(at, timing)?;
        }
        free.iter_mut().zip(&step).for_each(|(value, correction)| *value += correction);
        self.follow_coordinates(at, &step, &mut free, timing);
        self.balance_enclosed(at, solution, &mut free, timing)?;
        self.next_solution(at, solution, free, timing)
    }

    /// The solution seen from where the system holds fluid and bodies.
    fn pinned(&self, solution: &Solution<D>) -> Solution<D> {
        let mut pinned = solution.clone();
        if let Some(nullspace) = &self.nullspace {
            nullspace.pin(&mut pinned);
        }
        pinned
    }

    /// The solution with a mean velocity (m/s) where nothing holds fluid and bodies.
    fn centered(&self, mut solution: Solution<D>, mean: &Point<D>) -> Solution<D> {
        if let Some(nullspace) = &self.nullspace {
            nullspace.subtract(&(self.mean_velocity(&solution) - mean), &mut solution);
        }
        solution
    }

    /// The solution with all free unknowns zero.
    #[must_use]
    pub fn at_rest(&self, constraints: &AffineConstraints) -> Solution<D> {
        let raw = constraints.expand(&vec![0.0; constraints.n_unknowns()]);
        Solution::from_raw(&self.layout, self.modes, &raw)
    }

    /// A solution that meets the constraints, from another one.
    #[must_use]
    pub fn constrained(&self, constraints: &AffineConstraints, from: &Solution<D>) -> Solution<D> {
        let free = constraints.pick(&self.pinned(from).to_raw(self.modes));
        let raw = constraints.expand(&free);
        Solution {
            pressure_gradient: from.pressure_gradient,
            ..Solution::from_raw(&self.layout, self.modes, &raw)
        }
    }
}
