//! Problems made by hand, without a case file.

use alewife_core::body::{Pose, Wrench};
use alewife_core::coupling::{Drive, Problem, RigidBody, Side, VelocityProfile};
use alewife_core::space::Metric;
use alewife_mesh::{BoundaryKind, Mesh, Point};

/// A profile that is zero.
#[must_use]
pub fn rest() -> VelocityProfile {
    Box::new(|_, _| Point::<2>::zeros())
}

/// The same velocity on every side; the axis is a symmetry plane.
#[must_use]
pub fn sides(
    mesh: &Mesh<2>,
    profile: impl Fn(&Point<2>, f64) -> Point<2> + Send + Sync + Clone + 'static,
) -> Vec<Option<Side>> {
    mesh.boundaries
        .iter()
        .map(|boundary| match boundary.kind {
            BoundaryKind::Body(_) => None,
            BoundaryKind::Axis => Some(Side::Symmetry { normal_axis: 1 }),
            BoundaryKind::Side => {
                Some(Side::Velocity { profile: Box::new(profile.clone()), is_wall: false })
            }
        })
        .collect()
}

/// A problem whose bodies, if any, are held.
#[must_use]
pub fn fluid_only(
    mesh: &Mesh<2>,
    sides: Vec<Option<Side>>,
    density: f64,
    viscosity: f64,
    metric: Metric,
) -> Problem {
    let bodies = mesh.boundaries.iter().enumerate().filter_map(|(index, boundary)| {
        let BoundaryKind::Body(_) = boundary.kind else { return None };
        Some(RigidBody {
            name: boundary.name.clone(),
            boundary: index,
            pose: Pose::planar(0.0, 0.0, 0.0),
            drives: [0, 1, 2].map(|_| Drive::Given(Box::new(|_| 0.0))),
            volume: 0.0,
            second_moment: 0.0,
            mass: 0.0,
            inertia: 0.0,
            weight: Wrench::default(),
            load: Wrench::default(),
            load_factor: None,
            spring: None,
            gait: None,
            shape: None,
            link: None,
        })
    });
    Problem {
        metric,
        density,
        viscosity,
        has_inertia: density > 0.0,
        has_convection: density > 0.0,
        sides,
        bodies: bodies.collect(),
        groups: Vec::new(),
        frame: None,
        body_force: None,
        rate_discontinuities: None,
    }
}
