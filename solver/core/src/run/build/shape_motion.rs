//! From shape and gait of a case to the motion of an outline, or of a surface in space.

use std::sync::Arc;

use crate::case::{
    BentJoint, Body, CarangiformGait, GaitSpec, Geometry, JointsGait, Model, ShapeSpec, Stroke,
};
use crate::coupling::ShapeError;
use crate::gait::{
    AngleInTime, Anguilliform, Carangiform, Flagellum, Joint, Joints, Midline, Open, Own, Pulse,
    PulseLaw, RecoilMotion, ShapeMotion, SlenderBody,
};
use crate::run::RunError;

/// Knots of angles from a file that are taken for a period.
const KNOTS_OF_PERIOD: f64 = 16.0;

/// How the outline or the surface of a body moves in the body's frame; `None` if it does not.
///
/// # Errors
/// When the gait does not fit the shape, or moves the body as no body can.
pub fn shape_motion(
    body: &Body,
    geometry: Geometry,
) -> Result<Option<Arc<dyn ShapeMotion>>, RunError> {
    let refuse = |why: &str| RunError::Unsupported(format!("body `{}`: {why}", body.name));
    // Rods are made in `rod.rs`
    if !body.deforms() || body.rod.is_some() {
        return Ok(None);
    }
    let midline = match (&body.gait, &body.shape) {
        (
            Some(GaitSpec::Pulsating(gait)),
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
        (Some(GaitSpec::Carangiform(gait)), ShapeSpec::Fish(fish)) => {
            if let Some(still) = at_its_limits(gait) {
                for gait in still {
                    let gait = Some(GaitSpec::Carangiform(gait));
                    shape_motion(&Body { gait, ..body.clone() }, geometry)?;
                }
            }
            Midline::Carangiform(Carangiform { length: fish.length, gait: gait.clone() })
        }
        (Some(GaitSpec::Anguilliform(gait)), ShapeSpec::Fish(fish)) => {
            Midline::Anguilliform(Anguilliform { length: fish.length, gait: gait.clone() })
        }
        (Some(GaitSpec::Flagellum(gait)), ShapeSpec::Flagellate(body)) => {
            Midline::Flagellum(Flagellum {
                head: 2.0 * body.head[0],
                tail: body.tail_length,
                gait: gait.clone(),
            })
        }
        (Some(GaitSpec::Midline(gait)), ShapeSpec::Fish(_) | ShapeSpec::Flagellate(_)) => {
            let length = match &body.shape {
                ShapeSpec::Flagellate(own) => 2.0 * own.head[0] + own.tail_length,
                ShapeSpec::Fish(fish) => fish.length,
                _ => return Err(refuse("its gait does not fit its shape")),
            };
            let law = gait.law().map_err(|error| refuse(&error.to_string()))?;
            Midline::Own(Own { length, gait: (**gait).clone(), law })
        }
        (Some(GaitSpec::Joints(gait)), ShapeSpec::Tube(_)) => Midline::Joints(joints(gait)),
        _ => return Err(refuse("its gait does not fit its shape")),
    };
    let profile = body.shape.profile().ok_or_else(|| refuse("its lengths make no body"))?;
    let height = body.shape.section_height().filter(|_| geometry == Geometry::Spatial);
    let slender = match height {
        Some(height) => SlenderBody::in_space(&profile, height, midline),
        None => SlenderBody::new(&profile, midline),
    };
    let slender = slender.map_err(|reason| ShapeError { body: body.name.clone(), reason })?;
    Ok(Some(Arc::new(slender)))
}

/// What is subtracted from the gait of a body so that it has no momentum of its own.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyRecoil {
    /// Name of the body.
    pub body: String,
    /// The rigid motion that is subtracted.
    pub motion: RecoilMotion,
}

/// What is subtracted from the gaits of the bodies that deform.
///
/// # Errors
/// As [`shape_motion`], and where a gait fails within its first period.
pub fn recoils(model: &Model) -> Result<Vec<BodyRecoil>, RunError> {
    let mut recoils = Vec::new();
    for body in &model.bodies {
        let Some(shape) = shape_motion(body, model.case.geometry)? else { continue };
        let motion =
            shape.recoil().map_err(|reason| ShapeError { body: body.name.clone(), reason })?;
        recoils.push(BodyRecoil { body: body.name.clone(), motion });
    }
    Ok(recoils)
}

