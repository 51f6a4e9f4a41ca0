//! `Sections`: the elliptic cross-sections of a body about a midline, and what they enclose.
//!
//! A point of the body is C(p) + u W(p) + v H(p) with u² + v² <= 1, about the midline C with the half width W and the
//! half height H across. The parameter p runs from the nose to the end of the tail, where W and H vanish and are
//! odd in p, so that both ends are smooth. Where the midline is in the plane z = 0, so is W, and H is across it.

mod moments;
mod profile;
mod section;

pub use moments::{SectionMoments, SolidMoments, Summand};
pub use profile::SectionHeight;
use section::section;
pub use section::{Section, along_section, in_plane, on_section, parts_of};

use std::f64::consts::PI;

use crate::{GaussRule, Point, Spline};

/// Points of the Gauss rule on each piece: exact for second moments, of degree 14 in the parameter.
const RULE_POINTS: usize = 8;

/// Angles at which elements of area are taken.
const AREA_ANGLES: usize = 16;

/// A point of a surface of sections, and of the material that it carries.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionPoint {
    /// Parameter from the nose, 0, to the end of the tail.
    pub along: f64,
    /// Angle of the section: 0 on the side of W, a quarter turn at the top.
    pub around: f64,
}

/// Cubic pieces between knots, twice continuously differentiable.
#[derive(Debug, Clone, PartialEq)]
pub struct Sections {
    knots: Vec<f64>,
    /// Polynomials in the part of the piece from its start, and from its end backwards.
    pieces: Vec<[[Section; 4]; 2]>,
}

/// A place of a rule of integration along the body.
#[derive(Debug, Clone, Copy)]
pub struct RulePoint {
    /// Piece between two knots.
    pub piece: usize,
    /// Part of it, from 0 to 1.
    pub part: f64,
    /// Weight of an integral over the parameter.
    pub weight: f64,
}

impl Sections {
    /// The sections whose outline in the plane z = 0 is a spline through points of the nose, of
    /// one side, of the tail and back along the other side, at parameters that are the same from the nose on both;
    /// with half heights (m) at these points from nose to tail, zero at both. `None` where they do not fit.
    #[must_use]
    pub fn new(outline: &Spline, half_heights: &[f64]) -> Option<Self> {
        let n = half_heights.len().checked_sub(1)?;
        let all = outline.knots();
        if all.len() != 2 * n + 1 {
            return None;
        }
        let there = half_heights.iter().map(|height| [*height, 0.0]);
        let back = half_heights[1..n].iter().rev().map(|height| [-*height, 0.0]);
        let heights = Spline::with_knots(&there.chain(back).collect::<Vec<_>>(), all)?;
        let at_knot = |i: usize| -> [Section; 2] {
            let height = heights.evaluate_on(i, 0.0);
            let sides = halves(outline, i);
            [0, 1].map(|order| {
                let Halves { middle, half } = sides[order];
                section(middle.push(0.0), half.push(0.0), Point::<3>::z() * height[order].x)
            })
        };
        Some(Self::through(&all[..=n], at_knot))
    }

    /// The sections whose outlines along their widths and along their heights are splines through points (m) of the nose, of
    /// one side, of the tail and back along the other side, at parameters that are the same from the nose on both sides.
    /// `None` where they do not fit.
    #[must_use]
    pub fn around(outlines: [&[Point<3>]; 2], knots: &[f64]) -> Option<Self> {
        let n = knots.len() / 2;
        if n == 0 || knots.len() != 2 * n + 1 {
            return None;
        }
        let spline = |points: &[Point<3>], part: fn(&Point<3>) -> [f64; 2]| {
            Spline::with_knots(&points.iter().map(part).collect::<Vec<_>>(), knots)
        };
        let mut splines = Vec::new();
        for points in outlines {
            let flat = spline(points, |at| [at.x, at.y])?;
            splines.push([flat, spline(points, |at| [at.z, 0.0])?]);
        }
        let at_knot = |i: usize| -> [Section; 2] {
            let sides: Vec<[[Halves; 2]; 2]> =
                splines.iter().map(|parts| [halves(&parts[0], i), halves(&parts[1], i)]).collect();
            [0, 1].map(|order| {
                let [width, height] = [0, 1].map(|outline| {
                    let [flat, off]: [Halves; 2] = sides[outline].map(|parts| parts[order]);
                    [flat.middle.push(off.middle.x), flat.half.push(off.half.x)]
                });
                section(width[0], width[1], height[1])
            })
        };
        Some(Self::through(&knots[..=n], at_knot))
    }

    /// Cubic pieces with the values and derivatives at knots.
    fn through(knots: &[f64], at_knot: impl Fn(usize) -> [Section; 2]) -> Self {
        let at: Vec<[Section; 2]> = (0..knots.len()).map(at_knot).collect();
        let piece = |i: usize| {
            let span = knots[i + 1] - knots[i];
            let ([from, start], [to, end]) = (at[i], at[i + 1]);
            [
                hermite(from, start * span, to, end * span),
                hermite(to, -end * span, from, -start * span),
            ]
        };
        let pieces = (0..knots.len() - 1).map(piece).collect();
        Self { knots: knots.to_vec(), pieces }
    }

