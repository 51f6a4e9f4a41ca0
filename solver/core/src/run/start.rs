//! What a simulation starts with: its scheme, its mesh, its flow, and the memory it needs.

use alewife_mesh::{Mesh, MeshError, Point};

use super::RunError;
use super::control::first_piece;
use super::free_memory;
use super::simulation::{Simulation, StepScheme};
use crate::body::Twist;
use crate::case::{Case, Convection, Initial, Scheme, Steady, TimeSettings, Unsteady};
use crate::coupling::{
    BodiesAt, BodyShapes, Boundaries, BoundaryValues, DivergenceFreeProjection, Problem,
    RestPlaces, RigidBodyEquations, Solution, SurfaceLoads, impose_boundary_values,
    memory_estimate,
};
use crate::motion::UNCERTAIN;
use crate::state::InitialLevels;
use crate::step::{FlowError, SteadyFlow, SteadyTask, solve_steady};

impl<const D: usize> Simulation<D> {
    /// Meshed with straight sides, a sheet has its shape from the beginning, and so has a body with coordinates.
    pub(super) fn settle_moving_walls(&mut self) -> Result<(), RunError> {
        let Self { problem, state, work, moving_mesh, .. } = self;
        let Some(moving) = moving_mesh else { return Ok(()) };
        let poses = state.in_own_frame(problem, &state.poses);
        let mut settled = None;
        if moving.scene().has_moving_wall() || problem.n_coordinates() > 0 {
            let shapes = BodyShapes::at(&problem.bodies, 0.0)?;
            let nodes = moving.nodes(&poses, &shapes)?;
            work.mesh.nodes.clone_from(&nodes);
            work.system.move_to(problem, &work.mesh);
            settled = Some(nodes);
        }
        let minimum_gap = moving.gaps().minimum_gap(&poses);
        state.settle(settled, minimum_gap);
        Ok(())
    }

    /// Solves for the flow at time zero without a time derivative.
    pub(super) fn solve_at_start(
        &mut self,
        settings: &Steady,
        equations: &RigidBodyEquations,
        has_convection: bool,
    ) -> Result<SteadyFlow<D>, RunError> {
        let Self { problem, state, work, stop, .. } = self;
        let (poses, shapes) = (state.in_mesh(&state.poses), BodyShapes::at(&problem.bodies, 0.0)?);
        let bodies = BodiesAt { poses: &poses, shapes: &shapes };
        let stop = stop.as_ref();
        let task = SteadyTask { bodies, equations, settings, has_convection, stop };
        solve_steady(work, problem, &task).map_err(|failure| {
            state.begin(InitialLevels::steady(failure.last));
            RunError::from(*failure.error)
        })
    }

    /// Newton's and Euler's equations of bodies without acceleration at time zero.
    pub(super) fn steady_equations(&self) -> RigidBodyEquations {
        RigidBodyEquations::steady(&self.problem, &self.state.poses, 0.0)
    }

    /// Sets bodies in motion, and the fluid as an impulse on them does: without vorticity but on their surfaces.
    ///
    fn launch(&mut self, twists: Vec<Twist>) -> Result<(), RunError> {
        let Self { problem, state, .. } = self;
        let mesh = &state.mesh;
        let shapes = BodyShapes::at(&problem.bodies, 0.0)?;
        let poses = state.in_mesh(&state.poses);
        let mut solution = Solution { twists, ..state.now.clone() };
        let values = BoundaryValues {
            bodies: BodiesAt { poses: &poses, shapes: &shapes },
            twists: &solution.twists,
            rates: &solution.rates,
            rest_places: &RestPlaces::new(),
            origin: Point::<D>::zeros(),
        };
        let boundaries = Boundaries::new(mesh);
        impose_boundary_values(problem, mesh, &boundaries, &values, &mut solution.velocity);
        let mut projection = DivergenceFreeProjection::new(problem, mesh);
        let flow = projection.potential_flow(mesh, &solution.velocity);
        solution.velocity = flow.map_err(|error| FlowError::from_solve(error.into(), 0, 0.0))?;
        state.begin(InitialLevels::steady(solution));
        Ok(())
    }

    /// Solves for the flow an unsteady run starts from.
    pub(super) fn begin(&mut self, settings: &Unsteady) -> Result<StartFlow, RunError> {
        let n_bodies = self.problem.bodies.len();
        let has_inertia = self.problem.has_inertia;
        let twists = self.problem.initial_twists(&self.state.in_mesh(&self.state.poses));
        if let Some(twists) = twists.filter(|_| has_inertia) {
            self.launch(twists)?;
            return Ok(StartFlow { loads: SurfaceLoads::none(n_bodies), iterations: 1 });
        }
        // Without inertia the flow has no memory, and is that of the bodies' poses at any time
        if has_inertia && self.problem.initial.is_some() {
            return self.begin_with_given_flow();
        }
        if settings.initial != Initial::Stokes && has_inertia {
            return Ok(StartFlow { loads: SurfaceLoads::none(n_bodies), iterations: 0 });
        }
        // Where bodies have inertia their loads have not moved them yet
        let equations = if has_inertia {
            RigidBodyEquations::unloaded(&self.problem, 0.0)
        } else {
            self.steady_equations()
        };
        let equations = equations.relaxing_within(first_piece(settings));
        let max_iterations = if self.problem.viscosity.is_newtonian() { 5 } else { SHEAR };
        let settings = Steady { tolerance: 1e-10, max_iterations };
        let flow = self.solve_at_start(&settings, &equations, false)?;
        self.state.begin(InitialLevels::steady(flow.solution));
        let loads = self.loads(&flow.residual);
        Ok(StartFlow { loads, iterations: flow.iterations })
    }

