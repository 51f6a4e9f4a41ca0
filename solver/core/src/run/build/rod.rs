//! The elastic rod of a body of a case.

use std::f64::consts::PI;
use std::sync::Arc;

use alewife_mesh::Profile;
use nalgebra::{Rotation2, Vector2, Vector3};

use crate::case::{
    self, Activation, AlongBody, Body, Case, EndLoadSpec, FlowModel, Hold, Model, RestShape,
    RodEnd, RodSpec, Stroke, TimeSettings,
};
use crate::coupling::{Attachment, BodyVector, OnBody, RigidBody};
use crate::gait::{FlexibleShape, ShapeMotion};
use crate::rod::{
    Along, End, EndLoad, EndPose, Field, Flexure, LoadedEnd, PlanarProperties, PlanarRod,
    PlanarRodBody, RodProperties, Section, Support, Supports, Varying,
};
use crate::run::RunError;

/// Half width over the largest one below which a body is as stiff as there: ends close in points, which would bend at
/// no cost.
const ENDS: f64 = 0.1;

/// Stretching stiffness over the drag of a length in a step from which on a rod keeps its length.
const ENOUGH: f64 = 1e9;

/// The shape of a planar body that is a rod, which starts from its shape without loads; `None` of one that is none.
///
/// # Errors
/// Where its numbers make no rod.
pub fn rod_shape(case: &Case, body: &Body) -> Result<Option<Arc<dyn ShapeMotion>>, RunError> {
    let Some(spec) = &body.rod else { return Ok(None) };
    let refuse = |why: &str| RunError::Unsupported(format!("body `{}`: {why}", body.name));
    let profile = body.shape.profile().ok_or_else(|| refuse("a rod has to be slender"))?;
    let outline = profile.spline().ok_or_else(|| refuse("its lengths make no body"))?;
    let rod = PlanarRod::new(properties(case, body, spec, &profile))
        .map_err(|error| refuse(&error.to_string()))?;
    // The head is at the right, from where the rod goes on towards -x
    let nose = outline.evaluate(0.0)[0].x;
    let base = EndPose { place: Vector2::new(nose, 0.0), angle: PI, ..EndPose::default() };
    let turned = body.attached.as_ref().map_or(0.0, |attached| match &attached.hold {
        Hold::Angle(angle) => angle.at(0.0)[0],
        Hold::Clamped | Hold::Hinged => 0.0,
    });
    let start = rod.curved(base.place, base.angle + turned, &steady_rest(spec));
    let flexible = PlanarRodBody::new(rod, base, supports(body, base))
        .starting(start)
        .with_loaded_ends(loaded_ends(body));
    Ok(Some(Arc::new(FlexibleShape::new(outline, Arc::new(flexible)))))
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

/// Loads at the ends, seen from the frame of the straight body as its coordinates are.
fn loaded_ends(body: &Body) -> Vec<LoadedEnd> {
    let turn = Rotation2::new(-body.angle);
    let loaded = |at: case::LoadedEnd<&EndLoadSpec>| {
        let EndLoadSpec { force, moment } = at.load.clone();
        LoadedEnd {
            end: match at.end {
                RodEnd::Base => End::Base,
                RodEnd::Tip => End::Tip,
            },
            load: Box::new(move |time| {
                let along = |axis: usize| force.get(axis).map_or(0.0, |stroke| stroke.at(time)[0]);
                EndLoad {
                    force: turn * Vector2::new(along(0), along(1)),
                    moment: moment.as_ref().map_or(0.0, |stroke| stroke.at(time)[0]),
                }
            }),
        }
    };
    body.end_loads().map(loaded).collect()
}

fn properties(case: &Case, body: &Body, spec: &RodSpec, profile: &Profile) -> PlanarProperties {
    let (length, elements) = (profile.length(), spec.elements);
    // Without inertia the equations leave its mass out, but its centre is still that of one
    let density = match case.fluid.model {
        FlowModel::Stokes => 1.0,
        FlowModel::UnsteadyStokes | FlowModel::NavierStokes => {
            body.density.unwrap_or(case.fluid.density)
        }
    };
    let widths = profile.clone();
    let section = move |along: f64| Section::Strip { half_width: widths.find(along).half_width };
    let stiffness = stiffness(spec, profile);
    let stiffest = (0..=elements)
        .map(|i| stiffness.at(length * i as f64 / elements as f64))
        .fold(0.0, f64::max);
    let (mass, turning) = (section.clone(), section);
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
            rest: rest(spec, body.activation.as_ref()),
            moment: match body.activation.as_ref().and_then(|active| wave(active, &active.moment)) {
                Some(wave) => Field::in_time(wave),
                None => Field::ZERO,
            },
        },
    }
}

