//! Magnetic moments of a case, and the field they are in.

use std::f64::consts::TAU;
use std::sync::Arc;

use nalgebra::{Matrix3, Vector3};

use super::joints::value_of;
use crate::case::{
    DipoleField, Geometry, LinearField, MagneticSpec, Model, RotatingField, Stroke, smooth_ramp,
};
use crate::coupling::{FieldPart, Magnet, MagneticField, RigidBody, TimeValue};

/// Gives bodies their magnetic moments, where there is a field.
pub(super) fn add_magnets(model: &Model, bodies: &mut [RigidBody]) {
    let Some(magnetic) = &model.case.magnetic_field() else { return };
    let field = Arc::new(magnetic_field(magnetic, model.case.geometry));
    for (body, own) in bodies.iter_mut().zip(&model.bodies) {
        if !own.magnetic_moment.is_empty() {
            let moment = vector(&own.magnetic_moment);
            body.magnet = Some(Magnet { moment, field: Arc::clone(&field) });
        }
    }
}

/// A vector of the case in space; components that are not written are zero.
fn vector(values: &[f64]) -> Vector3<f64> {
    Vector3::from_fn(|axis, _| values.get(axis).copied().unwrap_or(0.0))
}

/// The values of a factor, 1 if there is none.
fn factor_of(factor: Option<&Stroke>) -> TimeValue {
    factor.cloned().map_or_else(|| -> TimeValue { Box::new(|_| 1.0) }, value_of)
}

fn magnetic_field(spec: &MagneticSpec, geometry: Geometry) -> MagneticField {
    let mut parts: Vec<FieldPart> = spec.rotating.iter().map(rotating).collect();
    if !spec.components.is_empty() {
        let components: Vec<TimeValue> = spec.components.iter().cloned().map(value_of).collect();
        let at = move |time: f64| {
            Vector3::from_fn(|axis, _| components.get(axis).map_or(0.0, |value| value(time)))
        };
        parts.push(FieldPart::Uniform(Box::new(at)));
    }
    parts.extend(spec.linear.iter().map(linear));
    parts.extend(spec.dipoles.iter().map(|source| dipole(source, geometry)));
    MagneticField { parts }
}

fn rotating(field: &RotatingField) -> FieldPart {
    let [start, ahead] = field.directions().map(Vector3::from);
    let RotatingField { strength, frequency, phase, ramp, .. } = *field;
    FieldPart::Uniform(Box::new(move |time| {
        let (sin, cos) = (TAU * (frequency * time + phase)).sin_cos();
        (start * cos + ahead * sin) * (strength * smooth_ramp(time, ramp)[0])
    }))
}

fn linear(field: &LinearField) -> FieldPart {
    let entry = |row: usize, column: usize| {
        let row: Option<&Vec<f64>> = field.gradient.get(row);
        row.and_then(|row| row.get(column)).copied().unwrap_or(0.0)
    };
    FieldPart::Linear {
        gradient: Matrix3::from_fn(entry),
        center: vector(&field.center),
        factor: factor_of(field.factor.as_ref()),
    }
}

fn dipole(source: &DipoleField, geometry: Geometry) -> FieldPart {
    FieldPart::Dipole {
        position: vector(&source.position),
        strength: vector(&source.strength),
        dimensions: if geometry == Geometry::Planar { 2 } else { 3 },
        factor: factor_of(source.factor.as_ref()),
    }
}
