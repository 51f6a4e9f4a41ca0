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

/// Integrals from 0 to each of them (row) of the cubics that are 1 at one of them and 0 at the others.
pub const GAUSS_INTEGRALS: [[f64; 4]; 4] = [
    [
        0.086_963_711_284_363_46,
        -0.026_604_180_084_998_794,
        0.012_627_462_689_404_725,
        -0.003_555_149_685_795_683_3,
    ],
    [
        0.188_118_117_499_868_06,
        0.163_036_288_715_636_55,
        -0.027_880_428_602_470_895,
        0.006_735_500_594_538_156,
    ],
    [
        0.167_191_921_974_188_78,
        0.353_953_006_033_743_97,
        0.163_036_288_715_636_55,
        -0.014_190_694_931_141_144,
    ],
    [
        0.177_482_572_254_522_6,
        0.313_445_114_741_868_37,
        0.352_676_757_516_271_87,
        0.086_963_711_284_363_46,
    ],
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
