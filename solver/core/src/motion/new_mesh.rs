//! The mesh that takes the place of one that has become poor: in space it is made for bodies where they are expected
//! half-way through its life, and moved back to where they are.

use alewife_mesh::Mesh;
use nalgebra::Vector3;

use super::moving_mesh::MovingMesh;
use super::scene::{Meshed, MostCells, RemeshError};
use crate::body::{MeshPoses, Pose};
use crate::coupling::{BodyShapes, Problem};
use crate::state::State;

/// Time from a new mesh to its reference mesh over that from the reference mesh before to the end of its mesh.
const LEAD: f64 = 0.7;
/// Most steps ahead: velocities of bodies change little in a few steps only.
const MOST_STEPS: f64 = 10.0;
/// Fewest steps ahead that are worth while.
const FEWEST_STEPS: f64 = 0.5;

/// A mesh that takes the place of another one.
pub(super) struct NewMesh<const D: usize> {
    /// At present, seen from the frame.
    pub mesh: Mesh<D>,
    /// Moves it.
    pub moving: MovingMesh<D>,
    /// Whole periods from each body to its image in the mesh (m).
    pub image_shifts: Vec<Vector3<f64>>,
}

/// Bodies at a time, and the cells that a mesh around them may have.
struct Expected {
    time: f64,
    poses: Vec<Pose>,
    most: MostCells,
}

/// The mesh that takes the place of that of a state, with bodies of these shapes at present.
///
/// # Errors
/// When it cannot be generated, or would have more cells than it may have.
pub(super) fn new_mesh<const D: usize>(
    problem: &Problem<D>,
    state: &State<D>,
    moving: &MovingMesh<D>,
    shapes: &BodyShapes,
    most: MostCells,
) -> Result<NewMesh<D>, RemeshError> {
    if let Some(made) = generate_for_future_poses(problem, state, moving, shapes, most) {
        return Ok(made);
    }
    let poses = state.poses.clone();
    generate(problem, state, moving, shapes, &Expected { time: state.time, poses, most })
}

/// A mesh that is best where bodies are expected later, so that it lasts for nearly twice as long as one that is best at
/// present; none where that is too far ahead to be fit for use at present.
fn generate_for_future_poses<const D: usize>(
    problem: &Problem<D>,
    state: &State<D>,
    moving: &MovingMesh<D>,
    shapes: &BodyShapes,
    most: MostCells,
) -> Option<NewMesh<D>> {
    // In the plane a mesh is a small part of a step, and is made where bodies are at present
    if D == 2 {
        return None;
    }
    let lasted = state.time - moving.reference_time();
    let lead = (LEAD * lasted).min(MOST_STEPS * state.last_step);
    if lead < FEWEST_STEPS * state.last_step {
        return None;
    }
    let ahead = Expected { most, ..expected(problem, state, moving, shapes, lead) };
    let mut made = generate(problem, state, moving, shapes, &ahead).ok()?;
    let poses = MeshPoses::seen_from(&state.origin, &state.poses, &made.image_shifts);
    let reason = made.moving.reason_to_replace(&made.mesh, &poses, shapes);
    tracing::debug!(lasted, lead = ahead.time - state.time, poor = reason, "mesh made ahead");
    reason.is_none().then_some(made)
}

/// Where bodies are expected after some time (s), or as far on the way there as leaves half of the smallest gap.
fn expected<const D: usize>(
    problem: &Problem<D>,
    state: &State<D>,
    moving: &MovingMesh<D>,
    shapes: &BodyShapes,
    lead: f64,
) -> Expected {
    let poses_after = |lead: f64| {
        let pairs = state.poses.iter().zip(&state.now.twists);
        let mut poses: Vec<Pose> =
            pairs.map(|(pose, twist)| pose.displaced(&(twist.to_vector() * lead))).collect();
        problem.apply_joints(&mut poses, state.time + lead);
        poses
    };
    let gaps = moving.gaps_at(shapes);
    let part = gaps.part_that_keeps_open(&|part| {
        let poses = if part > 0.0 { poses_after(part * lead) } else { state.poses.clone() };
        state.in_own_frame(problem, &poses).into_vec()
    });
    let lead = lead * part;
    let most = MostCells(f64::INFINITY);
    Expected { time: state.time + lead, poses: poses_after(lead), most }
}

/// A mesh generated for bodies where they are expected, moved to where they are with these shapes.
fn generate<const D: usize>(
    problem: &Problem<D>,
    state: &State<D>,
    moving: &MovingMesh<D>,
    shapes_now: &BodyShapes,
    expected: &Expected,
) -> Result<NewMesh<D>, RemeshError> {
    let Expected { time, poses, most } = expected;
    let origin = state.origin_at(problem, poses);
    let shapes = BodyShapes::with(&problem.bodies, *time, &state.shapes.now)?;
    let moved = |shifts: &[Vector3<f64>]| -> Vec<Vector3<f64>> {
        state.image_shifts.iter().zip(shifts).map(|(known, shift)| known + shift).collect()
    };
    let shifted = |shifts: &[Vector3<f64>]| MeshPoses::seen_from(&origin, poses, &moved(shifts));
    let seen = state.in_frame(&origin, poses);
    let Meshed { mesh, scene, poses, shifts } = moving.remesh(&seen, &shapes, &shifted, *most)?;
    let image_shifts = moved(&shifts);
    let moving =
        moving.succeeded_by(&mesh, scene, poses, *time)?.with_coordinates(state.shapes.now.clone());
    // Outlines that follow coordinates go through some of their points, and between them nearly so
    if *time == state.time && state.shapes.now.is_empty() {
        return Ok(NewMesh { mesh, moving, image_shifts });
    }
    let present = MeshPoses::seen_from(&state.origin, &state.poses, &image_shifts);
    let nodes = moving.nodes(&present, shapes_now)?;
    Ok(NewMesh { mesh: mesh.with_nodes(nodes), moving, image_shifts })
}
