//! `TubeForm`: widths along a tube with elliptic ends, and the profile they make.

use std::f64::consts::{FRAC_PI_2, PI};

use super::piece::Piece;
use super::stations::Profile;
use crate::Point;

/// Widths along a tube.
#[derive(Debug, Clone, PartialEq)]
pub struct TubeForm {
    /// [distance from the head, half width] (m), ascending, within the length.
    pub sections: Vec<[f64; 2]>,
    /// Length (m).
    pub length: f64,
    /// Longest distance between material points (m).
    pub spacing: f64,
}

impl Profile {
    /// Profile of a tube: half an ellipse before the first section and behind the last one, and a
    /// polynomial of degree five between neighbours, without slope and curvature at the sections.
    ///
    /// `None` when these lengths make no such body.
    #[must_use]
    pub fn tube(form: &TubeForm) -> Option<Self> {
        let TubeForm { sections, length, spacing } = form;
        let ([first, nose], [last, tip]) = (*sections.first()?, *sections.last()?);
        let does_rise = sections.windows(2).all(|pair| pair[1][0] > pair[0][0]);
        let is_wide = sections.iter().all(|[_, width]| *width > 0.0 && width.is_finite());
        let is_inside = first > 0.0 && last < *length && length.is_finite();
        if !(does_rise && is_wide && is_inside && *spacing > 0.0) {
            return None;
        }
        let end = |place: f64, semi_axes: [f64; 2], angles: [f64; 2]| Piece::Arc {
            center: Point::<2>::new(place, 0.0),
            semi_axes,
            angles,
        };
        let mut pieces = vec![end(first, [first, nose], [PI, FRAC_PI_2])];
        pieces.extend(
            sections
                .windows(2)
                .map(|pair| Piece::Bridge { from: pair[0].into(), to: pair[1].into() }),
        );
        pieces.push(end(last, [length - last, tip], [FRAC_PI_2, 0.0]));
        Some(Self::with_spacing(pieces, *spacing))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECTIONS: [[f64; 2]; 3] = [[0.5, 0.14], [1.5, 0.12], [2.4, 0.08]];

    fn tube(sections: &[[f64; 2]]) -> Option<Profile> {
        Profile::tube(&TubeForm { sections: sections.to_vec(), length: 2.8, spacing: 0.02 })
    }

    #[test]
    fn a_tube_has_its_sections_and_elliptic_ends() {
        let profile = tube(&SECTIONS).unwrap();
        for [along, width] in SECTIONS {
            assert!((profile.find(along).half_width - width).abs() < 1e-12);
        }
        // Halfway between two sections the mean of both; an ellipse at the end
        assert!((profile.find(1.0).half_width - 0.13).abs() < 1e-12);
        assert!((profile.find(0.1).half_width - 0.14 * 0.6).abs() < 1e-9);
        assert!((profile.length() - 2.8).abs() < 1e-14);
        let stations = profile.stations();
        assert!(stations.windows(2).all(|pair| pair[1].along - pair[0].along < 0.0201));
        // Two half ellipses and the bridges, whose mean width is that of their ends
        let half = 0.25 * PI * (0.5 * 0.14 + 0.4 * 0.08) + 0.13 + 0.9 * 0.1;
        let spline = std::sync::Arc::new(profile.spline().unwrap());
        let area = crate::Shape::Curve { spline }.moments().unwrap().measure;
        assert!((area / (2.0 * half) - 1.0).abs() < 1e-5, "{area}");
    }

    #[test]
    fn the_curvature_of_a_bridge_is_that_of_its_curve() {
        let bridge = Piece::Bridge { from: [0.0, 0.3].into(), to: [0.7, 0.1].into() };
        for p in [0.1, 0.4, 0.5, 0.9] {
            let h = 1e-4;
            let [before, after] = [p - h, p + h].map(|p| bridge.at(p));
            let rate = (after[0] - before[0]) / (2.0 * h);
            let bend = (after[1] - before[1]) / (2.0 * h);
            assert!((rate - bridge.at(p)[1]).norm() < 1e-6);
            let curvature = -(rate.x * bend.y - rate.y * bend.x) / rate.norm().powi(3);
            assert!((curvature - bridge.curvature(p)).abs() < 1e-4, "{p}");
        }
    }

    #[test]
    fn sections_that_make_no_tube_are_refused() {
        assert!(tube(&[]).is_none());
        assert!(tube(&[[0.5, 0.1], [0.4, 0.1]]).is_none());
        assert!(tube(&[[0.5, 0.1], [2.8, 0.1]]).is_none());
        assert!(tube(&[[0.5, 0.0]]).is_none());
    }
}
