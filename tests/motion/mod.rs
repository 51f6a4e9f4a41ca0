//! The mesh follows the bodies: elliptic motion, remeshing, transfer, projection; rods that touch.

mod growing;
mod momentum;
mod moving;
mod projection;
mod reach;
mod remesh;
mod rod_contact;
mod transfer;

use alewife_mesh::{Domain, Mesh, PlacedShape, Point, Shape, Sizing, generate};

/// The square of side 4 about the origin.
fn square(periodic_x: bool, periodic_y: bool) -> Domain {
    let (min, max) = (Point::<2>::new(-2.0, -2.0), Point::<2>::new(2.0, 2.0));
    Domain::Box { min, max, periodic_x, periodic_y }
}

/// A disc of radius 0.5.
fn disc(name: &str, x: f64, y: f64) -> PlacedShape {
    let shape = Shape::Disc { radius: 0.5 };
    PlacedShape { name: name.into(), shape, center: Point::<2>::new(x, y), angle: 0.0, size: None }
}

/// A sphere of radius 0.5 on the axis of a tube.
fn tube(x: f64) -> (Domain, PlacedShape) {
    let domain = Domain::Cylinder { x: [-2.0, 2.0], radius: 1.5, periodic_x: false };
    (domain, PlacedShape { shape: Shape::Sphere { radius: 0.5 }, ..disc("sphere", x, 0.0) })
}

/// A disc in the middle of the square.
fn disc_in_square(surface: f64, size: f64) -> Mesh<2> {
    let sizing = Sizing::graded(surface, 0.2, size);
    generate(&square(false, false), &[disc("disc", 0.0, 0.0)], &sizing).expect("is meshed")
}
