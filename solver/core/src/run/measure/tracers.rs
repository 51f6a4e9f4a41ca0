//! The quantities of tracers: how many there are, and how far they have spread.

use super::value::Value;
use crate::body::in_space;
use crate::case::TracerQuantity;
use crate::tracer::Tally;

/// A quantity of a cloud of particles.
pub(super) fn tracer_value<const D: usize>(tally: &Tally<D>, quantity: TracerQuantity) -> Value {
    match quantity {
        TracerQuantity::Position => in_space(&tally.center).into(),
        TracerQuantity::Count => (tally.count as f64).into(),
        TracerQuantity::Left => (tally.left as f64).into(),
        TracerQuantity::Dispersion => in_space(&tally.dispersion).into(),
        TracerQuantity::Inside => (tally.inside as f64).into(),
        TracerQuantity::Residence => tally.residence.into(),
    }
}
