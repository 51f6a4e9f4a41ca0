//! `Encounter`: a body and one other surface that it may meet, and how near they are.

use alewife_mesh::Point;

use super::Partner;
use super::surface::{ContactSurface, FacingPoints};

/// A body and what it may meet.
pub(super) struct Encounter<'a, const D: usize, S: ContactSurface<D>> {
    /// The body.
    pub body: usize,
    /// Its surface where it is.
    pub surface: &'a S,
    /// What it may meet.
    pub partner: Partner,
    /// From the partner to the image of it that is met (m).
    pub away: Point<D>,
    /// The surface of the partner, where it is met.
    pub facing: Facing<'a, D, S>,
}

/// The surface of a partner.
pub(super) enum Facing<'a, const D: usize, S: ContactSurface<D>> {
    /// That of a body.
    Body(S),
    /// A side of the domain.
    Wall(&'a S::Wall),
}

impl<const D: usize, S: ContactSurface<D>> Encounter<'_, D, S> {
    /// All close pairs of points with gaps below `range` (m).
    pub fn points(&self, range: f64) -> Vec<FacingPoints> {
        match &self.facing {
            Facing::Body(image) => self.surface.facing(image, range),
            Facing::Wall(wall) => self.surface.facing_wall(wall, range),
        }
    }

    /// The smallest gap (m).
    pub fn gap(&self) -> f64 {
        match &self.facing {
            Facing::Body(image) => self.surface.gap(image),
            Facing::Wall(wall) => self.surface.gap_to_wall(wall),
        }
    }

    /// A lower bound of the smallest gap (m), at little cost.
    pub fn gap_bound(&self) -> f64 {
        match &self.facing {
            Facing::Body(image) => self.surface.least_gap(image),
            Facing::Wall(wall) => self.surface.least_gap_to_wall(wall),
        }
    }
}
