//! How many cells a size field asks for, before any of them is made.

use super::SizeField;
use crate::count::{Cube, sum_over};
use crate::planar::boundary::BoundaryLoops;
use crate::planar::placement::{place, place_wrapped};
use crate::surface::SurfaceTree;
use crate::{Domain, MeshError, Outline, PlacedShape, Point, Sizing};

/// Cells over area / size^2: those of equilateral triangles, 4 / sqrt(3).
const CELLS: f64 = 2.309_401_076_758_503;

/// Halvings of the domain after which a square is taken as it is.
const DEEPEST: u32 = 60;

/// About how many cells [`generate`](crate::generate) would make; infinite where there would be more
/// than `limit`.
///
/// The integral of 4 / (sqrt(3) h^2) over the fluid, by squares in which h varies by a factor 2 at
/// most. Bodies may lie across periodic sides.
///
/// # Errors
/// What [`check_placement`](crate::check_placement) and [`Sizing::check`] refuse.
pub fn estimate_cells(
    domain: &Domain,
    bodies: &[PlacedShape],
    sizing: &Sizing,
    limit: f64,
) -> Result<f64, MeshError> {
    sizing.check(domain.sides())?;
    let border = match place(domain, bodies) {
        Ok(outlines) => BoundaryLoops::new(domain, bodies, outlines),
        Err(_) if domain.images().len() > 1 => {
            BoundaryLoops::on_torus(domain, bodies, place_wrapped(domain, bodies)?)
        }
        Err(error) => return Err(error),
    };
    match SizeField::from_border(domain, bodies, sizing, &border) {
        Ok(sizes) => {
            let outlines = &border.outlines[..bodies.len()];
            let images = &border.images;
            let tree = SurfaceTree::new(outlines);
            Ok(Count { domain, sizes: &sizes, outlines, images, tree, limit }.total())
        }
        Err(MeshError::TooManyCells { .. }) => Ok(f64::INFINITY),
        Err(error) => Err(error),
    }
}

/// The integral over the fluid.
struct Count<'a> {
    domain: &'a Domain,
    sizes: &'a SizeField,
    outlines: &'a [Outline],
    images: &'a [Point<2>],
    tree: SurfaceTree<2>,
    limit: f64,
}

impl Count<'_> {
    fn total(&self) -> f64 {
        let [min, max] = self.domain.corners();
        let size = max - min;
        let side = size.x.min(size.y);
        // Squares side by side along the longer side, the last one reaching beyond it
        let n = (size / side).map(|ratio| ratio.ceil().min(1e6));
        let side = (size.x / n.x).max(size.y / n.y);
        let mut next = (0.0, 0.0);
        let squares = std::iter::from_fn(|| {
            let (column, row) = next;
            let corner = min + Point::<2>::new(column, row) * side;
            let center = corner + Point::<2>::repeat(0.5 * side);
            next = if column + 1.0 >= n.x { (0.0, row + 1.0) } else { (column + 1.0, row) };
            (row < n.y).then_some(Cube { center, half: 0.5 * side, depth: 0 })
        });
        sum_over(squares, self.limit, |square| self.cells_of(square))
    }

    /// Cells in a square; `None` where it has to be halved.
    fn cells_of(&self, square: &Cube<2>) -> Option<f64> {
        let Cube { center, half, depth } = *square;
        let reach = std::f64::consts::SQRT_2 * half;
        let below = if self.domain.is_axisymmetric() { center.y } else { f64::INFINITY };
        let inside = self.domain.clearance(center).min(below);
        if inside < -reach {
            return Some(0.0);
        }
        let near = self.tree.nearest(self.outlines, self.images, center, None, reach);
        let outside = near.map_or(f64::INFINITY, |near| near.gap);
        if outside < -reach {
            return Some(0.0);
        }
        let h = self.sizes.at(center);
        // At a boundary a square of a few cells is small enough
        let is_cut = inside.min(outside) < reach && half > 2.0 * h;
        if depth < DEEPEST && (2.0 * half * self.sizes.growth() > h || is_cut) {
            return None;
        }
        let is_fluid = inside > 0.0 && outside > 0.0;
        Some(if is_fluid { CELLS * 4.0 * half * half / (h * h) } else { 0.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Shape, generate};

    fn disc(name: &str, x: f64, y: f64) -> PlacedShape {
        PlacedShape {
            name: name.into(),
            shape: Shape::Disc { radius: 1.0 },
            center: Point::<2>::new(x, y),
            angle: 0.0,
            size: None,
        }
    }

    fn square(periodic_x: bool) -> Domain {
        let (min, max) = (Point::<2>::new(-5.0, -4.0), Point::<2>::new(7.0, 4.0));
        Domain::Box { min, max, periodic_x, periodic_y: false }
    }

    #[test]
    fn the_estimate_is_near_the_number_of_cells() {
        let ball = PlacedShape { shape: Shape::Sphere { radius: 1.0 }, ..disc("s", 0.0, 0.0) };
        for (domain, bodies, sizing) in [
            (square(false), vec![disc("a", 0.0, 0.0)], Sizing::graded(0.1, 0.2, 1.0)),
            (square(false), vec![disc("a", 0.0, 0.0)], Sizing::graded(0.05, 0.0, 0.2)),
            (
                square(false),
                vec![disc("a", -1.05, 0.0), disc("b", 1.05, 0.0)],
                Sizing::graded(0.2, 0.2, 1.0),
            ),
            (
                Domain::HalfDisc { center: 0.0, radius: 50.0 },
                vec![ball],
                Sizing::graded(0.1, 0.2, 9.0),
            ),
        ] {
            let mesh = generate(&domain, &bodies, &sizing).unwrap();
            let estimate = estimate_cells(&domain, &bodies, &sizing, 1e9).unwrap();
            let ratio = estimate / mesh.n_cells() as f64;
            assert!((0.75..1.35).contains(&ratio), "{ratio}: {estimate} for {}", mesh.n_cells());
        }
    }

    #[test]
    fn more_cells_than_the_limit_are_not_counted() {
        let bodies = [disc("a", 0.0, 0.0)];
        let count = |sizing: &Sizing| estimate_cells(&square(false), &bodies, sizing, 1e5).unwrap();
        assert_eq!(count(&Sizing::graded(1e-3, 0.0, 1e-3)), f64::INFINITY);
        assert_eq!(count(&Sizing::graded(1e-12, 0.2, 1.0)), f64::INFINITY);
    }

    #[test]
    fn bodies_across_periodic_sides_are_counted() {
        let sizing = Sizing::graded(0.1, 0.2, 1.0);
        let across = estimate_cells(&square(true), &[disc("a", 6.9, 0.0)], &sizing, 1e9).unwrap();
        let inside = estimate_cells(&square(true), &[disc("a", 0.0, 0.0)], &sizing, 1e9).unwrap();
        assert!((0.95..1.05).contains(&(across / inside)), "{across} {inside}");
    }
}
