//! Where bodies are in a planar or axisymmetric domain.

use alewife_mesh::{Domain, MeshError, Outline, PlacedShape, Point, check_wrapped_placement};

use super::arrangement::{Arrangement, Misplaced, ROUNDING};
use crate::Model;
use crate::model::balls::{Ball, BallGrid};

/// The bodies of a model in their places in a domain.
pub fn placed_bodies(model: &Model, domain: &Domain) -> Vec<PlacedShape> {
    let scale = model.case.mesh.scale;
    let mut bodies: Vec<PlacedShape> = model.bodies.iter().map(|body| body.placed(scale)).collect();
    // What hangs on another body may reach beyond a periodic side
    for (index, placed) in bodies.iter_mut().enumerate() {
        if model.joint_above(index).is_some() {
            let center = placed.center;
            let images = domain.images().into_iter().map(|shift| center + shift);
            let inside = |point: &Point<2>| domain.clearance(*point);
            placed.center = images.max_by(|a, b| inside(a).total_cmp(&inside(b))).unwrap_or(center);
        }
    }
    bodies
}

/// Bodies in a domain, found by the circles around them.
pub struct Layout<'a> {
    domain: &'a Domain,
    /// Lower left and upper right corner (m).
    extent: [[f64; 2]; 2],
    images: Vec<Point<2>>,
    bodies: &'a [PlacedShape],
    /// `None` of a shape that has none.
    outlines: Vec<Option<Outline>>,
    grid: BallGrid<2>,
}

impl<'a> Layout<'a> {
    /// Bodies in a domain with the corners `extent` (m).
    pub fn new(domain: &'a Domain, bodies: &'a [PlacedShape], extent: [[f64; 2]; 2]) -> Self {
        let outlines: Vec<Option<Outline>> =
            bodies.iter().map(|body| Outline::new(body).ok()).collect();
        let mut grid = BallGrid::new(extent[0].into(), extent[1].into(), bodies.len());
        for (body, outline) in outlines.iter().enumerate() {
            if let Some(outline) = outline {
                grid.insert(body, &circle(outline));
            }
        }
        Self { domain, extent, images: domain.images(), bodies, outlines, grid }
    }

    /// Bodies with circles around them that may meet that of a body or of an image of it, itself
    /// among them, in ascending order.
    fn near(&self, body: usize) -> Vec<usize> {
        self.outlines[body].as_ref().map_or(Vec::new(), |outline| self.meeting(&circle(outline)))
    }

    /// Bodies with circles around them that may meet a disc or an image of it, in ascending order.
    fn meeting(&self, disc: &Ball<2>) -> Vec<usize> {
        let mut found = Vec::new();
        for shift in &self.images {
            let image = Ball { center: disc.center + shift, radius: disc.radius };
            let does_meet = |body: &usize| {
                let other = self.outlines[*body].as_ref().map(circle);
                other.is_some_and(|other| {
                    (image.center - other.center).norm() <= image.radius + other.radius
                })
            };
            found.extend(self.grid.near(&image).filter(does_meet));
        }
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Bodies that a point lies in, by more than rounding.
    fn bodies_around(&self, point: Point<2>) -> Vec<usize> {
        let is_inside = |body: &usize| {
            self.outlines[*body].as_ref().is_some_and(|outline| {
                let gaps = self.images.iter().map(|shift| outline.nearest(point + shift).gap);
                gaps.fold(f64::INFINITY, f64::min) < -ROUNDING * outline.reach()
            })
        };
        let near = self.meeting(&Ball { center: point, radius: 0.0 });
        near.into_iter().filter(is_inside).collect()
    }
}

impl Arrangement for Layout<'_> {
    fn misplaced(&self) -> Vec<Misplaced> {
        let mut misplaced = Vec::new();
        let mut is_inside = vec![false; self.bodies.len()];
        for (index, body) in self.bodies.iter().enumerate() {
            let mut refuse = |error| misplaced.push(Misplaced { body: index, error });
            if let Err(error) = check_wrapped_placement(self.domain, std::slice::from_ref(body)) {
                refuse(error);
                continue;
            }
            // Across a periodic side a body may lie, beyond it it may not
            let gap = self.domain.clearance(body.center);
            if gap < 0.0 {
                let (x, y) = (body.center.x, body.center.y);
                refuse(MeshError::Outside { body: body.name.clone(), gap, x, y });
                continue;
            }
            for other in self.near(index).into_iter().filter(|other| is_inside[*other]) {
                let pair = [self.bodies[other].clone(), body.clone()];
                if let Err(error) = check_wrapped_placement(self.domain, &pair) {
                    refuse(error);
                }
            }
            is_inside[index] = true;
        }
        misplaced
    }

