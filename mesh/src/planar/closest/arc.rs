//! `Arc`: a stretch of an outline between two parameters, with bounds of where it runs and turns.

use std::f64::consts::{PI, TAU};

use crate::planar::vector::cross;
use crate::{Outline, Point};

/// How often a stretch is halved at most: features closer together than 1/256 of a stretch are one.
const DEEPEST: u32 = 8;

/// A stretch of an outline with three continuous derivatives.
///
/// With h the length of its parameter and c its chord, second derivatives below `bend` keep it
/// within bend h^2 / 8 of its chord, and its first derivative within bend h / 2 of c / h.
#[derive(Debug, Clone, Copy)]
pub struct Arc {
    /// Parameters at its ends.
    pub low: f64,
    pub high: f64,
    /// Places of its ends (m).
    pub start: Point<2>,
    pub end: Point<2>,
    /// Second derivatives at its ends.
    bends: [Point<2>; 2],
    /// Largest second derivative, and largest third derivative.
    bend: f64,
    jerk: f64,
    level: u32,
}

/// A circle.
#[derive(Debug, Clone, Copy)]
pub struct Circle {
    /// Centre (m).
    pub center: Point<2>,
    /// Radius (m).
    pub radius: f64,
}

/// A stretch of each of two outlines.
#[derive(Debug, Clone, Copy)]
pub struct ArcPair {
    pub first: Arc,
    pub second: Arc,
}

/// An interval of numbers.
#[derive(Debug, Clone, Copy)]
pub struct Range {
    pub low: f64,
    pub high: f64,
}

impl Range {
    pub fn plus(self, other: Self) -> Self {
        Self { low: self.low + other.low, high: self.high + other.high }
    }

    pub fn times(self, other: Self) -> Self {
        let corners = [
            self.low * other.low,
            self.low * other.high,
            self.high * other.low,
            self.high * other.high,
        ];
        Self {
            low: corners.into_iter().fold(f64::INFINITY, f64::min),
            high: corners.into_iter().fold(f64::NEG_INFINITY, f64::max),
        }
    }
}

impl Arc {
    fn between(outline: &Outline, low: f64, high: f64, level: u32) -> Self {
        let ([start, slope, bend], [end, last_slope, last_bend]) =
            (outline.at(low), outline.at(high));
        let jerk = if outline.is_ellipse() {
            // The third derivative is minus the first one, largest at an end of the stretch
            slope.norm().max(last_slope.norm())
        } else {
            (last_bend - bend).norm() / (high - low)
        };
        let bends = [bend, last_bend];
        Self { low, high, start, end, bends, bend: bend.norm().max(last_bend.norm()), jerk, level }
    }

    /// The stretches an outline is made of.
    pub fn all_of(outline: &Outline) -> Vec<Self> {
        let breaks = outline.breaks();
        breaks.windows(2).map(|ends| Self::between(outline, ends[0], ends[1], 0)).collect()
    }

    /// Both halves.
    pub fn halves(&self, outline: &Outline) -> [Self; 2] {
        let middle = self.middle();
        [(self.low, middle), (middle, self.high)]
            .map(|(low, high)| Self::between(outline, low, high, self.level + 1))
    }

    /// Whether it is too short to be halved again.
    pub fn is_smallest(&self) -> bool {
        self.level >= DEEPEST
    }

    /// Length of its parameter.
    pub fn width(&self) -> f64 {
        self.high - self.low
    }

    /// Parameter in its middle.
    pub fn middle(&self) -> f64 {
        0.5 * (self.low + self.high)
    }

    /// From its start to its end (m).
    pub fn chord(&self) -> Point<2> {
        self.end - self.start
    }

    /// No point of it is farther than this from its chord (m).
    pub fn bulge(&self) -> f64 {
        self.bend * self.width() * self.width() / 8.0
    }

