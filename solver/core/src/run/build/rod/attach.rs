//! What of a rod is fixed to another body.

use nalgebra::Vector3;

use crate::case::{Geometry, Hold, Model};
use crate::coupling::{Attachment, BodyVector, OnBody, RigidBody};
use crate::rod::Support;
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
    let support = match attached.hold {
        Hold::Clamped => Support::Clamped,
        Hold::Hinged => Support::Hinged,
        Hold::Angle(_) => return Err(refuse("an angle in time is one in the laboratory".into())),
    };
    let dimension = if model.case.geometry == Geometry::Spatial { 3 } else { 2 };
    let (own, other) = (bodies[index].pose, bodies[to].pose);
    let start = bodies[index].flexible().map(|flexible| flexible.initial());
    let start = start.ok_or_else(|| refuse("it is no rod".into()))?;
    let in_other = |vector: Vector3<f64>| other.to_body(&own.to_world(&vector));
    let from_other = other.to_body(&(own.center - other.center));
    let given = |coordinate: usize| {
        let (nth, axis) = (coordinate / dimension, coordinate % dimension);
        let component =
            |axis: usize| if axis < dimension { start[nth * dimension + axis] } else { 0.0 };
        let vector = in_other(Vector3::from_fn(|axis, _| component(axis)));
        let vector = match nth {
            0 => BodyVector::Place(vector + from_other),
            _ => BodyVector::Direction(vector),
        };
        OnBody { coordinate, axis, vector }
    };
    let coordinates = (0..support.n_held(dimension)).map(given).collect();
    bodies[index].attachment = Some(Attachment { to, coordinates });
    Ok(())
}
