//! Numbers along a rod that planar ones and those in space have in common.

use crate::case::{
    Activation, Body, Case, EndFrame, FlowModel, Hold, RestShape, RodEnd, RodSpec, Stroke,
    TimeSettings,
};
use crate::rod::{Along, Axes, End, Field, Varying};
use crate::run::RunError;

/// Half width over the largest one below which a body is as stiff as there: ends close in points, which would bend at
/// no cost.
pub const ENDS: f64 = 0.1;

/// Stretching stiffness over the drag of a length in a step from which on a rod keeps its length.
const ENOUGH: f64 = 1e9;

/// Density of a body (kg/m3); without inertia the equations leave its mass out, but its centre is still that of one.
pub fn density(case: &Case, body: &Body) -> f64 {
    match case.fluid.model {
        FlowModel::Stokes => 1.0,
        FlowModel::UnsteadyStokes | FlowModel::NavierStokes => {
            body.density.unwrap_or(case.fluid.density)
        }
    }
}

/// Tension over stretch (N/m; N of a rod in space, times its length) of a rod of a length (m) that no flow of this case
/// stretches notably, as it moves by less than its length in a step: with more of it the drag would be lost in the rounding of
/// the tension.
pub fn stiff_enough(case: &Case, length: f64) -> f64 {
    let Some(step) = longest_step(case) else { return f64::INFINITY };
    let inertia = match case.fluid.model {
        FlowModel::Stokes => 0.0,
        FlowModel::UnsteadyStokes | FlowModel::NavierStokes => case.fluid.density,
    };
    let drag = case.fluid.viscosity.reference(step.recip()) + inertia * length * length / step;
    ENOUGH * drag * length / step
}

/// The longest step of a case in time (s).
pub fn longest_step(case: &Case) -> Option<f64> {
    let TimeSettings::Unsteady(unsteady) = &case.time else { return None };
    Some(match &unsteady.adaptive {
        Some(adaptive) => adaptive.largest.unwrap_or(0.1 * unsteady.end),
        None => unsteady.step,
    })
}

/// The rate of turning about the axis out of the plane, by its number among those of the body, without loads.
pub fn steady_rest(spec: &RodSpec, axis: usize) -> Along {
    match &spec.rest {
        Some(RestShape::Turning(turning)) => Along::Constant(turning[axis]),
        Some(RestShape::Curvature(curvature)) if axis == 2 => Along::Constant(*curvature),
        Some(RestShape::Table(rows)) if axis == 2 => Along::Table(rows.clone()),
        Some(RestShape::Curvature(_) | RestShape::Table(_)) | None => Along::Constant(0.0),
    }
}

/// A number along a rod with a wave of muscles, times a factor.
pub fn with_wave(
    steady: Along,
    active: Option<&Activation>,
    of: fn(&Activation) -> &Option<Stroke>,
    factor: f64,
) -> Field {
    let Some(wave) = active.and_then(|active| wave(active, of(active))) else {
        return Field::Steady(steady);
    };
    Field::in_time(move |along, time| {
        let Varying { value, rate } = wave(along, time);
        Varying { value: steady.at(along) + factor * value, rate: factor * rate }
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

/// Whether its head is clamped: in the laboratory, turned in time, or to another body.
pub fn is_clamped(body: &Body) -> bool {
    let hold = body.attached.as_ref().map(|attached| &attached.hold);
    matches!(hold, Some(Hold::Clamped | Hold::Angle(_)))
}

/// An end by its key.
pub fn end(of: RodEnd) -> End {
    match of {
        RodEnd::Base => End::Base,
        RodEnd::Tip => End::Tip,
    }
}

/// The axes of a load at an end, by their key.
pub fn axes(of: EndFrame) -> Axes {
    match of {
        EndFrame::Laboratory => Axes::Fixed,
        EndFrame::End => Axes::OfSection,
    }
}

/// Why a body is no rod.
pub fn refused(body: &Body, why: &str) -> RunError {
    RunError::Unsupported(format!("body `{}`: {why}", body.name))
}