    /// Its tangent turns no farther than this from its chord (rad).
    pub fn lean(&self) -> f64 {
        let (turned, along) = (0.5 * self.bend * self.width(), self.chord().norm() / self.width());
        if turned < along { (turned / along).asin() } else { PI }
    }

    /// A circle that holds it.
    pub fn circle(&self) -> Circle {
        let center = 0.5 * (self.start + self.end);
        Circle { center, radius: 0.5 * self.chord().norm() + self.bulge() }
    }

    /// Lower left and upper right corner of a rectangle that holds it (m).
    pub fn corners(&self) -> [Point<2>; 2] {
        let margin = Point::<2>::repeat(self.bulge());
        [self.start.inf(&self.end) - margin, self.start.sup(&self.end) + margin]
    }

    /// Bounds of its curvature (1/m).
    pub fn curvature(&self) -> Range {
        let half = 0.5 * self.width();
        let (slope, off) = (self.chord() / self.width(), self.bend * half);
        let bend = 0.5 * (self.bends[0] + self.bends[1]);
        // Linear between its ends for a spline; for an ellipse off by less than this
        let bend_off = self.jerk * half + 0.5 * self.bend * half * half;
        let (least, most) = (slope.norm() - off, slope.norm() + off);
        if least <= 0.0 {
            return Range { low: f64::NEG_INFINITY, high: f64::INFINITY };
        }
        let turn = cross(slope, bend);
        let spread = slope.norm() * bend_off + off * (bend.norm() + bend_off);
        let (low, high) = (turn - spread, turn + spread);
        let by = |value: f64, largest: bool| {
            let speed = if (value > 0.0) == largest { least } else { most };
            value / speed.powi(3)
        };
        Range { low: by(low, false), high: by(high, true) }
    }
}

/// Least distance between the chords of two stretches less what they may bulge (m), not negative.
pub fn least_distance(first: &Arc, second: &Arc) -> f64 {
    let between = segment_distance([first.start, first.end], [second.start, second.end]);
    (between - first.bulge() - second.bulge()).max(0.0)
}

/// Distance between two segments (m), zero where they cross.
fn segment_distance([a, b]: [Point<2>; 2], [c, d]: [Point<2>; 2]) -> f64 {
    let (p, q) = (cross(b - a, c - a), cross(b - a, d - a));
    let (r, s) = (cross(d - c, a - c), cross(d - c, b - c));
    if p * q < 0.0 && r * s < 0.0 {
        return 0.0;
    }
    [
        point_to_segment(a, [c, d]),
        point_to_segment(b, [c, d]),
        point_to_segment(c, [a, b]),
        point_to_segment(d, [a, b]),
    ]
    .into_iter()
    .fold(f64::INFINITY, f64::min)
}

fn point_to_segment(point: Point<2>, [a, b]: [Point<2>; 2]) -> f64 {
    let chord = b - a;
    let along = ((point - a).dot(&chord) / chord.norm_squared()).clamp(0.0, 1.0);
    (a + chord * along - point).norm()
}

/// Angle between two vectors (rad).
pub fn angle_between(a: Point<2>, b: Point<2>) -> f64 {
    cross(a, b).abs().atan2(a.dot(&b))
}

/// Distance of two parameters on a closed curve.
pub fn apart(a: f64, b: f64, period: f64) -> f64 {
    let between = (a - b).rem_euclid(period);
    between.min(period - between)
}

/// Whether the outline is surely crossed by another one: shallow crossings, which only
/// the search for pairs of points sees as a feature with a negative gap, are not looked for.
pub fn outlines_cross(first: &Outline, second: &Outline) -> bool {
    let mut open = Vec::new();
    for pair in Pairs::within(first, second, 0.0).backwards() {
        open.push(pair);
        while let Some(ArcPair { first: a, second: b }) = open.pop() {
            if !boxes_meet(&a, &b) || least_distance(&a, &b) > 0.0 {
                continue;
            }
            if surely_cross(&a, &b) {
                return true;
            }
            open.extend(split(&a, &b, first, second));
        }
    }
    false
}

