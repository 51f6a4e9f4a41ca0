//! Problems made by hand, without a case file.

use alewife_core::body::Pose;
use alewife_core::coupling::{Problem, RigidBody, Side, VelocityProfile};
use alewife_core::flow::Viscosity;
use alewife_core::space::Metric;
use alewife_mesh::{BoundaryId, BoundaryKind, Mesh, Point};

/// A profile that is zero.
#[must_use]
pub fn rest() -> VelocityProfile<2> {
    Box::new(|_, _| Point::<2>::zeros())
}

/// The same velocity on every side; the axis is a symmetry plane.
#[must_use]
pub fn sides<const D: usize>(
    mesh: &Mesh<D>,
    profile: impl Fn(&Point<D>, f64) -> Point<D> + Send + Sync + Clone + 'static,
) -> Vec<Option<Side<D>>> {
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
pub fn fluid_only<const D: usize>(
    mesh: &Mesh<D>,
    sides: Vec<Option<Side<D>>>,
    density: f64,
    viscosity: f64,
    metric: Metric,
) -> Problem<D> {
    let bodies = mesh.boundaries.iter().enumerate().filter_map(|(index, boundary)| {
        let BoundaryKind::Body(_) = boundary.kind else { return None };
        let pose = Pose::planar(0.0, 0.0, 0.0);
        Some(RigidBody::held(boundary.name.clone(), BoundaryId::new(index), pose))
    });
    Problem {
        metric,
        density,
        viscosity: Viscosity::Newtonian(viscosity),
        has_inertia: density > 0.0,
        has_convection: density > 0.0,
        sides,
        reports_sides: false,
        bodies: bodies.collect(),
        groups: Vec::new(),
        frame: None,
        mean_flow: None,
        force: None,
        initial: None,
        rate_discontinuities: None,
    }
}
