//! What a simulation starts with: its scheme, its mesh, and the memory it needs.

use alewife_mesh::Mesh;

use super::RunError;
use super::advance::{Simulation, StepScheme};
use crate::case::{Case, Convection, Scheme, TimeSettings};
use crate::coupling::{BodyShapes, Problem, memory_estimate};

impl<const D: usize> Simulation<D> {
    /// Meshed with straight sides, a sheet has its shape from the beginning.
    pub(super) fn settle_moving_walls(&mut self) -> Result<(), RunError> {
        let Self { problem, state, work, moving_mesh, .. } = self;
        let Some(moving) = moving_mesh else { return Ok(()) };
        if moving.scene().has_moving_wall() {
            let shapes = BodyShapes::at(&problem.bodies, 0.0)?;
            state.nodes = moving.nodes(&state.poses, &shapes)?;
            state.nodes_before.clone_from(&state.nodes);
            state.mesh.nodes.clone_from(&state.nodes);
            work.mesh.nodes.clone_from(&state.nodes);
            work.system.move_to(problem, &state.mesh);
        }
        state.contact.minimum_gap = moving.gaps().minimum_gap(&state.poses);
        Ok(())
    }
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

/// Refuses a mesh whose system would not fit into the memory that is free, where the system tells.
pub(super) fn check_memory<const D: usize>(mesh: &Mesh<D>) -> Result<(), RunError> {
    const GIGABYTE: f64 = 1e9;
    let n_dofs = D * mesh.n_nodes() + mesh.n_vertices;
    let needed = memory_estimate(n_dofs) / GIGABYTE;
    let report = std::fs::read_to_string("/proc/meminfo").unwrap_or_default();
    let line = report.lines().find_map(|line| line.strip_prefix("MemAvailable:"));
    let kilobytes = line.and_then(|line| line.trim().trim_end_matches(" kB").parse::<f64>().ok());
    match kilobytes.map(|kilobytes| kilobytes * 1024.0 / GIGABYTE) {
        Some(available) if needed > available => {
            Err(RunError::TooLarge { n_dofs, needed, available })
        }
        _ => Ok(()),
    }
}
