//! `GapQuery`: how far it is from a surface to the surfaces around it.

use std::sync::OnceLock;

use crate::surface::{Facing, FacingSurfaces, SurfaceTree};
use crate::{BoundaryKind, Domain, MeshError, Outline, PlacedShape, Point};

/// The exact surfaces of a domain and its bodies in one configuration.
#[derive(Debug, Clone)]
pub struct GapQuery {
    domain: Domain,
    outlines: Vec<Outline>,
    images: Vec<Point<2>>,
    /// Where the bodies are, found out when first asked for.
    tree: OnceLock<SurfaceTree<2>>,
}

impl GapQuery {
    /// Surfaces of a domain and bodies, which may overlap.
    ///
    /// # Errors
    /// Those of [`Outline::new`].
    pub fn new(domain: &Domain, bodies: &[PlacedShape]) -> Result<Self, MeshError> {
        let outlines = bodies.iter().map(Outline::new).collect::<Result<_, _>>()?;
        let (domain, images) = (domain.clone(), domain.images_of(bodies));
        Ok(Self { domain, outlines, images, tree: OnceLock::new() })
    }

    /// Puts a body, by its index, in another place (m, rad).
    pub fn place_body(&mut self, body: usize, center: Point<2>, angle: f64) {
        if let Some(outline) = self.outlines.get_mut(body) {
            *outline = outline.placed_at(center, angle);
        }
        self.tree.take();
    }

    /// Gives a body, by its index, another outline.
    pub fn set_body(&mut self, body: usize, outline: Outline) {
        if let Some(known) = self.outlines.get_mut(body) {
            *known = outline;
        }
        self.tree.take();
    }
}

impl FacingSurfaces<2> for GapQuery {
    /// Bodies face the sides of the domain, each other and all their periodic images; sides face
    /// bodies. Periodic sides and the axis are no surfaces.
    fn facing(
        &self,
        boundary: usize,
        kind: BoundaryKind,
        point: Point<2>,
        reach: f64,
    ) -> Option<Facing> {
        let n_sides = self.domain.sides().len();
        let but = match kind {
            BoundaryKind::Body(body) => Some(body),
            BoundaryKind::Side if !self.domain.is_periodic(boundary) => None,
            BoundaryKind::Side | BoundaryKind::Axis => return None,
        };
        let tree = self.tree.get_or_init(|| SurfaceTree::new(&self.outlines));
        let body = tree
            .nearest(&self.outlines, &self.images, point, but, reach)
            .map(|near| Facing { boundary: n_sides + near.surface, gap: near.gap });
        let sides = (0..n_sides)
            .filter(|&side| but.is_some() && !self.domain.is_periodic(side))
            .map(|side| Facing { boundary: side, gap: self.domain.side_gap(side, point) })
            .filter(|facing| facing.gap < reach);
        body.into_iter().chain(sides).min_by(|a, b| a.gap.total_cmp(&b.gap))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Shape;

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
