//! `Tracks`: what a recording has of a motion.

use alewife_solid::solid::Level;

use super::{Angles, Markers, Objective};

/// Marks and angles that a recording has, each with what it counts.
#[derive(Debug, Clone, PartialEq)]
pub struct Tracks {
    /// The marks.
    pub markers: Markers,
    /// The angles, in the plane.
    pub angles: Angles,
}

impl Objective for Tracks {
    fn at(
        &self,
        number: usize,
        level: &Level,
        rest: &[f64],
        by_places: &mut [f64],
        by_rest: &mut [f64],
    ) -> f64 {
        self.markers.at(number, level, rest, by_places, by_rest)
            + self.angles.at(number, level, rest, by_places, by_rest)
    }
}
