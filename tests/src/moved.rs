//! Meshes turned, mirrored and shifted as a whole.

use alewife_mesh::{Mesh, Point};
use nalgebra::Rotation2;

/// A mirror image about the x axis or none, then a turn about the origin, then a shift.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Moved {
    /// Whether y becomes -y first.
    pub mirrored: bool,
    /// Angle of the turn (rad).
    pub turn: f64,
    /// Shift (m).
    pub shift: [f64; 2],
}

impl Moved {
    /// -1 where angles and angular velocities change their sign, else 1.
    #[must_use]
    pub fn sign(&self) -> f64 {
        if self.mirrored { -1.0 } else { 1.0 }
    }

    /// A vector, which a shift leaves as it is.
    #[must_use]
    pub fn vector(&self, vector: Point<2>) -> Point<2> {
        Rotation2::new(self.turn) * Point::<2>::new(vector.x, self.sign() * vector.y)
    }

    /// A place (m).
    #[must_use]
    pub fn place(&self, place: Point<2>) -> Point<2> {
        self.vector(place) + Point::<2>::from(self.shift)
    }

    /// The direction of a body (rad).
    #[must_use]
    pub fn angle(&self, angle: f64) -> f64 {
        self.turn + self.sign() * angle
    }

    /// A mesh, its cells counter-clockwise as they were.
    #[must_use]
    pub fn mesh(&self, mesh: &Mesh<2>) -> Mesh<2> {
        let mut moved = mesh.clone();
        for node in &mut moved.nodes {
            *node = self.place(*node);
        }
        if self.mirrored {
            // Vertices a, b, c become a, c, b, and so the edges ab, bc, ca: ca, bc, ab.
            for cell in moved.cells.chunks_exact_mut(6) {
                cell.swap(1, 2);
                cell.swap(3, 5);
            }
            for facet in &mut moved.facets {
                facet.side = 2 - facet.side;
            }
        }
        moved
    }
}