    /// Starts from a velocity that is given, but for that of sides and bodies.
    fn begin_with_given_flow(&mut self) -> Result<StartFlow, RunError> {
        let Self { problem, state, work, .. } = self;
        let (poses, shapes) = (state.in_mesh(&state.poses), BodyShapes::at(&problem.bodies, 0.0)?);
        let bodies = BodiesAt { poses: &poses, shapes: &shapes };
        let mut flow = state.now.clone();
        for (velocity, place) in flow.velocity.iter_mut().zip(state.mesh.nodes.iter()) {
            *velocity = problem.initial.as_ref().map_or(*velocity, |initial| initial(place, 0.0));
        }
        let constraints = work.system.constraints(problem, &state.mesh, bodies);
        let flow = work.system.constrained(&constraints, &flow);
        self.state.begin(InitialLevels::steady(flow));
        let n_bodies = self.problem.bodies.len();
        Ok(StartFlow { loads: SurfaceLoads::none(n_bodies), iterations: 0 })
    }
}

/// The flow an unsteady run starts from.
pub(super) struct StartFlow {
    /// Loads of the fluid on the bodies.
    pub loads: SurfaceLoads,
    /// Linear systems solved.
    pub iterations: usize,
}

/// How the steps of a case are made.
pub(super) fn step_scheme<const D: usize>(case: &Case, problem: &Problem<D>) -> StepScheme {
    let (method, convection, is_linear) = match &case.time {
        TimeSettings::Steady(_) => (Scheme::default(), Convection::Newton, false),
        TimeSettings::Unsteady(settings) => {
            let convection = settings.convection;
            (settings.scheme, convection, convection == Convection::Extrapolated)
        }
    };
    // A frame whose velocity is itself sought enters the convection of every cell
    let unknown_frame = problem.frame.is_some() && problem.has_convection && !is_linear;
    StepScheme { method, convection, unknown_frame }
}

/// Most iterations for the first flow of a fluid whose viscosity depends on the rate of shear.
const SHEAR: usize = 30;

const GIGABYTE: f64 = 1e9;

/// Unknowns over cells of a large mesh, planar or spatial: velocities at vertices and edges, pressures
/// at vertices.
const DOFS_OF_CELL: f64 = 4.5;

/// Refuses a mesh whose system would not fit into the memory that is free, where the system tells.
pub(super) fn check_memory<const D: usize>(mesh: &Mesh<D>) -> Result<(), RunError> {
    let n_dofs = D * mesh.n_nodes() + mesh.n_vertices;
    let needed = memory_estimate(D, n_dofs as f64) / GIGABYTE;
    match free_memory() {
        Some(available) if needed > available => {
            Err(RunError::TooLarge { n_dofs, needed, available })
        }
        _ => Ok(()),
    }
}

/// Refuses a mesh with more cells than the case allows.
pub(super) fn check_max_cells<const D: usize>(case: &Case, mesh: &Mesh<D>) -> Result<(), RunError> {
    let n_cells = mesh.n_cells() as f64;
    match case.mesh.max_cells {
        Some(most) if mesh.n_cells() > most => Err(RunError::BeyondMaxCells { n_cells, most }),
        _ => Ok(()),
    }
}

/// Refuses a mesh before it is made, by an estimate of its cells, which gets the number from which on
/// they need not be counted.
pub(super) fn check_cells<const D: usize>(
    max_cells: Option<usize>,
    estimate: impl FnOnce(f64) -> Result<f64, MeshError>,
) -> Result<(), RunError> {
    let available = free_memory().unwrap_or(f64::INFINITY);
    let memory = |n_cells: f64| memory_estimate(D, DOFS_OF_CELL * n_cells) / GIGABYTE;
    // In proportion to what a million cells need
    let fitting = UNCERTAIN * 1e6 * available / memory(1e6);
    let given = max_cells.map_or(f64::INFINITY, |most| UNCERTAIN * most as f64);
    let limit = 10.0 * fitting.min(given);
    let n_cells = estimate(limit)?;
    if let Some(most) = max_cells.filter(|_| n_cells > given) {
        return Err(RunError::BeyondMaxCells { n_cells: n_cells.min(limit), most });
    }
    if n_cells <= fitting {
        return Ok(());
    }
    let n_cells = n_cells.min(limit);
    let coarser = (n_cells / fitting).powf(1.0 / D as f64);
    Err(RunError::TooManyCells { n_cells, needed: memory(n_cells), available, coarser })
}

/// Memory that is free (GB), where the system tells.
fn free_memory() -> Option<f64> {
    Some(free_memory::free_memory()? / GIGABYTE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_cells_than_fit_are_refused_with_what_would_fit() {
        assert!(check_cells::<2>(None, |_| Ok(1e3)).is_ok());
        if free_memory().is_none() {
            return;
        }
        let infinite = |_| Ok(f64::INFINITY);
        let beyond = check_cells::<2>(Some(500), |_| Ok(1e3));
        assert!(matches!(beyond, Err(RunError::BeyondMaxCells { most: 500, .. })), "{beyond:?}");
        for (refused, power) in [
            (check_cells::<2>(None, infinite), 1.0 / 2.0),
            (check_cells::<3>(None, infinite), 1.0 / 3.0),
        ] {
            match refused {
                Err(RunError::TooManyCells { coarser, needed, available, .. }) => {
                    assert!((coarser - 10f64.powf(power)).abs() < 1e-9, "{coarser}");
                    assert!(needed > available);
                }
                other => panic!("{other:?}"),
            }
        }
    }
}
