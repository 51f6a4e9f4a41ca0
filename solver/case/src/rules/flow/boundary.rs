//! Problems of `[boundary]`: sides, conditions that cannot hold there, and inflow without outflow.

use std::f64::consts::PI;

use super::given_flow::{check_backflow, check_given};
use super::given_mesh;
use crate::model::region::{normal_axis, opposite};
use crate::rules::Findings;
use crate::rules::body::joints::{check_cycle, cubic};
use crate::rules::command::check_command;
use crate::spec::formula::numbers;
use crate::text::type_error::suggestion;
use crate::{BoundaryCondition, Case, DomainSpec, Formula, Geometry, TimeFunction, TimeSettings};

/// Net inflow over gross flow above which it is an error.
const BALANCE: f64 = 1e-9;

pub fn check(findings: &mut Findings<'_>) {
    let case = findings.case();
    let sides = case.sides();
    for (side, condition) in &case.boundary {
        let key = format!("boundary.{side}");
        if sides.contains(&side.as_str()) {
            check_side(findings, &key, side, condition);
        } else if let Some(body) = case.body_around(side) {
            findings.error(
                &key,
                format!("the side `{side}` is the surface of the body \"{}\"", body.name),
                "leave it out of [boundary]: the motion of the body tells its velocity",
            );
        } else {
            findings.error(
                &key,
                format!("this domain has no side `{side}`"),
                &suggestion(side, &sides),
            );
        }
    }
    let bare: Vec<&str> = sides
        .iter()
        .copied()
        .filter(|side| *side != "axis" && !case.boundary.contains_key(*side))
        .collect();
    if !bare.is_empty() {
        let list = bare.join("`, `");
        findings.error(
            "boundary",
            format!(
                "nothing is said about the side{} `{list}`",
                if bare.len() > 1 { "s" } else { "" }
            ),
            "add to [boundary] for each: no-slip, do-nothing, traction-free, symmetry, { pressure = ... }, \
             { traction = ... }, { velocity = ... }, { profile = \"inflow.csv\" }, { parabolic = ... }, \
             { developed = ... }, { shear = ... } or { periodic = ... }",
        );
    }
    check_balance(findings);
}

/// Whether a condition can hold on a side.
fn check_side(findings: &mut Findings<'_>, key: &str, side: &str, condition: &BoundaryCondition) {
    let case = findings.case();
    let is_axisymmetric = case.geometry == Geometry::Axisymmetric;
    let is_curved = match case.domain {
        DomainSpec::Box { .. } | DomainSpec::Channel { .. } => false,
        DomainSpec::Disc { .. } | DomainSpec::HalfDisc { .. } | DomainSpec::Sphere { .. } => true,
        DomainSpec::Cylinder { .. } => side == "wall" && !is_axisymmetric,
        DomainSpec::Mesh(_) | DomainSpec::Surface(_) => {
            given_mesh::check_side(findings, key, side, condition);
            check_given(findings, key, condition);
            check_factor_of(findings, key, condition);
            return;
        }
    };
    match (side, condition) {
        ("axis", BoundaryCondition::Axis) => {}
        ("axis", _) => {
            findings.error(
                key,
                "the axis takes no condition of its own".to_owned(),
                "leave it out, or write axis = \"axis\"",
            );
            return;
        }
        (_, BoundaryCondition::Axis) => findings.error(
            key,
            format!("`axis` holds on the axis only, not on `{side}`"),
            "for a mirror plane or a frictionless wall write \"symmetry\"",
        ),
        (_, BoundaryCondition::Symmetry) if is_curved => findings.error(
            key,
            format!("`symmetry` holds on straight sides, and `{side}` is curved"),
            "write \"no-slip\" or \"traction-free\", or take a straight domain",
        ),
        (_, BoundaryCondition::Developed { .. }) if is_curved => findings.error(
            key,
            format!("flow is developed on flat sides, and `{side}` is curved"),
            "write { velocity = { value = [...] } }",
        ),
        (_, BoundaryCondition::Periodic(partner)) => check_periodic(findings, key, side, partner),
        (_, BoundaryCondition::Parabolic { .. }) if !["left", "right"].contains(&side) => findings
            .error(
                key,
                format!("a parabolic velocity enters through `left` or `right`, not `{side}`"),
                "on other sides write { developed = { peak = ... } }, positive into the domain",
            ),
        (_, BoundaryCondition::Shear { .. }) if is_axisymmetric => findings.error(
            key,
            "a simple shear is not axisymmetric".to_owned(),
            "take a planar geometry, or write { velocity = ... } or { parabolic = ... }",
        ),
        (_, BoundaryCondition::WavingSheet { .. }) => {
            check_sheet(findings, &format!("{key}.waving-sheet"), side, condition);
        }
        _ => {}
    }
    check_given(findings, key, condition);
    check_factor_of(findings, key, condition);
    check_backflow(findings, key, condition);
}

