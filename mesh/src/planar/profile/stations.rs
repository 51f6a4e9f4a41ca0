//! `Profile`: half width along the midline of a slender body, in smooth pieces, with material points.
//!
//! A profile is the upper half of a body laid straight: place s along the midline, from the head on,
//! and half width w there. Its pieces are straight, arcs of ellipses or bridges and meet with a common
//! tangent, so the outline has no corner.

use std::sync::Arc;

use super::piece::Piece;
use super::spread::{LONGEST_SPACING, spread};
use crate::{Shape, Spline};

/// Half width of a slender body along its midline.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    pieces: Vec<Piece>,
    /// Number of steps between material points on every piece, and how they are spread.
    spreads: Vec<Vec<f64>>,
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

impl Profile {
    pub(super) fn of(pieces: Vec<Piece>) -> Self {
        Self::with_spacing(pieces, f64::INFINITY)
    }

    /// With material points so far apart at most (m).
    pub(super) fn with_spacing(pieces: Vec<Piece>, spacing: f64) -> Self {
        let length = pieces[pieces.len() - 1].at(1.0)[0].x;
        let longest = spacing.min(LONGEST_SPACING * length);
        let spreads = (0..pieces.len()).map(|piece| spread(&pieces, piece, longest)).collect();
        Self { pieces, spreads }
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
    use crate::{FishForm, FlagellateForm};

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