/// A gait that waits for commands, with the values farthest from each other in their place; none of another gait.
fn at_its_limits(gait: &CarangiformGait) -> Option<[CarangiformGait; 2]> {
    let CarangiformGait { beat, bend, .. } = gait;
    beat.iter().chain(bend).find_map(Stroke::command)?;
    Some([0, 1].map(|end| {
        let at = |stroke: &Option<Stroke>, end: usize| {
            let limit = stroke.as_ref()?.range()[end];
            Some(Stroke::Constant(if limit.is_finite() { limit } else { 0.0 }))
        };
        CarangiformGait { beat: at(beat, 1), bend: at(bend, end), ..gait.clone() }
    }))
}

/// The midline of a chain with a skin.
fn joints(gait: &JointsGait) -> Joints {
    let bent = |joint: &BentJoint| {
        let angle = joint.angle.clone();
        // Behind the last knot of a file it rests
        let at = move |time: f64| match &angle {
            Stroke::Cubic(knots) => match knots.last() {
                Some([last, value, _]) if time > *last => [*value, 0.0],
                _ => angle.at(time),
            },
            _ => angle.at(time),
        };
        Joint {
            along: joint.along,
            angle: AngleInTime(Arc::new(at)),
            is_behind_root: joint.is_behind_root,
        }
    };
    // Angles from a file are never periodic: they are looked at as often as their knots ask for
    let (mut transient, mut spacing) = (0.0f64, f64::INFINITY);
    for joint in &gait.joints {
        match &joint.angle {
            Stroke::Sine { ramp, .. } => transient = transient.max(*ramp),
            Stroke::Cubic(knots) => {
                let last = knots.last().map_or(0.0, |knot| knot[0]);
                let intervals = knots.iter().filter(|knot| knot[0] > 0.0).count();
                transient = transient.max(last);
                spacing = spacing.min(last / intervals as f64);
            }
            _ => {}
        }
    }
    let period = gait.period().unwrap_or(f64::INFINITY).min(KNOTS_OF_PERIOD * spacing);
    // Angles that are all constant have any period
    let period = if period.is_finite() { period } else { 1.0 };
    let joints = gait.joints.iter().map(bent).collect();
    let strokes: Vec<Stroke> = gait.joints.iter().map(|joint| joint.angle.clone()).collect();
    let is_open = strokes.iter().any(|stroke| stroke.command().is_some());
    let open = is_open.then(|| Open::new(strokes, period));
    let is_recorded = spacing.is_finite();
    Joints { joints, rounding: gait.rounding, cycle: [transient, period], is_recorded, open }
}

#[cfg(test)]
mod tests {
    use alewife_mesh::Outline;

    use super::*;
    use crate::case::Case;

    fn body(body: &str) -> Body {
        let text = format!(
            "title = 't'
geometry = 'planar'
fluid = {{ model = 'stokes', viscosity = 1.0 }}
domain.box = {{ min = [-4.0, -4.0], max = [4.0, 4.0] }}
mesh.size = 0.5
time.unsteady = {{ step = 0.1, end = 1.0 }}
[[body]]
name = 'b'
center = [0, 0]
motion = 'free'
{body}
"
        );
        Case::parse("t.toml", &text, &[]).unwrap().model.bodies[0].clone()
    }

    /// At the start the outline is that of the shape, which is what is meshed.
    #[test]
    fn gaits_of_a_case_start_from_its_shape() {
        for text in [
            "shape.fish.length = 2.0\ngait.carangiform.period = 1.0",
            "shape.fish.length = 2.0\ngait.anguilliform.period = 1.0",
            "shape.flagellate = { head = [0.2, 0.1], tail_length = 5.0, thickness = 0.02 }\n\
             gait.flagellum = { period = 0.3, wavelength = 2.0, amplitude = 0.4 }",
            "shape.disc.radius = 1.0\ngait.pulsating = { amplitude = 0.5, period = 1.0 }",
        ] {
            let start =
                shape_motion(&body(text), Geometry::Planar).unwrap().unwrap().at(0.0).unwrap();
            let outline = Outline::new(&body(text).placed(1.0)).unwrap();
            for parameter in [0.0, 0.3, 1.9] {
                let off = start.position(parameter) - outline.at(parameter)[0];
                assert!(off.norm() < 1e-12, "{text}: {off}");
            }
        }
        let motion = |text: &str| shape_motion(&body(text), Geometry::Planar);
        assert!(motion("shape.fish.length = 1.0").unwrap().is_none());
        let bent = "shape.fish.length = 1.0\ngait.carangiform = { period = 1.0, bending = 9.0 }";
        assert!(motion(bent).unwrap_err().to_string().contains("crosses itself"));
    }
}