/// The factor in time of a condition, if it has one.
fn check_factor_of(findings: &mut Findings<'_>, key: &str, condition: &BoundaryCondition) {
    let (name, factor) = match condition {
        BoundaryCondition::Velocity { factor, .. } => ("velocity", factor),
        BoundaryCondition::Parabolic { factor, .. } => ("parabolic", factor),
        BoundaryCondition::Shear { factor, .. } => ("shear", factor),
        BoundaryCondition::Developed { factor, .. } => ("developed", factor),
        BoundaryCondition::Profile(profile) => ("profile", &profile.factor),
        BoundaryCondition::Pressure { factor, .. } => ("pressure", factor),
        BoundaryCondition::Traction { factor, .. } => ("traction", factor),
        _ => return,
    };
    if let Some(factor) = factor {
        check_factor(findings, &format!("{key}.{name}.factor"), factor);
    }
}

/// Largest amplitude times wavenumber of a sheet: the mesh follows no steeper one well.
const STEEPEST: f64 = 0.5;
/// Whole wavelengths in a side, to this part of one.
const WHOLE: f64 = 1e-6;

/// Whether a side can wave, and the mesh with it.
fn check_sheet(findings: &mut Findings<'_>, key: &str, side: &str, condition: &BoundaryCondition) {
    let BoundaryCondition::WavingSheet { amplitude, wavelength, .. } = *condition else {
        return;
    };
    let case = findings.case();
    let is_periodic = ["left", "right"]
        .iter()
        .any(|end| matches!(case.boundary.get(*end), Some(BoundaryCondition::Periodic(_))));
    if side != "bottom" || !is_periodic || case.geometry != Geometry::Planar {
        findings.error(
            key,
            "a waving sheet is the bottom of a box that is periodic along x".to_owned(),
            "write it on `bottom` of a planar box, with left = { periodic = \"right\" }",
        );
        return;
    }
    let [length, height, _] = case.extent().lengths();
    let n_waves = length / wavelength;
    if wavelength > 0.0 && ((n_waves - n_waves.round()).abs() > WHOLE || n_waves < 0.5) {
        findings.error(
            &format!("{key}.wavelength"),
            format!("{n_waves:.6} wavelengths fit into the side, which is periodic"),
            "take a wavelength that divides the length of the side",
        );
    }
    let steepness = 2.0 * PI * amplitude / wavelength;
    if steepness > STEEPEST || amplitude > 0.25 * height {
        findings.error(
            &format!("{key}.amplitude"),
            format!("the mesh cannot follow a sheet of amplitude {amplitude}"),
            &format!(
                "take an amplitude below {STEEPEST} wavelength / 2 pi, and below a quarter of the \
                 height of the box"
            ),
        );
    }
    if matches!(case.time, TimeSettings::Steady(_)) {
        findings.error(
            key,
            "a waving sheet moves, and the solution is steady".to_owned(),
            "use [time.unsteady]",
        );
    }
    if !findings.model().bodies.is_empty() {
        findings.error(
            key,
            "bodies above a waving sheet are not supported: remeshing would make the side straight"
                .to_owned(),
            "leave out the bodies, or make the side \"no-slip\"",
        );
    }
}