    /// Parameters of the sections that were given, from 0 to the end of the tail.
    #[must_use]
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// The parameter of the end of the tail.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.knots[self.knots.len() - 1]
    }

    /// The piece on which a parameter is.
    #[must_use]
    pub fn piece_at(&self, along: f64) -> usize {
        self.knots.partition_point(|knot| *knot <= along).clamp(1, self.pieces.len()) - 1
    }

    /// The section at a parameter, with its first and second derivative.
    #[must_use]
    pub fn at(&self, along: f64) -> [Section; 3] {
        let piece = self.piece_at(along);
        let (from, to) = (self.knots[piece], self.knots[piece + 1]);
        let span = to - from;
        // From the nearer end, so that widths vanish at both ends of the body without rounding
        let [part, back] = [(along - from) / span, (to - along) / span];
        if part <= 0.5 {
            evaluate(&self.pieces[piece][0], part, span)
        } else {
            evaluate(&self.pieces[piece][1], back, -span)
        }
    }

    /// The section on a piece, and its derivative by the parameter.
    #[must_use]
    pub fn on(&self, at: &RulePoint) -> [Section; 2] {
        let span = self.knots[at.piece + 1] - self.knots[at.piece];
        let [value, rate, _] = evaluate(&self.pieces[at.piece][0], at.part, span);
        [value, rate]
    }

    /// Places and weights of integrals along the body.
    #[must_use]
    pub fn rule(&self) -> Vec<RulePoint> {
        let rule = GaussRule::new(RULE_POINTS);
        let mut places = Vec::new();
        for (piece, ends) in self.knots.windows(2).enumerate() {
            let span = ends[1] - ends[0];
            let points = rule.points.iter().zip(&rule.weights);
            places.extend(points.map(|(part, weight)| RulePoint {
                piece,
                part: *part,
                weight: span * weight,
            }));
        }
        places
    }

    /// Volume and moments about the origin, with the midline in the plane z = 0.
    #[must_use]
    pub fn moments(&self) -> SectionMoments<f64> {
        let zero = SectionMoments::default();
        self.rule().iter().fold(zero, |mut sum: SectionMoments<f64>, place| {
            let [value, rate] = self.on(place).map(|section| in_plane(&section));
            sum.add(place.weight, &value, &rate);
            sum
        })
    }

    /// Volume and moments about the origin, whatever way the midline bends.
    #[must_use]
    pub fn solid_moments(&self) -> SolidMoments {
        self.rule().iter().fold(SolidMoments::default(), |mut sum, place| {
            let [value, rate] = self.on(place);
            sum.add(place.weight, &value, &rate);
            sum
        })
    }

    /// Area of the surface (m²), to a thousandth.
    #[must_use]
    pub fn area(&self) -> f64 {
        let turn = 2.0 * PI / AREA_ANGLES as f64;
        let pieces = self.knots.windows(2);
        let on_piece = |pair: &[f64]| -> f64 {
            let [value, rate, _] = self.at(0.5 * (pair[0] + pair[1]));
            let element = |i: usize| {
                let angle = turn * i as f64;
                on_section(&rate, angle).cross(&along_section(&value, angle)).norm()
            };
            (0..AREA_ANGLES).map(element).sum::<f64>() * turn * (pair[1] - pair[0])
        };
        pieces.map(on_piece).sum()
    }

    /// The same sections with their volume in the origin.
    #[must_use]
    pub fn centered(mut self) -> Self {
        let SectionMoments { volume, first, .. } = self.moments();
        let center = Point::<3>::new(first[0] / volume, first[1] / volume, 0.0);
        let center = section(center, Point::<3>::zeros(), Point::<3>::zeros());
        for piece in self.pieces.iter_mut().flatten() {
            piece[0] -= center;
        }
        self
    }

    /// A point of the surface, or its velocity where the sections are those of velocities.
    #[must_use]
    pub fn point(&self, at: SectionPoint) -> Point<3> {
        let [section, ..] = self.at(at.along);
        on_section(&section, at.around)
    }
}

/// The middle of both sides of an outline, and half of the way from one to the other.
#[derive(Clone, Copy)]
struct Halves {
    middle: Point<2>,
    half: Point<2>,
}

/// Those of a closed outline at a knot, and their derivatives by the parameter from the nose.
fn halves(outline: &Spline, knot: usize) -> [Halves; 2] {
    let last = outline.knots().len() - 1;
    let upper = outline.evaluate_on(knot, 0.0);
    let lower = if knot == 0 { upper } else { outline.evaluate_on(last - knot, 0.0) };
    [0, 1].map(|order| {
        // The other side is followed from tail to nose
        let sign = if order == 0 { 1.0 } else { -1.0 };
        let [up, down] = [upper[order], lower[order] * sign];
        Halves { middle: (up + down) * 0.5, half: (up - down) * 0.5 }
    })
}

/// The cubic with these values and slopes at 0 and 1.
fn hermite(from: Section, start: Section, to: Section, end: Section) -> [Section; 4] {
    let way = to - from;
    [from, start, way * 3.0 - start * 2.0 - end, start + end - way * 2.0]
}

