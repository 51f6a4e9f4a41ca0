//! Domains and bodies that several tests mesh.

use std::f64::consts::TAU;

use alewife_mesh::{Domain, PlacedShape, Point, Shape};

/// A shape at a place.
pub fn placed(name: &str, shape: Shape, x: f64, y: f64, angle: f64) -> PlacedShape {
    PlacedShape { name: name.into(), shape, center: Point::<2>::new(x, y), angle, size: None }
}

/// A star-shaped curve with lobes, through 20 points.
pub fn lobed(radius: f64, lobes: i32, depth: f64) -> Shape {
    let points = (0..20).map(|i| TAU * f64::from(i) / 20.0).map(|t| {
        let r = radius * (1.0 + depth * (f64::from(lobes) * t).cos());
        [r * t.cos(), r * t.sin()]
    });
    Shape::Spline { points: points.collect() }
}

/// A rectangle around the origin.
pub fn square(periodic_x: bool, periodic_y: bool) -> Domain {
    let (min, max) = (Point::<2>::new(-3.0, -3.0), Point::<2>::new(3.0, 3.2));
    Domain::Box { min, max, periodic_x, periodic_y }
}
