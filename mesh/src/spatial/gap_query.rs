//! `GapQuery`: the surroundings of bodies in space.

use super::body_surface::BodySurface;
use super::domain::Domain;
use super::shape::Body;
use crate::surface::{Sides, Surroundings};
use crate::{MeshError, Point};

/// Sides of a domain and surfaces of bodies. Periodic sides and planes of symmetry are no surfaces.
pub type GapQuery = Surroundings<3, Domain, BodySurface>;

impl Sides<3> for Domain {
    fn n_sides(&self) -> usize {
        self.sides().len()
    }

    fn is_faced(&self, side: usize) -> bool {
        !self.is_periodic(side) && !self.is_symmetric(side)
    }

    fn gap_to_side(&self, side: usize, point: Point<3>, bound: f64) -> Option<f64> {
        if let Self::Imported(imported) = self {
            return imported.side(side).gap_within(point, bound);
        }
        Some(self.side_gap(side, point)).filter(|gap| *gap < bound)
    }
}

impl GapQuery {
    /// Surfaces of a domain and bodies, which may overlap.
    ///
    /// # Errors
    /// Those of [`BodySurface::new`].
    pub fn new(domain: &Domain, bodies: &[Body]) -> Result<Self, MeshError> {
        let surfaces = bodies.iter().map(BodySurface::new).collect::<Result<_, _>>()?;
        Ok(Self::of(domain.clone(), surfaces, domain.images()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spatial::Shape;
    use crate::{BoundaryKind, Facing, FacingSurfaces};
    use nalgebra::Isometry3;

    #[test]
    fn the_nearest_of_bodies_images_and_walls_faces_a_point() {
        let domain = Domain::Box {
            min: Point::<3>::repeat(-4.0),
            max: Point::<3>::repeat(4.0),
            periodic: [true, false, false],
            symmetric: [false, false, false, true, false, false],
        };
        let ball = |name: &str, x: f64| {
            Body::new(name, Shape::Sphere { radius: 1.0 }, Isometry3::translation(x, 0.0, 0.0))
        };
        let mut around = GapQuery::new(&domain, &[ball("a", -1.5), ball("b", 2.5)]).unwrap();
        let facing = |around: &GapQuery, x: f64, y: f64, z: f64| {
            around.facing(7, BoundaryKind::Body(1), Point::<3>::new(x, y, z), 9.0)
        };
        // The image of a at 6.5; the walls are farther off
        assert_eq!(facing(&around, 3.5, 0.0, 0.0), Some(Facing { boundary: 6, gap: 2.0 }));
        // The plane of symmetry at y = 4 does not count
        assert_eq!(facing(&around, 2.5, 3.5, 0.5), Some(Facing { boundary: 5, gap: 3.5 }));
        assert_eq!(
            around.facing(2, BoundaryKind::Side, Point::<3>::new(2.5, -4.0, 0.0), 9.0),
            Some(Facing { boundary: 7, gap: 3.0 })
        );
        let to = Isometry3::translation(-1.5, 0.0, 2.5);
        let moved = around.body(0).unwrap().placed_at(&to);
        around.set_body(0, moved);
        assert_eq!(
            around.facing(5, BoundaryKind::Side, Point::<3>::new(-1.5, 0.0, 4.0), 9.0),
            Some(Facing { boundary: 6, gap: 0.5 })
        );
    }
}
