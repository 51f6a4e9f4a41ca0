//! From a case to a simulation at rest, or as it was saved.

use alewife_interrupt::check;
use alewife_mesh::Mesh;

use super::RunError;
use super::build::{Scalars, Tracers, build_problem, contact_law};
use super::case_mesh::{CaseMesh, Dimension, InitialMesh};
use super::measure::Measure;
use super::resume::SavedState;
use super::simulation::{Simulation, fluid_system};
use super::start::{check_max_cells, check_memory, step_scheme};
use super::step_control::StepControl;
use super::watch::CellBound;
use crate::case::{Case, Model, Scheme, TimeSettings};
use crate::coupling::{Problem, ShapeError};
use crate::motion::MovingMesh;
use crate::state::State;
use crate::step::Workspace;
use crate::timing::{Stage, Timing};

/// A simulation with its measurements.
pub(super) struct Prepared<const D: usize> {
    /// At rest, or as it was saved.
    pub simulation: Simulation<D>,
    /// What is measured of it.
    pub measure: Measure<D>,
}

/// Builds the simulation of a case with its measurements, as it was saved if there is such a state.
pub(super) fn prepare<const D: usize>(
    model: &Model,
    saved: Option<&SavedState<D>>,
) -> Result<Prepared<D>, RunError>
where
    Dimension<D>: CaseMesh<D>,
{
    let mut timing = Timing::default();
    let initial = timing.measure(Stage::Mesh, || Dimension::<D>::generate(model))?;
    let mesh = &initial.mesh;
    tracing::info!(cells = mesh.n_cells(), nodes = mesh.n_nodes(), "mesh generated");
    check_memory(mesh)?;
    check()?;
    let images = |mesh: &Mesh<D>| Dimension::<D>::images(&model.case, mesh);
    let mut measure = Measure::new(model, mesh, &images(mesh))?;
    let mut simulation = at_rest(model, initial, timing, |_| Ok(()))?;
    simulation.tracers =
        Tracers::of(&model.case, &simulation.problem, images(&simulation.state.mesh));
    simulation.scalars = Scalars::of(model, &simulation.problem, &simulation.state.mesh)?;
    log_recoils(&simulation.problem)?;
    if let Some(saved) = saved {
        saved.restore_into(&model.case, &mut simulation, |problem, reference| {
            Dimension::<D>::moving_mesh_of(model, problem, reference)
        })?;
        if simulation.moving_mesh.is_none() {
            let mesh = simulation.state.mesh_in_frame();
            let Simulation { problem, state, .. } = &simulation;
            measure.find_probes(&model.case, problem, state, &images(&mesh));
        }
    }
    Ok(Prepared { simulation, measure })
}

/// A simulation of a case at rest, on a mesh of it from elsewhere.
///
/// # Errors
/// When the case makes no problem on this mesh.
pub fn simulation_on<const D: usize>(
    model: &Model,
    mesh: Mesh<D>,
) -> Result<Simulation<D>, RunError>
where
    Dimension<D>: CaseMesh<D>,
{
    at_rest(model, Dimension::<D>::adopt(model, mesh)?, Timing::default(), |_| Ok(()))
}

/// What moves a mesh of a case from elsewhere, with the bodies as they begin; none where nothing moves it.
///
/// # Errors
/// When the case makes no problem on this mesh.
pub fn moving_mesh_on<const D: usize>(
    model: &Model,
    mesh: Mesh<D>,
) -> Result<Option<MovingMesh<D>>, RunError>
where
    Dimension<D>: CaseMesh<D>,
{
    let InitialMesh { mesh, shifts, make_moving } = Dimension::<D>::adopt(model, mesh)?;
    let problem = build_problem(model, &mesh)?;
    let state = State::at_rest(&problem, mesh).with_image_shifts(shifts);
    let poses = state.in_mesh(&state.poses);
    model.mesh_moves().then(|| make_moving(model, &problem, &state.mesh, poses)).transpose()
}

