//! From shape and gait of a case to the motion of an outline.

use std::sync::Arc;

use super::RunError;
use crate::case::{Body, Gait, ShapeSpec};
use crate::gait::{
    Anguilliform, Carangiform, Flagellum, Midline, Pulse, PulseLaw, ShapeMotion, Swimmer,
};

/// How the outline of a body moves in the body's frame; `None` if it does not.
///
/// # Errors
/// When the gait does not fit the shape, or moves the body as no body can.
pub fn shape_motion(body: &Body) -> Result<Option<Arc<dyn ShapeMotion>>, RunError> {
    let refuse = |why: &str| RunError::Unsupported(format!("body `{}`: {why}", body.name));
    let midline = match (&body.gait, &body.shape) {
        (None | Some(Gait::Squirmer(_)), _) => return Ok(None),
        (
            Some(Gait::Pulsating(gait)),
            ShapeSpec::Disc { radius } | ShapeSpec::Sphere { radius },
        ) => {
            let law = match gait.amplitude {
                Some(amplitude) => PulseLaw::Sine {
                    amplitude,
                    period: gait.period.ok_or_else(|| refuse("its gait has no period"))?,
                    phase: gait.phase,
                },
                None => PulseLaw::Table { knots: gait.table.clone(), period: gait.period },
            };
            let is_sphere = matches!(body.shape, ShapeSpec::Sphere { .. });
            return Ok(Some(Arc::new(Pulse { radius: *radius, is_sphere, law })));
        }
        (Some(Gait::Carangiform(gait)), ShapeSpec::Fish(fish)) => {
            Midline::Carangiform(Carangiform {
                length: fish.length,
                curvature: gait.curvature.clone(),
                bending: gait.bending,
                period: gait.period,
                phase: gait.start_phase,
                ramp: gait.ramp.unwrap_or(gait.period),
            })
        }
        (Some(Gait::Anguilliform(gait)), ShapeSpec::Fish(fish)) => {
            Midline::Anguilliform(Anguilliform {
                length: fish.length,
                amplitude: gait.amplitude,
                offset: gait.offset,
                period: gait.period,
                phase: gait.start_phase,
                ramp: gait.ramp.unwrap_or(gait.period),
            })
        }
        (Some(Gait::Flagellum(gait)), ShapeSpec::Flagellate(body)) => {
            Midline::Flagellum(Flagellum {
                head: 2.0 * body.head[0],
                length: body.tail_length,
                amplitude: gait.amplitude,
                wavelength: gait.wavelength,
                period: gait.period,
                phase: gait.start_phase,
                ramp: gait.ramp.unwrap_or(gait.period),
                joint: gait.joint.unwrap_or(body.tail_length / 20.0),
                inextensible: gait.inextensible,
            })
        }
        _ => return Err(refuse("its gait does not fit its shape")),
    };
    let profile = body.shape.profile().ok_or_else(|| refuse("its lengths make no body"))?;
    let swimmer = Swimmer::new(&profile, midline).map_err(|error| refuse(&error.to_string()))?;
    Ok(Some(Arc::new(swimmer)))
}
