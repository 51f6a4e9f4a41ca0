//! Whether parts of a body are apart from each other, so that they make two bodies.

use super::body_surface::BodySurface;
use super::closest::facing;
use super::surface::SmoothSurface;

/// Depth over the size of the smaller part down to which parts touch and do not overlap.
const TOUCHING: f64 = 1e-6;
/// Places on a part that are looked for within another one.
const PLACES: usize = 240;

impl BodySurface {
    /// Whether this and another surface enclose nothing together. Surfaces of which that is not certain, as where no
    /// closest points are found, are not apart.
    #[must_use]
    pub fn is_apart_from(&self, other: &Self) -> bool {
        let apart = |one: &SmoothSurface| other.parts().iter().all(|two| are_apart(one, two));
        self.parts().iter().all(apart)
    }
}

fn are_apart(one: &SmoothSurface, two: &SmoothSurface) -> bool {
    if two.gap(one.origin()) < 0.0 || one.gap(two.origin()) < 0.0 {
        return false;
    }
    let least = facing(one, two, f64::INFINITY).into_iter().map(|at| at.gap).reduce(f64::min);
    let touching = TOUCHING * one.scale().min(two.scale());
    let overlaps = |on: &SmoothSurface, of: &SmoothSurface| {
        on.places(PLACES).into_iter().any(|place| of.gap(place) < -touching)
    };
    least.is_some_and(|gap| gap > -touching) && !overlaps(one, two) && !overlaps(two, one)
}

#[cfg(test)]
mod tests {
    use nalgebra::{Isometry3, Translation3};

    use super::*;
    use crate::spatial::{Body, Centreline, Shape};

    fn at(shape: Shape, x: f64) -> BodySurface {
        let pose = Isometry3::from(Translation3::new(x, 0.0, 0.0));
        BodySurface::new(&Body::new("a", shape, pose)).unwrap()
    }

    #[test]
    fn parts_that_touch_or_do_not_are_apart_and_those_that_overlap_are_not() {
        let helix = Centreline::Helix { radius: 0.3, pitch: 0.8, turns: -2.0 };
        let [long, short] = [1.0, 0.5];
        let shapes = [
            (Shape::Sphere { radius: 0.5 }, 0.5),
            (Shape::Ellipsoid { semi_axes: [0.5, 0.3, 0.2] }, 0.5),
            (Shape::Capsule { radius: 0.25, length: 0.5 }, 0.5),
        ];
        for (one, reach) in &shapes {
            for (two, other) in &shapes {
                let sum = reach + other;
                let apart = |x: f64| at(one.clone(), 0.0).is_apart_from(&at(two.clone(), x));
                assert!(apart(sum) && apart(1.5 * sum) && apart(-1.01 * sum), "{one:?} {two:?}");
                for part in [0.0, 0.3, -0.7, 0.99, 0.9999] {
                    assert!(!apart(part * sum), "{one:?} {two:?} {part}");
                }
            }
        }
        // A tube whose end is in a sphere, or not
        let tube = at(Shape::Tube { centreline: helix, radius: 0.08 }, long);
        let sphere = |x: f64| at(Shape::Sphere { radius: short }, x);
        assert!(!tube.is_apart_from(&sphere(0.0)) && tube.is_apart_from(&sphere(-1.0)));
    }
}
