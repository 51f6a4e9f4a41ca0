//! `Profile`: half width along the midline of fish and flagellates, in smooth pieces, with material points.
//!
//! A profile is the upper half of a body laid straight: place s along the midline, from the head on,
//! and half width w there. Its pieces are straight or arcs of ellipses and meet with a common
//! tangent, so the outline has no corner.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use crate::quadrature::integrate;
use crate::{Point, Shape, Spline};

/// Longest distance between material points, over the length of the body.
const LONGEST_SPACING: f64 = 0.01;

/// Largest angle between neighbouring material points on an arc (rad).
const LARGEST_ANGLE: f64 = 0.15;

/// Growth of the distance between material points per distance from where the curvature jumps.
const GROWTH: f64 = 0.4;

/// Error of the spline next to a jump of curvature, over that jump and the squared spacing.
const JUMP_ERROR: f64 = 0.03;

/// Error of the spline that is aimed at, over the half width.
const ERROR: f64 = 2e-5;

/// Half width of a slender body along its midline.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    pieces: Vec<Piece>,
    /// Number of steps between material points on every piece, and how they are spread.
    spreads: Vec<Vec<f64>>,
}

/// A smooth piece of a profile, with a parameter in [0, 1]; s grows along it.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Piece {
    Line {
        from: Point<2>,
        to: Point<2>,
    },
    /// Arc of an ellipse with axes along s and w.
    Arc {
        center: Point<2>,
        semi_axes: [f64; 2],
        /// Eccentric angles of its ends (rad).
        angles: [f64; 2],
    },
}

/// A place of a profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Station {
    /// Piece of the profile, and parameter in [0, 1] on it.
    pub piece: usize,
    /// Parameter on the piece.
    pub parameter: f64,
    /// Distance from the head along the midline (m).
    pub along: f64,
    /// Half width (m).
    pub half_width: f64,
    /// Derivative of `along` by the parameter (m).
    pub rate: f64,
}

/// Lengths of a fish, all of them over its length but the first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FishForm {
    /// Length (m) up to the point in which its sides would meet.
    pub length: f64,
    /// Radius of the round head w_h.
    pub head_width: f64,
    /// Half width w_t where the sides begin to close.
    pub tail_width: f64,
    /// Where the round head ends; at most `head_width`.
    pub head_end: f64,
    /// Where the sides begin to close.
    pub tail_start: f64,
    /// Radius of the end of the tail.
    pub tip_radius: f64,
    /// Radius with which the corner at `tail_start` is rounded.
    pub corner_radius: f64,
}

/// Lengths of a flagellate (m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlagellateForm {
    /// Semi-axes of the head, along the body and across it.
    pub head: [f64; 2],
    /// Length of the tail from the end of the head on.
    pub tail_length: f64,
    /// Width of the tail, which has a round end.
    pub thickness: f64,
    /// Radius with which the corner of head and tail is filled.
    pub fillet: f64,
}

impl Piece {
    fn at(&self, parameter: f64) -> [Point<2>; 2] {
        match *self {
            Self::Line { from, to } => [from + (to - from) * parameter, to - from],
            Self::Arc { center, semi_axes: [a, b], angles: [first, last] } => {
                let turn = last - first;
                let (sin, cos) = (first + turn * parameter).sin_cos();
                [
                    center + Point::<2>::new(a * cos, b * sin),
                    Point::<2>::new(-a * sin, b * cos) * turn,
                ]
            }
        }
    }

    /// Curvature, positive where the body is convex (1/m).
    fn curvature(&self, parameter: f64) -> f64 {
        match *self {
            Self::Line { .. } => 0.0,
            Self::Arc { semi_axes: [a, b], angles: [first, last], .. } => {
                let speed = self.at(parameter)[1].norm() / (last - first).abs();
                a * b / speed.powi(3) * (first - last).signum()
            }
        }
    }

    /// An arc of a circle from one place of it to another, the short way round.
    fn circle(center: Point<2>, radius: f64, from: Point<2>, to: Point<2>) -> Self {
        let angle = |place: Point<2>| (place.y - center.y).atan2(place.x - center.x);
        let first = angle(from);
        let turn = (angle(to) - first + PI).rem_euclid(2.0 * PI) - PI;
        Self::Arc { center, semi_axes: [radius; 2], angles: [first, first + turn] }
    }
}

