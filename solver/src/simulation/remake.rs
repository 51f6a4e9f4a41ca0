//! A new mesh in the middle of a run, with both levels of the flow taken over to it.

use alewife_mesh::{BoundaryKind, Domain, Mesh, PlacedShape, Point, generate};
use nalgebra::Vector3;

use super::build::sizing;
use super::follow::Follower;
use super::state::{State, pose_at, seen_from};
use crate::body::Pose;
use crate::case::Case;
use crate::contact::Place;
use crate::coupling::{DivergenceFree, NodeSides, Problem, Solution};
use crate::motion::Transfer;
use crate::space::Tables;

/// Part of the widest free strip of a periodic domain that has to be left at its sides.
const STRIP_LEFT: f64 = 0.25;

/// Makes the mesh of a state anew, with bodies where they are, and takes the flow over. On error the
/// state is where it was.
///
/// # Errors
/// When the mesh cannot be made, or the flow not be made divergence-free on it, in words.
pub(super) fn remake(
    case: &Case,
    problem: &Problem,
    state: &mut State,
    follower: &Follower,
) -> Result<Follower, String> {
    let origin = state.origin;
    let old_places = state.in_frame(&origin, &state.places);
    let mut shapes = follower.shapes_at(&old_places, state.time);
    let domain = cut(follower.domain(), &shapes)?;
    let shifts: Vec<Point<2>> = shapes.iter().map(|shape| into(&domain, &shape.center)).collect();
    for (shape, shift) in shapes.iter_mut().zip(&shifts) {
        shape.center += shift;
    }
    let wraps: Vec<Point<2>> =
        state.wraps.iter().zip(&shifts).map(|(wrap, shift)| wrap + shift).collect();
    let places = seen_from(&origin, &state.places, &wraps);
    let previous_places = seen_from(&origin, &state.previous_places, &wraps);
    let new = generate(&domain, &shapes, &sizing(case)).map_err(|error| error.to_string())?;
    let made_at = (places.clone(), state.time);
    let made = Follower::new(case, problem, &new, domain.clone(), shapes, made_at)?;

    let old = state.mesh_in_frame();
    let tables = Tables::new(problem.axisymmetric);
    let transfer = Transfer::new(&old, &new, &domain.images())
        .and_then(|transfer| transfer.with_points(&tables, &domain.images()))
        .ok_or("the flow could not be found in the old mesh")?;
    let mut before = new.clone();
    before.nodes = transfer.positions(&state.nodes_before);
    // What bodies carry was where they were, exactly.
    let sides = NodeSides::new(&new);
    let mut on_bodies = Vec::new();
    for (body, rigid) in problem.bodies.iter().enumerate() {
        on_bodies.extend(sides.nodes_on(rigid.boundary).map(|node| (node, body)));
    }
    let back = made.carried(&on_bodies, &new, &previous_places, state.time_before());
    for (&(node, _), way) in on_bodies.iter().zip(back) {
        before.nodes[node] = new.nodes[node] + way;
    }
    let poses = |places: &[Place]| -> Vec<Pose> { places.iter().map(pose_at).collect() };
    let mut projection = DivergenceFree::new(problem, &new)
        .map_err(|error| format!("the flow on the new mesh: {error}"))?;
    let mut level =
        |mesh: &Mesh<2>, old: &Solution, places: &[Place], origin: Point<2>, time: f64| {
            let mut solution = Solution {
                velocity: transfer.quadratic(&old.velocity),
                pressure: transfer.linear(&old.pressure),
                twists: old.twists.clone(),
            };
            let poses = poses(places);
            let pairs = problem.bodies.iter().zip(&poses);
            let surfaces: Vec<_> = pairs.map(|(body, pose)| body.surface(pose, time)).collect();
            for &(node, body) in &on_bodies {
                let (pose, place) = (&poses[body], mesh.nodes[node]);
                let lever = Vector3::new(place.x, place.y, 0.0) - pose.center;
                let rigid = old.twists[body].velocity_at(&lever).xy();
                solution.velocity[node] = rigid + surfaces[body].velocity(&place);
            }
            hold_sides(problem, mesh, &sides, &origin, time, &mut solution.velocity);
            let missed = transfer.missed(&tables, mesh, &old.velocity, &solution.velocity);
            projection
                .move_to(problem, mesh)
                .and_then(|()| projection.project_with(mesh, &solution.velocity, &missed))
                .map(|velocity| Solution { velocity, ..solution })
                .map_err(|error| format!("the flow on the new mesh: {error}"))
        };
    let now = level(&new, &state.now, &places, origin, state.time)?;
    let previous = level(
        &before,
        &state.previous,
        &previous_places,
        state.origin_at(problem, &state.previous_places),
        state.time_before(),
    )?;
    let rates = transfer.quadratic(&state.rates);
    (state.now, state.previous, state.rates, state.wraps) = (now, previous, rates, wraps);
    state.nodes_before = before.nodes;
    state.nodes.clone_from(&new.nodes);
    state.mesh = new;
    for node in &mut state.mesh.nodes {
        *node += origin;
    }
    Ok(made)
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

/// The domain, its periodic sides put where no body is.
///
/// # Errors
/// When bodies leave no free strip.
fn cut(domain: &Domain, shapes: &[PlacedShape]) -> Result<Domain, String> {
    let mut moved = domain.clone();
    for axis in 0..2 {
        let Some((start, length)) = periodic_range(&moved, axis) else { continue };
        let mut taken = Vec::new();
        for shape in shapes {
            let outline = alewife_mesh::Outline::new(shape).map_err(|error| error.to_string())?;
            let reach = outline.reach();
            let from = (outline.center()[axis] - reach - start).rem_euclid(length);
            taken.push((from, from + 2.0 * reach));
        }
        taken.sort_by(|one, other| one.0.total_cmp(&other.0));
        let Some(&(first, _)) = taken.first() else { continue };
        // Free strips, each from the farthest end so far to the next start.
        let mut end = taken.iter().map(|(_, end)| end - length).fold(f64::NEG_INFINITY, f64::max);
        let mut strips = Vec::new();
        for &(from, to) in taken.iter().chain(&[(first + length, first + length)]) {
            if from > end {
                strips.push((end, from));
            }
            end = end.max(to);
        }
        let widest = strips.iter().copied().max_by(|a, b| (a.1 - a.0).total_cmp(&(b.1 - b.0)));
        let Some((from, to)) = widest else {
            return Err(format!(
                "bodies leave no straight strip free across the periodic direction {}",
                ["x", "y"][axis]
            ));
        };
        let margin = STRIP_LEFT * (to - from);
        let is_free = strips.iter().any(|&(from, to)| {
            [0.0, length].iter().any(|at| at - from >= margin && to - at >= margin)
        });
        if !is_free {
            shift(&mut moved, axis, (0.5 * (from + to)).rem_euclid(length));
        }
    }
    Ok(moved)
}

/// Start and length of the domain along a periodic axis.
fn periodic_range(domain: &Domain, axis: usize) -> Option<(f64, f64)> {
    match (domain, axis) {
        (Domain::Box { min, max, periodic_x: true, .. }, 0)
        | (Domain::Box { min, max, periodic_y: true, .. }, 1) => {
            Some((min[axis], max[axis] - min[axis]))
        }
        (Domain::Cylinder { x, periodic_x: true, .. }, 0) => Some((x[0], x[1] - x[0])),
        _ => None,
    }
}

/// Where a domain starts along its periodic directions (m), zero along others.
pub(super) fn start_of(domain: &Domain) -> [f64; 2] {
    [0, 1].map(|axis| periodic_range(domain, axis).map_or(0.0, |(start, _)| start))
}

/// A domain that starts elsewhere along its periodic directions.
pub(super) fn started_at(domain: &Domain, start: [f64; 2]) -> Domain {
    let mut moved = domain.clone();
    for (axis, start) in start.into_iter().enumerate() {
        if let Some((now, _)) = periodic_range(domain, axis) {
            shift(&mut moved, axis, start - now);
        }
    }
    moved
}

fn shift(domain: &mut Domain, axis: usize, way: f64) {
    match domain {
        Domain::Box { min, max, .. } => {
            min[axis] += way;
            max[axis] += way;
        }
        Domain::Cylinder { x, .. } => {
            x[0] += way;
            x[1] += way;
        }
        Domain::Disc { .. } | Domain::HalfDisc { .. } => {}
    }
}

/// Whole periods that take a point into the domain (m).
fn into(domain: &Domain, point: &Point<2>) -> Point<2> {
    let mut shift = Point::<2>::zeros();
    for axis in 0..2 {
        if let Some((start, length)) = periodic_range(domain, axis) {
            shift[axis] = -((point[axis] - start) / length).floor() * length;
        }
    }
    shift
}

#[cfg(test)]
mod tests {
    use super::*;
    use alewife_mesh::Shape;

    fn disc(x: f64, y: f64) -> PlacedShape {
        PlacedShape {
            name: "disc".into(),
            shape: Shape::Disc { radius: 0.2 },
            center: Point::<2>::new(x, y),
            angle: 0.0,
            size: None,
        }
    }

    fn strip() -> Domain {
        let (min, max) = (Point::<2>::new(0.0, -1.0), Point::<2>::new(2.0, 1.0));
        Domain::Box { min, max, periodic_x: true, periodic_y: false }
    }

    #[test]
    fn the_cut_of_a_periodic_domain_keeps_off_the_bodies() {
        let range = |domain: &Domain| periodic_range(domain, 0).unwrap().0;
        assert_eq!(range(&cut(&strip(), &[disc(1.0, 0.0)]).unwrap()), 0.0);
        // Half way round from a body on the cut, and from one that went round
        for x in [0.1, 2.1, -1.9, 14.1] {
            let moved = cut(&strip(), &[disc(x, 0.0)]).unwrap();
            assert!((range(&moved) - 1.1).abs() < 1e-12, "{x}: {moved:?}");
            let inside = x + into(&moved, &Point::<2>::new(x, 0.0)).x;
            assert!((1.1..3.1).contains(&inside), "{x}: {inside}");
        }
        let two = cut(&strip(), &[disc(0.0, 0.5), disc(0.5, 0.0)]).unwrap();
        assert!((range(&two) - 1.25).abs() < 1e-12, "{two:?}");
        let crowd: Vec<_> = (0..8).map(|i| disc(0.25 * f64::from(i), 0.0)).collect();
        assert!(cut(&strip(), &crowd).unwrap_err().contains("direction x"));
    }
}
