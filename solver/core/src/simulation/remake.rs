//! A new mesh in the middle of a run, with both levels of the flow taken over to it.

use alewife_mesh::{BoundaryKind, Domain, Mesh, Point};
use nalgebra::Vector3;

use super::build::sizing;
use super::follow::Follower;
use super::opened::{Opened, open};
use super::state::{Place, State, pose_at, seen_from};
use crate::body::Pose;
use crate::case::Model;
use crate::coupling::{BodyShapes, DivergenceFree, NodeSides, Problem, Solution};
use crate::motion::Transfer;
use crate::space::Tables;

/// Makes the mesh of a state anew, with bodies where they are, and takes the flow over. On error the
/// state is where it was.
///
/// # Errors
/// When the mesh cannot be made, or the flow not be made divergence-free on it, in words.
pub(super) fn remake(
    model: &Model,
    problem: &Problem,
    state: &mut State,
    follower: &Follower,
) -> Result<Follower, String> {
    if follower.waves() {
        return Err("a side that waves is not meshed anew; take a smaller amplitude".to_owned());
    }
    let origin = state.origin;
    let old_places = state.in_frame(&origin, &state.places);
    let shapes_at =
        |time: f64| BodyShapes::at(&problem.bodies, time).map_err(|error| error.to_string());
    let (now, before) = (shapes_at(state.time)?, shapes_at(state.time_before())?);
    let shapes = follower.shapes_at(&old_places, &now);
    let opened = open(follower.domain(), &model.case.mesh_domain(), shapes)?;
    let shifts = opened.shifts.iter();
    let wraps: Vec<Point<2>> =
        state.wraps.iter().zip(shifts).map(|(wrap, shift)| wrap + shift).collect();
    let places = seen_from(&origin, &state.places, &wraps);
    // The frame was elsewhere, too
    let origin_before = state.origin_at(problem, &state.previous_places);
    let previous_places = seen_from(&origin_before, &state.previous_places, &wraps);
    let new = opened.mesh(&sizing(&model.case)).map_err(|error| error.to_string())?;
    let Opened { domain, shapes, .. } = opened;
    let made_at = (places.clone(), state.time);
    let made = Follower::new(model, problem, &new, domain.clone(), shapes, made_at)?;

    let old = state.mesh_in_frame();
    let tables = Tables::new(problem.metric);
    let transfer = between(&domain, &tables, &old, &new)
        .ok_or("the flow could not be found in the old mesh")?;
    // One level back the new mesh is where its own motion puts it: nodes whose velocity jumps would
    // cost the next step its second order.
    let mut new_before = new.clone();
    new_before.nodes = made.nodes(&previous_places, &before).map_err(|error| error.to_string())?;
    let mut old_before = old.clone();
    old_before.nodes.clone_from(&state.nodes_before);
    let transfer_before = between(&domain, &tables, &old_before, &new_before)
        .ok_or("the flow of the step before could not be found in the old mesh")?;
    let sides = NodeSides::new(&new);
    let mut on_bodies = Vec::new();
    for (body, rigid) in problem.bodies.iter().enumerate() {
        on_bodies.extend(sides.nodes_on(rigid.boundary).map(|node| (node, body)));
    }
    let poses = |places: &[Place]| -> Vec<Pose> { places.iter().map(pose_at).collect() };
    let mut projection = DivergenceFree::new(problem, &new)
        .map_err(|error| format!("the flow on the new mesh: {error}"))?;
    let mut level = |transfer: &Transfer<'_>,
                     old: &Solution,
                     places: &[Place],
                     origin: Point<2>,
                     shapes: &BodyShapes| {
        let mesh = transfer.mesh();
        let mut solution = Solution {
            velocity: transfer.quadratic(&old.velocity),
            pressure: transfer.linear(&old.pressure),
            twists: old.twists.clone(),
        };
        let poses = poses(places);
        let surfaces = shapes.surfaces(&problem.bodies, &poses);
        for &(node, body) in &on_bodies {
            let (pose, place) = (&poses[body], mesh.nodes[node]);
            let lever = Vector3::new(place.x, place.y, 0.0) - pose.center;
            let rigid = old.twists[body].velocity_at(&lever).xy();
            solution.velocity[node] = rigid + surfaces[body].velocity(&place);
        }
        hold_sides(problem, mesh, &sides, &origin, shapes.time(), &mut solution.velocity);
        let missed = transfer.missed(&tables, &old.velocity, &solution.velocity);
        projection
            .move_to(problem, mesh)
            .and_then(|()| projection.project_with(mesh, &solution.velocity, &missed))
            .map(|velocity| Solution { velocity, ..solution })
            .map_err(|error| format!("the flow on the new mesh: {error}"))
    };
    let new_now = level(&transfer, &state.now, &places, origin, &now)?;
    let new_previous =
        level(&transfer_before, &state.previous, &previous_places, origin_before, &before)?;
    let rates = transfer.quadratic(&state.rates);
    (state.now, state.previous, state.rates, state.wraps) = (new_now, new_previous, rates, wraps);
    state.nodes_before = new_before.nodes;
    state.nodes.clone_from(&new.nodes);
    state.mesh = new;
    for node in &mut state.mesh.nodes {
        *node += origin;
    }
    Ok(made)
}

/// From one mesh of a domain to another, quadrature points included; the cells of both may lie periods
/// apart. `None` as of [`Transfer::new`].
fn between<'a>(
    domain: &Domain,
    tables: &Tables<2>,
    old: &'a Mesh<2>,
    new: &'a Mesh<2>,
) -> Option<Transfer<'a>> {
    let images = domain.images_around(old.nodes.iter().chain(&new.nodes).copied());
    Transfer::new(old, new, &images)?.with_points(tables, &images)
}

/// Gives nodes on sides the velocities that hold there.
fn hold_sides(
    problem: &Problem,
    mesh: &Mesh<2>,
    sides: &NodeSides,
    origin: &Point<2>,
    time: f64,
    velocity: &mut [Point<2>],
) {
    for (node, boundaries) in sides.iter() {
        let is_body =
            |&boundary: &usize| matches!(mesh.boundaries[boundary].kind, BoundaryKind::Body(_));
        if boundaries.iter().any(is_body) {
            continue;
        }
        if let Some(given) = problem.given_velocity(&boundaries, &(mesh.nodes[node] + origin), time)
        {
            velocity[node] = given;
        } else {
            for axis in problem.symmetry_axes(&boundaries) {
                velocity[node][axis] = 0.0;
            }
        }
    }
}