/// Tension over stretch (N/m) of a rod of a length (m) that no flow of this case stretches notably, as it moves by less than
/// its length in a step: with more of it the drag would be lost in the rounding of the tension.
fn stiff_enough(case: &Case, length: f64) -> f64 {
    let TimeSettings::Unsteady(unsteady) = &case.time else { return f64::INFINITY };
    let step = match &unsteady.adaptive {
        Some(adaptive) => adaptive.largest.unwrap_or(0.1 * unsteady.end),
        None => unsteady.step,
    };
    let inertia = match case.fluid.model {
        FlowModel::Stokes => 0.0,
        FlowModel::UnsteadyStokes | FlowModel::NavierStokes => case.fluid.density,
    };
    let drag = case.fluid.viscosity.reference(step.recip()) + inertia * length * length / step;
    ENOUGH * drag * length / step
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

/// The curvature without loads.
fn steady_rest(spec: &RodSpec) -> Along {
    match &spec.rest {
        None => Along::Constant(0.0),
        Some(RestShape::Curvature(curvature)) => Along::Constant(*curvature),
        Some(RestShape::Table(rows)) => Along::Table(rows.clone()),
    }
}

/// The same with that of muscles.
fn rest(spec: &RodSpec, active: Option<&Activation>) -> Field {
    let steady = steady_rest(spec);
    let Some(wave) = active.and_then(|active| wave(active, &active.curvature)) else {
        return Field::Steady(steady);
    };
    Field::in_time(move |along, time| {
        let Varying { value, rate } = wave(along, time);
        Varying { value: steady.at(along) + value, rate }
    })
}

/// A stroke as it goes along the body.
fn wave(
    active: &Activation,
    stroke: &Option<Stroke>,
) -> Option<impl Fn(f64, f64) -> Varying + Send + Sync + 'static + use<>> {
    let stroke = stroke.clone()?;
    let delay = active.wave_speed.map_or(0.0, f64::recip);
    let envelope = match &active.envelope[..] {
        [] => Along::Constant(1.0),
        rows => Along::Table(rows.to_vec()),
    };
    Some(move |along: f64, time: f64| {
        let [value, rate] = stroke.at(time - delay * along);
        let factor = envelope.at(along);
        Varying { value: factor * value, rate: factor * rate }
    })
}

/// What of the rod of a body is fixed to another body, as both are at the start.
///
/// # Errors
/// Where there is no such body.
pub(super) fn attach(
    model: &Model,
    index: usize,
    bodies: &mut [RigidBody],
) -> Result<(), RunError> {
    let body = &model.bodies[index];
    let Some(attached) = &body.attached else { return Ok(()) };
    let Some(name) = &attached.to else { return Ok(()) };
    let refuse = |why: String| RunError::Unsupported(format!("body `{}`: {why}", body.name));
    let to = model.bodies.iter().position(|other| other.name == *name);
    let to = to.ok_or_else(|| refuse(format!("there is no body `{name}` to attach it to")))?;
    let n_held = match attached.hold {
        Hold::Clamped => 4,
        Hold::Hinged => 2,
        Hold::Angle(_) => return Err(refuse("an angle in time is one in the laboratory".into())),
    };
    let (own, other) = (bodies[index].pose, bodies[to].pose);
    let start = bodies[index].flexible().map(|flexible| flexible.initial());
    let start = start.ok_or_else(|| refuse("it is no rod".into()))?;
    let in_other = |vector: Vector3<f64>| other.to_body(&own.to_world(&vector));
    let place = in_other(Vector3::new(start[0], start[1], 0.0))
        + other.to_body(&(own.center - other.center));
    let along = in_other(Vector3::new(start[2], start[3], 0.0));
    let given = |coordinate: usize| OnBody {
        coordinate,
        axis: coordinate % 2,
        vector: if coordinate < 2 {
            BodyVector::Place(place)
        } else {
            BodyVector::Direction(along)
        },
    };
    let coordinates = (0..n_held).map(given).collect();
    bodies[index].attachment = Some(Attachment { to, coordinates });
    Ok(())
}
