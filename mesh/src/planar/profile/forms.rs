//! `FishForm` and `FlagellateForm`: the lengths of a body, and the profile they make.

use std::f64::consts::{FRAC_PI_2, PI};

use super::piece::Piece;
use super::stations::Profile;
use crate::Point;

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
}
