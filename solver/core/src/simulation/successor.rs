//! The mesh that takes the place of one that has become poor: made for bodies where they are expected half-way through
//! its life, and moved back to where they are.

use alewife_mesh::Mesh;
use nalgebra::Vector3;

use super::moving_mesh::MovingMesh;
use super::predict::part_left_by_gaps;
use super::scene::{Meshed, RemeshError};
use super::state::{State, seen_from};
use crate::body::Pose;
use crate::coupling::{BodyShapes, Problem};

/// Time from the new mesh to its reference mesh over the time that the one before lasted from its own.
const LEAD: f64 = 0.7;
/// Most steps ahead: velocities of bodies are known to change slowly for a few steps only.
const MOST_STEPS_AHEAD: f64 = 10.0;

/// A mesh that takes the place of another one.
pub(super) struct Successor<const D: usize> {
    /// At present, seen from the frame.
    pub mesh: Mesh<D>,
    /// Moves it.
    pub moving: MovingMesh<D>,
    /// Whole periods from each body to its image in the mesh (m).
    pub image_shifts: Vec<Vector3<f64>>,
}

/// Where bodies are expected.
struct Expected {
    time: f64,
    poses: Vec<Pose>,
}

/// The mesh that takes the place of that of a state, with bodies of these shapes at present. Its quality is best where
/// bodies are expected later, so that it lasts for nearly twice as long as one that is best at present.
///
/// # Errors
/// When it cannot be generated.
pub(super) fn successor<const D: usize>(
    problem: &Problem<D>,
    state: &State<D>,
    moving: &MovingMesh<D>,
    shapes: &BodyShapes,
) -> Result<Successor<D>, RemeshError> {
    let lasted = state.time - moving.reference_time();
    let lead = (LEAD * lasted).min(MOST_STEPS_AHEAD * state.last_step);
    if D == 3 && lead > 0.5 * state.last_step {
        let ahead = expected(problem, state, moving, shapes, lead);
        if let Ok(mut made) = generate(problem, state, moving, &ahead) {
            let poses = seen_from(&state.origin, &state.poses, &made.image_shifts);
            match made.moving.reason_to_replace(&made.mesh, &poses, shapes) {
                None => {
                    tracing::debug!(lasted, lead = ahead.time - state.time, "mesh ahead");
                    return Ok(made);
                }
                Some(reason) => tracing::debug!(lasted, lead, reason, "no mesh ahead"),
            }
        } else { tracing::debug!(lasted, lead, "mesh ahead failed"); }
    }
    generate(problem, state, moving, &Expected { time: state.time, poses: state.poses.clone() })
}

/// Where bodies are expected after some time (s), or as far on the way there as leaves the smallest gap half of what it is.
fn expected<const D: usize>(
    problem: &Problem<D>,
    state: &State<D>,
    moving: &MovingMesh<D>,
    shapes: &BodyShapes,
    lead: f64,
) -> Expected {
    let poses_at = |lead: f64| {
        let pairs = state.poses.iter().zip(&state.now.twists);
        let mut poses: Vec<Pose> =
            pairs.map(|(pose, twist)| pose.displaced(&(twist.to_vector() * lead))).collect();
        problem.apply_joints(&mut poses, state.time + lead);
        poses
    };
    let gaps = moving.gaps_at(shapes);
    let part = part_left_by_gaps(problem, &*gaps, state, &state.poses, |part| poses_at(part * lead));
    Expected { time: state.time + part * lead, poses: poses_at(part * lead) }
}

/// A mesh generated for bodies where they are expected, at present.
fn generate<const D: usize>(
    problem: &Problem<D>,
    state: &State<D>,
    moving: &MovingMesh<D>,
    expected: &Expected,
) -> Result<Successor<D>, RemeshError> {
    let Expected { time, poses } = expected;
    let origin = state.origin_at(problem, poses);
    let shapes = BodyShapes::at(&problem.bodies, *time)?;
    let moved = |shifts: &[Vector3<f64>]| -> Vec<Vector3<f64>> {
        state.image_shifts.iter().zip(shifts).map(|(known, shift)| known + shift).collect()
    };
    let shifted = |shifts: &[Vector3<f64>]| seen_from(&origin, poses, &moved(shifts));
    let seen = state.in_frame(&origin, poses);
    let Meshed { mesh, scene, poses, shifts } = moving.remesh(&seen, &shapes, &shifted)?;
    let image_shifts = moved(&shifts);
    let moving = moving.succeeded_by(&mesh, scene, poses, *time)?;
    if *time == state.time {
        return Ok(Successor { mesh, moving, image_shifts });
    }
    let present = seen_from(&state.origin, &state.poses, &image_shifts);
    let nodes = moving.nodes(&present, &BodyShapes::at(&problem.bodies, state.time)?)?;
    Ok(Successor { mesh: Mesh { nodes, ..mesh }, moving, image_shifts })
}
