//! What makes no rod, and numbers along one.

use super::common::unit;
use crate::rod::{Along, Flexure, PlanarProperties, PlanarRod, RodError, RodProperties};

fn refused(rod: RodProperties, stiffness: Along) -> RodError {
    let bending = Flexure::passive(stiffness);
    PlanarRod::new(PlanarProperties { rod, bending }).expect_err("there is no such rod")
}

#[test]
fn rods_without_size_stiffness_or_sense_are_refused() {
    let stiff = Along::Constant(1.0);
    let size = refused(RodProperties { elements: 0, ..unit(2) }, stiff.clone());
    assert_eq!(size, RodError::Size { length: 1.0, elements: 0 });
    refused(RodProperties { length: f64::NAN, ..unit(2) }, stiff.clone());
    refused(RodProperties { stretching: -1.0, ..unit(2) }, stiff.clone());
    refused(RodProperties { damping: f64::INFINITY, ..unit(2) }, stiff.clone());
    refused(RodProperties { mass: Along::Constant(-1.0), ..unit(2) }, stiff);
    let soft = refused(unit(2), Along::Table(vec![[0.0, 1.0], [1.0, -1.0]]));
    let message = soft.to_string();
    assert!(message.contains("bending") && message.contains("along"), "{message}");
}

#[test]
fn tables_are_linear_between_rows_and_constant_outside() {
    let table = Along::Table(vec![[0.2, 1.0], [0.6, 3.0]]);
    for (along, value) in [(0.0, 1.0), (0.2, 1.0), (0.3, 1.5), (0.6, 3.0), (1.0, 3.0)] {
        assert!((table.at(along) - value).abs() < 1e-14, "{along}: {}", table.at(along));
    }
}
