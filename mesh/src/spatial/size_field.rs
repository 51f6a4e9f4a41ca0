//! `SizeField`: the edge length wanted at a point, from surfaces, gaps and boxes.

use super::domain::Domain;
use super::geometry::{Geometry, Group};
use super::placement::check_placement;
use super::shape::Body;
use super::surface::SizedGap;
use crate::{Bounds, MeshError, Point, SizeBox, Sizing};

/// Fewest edges of the largest size in a period.
const PERIOD: f64 = 4.0;

/// The edge length wanted anywhere, inside bodies and outside the domain, too.
///
/// h(x) = min(size, surface sizes + growth · distance, box sizes + growth · distance,
/// (d + d') / layers), where d and d' are the distances to the two nearest of the bodies and the
/// walls: across a gap d + d' is its width. In a periodic box bodies and boxes of sizes repeat, and
/// a period has four edges at least.
#[derive(Debug, Clone)]
pub struct SizeField {
    geometry: Geometry,
    size: f64,
    growth: f64,
    layers: f64,
    boxes: Vec<SizeBox<3>>,
    /// By what bodies and boxes repeat (m), zero first.
    shifts: Vec<Point<3>>,
}

/// What one group of surfaces asks for at a point.
struct Wish {
    /// Distance to its nearest surface (m).
    distance: f64,
    /// Edge length (m).
    size: f64,
}

impl SizeField {
    /// The sizes in a domain around bodies.
    ///
    /// # Errors
    /// What [`check_placement`](super::check_placement) and [`Sizing::check`] refuse.
    pub fn new(domain: &Domain, bodies: &[Body], sizing: &Sizing<3>) -> Result<Self, MeshError> {
        sizing.check(&domain.sides())?;
        check_placement(domain, bodies)?;
        Ok(Self::of(Geometry::new(domain, bodies, sizing)?, sizing))
    }

    /// The sizes around surfaces.
    pub(super) fn of(geometry: Geometry, sizing: &Sizing<3>) -> Self {
        Self {
            shifts: geometry.periods.shifts(),
            size: sizing.size.min(geometry.periods.shortest() / PERIOD),
            geometry,
            growth: sizing.growth,
            layers: sizing.gap_layers,
            boxes: sizing.boxes.clone(),
        }
    }

