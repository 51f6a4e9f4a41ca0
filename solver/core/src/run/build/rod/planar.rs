//! The elastic rod of a planar body of a case.

use std::f64::consts::PI;
use std::sync::Arc;

use alewife_mesh::Profile;
use nalgebra::{Rotation2, Vector2};

use super::laws::{
    ENDS, axes, density, end, is_clamped, refused, steady_rest, stiff_enough, with_wave,
};
use crate::case::{self, AlongBody, Body, Case, EndFrame, EndLoadSpec, EndMoment, Hold, RodSpec};
use crate::gait::FlexibleShape;
use crate::rod::{
    Along, End, EndLoad, EndPose, Flexure, LoadedEnd, PlanarProperties, PlanarRod, PlanarRodBody,
    RodProperties, Section, Support, Supports,
};
use crate::run::RunError;

/// The shape of a planar body that is a rod.
pub fn shape(case: &Case, body: &Body, spec: &RodSpec) -> Result<FlexibleShape, RunError> {
    let refuse = |why: &str| refused(body, why);
    let profile = body.shape.profile().ok_or_else(|| refuse("a rod has to be slender"))?;
    let outline = profile.spline().ok_or_else(|| refuse("its lengths make no body"))?;
    let of_length =
        |length: f64| properties(case, body, spec, Lengths { profile: &profile, length });
    let rod = if spec.periodic {
        let period = case.period_along(body.angle);
        let period = period.ok_or_else(|| refuse("the domain is not periodic along it"))?;
        PlanarRod::periodic(of_length(period), Vector2::new(-period, 0.0))
    } else {
        PlanarRod::new(of_length(profile.length()))
    };
    let rod = rod.map_err(|error| refuse(&error.to_string()))?;
    let rod = if is_clamped(body) { rod.clamped(End::Base) } else { rod };
    // The head is at the right, from where the rod goes on towards -x
    let nose = outline.evaluate(0.0)[0].x;
    let base = EndPose { place: Vector2::new(nose, 0.0), angle: PI, ..EndPose::default() };
    let turned = body.attached.as_ref().map_or(0.0, |attached| match &attached.hold {
        Hold::Angle(angle) => angle.at(0.0)[0],
        Hold::Clamped | Hold::Hinged => 0.0,
    });
    let start = rod.curved(base.place, base.angle + turned, &steady_rest(spec, 2));
    let flexible = PlanarRodBody::new(rod, base, supports(body, base))
        .starting(start)
        .with_loaded_ends(loaded_ends(body));
    Ok(FlexibleShape::new(outline, Arc::new(flexible)))
}

/// What holds the head.
fn supports(body: &Body, base: EndPose) -> Supports<EndPose> {
    let Some(attached) = body.attached.as_ref().filter(|attached| attached.to.is_none()) else {
        return Supports::FREE;
    };
    match attached.hold.clone() {
        Hold::Clamped => Supports::one(End::Base, Support::Clamped, move |_| base),
        Hold::Hinged => Supports::one(End::Base, Support::Hinged, move |_| base),
        Hold::Angle(stroke) => Supports::one(End::Base, Support::Clamped, move |time| {
            let [angle, angular_velocity] = stroke.at(time);
            EndPose { angle: base.angle + angle, angular_velocity, ..base }
        }),
    }
}

/// Loads at the ends, seen from the frame of the straight body as its coordinates are, or along the tangent and the normal,
/// which are -x and -y of that frame where it is straight.
fn loaded_ends(body: &Body) -> Vec<LoadedEnd> {
    let loaded = |at: case::LoadedEnd<&EndLoadSpec>| {
        let EndLoadSpec { force, moment, frame } = at.load.clone();
        let turn = Rotation2::new(match frame {
            EndFrame::Laboratory => -body.angle,
            EndFrame::End => PI,
        });
        LoadedEnd {
            end: end(at.end),
            axes: axes(frame),
            load: Box::new(move |time| {
                let along = |axis: usize| force.get(axis).map_or(0.0, |stroke| stroke.at(time)[0]);
                EndLoad {
                    force: turn * Vector2::new(along(0), along(1)),
                    moment: moment
                        .iter()
                        .flat_map(EndMoment::components)
                        .map(|of| of.at(time)[0])
                        .sum(),
                }
            }),
        }
    };
    body.end_loads().map(loaded).collect()
}

/// Widths along a rod, and how long it is (m), with the slit where it is joined to itself.
struct Lengths<'a> {
    profile: &'a Profile,
    length: f64,
}

fn properties(case: &Case, body: &Body, spec: &RodSpec, of: Lengths<'_>) -> PlanarProperties {
    let Lengths { profile, length } = of;
    let elements = spec.elements;
    let density = density(case, body);
    let widths = profile.clone();
    let section = move |along: f64| Section::Strip { half_width: widths.find(along).half_width };
    let stiffness = stiffness(spec, profile);
    let stiffest = (0..=elements)
        .map(|i| stiffness.at(length * i as f64 / elements as f64))
        .fold(0.0, f64::max);
    let (mass, turning, active) = (section.clone(), section, body.activation.as_ref());
    PlanarProperties {
        rod: RodProperties {
            length,
            elements,
            stretching: spec.stretching.unwrap_or_else(|| {
                RodProperties::stiff(stiffest, length).min(stiff_enough(case, length))
            }),
            damping: spec.damping,
            mass: Along::function(move |along| density * mass(along).area()),
            section_inertia: Along::function(move |along| density * turning(along).turning()),
        },
        bending: Flexure {
            stiffness,
            rest: with_wave(steady_rest(spec, 2), active, |active| &active.curvature, 1.0),
            moment: with_wave(Along::Constant(0.0), active, |active| &active.moment, 1.0),
        },
    }
}

fn stiffness(spec: &RodSpec, profile: &Profile) -> Along {
    match (&spec.bending, spec.young) {
        (Some(AlongBody::Table(rows)), _) => Along::Table(rows.clone()),
        (Some(AlongBody::Constant(value)), _) => Along::Constant(*value),
        (None, young) => {
            let (young, widths) = (young.unwrap_or_default(), profile.clone());
            let stations = profile.stations();
            let widest = stations.iter().map(|at| at.half_width).fold(0.0, f64::max);
            Along::function(move |along| {
                let half_width = widths.find(along).half_width.max(ENDS * widest);
                young * Section::Strip { half_width }.second_moment()
            })
        }
    }
}
