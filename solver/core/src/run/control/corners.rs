//! Times at which something that is given in a table begins to rise or to fall, or ends to: a step that ends there passes
//! over no pulse.

use std::cmp::Ordering;

use crate::case::{
    Body, BoundaryCondition, Case, DrivenLaw, GaitSpec, JointKind, Model, Motion, Stroke,
    TimeFunction,
};

/// The first such time (s) between two others, of velocities and loads.
pub(super) fn next_corner(model: &Model, [from, to]: [f64; 2]) -> Option<f64> {
    let of_bodies = model.bodies.iter().flat_map(of_body);
    let of_joints = model.joints.iter().filter_map(|joint| match &joint.kind {
        JointKind::Hinge(hinge) => hinge.torque.as_ref().and_then(of_stroke),
        JointKind::Slider(slider) => slider.force.as_ref().and_then(of_stroke),
        JointKind::Arm { .. } | JointKind::Bent { .. } | JointKind::Ball(_) => None,
    });
    let tables = of_bodies.chain(of_joints).chain(of_case(&model.case));
    let times = tables.flat_map(corners).filter(|time| *time > from && *time < to);
    times.reduce(f64::min)
}

/// Knots of a table before and behind which it does not rise alike, fall alike or stay.
fn corners(knots: &[[f64; 2]]) -> impl Iterator<Item = f64> {
    let trend = |at: usize| match (knots.get(at.wrapping_sub(1)), knots.get(at)) {
        (Some(before), Some(after)) => before[1].partial_cmp(&after[1]),
        _ => Some(Ordering::Equal),
    };
    let is_corner = move |at: &usize| trend(*at) != trend(at + 1);
    (0..knots.len()).filter(is_corner).map(|at| knots[at][0])
}

fn of_factor(factor: &TimeFunction) -> Option<&[[f64; 2]]> {
    match factor {
        TimeFunction::Table(knots) => Some(knots),
        _ => None,
    }
}

fn of_stroke(stroke: &Stroke) -> Option<&[[f64; 2]]> {
    match stroke {
        Stroke::Table(knots) => Some(knots),
        _ => None,
    }
}

/// Tables of sides, of what drives the fluid and of the magnetic field.
fn of_case(case: &Case) -> impl Iterator<Item = &[[f64; 2]]> {
    let sides = case.boundary.values().filter_map(|condition| match condition {
        BoundaryCondition::Velocity { factor, .. }
        | BoundaryCondition::Parabolic { factor, .. }
        | BoundaryCondition::Developed { factor, .. }
        | BoundaryCondition::Pressure { factor, .. }
        | BoundaryCondition::Traction { factor, .. }
        | BoundaryCondition::Shear { factor, .. } => factor.as_ref(),
        BoundaryCondition::Profile(profile) => profile.factor.as_ref(),
        _ => None,
    });
    let flow = case.flow.iter().filter_map(|flow| flow.factor.as_ref());
    let magnetic = case.field.iter().filter_map(|field| field.magnetic.as_ref());
    let magnetic = magnetic.flat_map(|field| &field.components).filter_map(of_stroke);
    sides.chain(flow).filter_map(of_factor).chain(magnetic)
}

/// Tables of the load, the motion and the slip of a body.
fn of_body(body: &Body) -> impl Iterator<Item = &[[f64; 2]]> {
    let imposed = match &body.motion {
        Motion::Imposed(imposed) => [&imposed.factor, &imposed.angular_factor],
        _ => [&None, &None],
    };
    let driven = body.driven.iter().filter_map(|driven| match &driven.law {
        DrivenLaw::Rate(rate) => rate.factor.as_ref(),
        DrivenLaw::Way(_) => None,
    });
    let slip = body.gait.iter().flat_map(|gait| match gait {
        GaitSpec::Squirmer(gait) => gait.factors.values().collect(),
        _ => Vec::new(),
    });
    let given = imposed.into_iter().flatten().chain(&body.load_factor);
    given.chain(driven).chain(slip).filter_map(of_factor)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_has_corners_where_it_begins_to_rise_and_to_fall_and_ends_to() {
        let of = |knots: &[[f64; 2]]| corners(knots).collect::<Vec<_>>();
        let pulse = [[0.0, 0.0], [20.0, 0.0], [20.1, 1.0], [20.2, 0.5], [20.3, 0.0], [50.0, 0.0]];
        assert_eq!(of(&pulse), [20.0, 20.1, 20.3]);
        // It is constant outside
        assert_eq!(of(&[[1.0, 0.0], [2.0, 1.0]]), [1.0, 2.0]);
        assert_eq!(of(&[[1.0, 2.0], [3.0, 2.0]]), [0.0; 0]);
    }
}
