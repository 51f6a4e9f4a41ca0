//! `Encounter`: a body and one other surface that it may meet, and how near they are.

use alewife_mesh::{
    Closest, Outline, Point, Wall, closest, closest_features, closest_to_wall, wall_features,
};

use super::Partner;

/// A body and what it may meet.
pub(super) struct Encounter<'a> {
    /// The body.
    pub body: usize,
    /// Its outline where it is.
    pub outline: &'a Outline,
    /// What it may meet.
    pub partner: Partner,
    /// From the partner to the image of it that is met (m).
    pub away: Point<2>,
    /// The surface of the partner, where it is met.
    pub surface: Surface<'a>,
}

/// The surface of a partner.
pub(super) enum Surface<'a> {
    /// That of a body.
    Outline(Outline),
    /// A side of the domain.
    Wall(&'a Wall),
}

impl Encounter<'_> {
    /// All close pairs of points with gaps below `range` (m).
    pub fn features(&self, range: f64) -> Vec<Closest> {
        match &self.surface {
            Surface::Outline(image) => closest_features(self.outline, image, range),
            Surface::Wall(wall) => wall_features(self.outline, wall, range),
        }
    }

    /// The smallest gap (m).
    pub fn gap(&self) -> f64 {
        match &self.surface {
            Surface::Outline(image) => closest(self.outline, image).gap,
            Surface::Wall(wall) => closest_to_wall(self.outline, wall).gap,
        }
    }

    /// A lower bound of the smallest gap (m), at no cost.
    pub fn gap_bound(&self) -> f64 {
        match &self.surface {
            Surface::Outline(image) => self.outline.least_gap(image.center()) - image.reach(),
            Surface::Wall(wall) => wall.gap(self.outline.center()) - self.outline.reach(),
        }
    }
}
