//! What of a rod is fixed to another body.

use nalgebra::Vector3;

use crate::case::{Hold, Model};
use crate::coupling::{Attachment, BodyVector, OnBody, RigidBody};
use crate::run::RunError;

/// What of the rod of a body is fixed to another body, as both are at the start.
///
/// # Errors
/// Where there is no such body.
pub fn attach(model: &Model, index: usize, bodies: &mut [RigidBody]) -> Result<(), RunError> {
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
