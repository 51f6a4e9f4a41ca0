//! `Ring`: one section of a slender body as an ellipse in space, and its point nearest to another one.

use crate::Point;
use crate::spatial::sections::{Section, Sections, on_section, parts_of};

/// Angles at which a ring is looked at for the box around it, and for places on the surface.
const ANGLES: usize = 8;

/// Steps on the evolute: what is found is good enough to start from.
const STEPS: usize = 3;

/// Difference of the squares of width and height over that of the width below which a section is round.
const ROUND: f64 = 1e-12;

/// A section and its parameter.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ring {
    /// Parameter from the nose to the end of the tail.
    pub along: f64,
    /// The section there.
    pub section: Section,
    /// Its middle (m).
    pub center: Point<3>,
    /// Radius of a ball about the centre that holds it (m).
    pub reach: f64,
    /// Unit vectors along its width and its height, and across both.
    side: Point<3>,
    up: Point<3>,
    ahead: Point<3>,
    /// Half width and half height (m).
    width: f64,
    height: f64,
}

/// A place, and how far it is along a direction (m).
#[derive(Debug, Clone, Copy)]
pub(super) struct Lowest {
    pub place: Point<3>,
    pub value: f64,
}

impl Ring {
    /// The section at a parameter.
    pub fn new(sections: &Sections, along: f64) -> Self {
        let [section, ..] = sections.at(along);
        let [center, across, upward] = parts_of(&section);
        let (width, height) = (across.norm(), upward.norm());
        let (side, up) = (across / width, upward / height);
        let reach = width.max(height);
        Self { along, section, center, reach, side, up, ahead: up.cross(&side), width, height }
    }

    /// Cosine and sine of the angle of its point nearest to a place in its plane, along and across the width,
    /// both not negative (m).
    fn nearest(&self, x: f64, z: f64) -> [f64; 2] {
        let Self { width, height, .. } = *self;
        let apart = width * width - height * height;
        let unit = |cos: f64, sin: f64| {
            let norm = (cos * cos + sin * sin).sqrt();
            if norm > 0.0 { [cos / norm, sin / norm] } else { [1.0, 0.0] }
        };
        if apart.abs() <= ROUND * width * width {
            return unit(x, z);
        }
        let [mut cos, mut sin] = [std::f64::consts::FRAC_1_SQRT_2; 2];
        for _ in 0..STEPS {
            let ex = apart * cos * cos * cos / width;
            let ez = -apart * sin * sin * sin / height;
            let [u, v] = [width * cos - ex, height * sin - ez];
            let square = (x - ex) * (x - ex) + (z - ez) * (z - ez);
            if square > 0.0 {
                let stretch = ((u * u + v * v) / square).sqrt();
                cos = (((x - ex) * stretch + ex) / width).clamp(0.0, 1.0);
                sin = (((z - ez) * stretch + ez) / height).clamp(0.0, 1.0);
            }
            [cos, sin] = unit(cos, sin);
        }
        [cos, sin]
    }

    /// Its point that is lowest along a direction.
    pub fn lowest(&self, along: &Point<3>) -> Lowest {
        let [_, across, upward] = parts_of(&self.section).map(|part| part.dot(along));
        let place = on_section(&self.section, (-upward).atan2(-across));
        Lowest { place, value: place.dot(along) }
    }

    /// Square of the distance of a point (m2).
    pub fn squared_distance(&self, of: &Point<3>) -> f64 {
        let off = of - self.center;
        let (x, z) = (off.dot(&self.side).abs(), off.dot(&self.up).abs());
        let ahead = off.dot(&self.ahead);
        let [cos, sin] = self.nearest(x, z);
        let [u, v] = [x - self.width * cos, z - self.height * sin];
        u * u + v * v + ahead * ahead
    }

    /// The angle at which it is nearest to a point (m).
    pub fn angle_of(&self, of: &Point<3>) -> f64 {
        let off = of - self.center;
        let (side, up) = (off.dot(&self.side), off.dot(&self.up));
        let [cos, sin] = self.nearest(side.abs(), up.abs());
        (sin * up.signum()).atan2(cos * side.signum())
    }
}

/// Places around a section.
pub(super) fn ring_corners(section: &Section) -> [Point<3>; ANGLES] {
    let angle = std::f64::consts::TAU / ANGLES as f64;
    std::array::from_fn(|i| on_section(section, angle * i as f64))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spatial::sections::test_bodies::bent_fish;

    /// Against all angles, one by one.
    #[test]
    fn a_ring_is_nearest_where_it_is_found_to_be() {
        let body = bent_fish();
        for part in [0.2, 0.5, 0.9] {
            let ring = Ring::new(&body, part * body.end());
            for i in 0..40 {
                let at = |k: f64| (0.618_034 * k * f64::from(i + 1)).fract() - 0.5;
                let of = ring.center + Point::<3>::new(at(1.0), at(5.0), at(11.0)) * 0.6;
                let distance = |angle: f64| (on_section(&ring.section, angle) - of).norm();
                let all =
                    (0..3000).map(|i| distance(f64::from(i) * std::f64::consts::TAU / 3000.0));
                let least = all.fold(f64::INFINITY, f64::min);
                let found = ring.squared_distance(&of).sqrt();
                assert!((found - distance(ring.angle_of(&of))).abs() < 1e-12);
                assert!((found - least).abs() < 0.02 * ring.reach, "{found} {least}");
            }
        }
    }
}
