//! From a planar or axisymmetric case to a simulation at rest, or as it was saved.

use std::sync::Arc;

use alewife_mesh::Mesh;
use nalgebra::Vector3;

use super::case::{InitialMesh, PlanarCase, initial_mesh};
use super::resume::moving_mesh_of;
use super::scene::PlanarScene;
use super::sides::build_problem;
use crate::case::Model;
use crate::coupling::{FluidSystem, Problem, ShapeError};
use crate::simulation::advance::Simulation;
use crate::simulation::build::contact_law;
use crate::simulation::measure::Measure;
use crate::simulation::moving_mesh::MovingMesh;
use crate::simulation::resume::SavedState;
use crate::simulation::scene::RemeshError;
use crate::simulation::start::{check_memory, step_scheme};
use crate::simulation::state::State;
use crate::simulation::workspace::Workspace;
use crate::simulation::{RunError, Stage, Timing};

/// A simulation with its measurements.
pub(in crate::simulation) struct Prepared {
    /// At rest, or as it was saved.
    pub simulation: Simulation<2>,
    /// What is measured of it.
    pub measure: Measure<2>,
}

/// Builds the simulation of a case with its measurements, as it was saved if there is such a state.
pub(in crate::simulation) fn prepare(
    model: &Model,
    saved: Option<&SavedState<2>>,
) -> Result<Prepared, RunError> {
    let mut timing = Timing::default();
    let initial = timing.measure(Stage::Mesh, || initial_mesh(model))?;
    let mesh = &initial.mesh;
    tracing::info!(cells = mesh.n_cells(), nodes = mesh.n_nodes(), "mesh generated");
    check_memory(mesh)?;
    let domain = model.case.mesh_domain();
    let images = |mesh: &Mesh<2>| domain.images_around(mesh.nodes.iter().copied());
    let mut measure = Measure::new(model, mesh, &images(mesh))?;
    let mut simulation = at_rest(model, initial, timing)?;
    log_recoils(&simulation.problem)?;
    if let Some(saved) = saved {
        saved.restore_into(&model.case, &mut simulation, |problem, reference| {
            moving_mesh_of(model, problem, reference)
        })?;
        if simulation.moving_mesh.is_none() {
            let mesh = simulation.state.mesh_in_frame();
            measure.find_probes(&model.case, &mesh, &images(&mesh));
        }
    }
    Ok(Prepared { simulation, measure })
}

/// A simulation of a case at rest, on a mesh of it from elsewhere.
///
/// # Errors
/// When the case makes no problem on this mesh.
pub fn simulation_on(model: &Model, mesh: Mesh<2>) -> Result<Simulation<2>, RunError> {
    at_rest(model, InitialMesh::of(model, mesh)?, Timing::default())
}

/// Tells what is subtracted from the gaits of the bodies that deform.
fn log_recoils(problem: &Problem<2>) -> Result<(), RunError> {
    for body in &problem.bodies {
        let Some(shape) = &body.shape else { continue };
        let motion =
            shape.recoil().map_err(|reason| ShapeError { body: body.name.clone(), reason })?;
        tracing::info!(
            body = body.name,
            translation = motion.translation,
            largest_speed = motion.largest_speed,
            rms_speed = motion.rms_speed,
            rotation = motion.rotation,
            largest_angular_velocity = motion.largest_angular_velocity,
            rms_angular_velocity = motion.rms_angular_velocity,
            turn = motion.turn,
            "recoil subtracted from the gait"
        );
    }
    Ok(())
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
            let settings = planar.motion_settings(case);
            Ok(MovingMesh::new(mesh, Box::new(scene), settings, poses, 0.0)?)
        });
        moving_mesh = Some(moving.map_err(RunError::from_remesh)?);
    }
    let law = case.contact.as_ref().map(contact_law).transpose()?;
    let work = Workspace { system, mesh: state.mesh.clone(), timing };
    let mut simulation =
        Simulation { problem, state, work, moving_mesh, law, scheme, is_fresh: true, stop: None };
    simulation.settle_moving_walls()?;
    Ok(simulation)
}
