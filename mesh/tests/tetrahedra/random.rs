//! Bodies in space at random: placements with small gaps, and swimmers with thin tails.

use alewife_mesh::spatial::{Body, BodySurface, Centreline, Domain, Part, Shape, check_placement};
use alewife_mesh::{Point, Surface, whole};
use nalgebra::{Isometry3, Translation3, UnitQuaternion};

use super::{at, cube, surface};

/// Numbers between 0 and 1 (splitmix64).
struct Random(u64);

impl Random {
    fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.number()
    }

    fn point(&mut self, half: f64) -> Point<3> {
        Point::<3>::from_fn(|_, _| self.between(-half, half))
    }

    fn rotation(&mut self) -> UnitQuaternion<f64> {
        UnitQuaternion::from_scaled_axis(self.point(3.0))
    }

    fn shape(&mut self) -> Shape {
        let radius = self.between(0.35, 0.7);
        match (3.0 * self.number()).floor() {
            0.0 => Shape::Sphere { radius },
            1.0 => {
                let mut part = || radius * self.between(0.5, 0.95);
                Shape::Ellipsoid { semi_axes: [radius, part(), part()] }
            }
            _ => {
                let narrow = radius * self.between(0.4, 0.7);
                Shape::Capsule { radius: narrow, length: 2.0 * (radius - narrow) }
            }
        }
    }
}

/// One to three bodies in a box, each often close to the first, or to a side.
pub fn random_placement(seed: u64) -> (Domain, Vec<Body>) {
    let mut random = Random(seed);
    let domain = cube(1.4);
    let n = 1 + whole(3.0 * random.number().powi(2));
    let mut bodies: Vec<Body> = Vec::new();
    while bodies.len() < n {
        let pose = Isometry3::from_parts(Translation3::from(random.point(1.0)), random.rotation());
        let mut all = bodies.clone();
        all.push(Body::new(&format!("body{}", bodies.len()), random.shape(), pose));
        let is_close = random.number() < 0.6;
        let way = if bodies.is_empty() {
            Point::<3>::z()
        } else {
            bodies[0].pose.translation.vector - pose.translation.vector
        };
        let gap = 0.02 + 0.1 * random.number().powi(2);
        if is_close {
            approach(&domain, &mut all, way.normalize(), gap);
        }
        if check_placement(&domain, &all).is_ok() && is_apart(&domain, &all) {
            bodies = all;
        }
    }
    (domain, bodies)
}

/// Twenty bodies anywhere in a periodic box, spheres and ellipsoids, some of them close to others, down to
/// gaps of 0.02 of the larger radius.
pub fn random_crowd(seed: u64) -> (Domain, Vec<Body>) {
    let mut random = Random(seed);
    let min = random.point(10.0);
    let max = min + Point::<3>::from_fn(|_, _| random.between(4.0, 5.5));
    let domain = Domain::Box { min, max, periodic: [true; 3], symmetric: [false; 6] };
    let mut bodies: Vec<Body> = Vec::new();
    while bodies.len() < 20 {
        let place = Point::<3>::from_fn(|axis, _| random.between(min[axis], max[axis]));
        let pose = Isometry3::from_parts(Translation3::from(place), random.rotation());
        let radius = random.between(0.45, 0.65);
        let shape = if random.number() < 0.5 {
            Shape::Sphere { radius }
        } else {
            let mut part = || radius * random.between(0.55, 0.95);
            Shape::Ellipsoid { semi_axes: [radius, part(), part()] }
        };
        let mut all = bodies.clone();
        all.push(Body::new(&format!("body{}", bodies.len()), shape, pose));
        let gap = 0.02 * 0.65 + 0.1 * random.number().powi(2);
        let is_close = random.number() < 0.6;
        let way = random.point(1.0).normalize();
        if is_close {
            approach(&domain, &mut all, way, gap);
            if let Some(last) = all.last_mut() {
                let place = &mut last.pose.translation.vector;
                *place = Point::<3>::from_fn(|axis, _| {
                    min[axis] + (place[axis] - min[axis]).rem_euclid(max[axis] - min[axis])
                });
            }
        }
        if check_placement(&domain, &all).is_ok() && has_gaps(&domain, &all, 0.02 * 0.65) {
            bodies = all;
        }
    }
    (domain, bodies)
}

/// Whether the last of some bodies is a gap away from all images of the others.
fn has_gaps(domain: &Domain, bodies: &[Body], gap: f64) -> bool {
    let Some((last, others)) = bodies.split_last() else { return true };
    let own = surface(last);
    others.iter().all(|other| {
        domain.images().into_iter().all(|shift| {
            let image = surface(other).placed_at(&(Translation3::from(shift) * other.pose));
            let apart = (own.center() - image.center()).norm() - own.reach() - image.reach();
            apart > gap || own.closest_points(&image, f64::INFINITY)[0].gap >= gap
        })
    })
}

/// Moves the last body along a way until it touches something, and back by a gap.
fn approach(domain: &Domain, bodies: &mut [Body], way: Point<3>, gap: f64) {
    if check_placement(domain, bodies).is_err() {
        return;
    }
    let last = bodies.len() - 1;
    let start = bodies[last].pose.translation.vector;
    let (mut free, mut stopped) = (0.0, 6.0);
    for _ in 0..30 {
        let middle = 0.5 * (free + stopped);
        bodies[last].pose.translation.vector = start + way * middle;
        if check_placement(domain, bodies).is_ok() { free = middle } else { stopped = middle }
    }
    bodies[last].pose.translation.vector = start + way * (free - gap).max(0.0);
}

/// Whether the gaps of the last body are not below 0.01.
fn is_apart(domain: &Domain, bodies: &[Body]) -> bool {
    let last = bodies.len() - 1;
    let own = surface(&bodies[last]);
    let others: Vec<BodySurface> = bodies[..last].iter().map(surface).collect();
    let mut random = Random(7);
    (0..500).all(|_| {
        let direction = random.point(1.0).normalize();
        let on = own.nearest_point(own.center() + direction * own.reach()).point;
        let sides = (0..6).all(|side| domain.side_gap(side, on) > 0.015);
        sides && others.iter().all(|other| other.nearest_point(on).gap > 0.015)
    })
}

/// An ellipsoidal head with a thin helical tail, turned and moved at random.
pub fn random_swimmer(seed: u64) -> Body {
    let mut random = Random(seed);
    let head = Shape::Ellipsoid { semi_axes: [0.4, 0.25, 0.2] };
    let centreline = Centreline::Helix { radius: 0.2, pitch: 0.9, turns: 0.5 };
    let tail = Shape::Tube { centreline, radius: 0.06 };
    let middle = Translation3::new(-0.1, 0.0, 0.0);
    let place = Translation3::from(random.point(0.2));
    let pose = Isometry3::from_parts(place, random.rotation()) * middle;
    let mut body = Body::new("swimmer", head, pose);
    body.parts[0].pose = at(-0.35, 0.15, 0.05);
    body.parts.push(Part { shape: tail, pose: Isometry3::identity() });
    body
}