/// Numbers of a function of time.
pub(crate) fn check_factor(findings: &mut Findings<'_>, key: &str, factor: &TimeFunction) {
    if let TimeFunction::Table(knots) = factor {
        let is_rising = knots.windows(2).all(|pair| pair[1][0] > pair[0][0]);
        if knots.is_empty() || !is_rising {
            findings.error(
                &format!("{key}.table"),
                "the times of a table must rise from knot to knot".to_owned(),
                "write table = [[t0, f0], [t1, f1], ...] with t0 < t1 < ...",
            );
        }
    }
    if let TimeFunction::Cubic(knots) = factor {
        cubic(findings, &format!("{key}.cubic"), knots);
    }
    if let TimeFunction::Cycle(cycle) = factor {
        check_cycle(findings, &format!("{key}.cycle"), cycle);
    }
    if let TimeFunction::Command(command) = factor {
        check_command(findings, &format!("{key}.command"), command);
        return;
    }
    if matches!(findings.case().time, TimeSettings::Steady(_)) {
        findings.warning(
            key,
            "a steady solution knows no time: the factor is taken at time 0".to_owned(),
            "leave the factor out, or use [time.unsteady]",
        );
    }
}

fn check_periodic(findings: &mut Findings<'_>, key: &str, side: &str, partner: &str) {
    let case = findings.case();
    let sides = case.sides();
    let Some(wanted) = opposite(side).filter(|wanted| sides.contains(wanted)) else {
        findings.error(
            key,
            format!("`{side}` has no side opposite to it, so it cannot be periodic"),
            "periodic pairs are left and right, bottom and top, back and front of a box, a channel or a \
             cylinder",
        );
        return;
    };
    if partner != wanted {
        findings.error(
            key,
            format!("`{side}` cannot be periodic with `{partner}`"),
            &format!("write {side} = {{ periodic = \"{wanted}\" }}"),
        );
        return;
    }
    let refers_back =
        matches!(case.boundary.get(wanted), None | Some(BoundaryCondition::Periodic(_)));
    if !refers_back {
        findings.error(
            &format!("boundary.{wanted}"),
            format!("`{side}` is periodic with `{wanted}`, but `{wanted}` has another condition"),
            &format!("write {wanted} = {{ periodic = \"{side}\" }}, or leave `{wanted}` out"),
        );
    }
}

/// An incompressible fluid that enters a closed region has nowhere to go.
fn check_balance(findings: &mut Findings<'_>) {
    let case = findings.case();
    if case.boundary.values().any(BoundaryCondition::is_open) {
        return;
    }
    // Flows that vary differently in time cannot balance each other.
    let mut groups: Vec<FlowGroup<'_>> = Vec::new();
    let sides = case.sides();
    // Others are refused as such
    for (side, condition) in case.boundary.iter().filter(|(side, _)| sides.contains(&side.as_str()))
    {
        let factor = factor_in_time(condition);
        // What is not known from the case alone is asked of its mesh, before a run
        let Some(inflow) = inflow(case, side, condition) else { return };
        match groups.iter_mut().find(|group| group.factor == factor) {
            Some(group) => {
                group.net += inflow;
                group.gross += inflow.abs();
            }
            None => groups.push(FlowGroup { factor, net: inflow, gross: inflow.abs() }),
        }
    }
    for FlowGroup { net, gross, .. } in groups {
        if net.abs() > BALANCE * gross {
            let (verb, unit) = if net > 0.0 { ("enters", "") } else { ("leaves", "-") };
            let kind = if case.geometry == Geometry::Planar { "m2/s" } else { "m3/s" };
            findings.error(
                "boundary",
                format!(
                    "fluid {verb} the domain and has nowhere to go: net inflow {unit}{:.6} {kind} \
                     through the prescribed velocities, and no side is open",
                    net.abs()
                ),
                "make one side open with \"do-nothing\" or \"traction-free\", or prescribe a \
                 velocity that balances the flow",
            );
        }
    }
}

