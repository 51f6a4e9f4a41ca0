//! `Hermite`: the cubic between two knots, and the Gauss rule of an element.

/// Points of the Gauss rule of an element, from 0 to 1.
pub const GAUSS: [f64; 4] = [
    0.069_431_844_202_973_71,
    0.330_009_478_207_571_9,
    0.669_990_521_792_428_1,
    0.930_568_155_797_026_3,
];

/// Its weights, whose sum is 1.
pub const GAUSS_WEIGHTS: [f64; 4] = [
    0.173_927_422_568_726_9,
    0.326_072_577_431_273_1,
    0.326_072_577_431_273_1,
    0.173_927_422_568_726_9,
];

/// Weights on the places and tangents of both knots, in the order place, tangent, place, tangent.
#[derive(Debug, Clone, Copy)]
pub struct Hermite {
    /// Of the place.
    pub place: [f64; 4],
    /// Of the derivative by the distance along the rod (1/m).
    pub first: [f64; 4],
    /// Of the second derivative (1/m²).
    pub second: [f64; 4],
}

impl Hermite {
    /// At a part xi, 0 to 1, of an element of a length (m).
    pub fn at(xi: f64, length: f64) -> Self {
        let (x, h) = (xi, length);
        Self {
            place: [
                1.0 + x * x * (2.0 * x - 3.0),
                h * x * (1.0 - x) * (1.0 - x),
                x * x * (3.0 - 2.0 * x),
                h * x * x * (x - 1.0),
            ],
            first: [
                6.0 * x * (x - 1.0) / h,
                1.0 + x * (3.0 * x - 4.0),
                6.0 * x * (1.0 - x) / h,
                x * (3.0 * x - 2.0),
            ],
            second: [
                (12.0 * x - 6.0) / (h * h),
                (6.0 * x - 4.0) / h,
                (6.0 - 12.0 * x) / (h * h),
                (6.0 * x - 2.0) / h,
            ],
        }
    }
}