impl Profile {
    /// Profile of a fish: half width sqrt(2 w_h s - s²) up to the end of the head, linear to w_t,
    /// and linear to 0 at the length, closed by a round end inscribed in this wedge.
    ///
    /// `None` when these lengths make no such body.
    ///
    /// # Source
    /// @gazzola2011.
    #[must_use]
    pub fn fish(form: &FishForm) -> Option<Self> {
        let length = form.length;
        let all = [
            length,
            form.head_width,
            form.tail_width,
            form.head_end,
            form.tail_start,
            form.tip_radius,
            form.corner_radius,
        ];
        if !all.iter().all(|value| value.is_finite() && *value > 0.0) {
            return None;
        }
        let [_, head, tail, end, start, tip, corner] = all.map(|value| value * length);
        let nose = Point::<2>::new(head, 0.0);
        if end > head || start <= end || form.tail_start >= 1.0 {
            return None;
        }
        let cheek = Point::<2>::new(end, (2.0 * head * end - end * end).sqrt());
        let peduncle = Point::<2>::new(start, tail);
        if tail >= cheek.y {
            return None;
        }
        // Round the corner of head and flank: a circle inside both
        let flank = (peduncle - cheek).normalize();
        let inward = Point::<2>::new(flank.y, -flank.x);
        let round = 0.5 * head;
        let base = cheek + inward * round - nose;
        let (along, reach) = (base.dot(&flank), head - round);
        let advance =
            -along - (along * along - base.norm_squared() + reach * reach).max(0.0).sqrt();
        let center = nose + base + flank * advance;
        let on_head = nose + (center - nose) * (head / reach);
        let on_flank = center - inward * round;
        // Round the corner of flank and wedge
        let wedge = (Point::<2>::new(length, 0.0) - peduncle).normalize();
        let outward = Point::<2>::new(-wedge.y, wedge.x);
        let turn = flank.dot(&wedge).clamp(-1.0, 1.0).acos();
        let cut = corner * (0.5 * turn).tan();
        let (from, to) = (peduncle - flank * cut, peduncle + wedge * cut);
        // End of the wedge
        let back = tip / outward.x;
        let tip_center = Point::<2>::new(length - back, 0.0);
        let touch = tip_center + outward * tip;
        let is_ordered =
            on_head.x < on_flank.x && on_flank.x < from.x && to.x < touch.x && turn > 1e-9;
        if !is_ordered {
            return None;
        }
        let right = Point::<2>::new(tip_center.x + tip, 0.0);
        Some(Self::of(vec![
            Piece::circle(nose, head, Point::<2>::zeros(), on_head),
            Piece::circle(center, round, on_head, on_flank),
            Piece::Line { from: on_flank, to: from },
            Piece::circle(to - outward * corner, corner, from, to),
            Piece::Line { from: to, to: touch },
            Piece::circle(tip_center, tip, touch, right),
        ]))
    }

