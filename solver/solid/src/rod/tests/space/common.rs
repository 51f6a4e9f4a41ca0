//! What tests of rods in space share.

use nalgebra::{DVector, Rotation3, Vector3};

use crate::rod::tests::common::unit;
use crate::rod::{
    Along, End, Field, Flexure, RodProperties, SpatialEndPose, SpatialProperties, SpatialRod,
    Support,
};
use crate::structure::Held;

/// Stiffness in twist; those in bending are one.
pub const TWISTING: f64 = 0.8;

/// A straight rod with given properties.
pub fn straight(rod: RodProperties) -> SpatialRod {
    at_rest_with(rod, [0.0; 3].map(|value| Field::Steady(Along::Constant(value))))
}

/// A rod with given rest rates of turning about d1, d2 and t.
pub fn at_rest_with(rod: RodProperties, rest: [Field; 3]) -> SpatialRod {
    let [first, second, twist] = rest;
    let flexure = |stiffness: f64, rest: Field| Flexure {
        rest,
        ..Flexure::passive(Along::Constant(stiffness))
    };
    let bending = [flexure(1.0, first), flexure(1.0, second)];
    let properties = SpatialProperties { rod, bending, twisting: flexure(TWISTING, twist) };
    SpatialRod::new(properties).expect("there is such a rod")
}

/// A rod of length, bending stiffness and mass one.
pub fn simple(elements: usize) -> SpatialRod {
    straight(unit(elements))
}

/// The base held in the origin, along x.
pub fn at_base(rod: &SpatialRod, support: Support) -> Vec<Held> {
    rod.held(End::Base, support, &SpatialEndPose::default())
}

/// Coordinates of a rod from the origin along x.
pub fn along_x(rod: &SpatialRod) -> DVector<f64> {
    rod.straight(Vector3::zeros(), Rotation3::identity())
}

/// Coordinates of a rod turned about the origin and moved.
pub fn carried(q: &DVector<f64>, rotation: &Rotation3<f64>, by: Vector3<f64>) -> DVector<f64> {
    let mut result = q.clone();
    for i in (0..q.len()).step_by(3) {
        let shift = if i % 9 == 0 { by } else { Vector3::zeros() };
        let vector = rotation * q.fixed_rows::<3>(i) + shift;
        result.fixed_rows_mut::<3>(i).copy_from(&vector);
    }
    result
}