/// A polynomial with its derivatives by a parameter that changes by `span` over it.
fn evaluate([a, b, c, d]: &[Section; 4], part: f64, span: f64) -> [Section; 3] {
    [
        a + (b + (c + d * part) * part) * part,
        (b + (c * 2.0 + d * (3.0 * part)) * part) / span,
        (c * 2.0 + d * (6.0 * part)) / (span * span),
    ]
}

#[cfg(test)]
pub(super) mod test_bodies {
    use super::*;

    /// A section at a place from nose to tail.
    struct At {
        center: [f64; 2],
        /// Direction of its width.
        side: [f64; 2],
        half_width: f64,
        half_height: f64,
    }

    /// Through sections at angles from nose to tail.
    fn through(n: usize, at: impl Fn(f64) -> At) -> Sections {
        let stations: Vec<At> = (0..=n).map(|i| at(PI * i as f64 / n as f64)).collect();
        let side = |sign: f64| {
            let shifted = move |at: &At| {
                [0, 1].map(|axis| at.center[axis] + sign * at.half_width * at.side[axis])
            };
            stations.iter().map(shifted)
        };
        let back = side(-1.0).skip(1).take(n - 1).rev();
        let points: Vec<[f64; 2]> = side(1.0).chain(back).collect();
        // As if it were straight
        let knots: Vec<f64> = (0..=2 * n).map(|i| PI * i as f64 / n as f64).collect();
        let spline = Spline::with_knots(&points, &knots).unwrap();
        let heights: Vec<f64> = stations.iter().map(|at| at.half_height).collect();
        Sections::new(&spline, &heights).unwrap()
    }

    /// An ellipsoid with its nose at +x.
    pub fn ellipsoid([a, b, c]: [f64; 3], n: usize) -> Sections {
        through(n, |angle| {
            let sin = if angle >= PI { 0.0 } else { angle.sin() };
            let (center, side) = ([a * angle.cos(), 0.0], [0.0, 1.0]);
            At { center, side, half_width: b * sin, half_height: c * sin }
        })
    }

    /// A body that is bent to an S, with a thick head.
    pub fn bent_fish() -> Sections {
        through(60, |angle| {
            let x = angle.cos();
            let sin = if angle >= PI { 0.0 } else { angle.sin() };
            let slope = 0.3 * 3.0 * (3.0 * x).cos();
            let length = slope.hypot(1.0);
            let side = [-slope / length, 1.0 / length];
            let half_width = sin * (0.12 + 0.05 * x);
            let half_height = half_width * (1.3 - 0.5 * x);
            At { center: [x, 0.3 * (3.0 * x).sin()], side, half_width, half_height }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::test_bodies::{bent_fish, ellipsoid};
    use super::*;

    #[test]
    fn moments_of_an_ellipsoid_are_known() {
        let [a, b, c] = [0.9, 0.3, 0.5];
        let SectionMoments { volume, first, second } = ellipsoid([a, b, c], 80).moments();
        let exact = 4.0 / 3.0 * PI * a * b * c;
        assert!((volume / exact - 1.0).abs() < 1e-5, "{volume} {exact}");
        assert!(first[0].abs() < 1e-12 && first[1].abs() < 1e-12);
        let sphere = ellipsoid([0.7; 3], 80).area() / (4.0 * PI * 0.49);
        assert!((sphere - 1.0).abs() < 1e-3, "{sphere}");
        for (own, of) in second.iter().zip([a * a, 0.0, b * b, c * c]) {
            assert!((own - exact * of / 5.0).abs() < 1e-5 * exact, "{second:?}");
        }
    }

    /// By the divergence theorem on the surface, with a rule of another kind.
    #[test]
    fn moments_of_a_bent_body_are_those_of_its_surface() {
        let body = bent_fish();
        let (n_along, n_around) = (4000, 64);
        let (mut volume, mut x, mut xy, mut zz) = (0.0, 0.0, 0.0, 0.0);
        let [step, turn] = [body.end() / n_along as f64, 2.0 * PI / n_around as f64];
        for i in 0..n_along {
            let [value, rate, _] = body.at(step * (i as f64 + 0.5));
            for k in 0..n_around {
                let angle = turn * k as f64;
                let at = on_section(&value, angle);
                let normal = on_section(&rate, angle).cross(&along_section(&value, angle));
                let flux = at.dot(&normal) * step * turn;
                volume += flux / 3.0;
                x += at.x * flux / 4.0;
                xy += at.x * at.y * flux / 5.0;
                zz += at.z * at.z * flux / 5.0;
            }
        }
        let own = body.moments();
        for (own, sum) in [own.volume, own.first[0], own.second[1], own.second[3]]
            .into_iter()
            .zip([volume, x, xy, zz])
        {
            assert!((own - sum).abs() < 1e-5 * volume, "{own} {sum}");
        }
        let centered = body.centered().moments();
        assert!(centered.first[0].abs() < 1e-14 && centered.first[1].abs() < 1e-14);
    }
}
