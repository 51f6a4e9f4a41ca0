//! `GapQuery`: the surroundings of bodies in the plane.

use super::{Domain, Outline, PlacedShape};
use crate::surface::{Sides, Surroundings};
use crate::{MeshError, Point};

/// Sides of a domain and outlines of bodies. Periodic sides and the axis are no surfaces.
pub type GapQuery = Surroundings<2, Domain, Outline>;

impl Sides<2> for Domain {
    fn n_sides(&self) -> usize {
        self.sides().len()
    }

    fn is_faced(&self, side: usize) -> bool {
        !self.is_periodic(side)
    }

    fn gap_to_side(&self, side: usize, point: Point<2>, bound: f64) -> Option<f64> {
        Some(self.side_gap(side, point)).filter(|gap| *gap < bound)
    }
}

impl GapQuery {
    /// Surfaces of a domain and bodies, which may overlap.
    ///
    /// # Errors
    /// Those of [`Outline::new`].
    pub fn new(domain: &Domain, bodies: &[PlacedShape]) -> Result<Self, MeshError> {
        let outlines = bodies.iter().map(Outline::new).collect::<Result<_, _>>()?;
        Ok(Self::of(domain.clone(), outlines, domain.images_of(bodies)))
    }

    /// Puts a body, by its index, in another place (m, rad).
    pub fn place_body(&mut self, body: usize, center: Point<2>, angle: f64) {
        if let Some(moved) = self.body(body).map(|outline| outline.placed_at(center, angle)) {
            self.set_body(body, moved);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BoundaryKind, Facing, FacingSurfaces, Shape};

    fn disc(name: &str, x: f64) -> PlacedShape {
        let shape = Shape::Disc { radius: 1.0 };
        let center = Point::<2>::new(x, 0.0);
        PlacedShape { name: name.into(), shape, center, angle: 0.0, size: None }
    }

    #[test]
    fn the_nearest_of_bodies_images_and_sides_faces_a_point() {
        let domain = |periodic_x| Domain::Box {
            min: Point::<2>::new(-4.0, -3.0),
            max: Point::<2>::new(4.0, 3.0),
            periodic_x,
            periodic_y: false,
        };
        let bodies = [disc("a", -1.5), disc("b", 2.5)];
        let right = Point::<2>::new(3.5, 0.0);
        let of_b = BoundaryKind::Body(1);
        let mut walled = GapQuery::new(&domain(false), &bodies).unwrap();
        assert_eq!(walled.facing(5, of_b, right, 9.0), Some(Facing { boundary: 1, gap: 0.5 }));
        assert_eq!(walled.facing(5, of_b, right, 0.4), None);
        // The image of a at 6.5 is 2 away, the walls at y = 3 and -3 are 3 away
        let periodic = GapQuery::new(&domain(true), &bodies).unwrap();
        assert_eq!(periodic.facing(5, of_b, right, 9.0), Some(Facing { boundary: 4, gap: 2.0 }));
        assert_eq!(periodic.facing(1, BoundaryKind::Side, right, 9.0), None);
        let below = Point::<2>::new(-1.5, -3.0);
        assert_eq!(
            walled.facing(2, BoundaryKind::Side, below, 9.0),
            Some(Facing { boundary: 4, gap: 2.0 })
        );
        walled.place_body(0, Point::<2>::new(-1.5, -1.75), 0.0);
        assert_eq!(
            walled.facing(2, BoundaryKind::Side, below, 9.0),
            Some(Facing { boundary: 4, gap: 0.25 })
        );
    }
}
