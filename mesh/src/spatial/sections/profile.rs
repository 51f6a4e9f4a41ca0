//! `SectionHeight`: how high the sections of a profile are, and the straight body they make.

use super::Sections;
use crate::{Profile, Station};

/// Half height of the sections of a slender body, across the plane of its midline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SectionHeight {
    /// As their half width: sections are circles.
    Round,
    /// That of half an ellipse from the nose to the end of the tail.
    Ellipse {
        /// In the middle of the body (m).
        half_height: f64,
    },
}

impl SectionHeight {
    /// At a place of a profile with this length (m).
    #[must_use]
    pub fn at(&self, along: f64, half_width: f64, length: f64) -> f64 {
        match self {
            Self::Round => half_width,
            Self::Ellipse { half_height } => {
                let part = (along / length).clamp(0.0, 1.0);
                2.0 * half_height * (part * (1.0 - part)).sqrt()
            }
        }
    }

    /// At the material points of a profile from nose to tail, zero at both ends (m).
    #[must_use]
    pub fn along(&self, profile: &Profile) -> Vec<f64> {
        let (stations, length) = (profile.stations(), profile.length());
        let last = stations.len() - 1;
        let at = |(i, station): (usize, &Station)| {
            let height = self.at(station.along, station.half_width, length);
            if i == 0 || i == last { 0.0 } else { height }
        };
        stations.iter().enumerate().map(at).collect()
    }
}

impl Profile {
    /// The body at rest, straight along x with the head towards +x and its volume in the origin; `None` for
    /// lengths that make none.
    #[must_use]
    pub fn sections(&self, height: SectionHeight) -> Option<Sections> {
        Some(Sections::new(&self.spline()?, &height.along(self))?.centered())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::FlagellateForm;
    use std::f64::consts::PI;

    #[test]
    fn a_round_flagellate_has_the_volume_of_its_profile_turned() {
        let form =
            FlagellateForm { head: [2.0, 1.0], tail_length: 50.0, thickness: 0.2, fillet: 0.2 };
        let profile = Profile::flagellate(&form).unwrap();
        let volume = profile.sections(SectionHeight::Round).unwrap().moments().volume;
        let n = 400_000;
        let step = profile.length() / f64::from(n);
        let area = |i: u32| profile.find(step * (f64::from(i) + 0.5)).half_width.powi(2) * PI;
        let sum: f64 = (0..n).step_by(40).map(|i| area(i) * 40.0 * step).sum();
        assert!((volume / sum - 1.0).abs() < 1e-4, "{volume} {sum}");
    }
}
