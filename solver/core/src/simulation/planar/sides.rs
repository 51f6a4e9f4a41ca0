//! The problem of a planar or axisymmetric case, with the sides of its domain.

use alewife_mesh::{Mesh, Point};

use crate::case::{BoundaryCondition, Case, DomainSpec, Model, TimeFunction};
use crate::coupling::{Problem, Side, VelocityProfile};
use crate::gait::WavingSheet;
use crate::simulation::RunError;
use crate::simulation::build::problem_with_sides;
use crate::space::Metric;
use crate::time::factor_at;

/// The problem of a case on its mesh.
///
/// # Errors
/// When the case asks for something that is not there yet.
pub fn build_problem(model: &Model, mesh: &Mesh<2>) -> Result<Problem<2>, RunError> {
    problem_with_sides(model, mesh, |name| side(&model.case, name))
}

/// Lower and upper end of the domain along y, where profiles are zero.
fn height_range(case: &Case) -> [f64; 2] {
    match &case.domain {
        DomainSpec::Box { min, max } => [min[1], max[1]],
        DomainSpec::Channel { height, .. } => [0.0, *height],
        DomainSpec::Disc { center, radius } => [center[1] - radius, center[1] + radius],
        // Symmetric about the axis.
        DomainSpec::HalfDisc { radius, .. } | DomainSpec::Cylinder { radius, .. } => {
            [-radius, *radius]
        }
    }
}

/// What holds on a side of the domain.
fn side(case: &Case, name: &str) -> Result<Side<2>, RunError> {
    let condition = case.boundary.get(name).ok_or_else(|| {
        RunError::Unsupported(format!("side `{name}` of the domain has no condition in [boundary]"))
    })?;
    let scaled = |profile: VelocityProfile<2>, factor: &Option<TimeFunction>| {
        let factor = factor.clone();
        Side::Velocity {
            profile: Box::new(move |point, time| {
                profile(point, time) * factor_at(factor.as_ref(), time)
            }),
            is_wall: false,
        }
    };
    Ok(match condition {
        BoundaryCondition::NoSlip => {
            Side::Velocity { profile: Box::new(|_, _| Point::<2>::zeros()), is_wall: true }
        }
        BoundaryCondition::WavingSheet { amplitude, wavelength, period, extensible } => {
            let sheet = WavingSheet::new(*amplitude, *wavelength, *period, *extensible);
            let profile: VelocityProfile<2> =
                Box::new(move |point, time| sheet.velocity(point[0], time));
            Side::Velocity { profile, is_wall: true }
        }
        BoundaryCondition::DoNothing => Side::DoNothing,
        BoundaryCondition::TractionFree => Side::TractionFree,
        BoundaryCondition::Periodic(_) => Side::Periodic,
        BoundaryCondition::Axis => Side::Symmetry { normal_axis: Metric::RADIAL },
        BoundaryCondition::Symmetry => match name {
            "left" | "right" => Side::Symmetry { normal_axis: 0 },
            "bottom" | "top" => Side::Symmetry { normal_axis: Metric::RADIAL },
            "wall" if matches!(case.domain, DomainSpec::Cylinder { .. }) => {
                Side::Symmetry { normal_axis: Metric::RADIAL }
            }
            _ => {
                return Err(RunError::Unsupported(format!(
                    "side `{name}` is curved, and a symmetry plane is straight"
                )));
            }
        },
        BoundaryCondition::Velocity { value, factor } => {
            let value = Point::<2>::new(value[0], value[1]);
            scaled(Box::new(move |_, _| value), factor)
        }
        BoundaryCondition::Parabolic { peak, factor } => {
            let ([low, high], peak) = (height_range(case), *peak);
            scaled(
                Box::new(move |point, _| {
                    let s = (point[1] - low) / (high - low);
                    Point::<2>::new(4.0 * peak * s * (1.0 - s), 0.0)
                }),
                factor,
            )
        }
        BoundaryCondition::Shear { rate, origin, factor } => {
            let (rate, origin) = (*rate, *origin);
            scaled(
                Box::new(move |point, _| Point::<2>::new(rate * (point[1] - origin), 0.0)),
                factor,
            )
        }
    })
}
