//! From a case to a simulation at rest, or as it was saved.

use std::sync::Arc;

use alewife_mesh::Mesh;
use nalgebra::Vector3;

use super::advance::{Simulation, StepScheme};
use super::build::{build_problem, contact_law};
use super::measure::Measure;
use super::moving_mesh::{MotionSettings, MovingMesh};
use super::planar::{InitialMesh, PlanarCase, PlanarScene, initial_mesh};
use super::resume::SavedState;
use super::scene::RemeshError;
use super::state::State;
use super::step::Workspace;
use super::{RunError, Stage, Timing};
use crate::case::{Case, Convection, MeshEquation, Model, Scheme, TimeSettings};
use crate::coupling::{BodyShapes, FluidSystem, Problem, memory_estimate};
use crate::motion::{MotionKind, Stiffening};

/// Builds the simulation of a case with its measurements, as it was saved if there is such a state.
pub(super) fn prepare(
    model: &Model,
    saved: Option<&SavedState>,
) -> Result<(Simulation<2>, Measure), RunError> {
    let mut timing = Timing::default();
    let initial = timing.measure(Stage::Mesh, || initial_mesh(model))?;
    let mesh = &initial.mesh;
    tracing::info!(cells = mesh.n_cells(), nodes = mesh.n_nodes(), "mesh generated");
    check_memory(mesh)?;
    let mut measure = Measure::new(model, mesh)?;
    let mut simulation = at_rest(model, initial, timing)?;
    if let Some(saved) = saved {
        saved.restore_into(model, &mut simulation)?;
        if simulation.moving_mesh.is_none() {
            measure.find_probes(&model.case, &simulation.state.mesh_in_frame());
        }
    }
    Ok((simulation, measure))
}

/// A simulation of a case at rest, on a mesh of it from elsewhere.
///
/// # Errors
/// When the case makes no problem on this mesh.
pub fn simulation_on(model: &Model, mesh: Mesh<2>) -> Result<Simulation<2>, RunError> {
    at_rest(model, InitialMesh::of(model, mesh)?, Timing::default())
}

fn at_rest(
    model: &Model,
    initial: InitialMesh,
    mut timing: Timing,
) -> Result<Simulation<2>, RunError> {
    let case = &model.case;
    let InitialMesh { mesh, cell } = initial;
    let problem = build_problem(model, &mesh)?;
    let scheme = step_scheme(case, &problem);
    let mut state = State::at_rest(&problem, mesh);
    state.image_shifts =
        cell.shifts.iter().map(|shift| Vector3::new(shift.x, shift.y, 0.0)).collect();
    let poses = state.in_mesh(&state.poses);
    let system = timing.measure(Stage::Assembly, || {
        FluidSystem::new(&problem, &state.mesh, &poses, scheme.unknown_frame)
    });
    tracing::info!(unknowns = system.n_unknowns, entries = system.n_entries(), "system built");
    let mut moving_mesh = None;
    if model.mesh_moves() {
        let planar = Arc::new(PlanarCase::new(model, &problem)?);
        let moving = timing.measure(Stage::MeshMotion, || -> Result<_, RemeshError> {
            let (domain, shapes) = (cell.domain, cell.shapes);
            let mesh = &state.mesh;
            let scene = PlanarScene::new(Arc::clone(&planar), mesh, domain, shapes, poses.clone())?;
            let settings = motion_settings(case, &planar);
            Ok(MovingMesh::new(mesh, Box::new(scene), settings, poses, 0.0)?)
        });
        moving_mesh = Some(moving.map_err(RunError::from_remesh)?);
    }
    let law = case.contact.as_ref().map(contact_law).transpose()?;
    let work = Workspace { system, mesh: state.mesh.clone(), timing };
    let mut simulation =
        Simulation { problem, state, work, moving_mesh, law, scheme, is_fresh: true };
    simulation.settle_moving_walls()?;
    Ok(simulation)
}

impl Simulation<2> {
    /// Meshed with straight sides, a sheet has its shape from the beginning.
    fn settle_moving_walls(&mut self) -> Result<(), RunError> {
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

fn step_scheme(case: &Case, problem: &Problem<2>) -> StepScheme {
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

/// How the mesh of a case moves.
pub(super) fn motion_settings(case: &Case, planar: &PlanarCase) -> MotionSettings {
    let kind = match case.mesh.moving.equation {
        MeshEquation::Elastic => MotionKind::default(),
        MeshEquation::Harmonic => MotionKind::Harmonic(Stiffening::MasudHughes),
    };
    MotionSettings { kind, turns: planar.turns.clone() }
}

/// Refuses a mesh whose system would not fit into the memory that is free, where the system tells.
fn check_memory(mesh: &Mesh<2>) -> Result<(), RunError> {
    const GIGABYTE: f64 = 1e9;
    let n_dofs = 2 * mesh.n_nodes() + mesh.n_vertices;
    let needed = memory_estimate(n_dofs) / GIGABYTE;
    let told = std::fs::read_to_string("/proc/meminfo").unwrap_or_default();
    let line = told.lines().find_map(|line| line.strip_prefix("MemAvailable:"));
    let kilobytes = line.and_then(|line| line.trim().trim_end_matches(" kB").parse::<f64>().ok());
    match kilobytes.map(|kilobytes| kilobytes * 1024.0 / GIGABYTE) {
        Some(available) if needed > available => {
            Err(RunError::TooLarge { n_dofs, needed, available })
        }
        _ => Ok(()),
    }
}