    /// The surfaces that bound the fluid.
    pub(super) fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// The largest edge length wanted anywhere (m).
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.size
    }

    /// The edge length wanted at a point (m).
    #[must_use]
    pub fn at(&self, point: Point<3>) -> f64 {
        let [min, max] = self.geometry.corners;
        let point = self.geometry.periods.beside(point, (min + max) * 0.5);
        let mut size = self.size;
        for (one, shift) in
            self.boxes.iter().flat_map(|one| self.shifts.iter().map(move |s| (one, s)))
        {
            let bounds = Bounds { min: one.min + shift, max: one.max + shift };
            size = size.min(one.size + self.growth * bounds.squared_distance(&point).sqrt());
        }
        // The domain comes first, then bodies as far as they can matter
        let mut to_walls = f64::INFINITY;
        let (domain, bodies) = self.geometry.groups.split_at(1);
        let (mut nearest, mut second) = (f64::INFINITY, f64::INFINITY);
        for group in domain {
            let wish = self.wish(group, point);
            size = size.min(wish.size);
            to_walls = wish.distance;
        }
        let least = self.growth.min(1.0 / self.layers);
        let images = bodies.iter().flat_map(|body| {
            let beside = self.geometry.periods.beside(point, body.center);
            let is_near = self.least_distance(body, beside) * least < self.size;
            let shifts = if is_near { &self.shifts[..] } else { &[] };
            shifts.iter().map(move |shift| (body, beside - shift))
        });
        for (group, seen) in images {
            if self.least_distance(group, seen) * least >= size
                || !self.may_be_within(group, seen, size / least)
            {
                continue;
            }
            let wish = self.wish(group, seen);
            size = size.min(wish.size);
            size = size.min(self.size_before_sides(group, wish.distance, point));
            let facing = if group.cut_by.is_empty() {
                to_walls
            } else {
                self.distance_to_walls(&group.cut_by, point)
            };
            size = size.min((wish.distance + facing) / self.layers);
            if wish.distance < nearest {
                (nearest, second) = (wish.distance, nearest);
            } else if wish.distance < second {
                second = wish.distance;
            }
        }
        size.min((nearest + second) / self.layers)
    }

    /// A lower bound of the distance of a point to a group (m).
    fn least_distance(&self, group: &Group, point: Point<3>) -> f64 {
        ((point - group.center).norm() - group.reach).max(0.0)
    }

    /// Whether a group may be nearer to a point (m) than some distance (m).
    fn may_be_within(&self, group: &Group, point: Point<3>, distance: f64) -> bool {
        let mut surfaces = self.geometry.surfaces[group.first..group.last].iter();
        surfaces.any(|surface| surface.may_be_within(point, distance))
    }

    /// Distance to the nearest wall but for some sides (m).
    fn distance_to_walls(&self, but: &[usize], point: Point<3>) -> f64 {
        let sides = self.geometry.surfaces[..self.geometry.groups[0].last].iter().enumerate();
        let walls = sides.filter(|(side, plane)| plane.is_solid() && !but.contains(side));
        walls.map(|(_, plane)| plane.gap(point).abs()).fold(f64::INFINITY, f64::min)
    }

    /// The edge length wanted between a body at a distance (m) and sides that are no walls.
    fn size_before_sides(&self, body: &Group, distance: f64, point: Point<3>) -> f64 {
        let sides = &self.geometry.surfaces[..self.geometry.groups[0].last];
        let mut size = f64::INFINITY;
        for (side, plane) in sides.iter().enumerate().filter(|(_, side)| !side.is_solid()) {
            let gap = distance + plane.gap(point).abs();
            if !plane.is_periodic && !body.cut_by.contains(&side) {
                // A body faces its image behind a plane of symmetry that does not cut it
                size = size.min(2.0 * gap / self.layers);
            }
        }
        size
    }

    fn wish(&self, group: &Group, point: Point<3>) -> Wish {
        let mut wish = Wish { distance: f64::INFINITY, size: f64::INFINITY };
        for surface in &self.geometry.surfaces[group.first..group.last] {
            let SizedGap { gap, size } = surface.sized_gap(point);
            if surface.is_solid() {
                wish.distance = wish.distance.min(gap.abs());
            }
            wish.size = wish.size.min(size + self.growth * gap.abs());
            for bend in &surface.bends {
                wish.size = wish.size.min(bend.size + self.growth * (bend.at - point).norm());
            }
        }
        wish
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spatial::Shape;
    use nalgebra::Isometry3;

    fn sizes(gap: f64) -> SizeField {
        let domain = Domain::walls(Point::<3>::repeat(-5.0), Point::<3>::repeat(5.0));
        let sphere = |name: &str, x: f64| {
            Body::new(name, Shape::Sphere { radius: 1.0 }, Isometry3::translation(x, 0.0, 0.0))
        };
        let bodies = [sphere("a", -1.0 - 0.5 * gap), sphere("b", 1.0 + 0.5 * gap)];
        let wake = SizeBox {
            min: Point::<3>::new(2.5, -1.0, -1.0),
            max: Point::<3>::repeat(3.0),
            size: 0.1,
        };
        let sizing = Sizing { gap_layers: 2.0, boxes: vec![wake], ..Sizing::graded(0.2, 0.3, 0.8) };
        SizeField::new(&domain, &bodies, &sizing).unwrap()
    }

    #[test]
    fn a_gap_gets_its_layers_and_a_box_its_size() {
        let sizes = sizes(0.05);
        for x in [-0.025, 0.0, 0.02] {
            assert!((sizes.at(Point::<3>::new(x, 0.0, 0.0)) - 0.025).abs() < 1e-14);
        }
        assert_eq!(sizes.at(Point::<3>::new(2.7, 0.0, 0.0)), 0.1);
        assert!((sizes.at(Point::<3>::new(-2.025, 0.0, 0.0)) - 0.2).abs() < 1e-14);
        assert!((sizes.at(Point::<3>::new(-3.025, 0.0, 0.0)) - 0.5).abs() < 1e-14);
        assert_eq!(sizes.at(Point::<3>::new(-4.0, 4.0, 4.0)), 0.8);
    }

    /// Bodies that are left out because they are far change nothing.
    #[test]
    fn sizes_change_slowly() {
        let sizes = sizes(0.3);
        let part = |i: usize, k: f64| (0.618_034 * k * (i + 1) as f64).fract() - 0.5;
        let points: Vec<_> = (0..3000)
            .map(|i| Point::<3>::new(part(i, 1.0), part(i, 7.0), part(i, 31.0)) * 12.0)
            .collect();
        for x in points {
            let y = x + Point::<3>::new(0.003, -0.002, 0.001);
            // Two distances over two layers
            assert!((sizes.at(x) - sizes.at(y)).abs() <= (x - y).norm() + 1e-12);
        }
    }
}
