//! `Closest`: two points of two curves that face each other.

use crate::{Outline, Point};

/// Two points of two curves that face each other, where their distance is smallest nearby.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Closest {
    /// The point on the first outline (m).
    pub first: Point<2>,
    /// The point on the second outline, or on the wall (m).
    pub second: Point<2>,
    /// Unit normal from the second to the first: out of the second body, into the first.
    pub normal: Point<2>,
    /// Distance along the normal (m); where bodies overlap, minus the depth.
    pub gap: f64,
    /// Parameters of [`Outline::at`](crate::Outline::at); on a wall the length along it (m), or the angle (rad).
    pub parameters: [f64; 2],
    /// Curvatures there (1/m), positive where the body is convex, negative for a round container.
    pub curvatures: [f64; 2],
}

impl Closest {
    /// How far the place is from one where the minimum and a maximum annihilate each other (1/m):
    /// k1 + k2 + gap k1 k2 with the curvatures, zero there and positive at every minimum.
    #[must_use]
    pub fn regularity(&self) -> f64 {
        let [first, second] = self.curvatures;
        first + second + self.gap * first * second
    }

    /// The same with the two sides exchanged.
    #[must_use]
    pub fn swapped(&self) -> Self {
        Self {
            first: self.second,
            second: self.first,
            normal: -self.normal,
            gap: self.gap,
            parameters: [self.parameters[1], self.parameters[0]],
            curvatures: [self.curvatures[1], self.curvatures[0]],
        }
    }
}

/// The one with the least gap.
pub fn least(features: &[Closest]) -> Option<Closest> {
    features.iter().copied().reduce(|best, at| if at.gap < best.gap { at } else { best })
}

/// The deepest, or nearest, of many points of one outline to the other.
pub fn by_points(first: &Outline, second: &Outline) -> Closest {
    const POINTS: usize = 256;
    let from = |one: &Outline, other: &Outline| {
        let mut best: Option<Closest> = None;
        for i in 0..POINTS {
            let parameter = one.period() * i as f64 / POINTS as f64;
            let at = one.at(parameter)[0];
            let foot = other.nearest(at);
            if best.is_none_or(|best| foot.gap < best.gap) {
                best = Some(Closest {
                    first: at,
                    second: foot.point,
                    normal: foot.normal,
                    gap: foot.gap,
                    parameters: [parameter, 0.0],
                    curvatures: [0.0, foot.curvature],
                });
            }
        }
        best
    };
    let pairs = [from(first, second), from(second, first).map(|at| at.swapped())];
    least(&pairs.into_iter().flatten().collect::<Vec<_>>()).expect("there are points")
}