/// Both pairs got by halving the longer one of two stretches; none when both are smallest.
pub fn split(a: &Arc, b: &Arc, first: &Outline, second: &Outline) -> Vec<ArcPair> {
    let a_is_longer = a.circle().radius >= b.circle().radius;
    let with_half_of_a = |half| ArcPair { first: half, second: *b };
    let with_half_of_b = |half| ArcPair { first: *a, second: half };
    match (a.is_smallest(), b.is_smallest()) {
        (true, true) => Vec::new(),
        (false, true) => a.halves(first).map(with_half_of_a).to_vec(),
        (false, false) if a_is_longer => a.halves(first).map(with_half_of_a).to_vec(),
        _ => b.halves(second).map(with_half_of_b).to_vec(),
    }
}

/// Pairs of stretches of two outlines that may be within a range of each other, of which a thin body has very many.
pub struct Pairs {
    first: Vec<(Arc, Circle)>,
    second: Vec<(Arc, Circle)>,
    /// Distance up to which none is left out (m).
    range: f64,
}

impl Pairs {
    pub fn within(first: &Outline, second: &Outline, range: f64) -> Self {
        /// More than the rounding of distances, over the distances and over the places themselves.
        const ROUNDING: [f64; 2] = [1e-9, 1e-12];
        let keep = |one: &Outline, other: &Outline| {
            let near = Arc::all_of(one).into_iter().filter_map(|arc| {
                let Circle { center, radius } = arc.circle();
                let surely = radius * (1.0 + ROUNDING[0]) + center.norm() * ROUNDING[1];
                let is_near = other.least_gap(center) <= radius + range;
                is_near.then_some((arc, Circle { center, radius: surely }))
            });
            near.collect()
        };
        let range_with_rounding = range * (1.0 + ROUNDING[0]);
        Self { first: keep(first, second), second: keep(second, first), range: range_with_rounding }
    }

    /// From the last one to the first, without those whose [`least_distance`] is surely beyond the range.
    pub fn backwards(&self) -> impl Iterator<Item = ArcPair> {
        let Self { first, second, range } = self;
        first.iter().rev().flat_map(move |(a, around)| {
            let near = second.iter().rev().filter(move |(_, other)| {
                let reach = around.radius + other.radius + range;
                (around.center - other.center).norm_squared() <= reach * reach
            });
            near.map(|(b, _)| ArcPair { first: *a, second: *b })
        })
    }
}

/// Whether the rectangles around two stretches meet.
fn boxes_meet(a: &Arc, b: &Arc) -> bool {
    let ([low, high], [other_low, other_high]) = (a.corners(), b.corners());
    (0..2).all(|axis| low[axis] <= other_high[axis] && other_low[axis] <= high[axis])
}

/// Whether the ends of each stretch lie on either side of the strip that holds the other.
fn surely_cross(a: &Arc, b: &Arc) -> bool {
    let straddles = |one: &Arc, strip: &Arc| {
        let normal = Point::<2>::new(-strip.chord().y, strip.chord().x).normalize();
        let sides = [one.start, one.end].map(|point| normal.dot(&(point - strip.start)));
        sides[0] * sides[1] < 0.0 && sides[0].abs().min(sides[1].abs()) > strip.bulge()
    };
    straddles(a, b) && straddles(b, a)
}

/// A parameter within one period of a closed curve.
pub fn wrapped(parameter: f64, period: f64) -> f64 {
    let within = parameter.rem_euclid(period);
    // Rounding may give the period itself
    if within < period { within } else { 0.0 }
}

/// Directions of two tangents that may be opposite somewhere on two stretches.
pub fn may_be_opposite(a: &Arc, b: &Arc) -> bool {
    let lean = a.lean() + b.lean();
    lean >= PI || angle_between(a.chord(), -b.chord()) <= lean + 1e-12 * TAU
}
