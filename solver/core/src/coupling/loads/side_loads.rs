//! The load of the fluid on each side, from the residual as that of bodies.
//!
//! The residual of a node is the force of all the boundary there on the fluid. Where sides meet it is divided: an
//! open side has the traction that its condition gives, the others the traction of the flow, and what the residual has
//! beyond these in equal parts. So the loads of all sides and bodies add up to the change of momentum.

use std::collections::{BTreeMap, BTreeSet};

use alewife_mesh::{BoundaryId, NodeId, Point};

use super::super::boundaries::BoundaryNode;
use super::super::problem::{Problem, Side};
use super::ResidualOnMesh;
use super::surface_load::{SidesAt, SurfaceStress, Traction};
use crate::body::Wrench;

/// Force of a side on the fluid by node (N).
type NodalForces<const D: usize> = BTreeMap<NodeId, Point<D>>;

/// What a side has of the force of all sides at a node on the fluid.
struct Share<const D: usize> {
    boundary: BoundaryId,
    /// Force (N).
    force: Point<D>,
}

/// Loads on each boundary that is a side, the torque about the origin; none on bodies and periodic sides.
#[must_use]
pub fn side_loads<const D: usize>(
    problem: &Problem<D>,
    flow: &ResidualOnMesh<'_, D>,
    stress: &SurfaceStress<'_, D>,
    when: SidesAt<D>,
) -> Vec<Wrench> {
    let mut loads = vec![Wrench::default(); problem.sides.len()];
    let tractions = tractions(problem, flow, stress, when);
    for at in flow.boundaries.nodes().filter(|at| at.body.is_none()) {
        let point = &flow.mesh.nodes[at.node];
        for Share { boundary, force } in shares(problem, &tractions, &at, flow.force_at(at.node)) {
            loads[boundary].force -= problem.metric.total_force(&force);
            loads[boundary].torque -= problem.metric.total_torque(point, &force);
        }
    }
    loads
}

/// Whether a boundary is a side with a load.
fn has_load<const D: usize>(problem: &Problem<D>, boundary: BoundaryId) -> bool {
    problem.sides[boundary].as_ref().is_some_and(|side| !matches!(side, Side::Periodic))
}

fn is_open<const D: usize>(problem: &Problem<D>, boundary: BoundaryId) -> bool {
    problem.sides[boundary].as_ref().is_some_and(Side::is_open)
}

/// Integrals of tractions: of open sides what their conditions give at all their nodes, of others that of the flow where
/// they meet.
fn tractions<const D: usize>(
    problem: &Problem<D>,
    flow: &ResidualOnMesh<'_, D>,
    stress: &SurfaceStress<'_, D>,
    when: SidesAt<D>,
) -> Vec<NodalForces<D>> {
    let closed = |at: &BoundaryNode| {
        let sides = at.boundaries.iter();
        sides.filter(|&&side| has_load(problem, side) && !is_open(problem, side)).count()
    };
    let shared = flow.boundaries.nodes().filter(|at| at.body.is_none() && closed(at) > 1);
    let shared: BTreeSet<NodeId> = shared.map(|at| at.node).collect();
    let of_boundary = |(boundary, side): (usize, &Option<Side<D>>)| {
        let boundary = BoundaryId::new(boundary);
        match side {
            Some(Side::DoNothing) => {
                stress.nodal_tractions(boundary, Traction::OfDevelopedFlow, |_| true)
            }
            Some(side @ (Side::Pressure { .. } | Side::Traction { .. })) => {
                stress.given_tractions(boundary, side, when)
            }
            None | Some(Side::TractionFree | Side::Periodic) => NodalForces::new(),
            Some(Side::Velocity { .. } | Side::Symmetry { .. }) => {
                stress.nodal_tractions(boundary, Traction::Whole, |node| shared.contains(&node))
            }
        }
    };
    problem.sides.iter().enumerate().map(of_boundary).collect()
}

/// What each side at a node has of the force there on the fluid (N).
fn shares<const D: usize>(
    problem: &Problem<D>,
    tractions: &[NodalForces<D>],
    at: &BoundaryNode,
    force: Point<D>,
) -> Vec<Share<D>> {
    let own = |boundary: BoundaryId| {
        tractions[boundary].get(&at.node).copied().unwrap_or_else(Point::<D>::zeros)
    };
    let sides = || at.boundaries.iter().copied().filter(|&side| has_load(problem, side));
    let (open, closed): (Vec<BoundaryId>, Vec<BoundaryId>) =
        sides().partition(|&side| is_open(problem, side));
    // The residual has no traction of open sides
    let share = |&boundary: &BoundaryId| Share { boundary, force: own(boundary) };
    let mut shares: Vec<Share<D>> = open.iter().map(share).collect();
    let takers = if closed.is_empty() { &open } else { &closed };
    if let [only] = takers[..] {
        match shares.iter_mut().find(|share| share.boundary == only) {
            Some(share) => share.force += force,
            None => shares.push(Share { boundary: only, force }),
        }
        return shares;
    }
    let first = shares.len();
    shares.extend(closed.iter().map(share));
    let first = if closed.is_empty() { 0 } else { first };
    for axis in 0..D {
        divide(problem, &mut shares[first..], axis, force[axis], !closed.is_empty());
    }
    shares
}

/// Gives sides their parts of a force along an axis (N), those without a traction along it none.
fn divide<const D: usize>(
    problem: &Problem<D>,
    shares: &mut [Share<D>],
    axis: usize,
    force: f64,
    has_tractions: bool,
) {
    let holds = |boundary: BoundaryId| match problem.sides[boundary] {
        Some(Side::Symmetry { normal_axis }) => normal_axis == axis,
        _ => true,
    };
    let any = shares.iter().any(|share| holds(share.boundary));
    let takers: Vec<usize> =
        (0..shares.len()).filter(|&nth| !any || holds(shares[nth].boundary)).collect();
    let mut rest = force;
    for (nth, share) in shares.iter_mut().enumerate() {
        if has_tractions && takers.contains(&nth) {
            rest -= share.force[axis];
        } else if has_tractions {
            share.force[axis] = 0.0;
        }
    }
    for &nth in &takers {
        shares[nth].force[axis] += rest / takers.len() as f64;
    }
}