    /// Profile of a flagellate: an elliptic head and a tail of constant width with a round end.
    ///
    /// `None` when these lengths make no such body.
    #[must_use]
    pub fn flagellate(form: &FlagellateForm) -> Option<Self> {
        let [a, b] = form.head;
        let half = 0.5 * form.thickness;
        let (fillet, end) = (form.fillet, 2.0 * a + form.tail_length);
        let all = [a, b, half, fillet, form.tail_length];
        if !all.iter().all(|value| value.is_finite() && *value > 0.0) || half >= b {
            return None;
        }
        // The fillet's centre: a radius above the tail, and above the ellipse along its normal.
        // Its height half + fillet = b sin + fillet a sin / speed falls with the angle.
        let excess = |angle: f64| {
            let (sin, cos) = angle.sin_cos();
            let speed = (a * sin).hypot(b * cos);
            b * sin + fillet * a * sin / speed - half - fillet
        };
        let (mut low, mut high) = (0.0, FRAC_PI_2);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if excess(middle) < 0.0 { low = middle } else { high = middle }
        }
        let angle = 0.5 * (low + high);
        let (sin, cos) = angle.sin_cos();
        let speed = (a * sin).hypot(b * cos);
        let touch = Point::<2>::new(a + a * cos, b * sin);
        let center = touch + Point::<2>::new(b * cos, a * sin) * (fillet / speed);
        let bottom = Point::<2>::new(center.x, half);
        let tip = Point::<2>::new(end - half, 0.0);
        if bottom.x >= tip.x || bottom.y >= touch.y {
            return None;
        }
        let head =
            Piece::Arc { center: Point::<2>::new(a, 0.0), semi_axes: [a, b], angles: [PI, angle] };
        let shoulder = Point::<2>::new(tip.x, half);
        Some(Self::of(vec![
            head,
            Piece::circle(center, fillet, touch, bottom),
            Piece::Line { from: bottom, to: shoulder },
            Piece::circle(tip, half, shoulder, Point::<2>::new(end, 0.0)),
        ]))
    }

    fn of(pieces: Vec<Piece>) -> Self {
        let mut profile = Self { pieces, spreads: Vec::new() };
        profile.spreads = (0..profile.pieces.len()).map(|piece| profile.spread(piece)).collect();
        profile
    }

    /// Distance from the head to the end of the tail along the midline (m).
    #[must_use]
    pub fn length(&self) -> f64 {
        self.pieces[self.pieces.len() - 1].at(1.0)[0].x
    }

    /// Number of its smooth pieces.
    #[must_use]
    pub fn n_pieces(&self) -> usize {
        self.pieces.len()
    }

    /// A place on one of its pieces, parameter in [0, 1].
    #[must_use]
    pub fn at(&self, piece: usize, parameter: f64) -> Station {
        let [place, rate] = self.pieces[piece].at(parameter);
        Station { piece, parameter, along: place.x, half_width: place.y.max(0.0), rate: rate.x }
    }

    /// The piece and the parameter on it at a distance along the midline (m), kept within the body.
    #[must_use]
    pub fn find(&self, along: f64) -> Station {
        let last = self.pieces.len() - 1;
        let piece = (0..last).find(|i| self.pieces[*i].at(1.0)[0].x >= along).unwrap_or(last);
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if self.pieces[piece].at(middle)[0].x < along { low = middle } else { high = middle }
        }
        self.at(piece, 0.5 * (low + high))
    }

    /// Stations of the material points from the head to the end of the tail, both included.
    #[must_use]
    pub fn stations(&self) -> Vec<Station> {
        let mut stations = vec![self.at(0, 0.0)];
        for (piece, spread) in self.spreads.iter().enumerate() {
            stations.extend(spread.iter().map(|parameter| self.at(piece, *parameter)));
        }
        // Both ends are on the midline, without rounding
        let last = stations.len() - 1;
        stations[0].half_width = 0.0;
        stations[last].half_width = 0.0;
        stations
    }

    /// Parameters of the material points of a piece but its first, close to each other where the
    /// outline bends and where its curvature jumps.
    fn spread(&self, index: usize) -> Vec<f64> {
        let piece = &self.pieces[index];
        let n = 2000;
        let length = |from: f64, to: f64| integrate(from, to, |x| piece.at(x)[1].norm());
        let whole = self.length();
        let jump = |end: f64, neighbour: Option<&Piece>, at: f64| {
            // At the ends of the body the outline goes on with the same curvature
            let jump =
                neighbour.map_or(0.0, |other| (other.curvature(at) - piece.curvature(end)).abs());
            let width = piece.at(end)[0].y;
            if jump > 0.0 { (ERROR * width / (JUMP_ERROR * jump)).sqrt() } else { f64::INFINITY }
        };
        let before = index.checked_sub(1).map(|i| &self.pieces[i]);
        let finest = [jump(0.0, before, 1.0), jump(1.0, self.pieces.get(index + 1), 0.0)];
        // Number of steps up to each parameter: the integral of one over the wanted spacing
        let total: f64 = length(0.0, 1.0);
        let (mut steps, mut done) = (vec![0.0], 0.0);
        for i in 0..n {
            let (from, to) = (f64::from(i) / f64::from(n), f64::from(i + 1) / f64::from(n));
            let part = length(from, to);
            let from_start = done + 0.5 * part;
            let bend = piece.curvature(0.5 * (from + to)).abs();
            let wanted = (LONGEST_SPACING * whole)
                .min(LARGEST_ANGLE / bend)
                .min(finest[0] + GROWTH * from_start)
                .min(finest[1] + GROWTH * (total - from_start));
            steps.push(steps[steps.len() - 1] + part / wanted);
            done += part;
        }
        let count = steps[steps.len() - 1].ceil().max(2.0);
        let scale = steps[steps.len() - 1] / count;
        let mut parameters: Vec<f64> = (1..count as usize)
            .map(|k| {
                let wanted = k as f64 * scale;
                let i = steps.partition_point(|s| *s <= wanted).clamp(1, steps.len() - 1);
                let part = (wanted - steps[i - 1]) / (steps[i] - steps[i - 1]);
                (i as f64 - 1.0 + part) / f64::from(n)
            })
            .collect();
        parameters.push(1.0);
        parameters
    }

    /// The outline at rest, straight along x with the head towards +x and the centre of area in the
    /// origin: the spline through the material points, from the head counter-clockwise.
    #[must_use]
    pub fn spline(&self) -> Option<Spline> {
        let stations = self.stations();
        let upper = stations.iter().map(|s| [-s.along, s.half_width]);
        let lower = stations[1..stations.len() - 1].iter().rev().map(|s| [-s.along, -s.half_width]);
        let points: Vec<[f64; 2]> = upper.chain(lower).collect();
        let spline = Spline::through(&points)?;
        let knots = spline.knots().to_vec();
        let shape = Shape::Curve { spline: Arc::new(spline) };
        let center = shape.moments()?.centroid.x;
        let centered: Vec<[f64; 2]> = points.iter().map(|[x, y]| [x - center, *y]).collect();
        Spline::with_knots(&centered, &knots)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FISH: FishForm = FishForm {
        length: 1.0,
        head_width: 0.04,
        tail_width: 0.01,
        head_end: 0.04,
        tail_start: 0.95,
        tip_radius: 1e-3,
        corner_radius: 0.01,
    };

    const FLAGELLATE: FlagellateForm =
        FlagellateForm { head: [2.0, 1.0], tail_length: 50.0, thickness: 0.2, fillet: 0.2 };

    /// Pieces meet with a common tangent, and s grows.
    #[test]
    fn profiles_are_smooth() {
        for profile in [Profile::fish(&FISH).unwrap(), Profile::flagellate(&FLAGELLATE).unwrap()] {
            for pair in profile.pieces.windows(2) {
                let ([end, before], [start, after]) = (pair[0].at(1.0), pair[1].at(0.0));
                assert!((end - start).norm() < 1e-12);
                let turn = before.normalize() - after.normalize();
                assert!(turn.norm() < 1e-7, "{turn}");
            }
            let stations = profile.stations();
            assert!(stations.windows(2).all(|pair| pair[1].along > pair[0].along));
            assert!(stations.len() < 260, "{}", stations.len());
        }
    }

    /// Largest distance of the spline from the profile, over the half width there.
    #[test]
    fn the_spline_has_the_width_of_the_profile() {
        for profile in [Profile::fish(&FISH).unwrap(), Profile::flagellate(&FLAGELLATE).unwrap()] {
            let spline = profile.spline().unwrap();
            let nose = spline.evaluate(0.0)[0].x;
            let n = profile.stations().len() - 1;
            let mut worst: f64 = 0.0;
            for k in spline.knots()[..=n].windows(2) {
                for i in 1..10 {
                    let at = spline.evaluate(k[0] + (k[1] - k[0]) * f64::from(i) / 10.0)[0];
                    let exact = profile.find(nose - at.x);
                    let [_, rate] = profile.pieces[exact.piece].at(exact.parameter);
                    let off = (at.y - exact.half_width) * rate.x / rate.norm();
                    let width = exact.half_width.max(0.3 * 1e-3);
                    worst = worst.max(off.abs() / width);
                }
            }
            assert!(worst < 1e-4, "{worst}");
        }
    }

    #[test]
    fn the_fish_has_its_published_area() {
        let spline = Profile::fish(&FISH).unwrap().spline().unwrap();
        let moments = Shape::Curve { spline: Arc::new(spline) }.moments().unwrap();
        assert!((moments.measure - 0.04851).abs() < 1e-5, "{}", moments.measure);
        assert!(moments.centroid.norm() < 1e-14);
    }

    #[test]
    fn lengths_that_make_no_body_are_refused() {
        assert!(Profile::fish(&FishForm { tail_start: 1.0, ..FISH }).is_none());
        assert!(Profile::fish(&FishForm { tail_width: 0.05, ..FISH }).is_none());
        assert!(Profile::fish(&FishForm { tip_radius: 0.05, ..FISH }).is_none());
        assert!(Profile::flagellate(&FlagellateForm { thickness: 3.0, ..FLAGELLATE }).is_none());
        assert!(
            Profile::flagellate(&FlagellateForm { tail_length: 0.5, fillet: 5.0, ..FLAGELLATE })
                .is_none()
        );
    }
}