/// Flow through all sides with the same factor in time (m2/s planar, m3/s otherwise).
struct FlowGroup<'a> {
    factor: Option<&'a TimeFunction>,
    /// What enters, less what leaves.
    net: f64,
    /// What enters, and what leaves.
    gross: f64,
}

/// The factor in time of the flow through a side.
fn factor_in_time(condition: &BoundaryCondition) -> Option<&TimeFunction> {
    match condition {
        BoundaryCondition::Velocity { factor, .. }
        | BoundaryCondition::Parabolic { factor, .. }
        | BoundaryCondition::Developed { factor, .. }
        | BoundaryCondition::Shear { factor, .. } => factor.as_ref(),
        BoundaryCondition::Profile(profile) => profile.factor.as_ref(),
        _ => None,
    }
}

/// Flow into the domain through a side without its factor in time (m2/s planar, m3/s otherwise), where the case tells.
fn inflow(case: &Case, side: &str, condition: &BoundaryCondition) -> Option<f64> {
    match condition {
        BoundaryCondition::Velocity { value, .. } => numbers(value)?,
        BoundaryCondition::Developed { flux, .. } => return *flux,
        // The mesh tells
        BoundaryCondition::Profile(_) => return None,
        _ => Vec::new(),
    };
    if let Some(mesh) = case.given_mesh() {
        let shape = mesh.side_shape(side);
        return shape.map_or(Some(0.0), |shape| given_mesh::inflow_through(case, shape, condition));
    }
    let Some(axis) = normal_axis(side) else { return Some(wall_inflow(&case.domain, condition)) };
    let extent = case.extent();
    let lengths = extent.lengths();
    let area = match (&case.domain, case.geometry) {
        (DomainSpec::Cylinder { radius, .. }, _) => PI * radius * radius,
        (_, Geometry::Spatial) => {
            (0..3).filter(|along| *along != axis).map(|along| lengths[along]).product()
        }
        (_, _) => lengths[1 - axis],
    };
    let mean_velocity = match condition {
        BoundaryCondition::Velocity { value, .. } => {
            value.get(axis).and_then(Formula::number).unwrap_or(0.0)
        }
        BoundaryCondition::Parabolic { peak, .. } if axis == 0 => {
            peak * match (&case.domain, case.geometry) {
                (DomainSpec::Cylinder { .. }, _) => 1.0 / 2.0,
                (_, geometry) => {
                    let n_across = if geometry == Geometry::Spatial { 2 } else { 1 };
                    let across = case.walls_across().into_iter().skip(1).take(n_across);
                    across.flatten().map(|_| 2.0 / 3.0).product()
                }
            }
        }
        BoundaryCondition::Shear { rate, origin, .. } if axis == 0 => {
            rate * (0.5 * (extent.min[1] + extent.max[1]) - origin)
        }
        _ => 0.0,
    };
    let inward = if matches!(side, "left" | "bottom" | "back") { 1.0 } else { -1.0 };
    Some(inward * mean_velocity * area)
}

/// The same through a side that is not straight: what enters on one side of a closed surface leaves
/// it on the other, but for velocities that are turned about an axis.
fn wall_inflow(domain: &DomainSpec, condition: &BoundaryCondition) -> f64 {
    let BoundaryCondition::Velocity { value, .. } = condition else { return 0.0 };
    let Some([_, radial]) =
        numbers(value).as_deref().and_then(|all| <[f64; 2]>::try_from(all).ok())
    else {
        return 0.0;
    };
    let area = match domain {
        // The radial part of a velocity along y on a sphere: 2 pi R^2 int sin^2
        DomainSpec::HalfDisc { radius, .. } => PI * PI * radius * radius,
        DomainSpec::Cylinder { x, radius } => 2.0 * PI * radius * (x[1] - x[0]),
        _ => 0.0,
    };
    -radial * area
}
