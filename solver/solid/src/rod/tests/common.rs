//! What tests of rods share.

use nalgebra::{DVector, Vector2};

use crate::dry::Level;
use crate::rod::{
    Along, End, EndPose, Field, Flexure, PlanarProperties, PlanarRod, RodProperties, Support,
};
use crate::structure::Held;

/// Size and mass of a rod of length, bending stiffness and mass one.
pub fn unit(elements: usize) -> RodProperties {
    RodProperties {
        length: 1.0,
        elements,
        stretching: RodProperties::stiff(1.0, 1.0),
        damping: 0.0,
        mass: Along::Constant(1.0),
        section_inertia: Along::Constant(0.0),
    }
}

/// A straight planar rod with given properties and bending stiffness one.
pub fn planar(rod: RodProperties) -> PlanarRod {
    bending(rod, Flexure::passive(Along::Constant(1.0)))
}

/// The same, clamped at its base.
pub fn cantilever(rod: RodProperties) -> PlanarRod {
    planar(rod).clamped(End::Base)
}

/// A planar rod.
pub fn bending(rod: RodProperties, bending: Flexure) -> PlanarRod {
    PlanarRod::new(PlanarProperties { rod, bending }).expect("there is such a rod")
}

/// Bending of stiffness one with an active moment.
pub fn with_moment(moment: Field) -> Flexure {
    Flexure { moment, ..Flexure::passive(Along::Constant(1.0)) }
}

/// The base held in the origin, along x.
pub fn at_base(rod: &PlanarRod, support: Support) -> Vec<Held> {
    rod.held(End::Base, support, &EndPose::default())
}

/// Coordinates of a rod from the origin along x.
pub fn along_x(rod: &PlanarRod) -> DVector<f64> {
    rod.straight(Vector2::zeros(), 0.0)
}

/// Coordinates at rest at time zero.
pub fn at_rest(coordinates: DVector<f64>) -> Level {
    let velocities = DVector::zeros(coordinates.len());
    Level { coordinates, velocities, time: 0.0 }
}

/// Numbers between -1 and 1 that look random, and are the same in every run.
pub fn scatter(n: usize, seed: f64) -> DVector<f64> {
    DVector::from_fn(n, |i, _| (12.9898 * (i as f64 + 1.0) + 78.233 * seed).sin())
}

/// Asserts that a value is near another, to a part of it.
#[track_caller]
pub fn assert_near(value: f64, expected: f64, part: f64) {
    let error = (value - expected).abs() / expected.abs();
    assert!(error < part, "{value} is not {expected} to {part}, but to {error:.2e}");
}
