//! What holds on the sides of a domain.

mod balance;
mod profile;
mod section;

pub(super) use balance::check_net_inflow;

use alewife_mesh::{Circle, Mesh, Point, SideShape};

use self::profile::profile;
use self::section::{Amount, developed};
use super::formulas::{number, vector};

use crate::case::{BoundaryCondition, Case, DomainSpec, Geometry, TimeFunction, normal_axis};
use crate::coupling::{PressureProfile, Side, VelocityProfile};
use crate::gait::WavingSheet;
use crate::run::RunError;
use crate::space::Metric;
use crate::time::factor_at;

/// What holds on a side of the domain.
pub(super) fn side<const D: usize>(
    case: &Case,
    mesh: &Mesh<D>,
    name: &str,
) -> Result<Side<D>, RunError> {
    let condition = case.boundary.get(name).ok_or_else(|| {
        RunError::Unsupported(format!("side `{name}` of the domain has no condition in [boundary]"))
    })?;
    let scaled = |profile: VelocityProfile<D>, factor: &Option<TimeFunction>| {
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
            Side::Velocity { profile: Box::new(|_, _| Point::<D>::zeros()), is_wall: true }
        }
        BoundaryCondition::WavingSheet { amplitude, wavelength, period, extensible } => {
            let sheet = WavingSheet::new(*amplitude, *wavelength, *period, *extensible);
            let profile: VelocityProfile<D> = Box::new(move |point, time| {
                let velocity = sheet.velocity(point[0], time);
                Point::<D>::from_fn(|axis, _| velocity.as_slice().get(axis).copied().unwrap_or(0.0))
            });
            Side::Velocity { profile, is_wall: true }
        }
        BoundaryCondition::DoNothing => Side::DoNothing,
        BoundaryCondition::TractionFree => Side::TractionFree,
        BoundaryCondition::Periodic(_) => Side::Periodic,
        BoundaryCondition::Axis => Side::Symmetry { normal_axis: Metric::RADIAL },
        BoundaryCondition::Symmetry => Side::Symmetry { normal_axis: mirror_axis(case, name)? },
        BoundaryCondition::Velocity { value, factor } => scaled(vector(case, value)?, factor),
        BoundaryCondition::Pressure { value, factor, backflow } => {
            let (pressure, factor) = (number(case, value)?, factor.clone());
            let profile: PressureProfile<D> = Box::new(move |place, time| {
                pressure(place, time) * factor_at(factor.as_ref(), time)
            });
            Side::Pressure { profile, backflow: *backflow }
        }
        BoundaryCondition::Traction { value, factor, backflow } => {
            let (traction, factor) = (vector(case, value)?, factor.clone());
            let profile: VelocityProfile<D> = Box::new(move |place, time| {
                traction(place, time) * factor_at(factor.as_ref(), time)
            });
            Side::Traction { profile, backflow: *backflow }
        }
        BoundaryCondition::Profile(spec) => scaled(profile(spec, mesh, name)?, &spec.factor),
        BoundaryCondition::Developed { flux, peak, factor } => {
            scaled(developed(case, mesh, name, amount(name, *flux, *peak)?)?, factor)
        }
        BoundaryCondition::Parabolic { peak, factor } => {
            let profile = match case.given_mesh() {
                Some(given) => match parabola_through(given.side_shape(name), *peak) {
                    Some(parabola) => parabola,
                    None => developed(case, mesh, name, Amount::Peak(*peak))?,
                },
                None => parabola(case, *peak),
            };
            scaled(profile, factor)
        }
        BoundaryCondition::Shear { rate, origin, factor } => {
            let (rate, origin) = (*rate, *origin);
            scaled(Box::new(move |point, _| along_x(rate * (point[1] - origin))), factor)
        }
    })
}

/// How much flows through a side with a developed flow.
fn amount(side: &str, flux: Option<f64>, peak: Option<f64>) -> Result<Amount, RunError> {
    flux.map(Amount::Flux).or(peak.map(Amount::Peak)).ok_or_else(|| {
        RunError::Unsupported(format!("side `{side}` has neither a flux nor a peak"))
    })
}

fn along_x<const D: usize>(speed: f64) -> Point<D> {
    Point::<D>::from_fn(|axis, _| if axis == 0 { speed } else { 0.0 })
}

/// The axis a mirror plane is normal to.
fn mirror_axis(case: &Case, side: &str) -> Result<usize, RunError> {
    if let Some(shape) = case.given_mesh().and_then(|mesh| mesh.side_shape(side)) {
        return shape.normal_axis().ok_or_else(|| {
            RunError::Unsupported(format!("side `{side}` is not flat and normal to x, y or z"))
        });
    }
    let is_cylinder = matches!(case.domain, DomainSpec::Cylinder { .. });
    match normal_axis(side) {
        Some(axis) => Ok(axis),
        None if is_cylinder && case.geometry == Geometry::Axisymmetric => Ok(Metric::RADIAL),
        None => Err(RunError::Unsupported(format!(
            "side `{side}` is curved, and a symmetry plane is straight"
        ))),
    }
}

/// A velocity into a given mesh that is largest in the middle of a side, and zero at its ends or its
/// round rim; `None` of other sides.
fn parabola_through<const D: usize>(
    shape: Option<&SideShape>,
    peak: f64,
) -> Option<VelocityProfile<D>> {
    let shape = shape?;
    let (inward, Circle { center, radius }) = (shape.inward(), shape.circle?);
    let velocity = Point::<D>::from_fn(|axis, _| peak * inward[axis]);
    let center = Point::<D>::from_fn(|axis, _| center[axis]);
    Some(Box::new(move |point, _| {
        velocity * (1.0 - (point - center).norm_squared() / (radius * radius))
    }))
}

/// A velocity along x that is zero at walls, a parabola across each axis with its largest value in the
/// middle or at a plane of symmetry; in a round section that of Poiseuille.
fn parabola<const D: usize>(case: &Case, peak: f64) -> VelocityProfile<D> {
    if let (DomainSpec::Cylinder { radius, .. }, Geometry::Spatial) = (&case.domain, case.geometry)
    {
        let square = radius * radius;
        return Box::new(move |point, _| {
            let distance: f64 = (1..D).map(|axis| point[axis] * point[axis]).sum();
            along_x(peak * (1.0 - distance / square))
        });
    }
    let across = case.walls_across();
    Box::new(move |point, _| {
        let parts = across.iter().take(D).enumerate().skip(1).map(|(axis, ends)| {
            let Some([low, high]) = *ends else { return 1.0 };
            let s = (point[axis] - low) / (high - low);
            4.0 * s * (1.0 - s)
        });
        along_x(peak * parts.product::<f64>())
    })
}