/// A simulation of a case at rest whose problem is changed before it begins.
///
/// # Errors
/// When the case makes no mesh or problem, or `change` fails.
pub fn simulation_with<const D: usize>(
    model: &Model,
    change: impl FnOnce(&mut Problem<D>) -> Result<(), RunError>,
) -> Result<Simulation<D>, RunError>
where
    Dimension<D>: CaseMesh<D>,
{
    at_rest(model, Dimension::<D>::generate(model)?, Timing::default(), change)
}

/// Tells what is subtracted from the gaits of the bodies that deform.
fn log_recoils<const D: usize>(problem: &Problem<D>) -> Result<(), RunError> {
    for body in &problem.bodies {
        let Some(shape) = body.shape.as_ref().filter(|_| body.flexible().is_none()) else {
            continue;
        };
        let motion =
            shape.recoil().map_err(|reason| ShapeError { body: body.name.clone(), reason })?;
        // Of what is asked for while the run goes on it is not known before
        if motion.duration == 0.0 {
            continue;
        }
        tracing::info!(
            body = body.name,
            translation = motion.translation,
            largest_speed = motion.largest_speed,
            rms_speed = motion.rms_speed,
            rotation = motion.rotation,
            largest_angular_velocity = motion.largest_angular_velocity,
            rms_angular_velocity = motion.rms_angular_velocity,
            turn = motion.turn,
            duration = motion.duration,
            "recoil subtracted from the gait"
        );
    }
    Ok(())
}

/// Refuses what bodies with coordinates cannot be beside yet.
fn check_coordinates<const D: usize>(case: &Case, problem: &Problem<D>) -> Result<(), RunError> {
    if problem.n_coordinates() == 0 {
        return Ok(());
    }
    let is_explicit = matches!(
        &case.time,
        TimeSettings::Unsteady(settings) if settings.scheme == Scheme::Rk3
    );
    let refused = [
        (is_explicit, "by explicit steps", "write time.unsteady.scheme = \"bdf2\""),
        (problem.has_joints(), "beside joints yet", "leave out [[joint]]"),
        (
            problem.free_translations().contains(&true),
            "where nothing holds fluid and bodies",
            "let a side be a wall, or take fluid.model = \"unsteady-stokes\"",
        ),
    ];
    match refused.iter().find(|(is_so, ..)| *is_so) {
        Some((_, what, remedy)) => {
            Err(RunError::Unsupported(format!("bodies cannot be rods {what}: {remedy}")))
        }
        None => Ok(()),
    }
}

fn at_rest<const D: usize>(
    model: &Model,
    initial: InitialMesh<D>,
    mut timing: Timing,
    change: impl FnOnce(&mut Problem<D>) -> Result<(), RunError>,
) -> Result<Simulation<D>, RunError> {
    let case = &model.case;
    let InitialMesh { mesh, shifts, make_moving } = initial;
    check_max_cells(case, &mesh)?;
    let cell_bound = CellBound::new(case, mesh.n_cells());
    let mut problem = build_problem(model, &mesh)?;
    change(&mut problem)?;
    check_coordinates(case, &problem)?;
    let scheme = step_scheme(case, &problem);
    let state = State::at_rest(&problem, mesh).with_image_shifts(shifts);
    let poses = state.in_mesh(&state.poses);
    let moving_mesh = model.mesh_moves().then(|| {
        timing.measure(Stage::MeshMotion, || make_moving(model, &problem, &state.mesh, poses))
    });
    let moving_mesh = moving_mesh.transpose()?;
    check()?;
    let system = timing.measure(Stage::Assembly, || {
        fluid_system(&problem, &state, moving_mesh.as_ref(), scheme.unknown_frame, check)
    })?;
    tracing::info!(unknowns = system.n_unknowns, entries = system.n_entries(), "system built");
    let law = contact_law(model)?;
    let work = Workspace { system, mesh: state.mesh.clone(), timing };
    let mut simulation = Simulation {
        problem,
        state,
        control: StepControl::default(),
        work,
        moving_mesh,
        law,
        scheme,
        is_fresh: true,
        cell_bound,
        tracers: None,
        scalars: None,
        stop: None,
    };
    simulation.settle_moving_walls()?;
    Ok(simulation)
}