    fn is_outside(&self, point: &[f64]) -> bool {
        let point = in_plane(point);
        let [min, max] = self.extent;
        let size = (max[0] - min[0]).hypot(max[1] - min[1]);
        let below_axis = if self.domain.is_axisymmetric() { -point.y } else { 0.0 };
        self.domain.clearance(point) < -ROUNDING * size || below_axis > ROUNDING * size
    }

    fn around(&self, point: &[f64]) -> Vec<&str> {
        let around = self.bodies_around(in_plane(point)).into_iter();
        around.map(|body| self.bodies[body].name.as_str()).collect()
    }
}

/// The point with these coordinates (m).
fn in_plane(point: &[f64]) -> Point<2> {
    Point::<2>::from_fn(|axis, _| point.get(axis).copied().unwrap_or(f64::NAN))
}

/// The circle around an outline, with room for the smallest gap there may be.
fn circle(outline: &Outline) -> Ball<2> {
    Ball { center: outline.center(), radius: (1.0 + ROUNDING) * outline.reach() }
}

#[cfg(test)]
mod tests {
    use alewife_mesh::Shape;

    use super::*;

    /// Numbers in [0, 1) without a pattern, by the golden ratio.
    fn scattered(nth: usize) -> f64 {
        (nth as f64 * 0.618_033_988_749).fract()
    }

    /// Discs and ellipses, some of which overlap each other, cross a side or are outside.
    fn scattered_bodies() -> Vec<PlacedShape> {
        let shape = |nth: usize| match nth % 3 {
            0 => Shape::Ellipse { semi_axes: [0.3, 0.04] },
            _ => Shape::Disc { radius: if nth % 20 == 1 { 0.5 } else { 0.06 } },
        };
        let body = |nth: usize| PlacedShape {
            name: format!("body-{nth}"),
            shape: shape(nth),
            center: Point::<2>::new(4.1 * scattered(nth) - 0.05, 3.1 * scattered(7 * nth) - 0.05),
            angle: nth as f64,
            size: None,
        };
        (0..90).map(body).collect()
    }

    /// The same with every pair of bodies looked at.
    fn misplaced_by_all_pairs(domain: &Domain, bodies: &[PlacedShape]) -> Vec<Misplaced> {
        let mut misplaced = Vec::new();
        let mut inside: Vec<usize> = Vec::new();
        for (index, body) in bodies.iter().enumerate() {
            let alone = check_wrapped_placement(domain, std::slice::from_ref(body)).err();
            let gap = domain.clearance(body.center);
            let (name, [x, y]) = (body.name.clone(), [body.center.x, body.center.y]);
            let beyond = (gap < 0.0).then_some(MeshError::Outside { body: name, gap, x, y });
            if let Some(error) = alone.or(beyond) {
                misplaced.push(Misplaced { body: index, error });
                continue;
            }
            for other in &inside {
                let pair = [bodies[*other].clone(), body.clone()];
                let error = check_wrapped_placement(domain, &pair).err();
                misplaced.extend(error.map(|error| Misplaced { body: index, error }));
            }
            inside.push(index);
        }
        misplaced
    }

    #[test]
    fn overlaps_are_those_found_among_all_pairs_of_bodies() {
        let (min, max) = (Point::<2>::zeros(), Point::<2>::new(4.0, 3.0));
        let bodies = scattered_bodies();
        for [periodic_x, periodic_y] in [[false, false], [true, false], [true, true]] {
            let domain = Domain::Box { min, max, periodic_x, periodic_y };
            let layout = Layout::new(&domain, &bodies, [min.into(), max.into()]);
            let found = layout.misplaced();
            let overlaps =
                found.iter().filter(|one| matches!(one.error, MeshError::Overlap { .. }));
            let n_overlaps = overlaps.count();
            assert!(n_overlaps > 10 && found.len() > n_overlaps, "{n_overlaps} of {}", found.len());
            assert_eq!(found, misplaced_by_all_pairs(&domain, &bodies));
        }
    }

    #[test]
    fn the_bodies_around_a_point_are_found_across_periodic_sides() {
        let (min, max) = (Point::<2>::zeros(), Point::<2>::new(4.0, 3.0));
        let bodies = scattered_bodies();
        let domain = Domain::Box { min, max, periodic_x: true, periodic_y: true };
        let layout = Layout::new(&domain, &bodies, [min.into(), max.into()]);
        let mut n_found = 0;
        for nth in 0..200 {
            let point = Point::<2>::new(4.0 * scattered(3 * nth), 3.0 * scattered(5 * nth + 1));
            let is_around = |body: &usize| {
                let outline = Outline::new(&bodies[*body]).unwrap();
                let mut images = domain.images().into_iter();
                images.any(|shift| outline.nearest(point + shift).gap < -1e-5)
            };
            let around = layout.bodies_around(point);
            n_found += around.len();
            assert_eq!(around, (0..bodies.len()).filter(is_around).collect::<Vec<_>>());
        }
        assert!(n_found > 50, "{n_found}");
    }
}
