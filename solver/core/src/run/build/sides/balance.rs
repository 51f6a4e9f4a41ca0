//! Whether what enters a closed domain leaves it: sides whose flux only the mesh tells.

use alewife_mesh::{BoundaryId, Mesh};

use crate::case::{BoundaryCondition, Case};
use crate::coupling::{Problem, Side};
use crate::run::RunError;
use crate::space::FacetRule;

/// Net inflow over all that crosses the sides above which it is no error of the mesh.
const BALANCE: f64 = 1e-2;

/// Flux over that of the same speeds across the sides which is rounding.
const ROUNDING: f64 = 1e-12;

/// Times (s) at which fluxes are compared: those of expressions may differ at any.
const TIMES: [f64; 3] = [0.0, 0.382, 1.0];

/// Refuses a flux into a closed domain that has nowhere to go. Of sides with plain numbers a case tells by itself.
///
/// # Errors
/// When more enters than leaves.
pub fn check_net_inflow<const D: usize>(
    case: &Case,
    problem: &Problem<D>,
    mesh: &Mesh<D>,
) -> Result<(), RunError> {
    let is_round = |side: &str| {
        let shape = case.given_mesh().and_then(|mesh| mesh.side_shape(side));
        shape.is_none_or(|shape| shape.circle.is_some())
    };
    let is_unknown = |(side, condition): (&String, &BoundaryCondition)| match condition {
        BoundaryCondition::Velocity { value, .. } => value.iter().any(|one| one.number().is_none()),
        BoundaryCondition::Developed { .. } | BoundaryCondition::Profile(_) => true,
        BoundaryCondition::Parabolic { .. } => !is_round(side),
        _ => false,
    };
    if !problem.is_enclosed() || !case.boundary.iter().any(is_unknown) {
        return Ok(());
    }
    let rule = FacetRule::new(problem.metric);
    for time in TIMES {
        let (mut net, mut gross, mut along) = (0.0, 0.0, 0.0);
        for facet in &mesh.facets {
            let Some(Side::Velocity { profile, is_wall: false }) = side_of(problem, facet.boundary)
            else {
                continue;
            };
            rule.for_each_point(mesh, facet, |at| {
                let velocity = profile(&at.position, time);
                let inflow = -velocity.dot(&at.normal_ds);
                net += inflow;
                gross += inflow.abs();
                along += velocity.norm() * at.normal_ds.norm();
            });
        }
        // Of a side that moves along itself both are rounding
        if net.abs() > BALANCE * gross && net.abs() > ROUNDING * along {
            return Err(RunError::Unsupported(format!(
                "net inflow {net:.6} at time {time} through the prescribed velocities, and no side is open: \
                 make one side \"do-nothing\", or give it a `pressure`"
            )));
        }
    }
    Ok(())
}

fn side_of<const D: usize>(problem: &Problem<D>, boundary: BoundaryId) -> Option<&Side<D>> {
    problem.sides[boundary].as_ref()
}
