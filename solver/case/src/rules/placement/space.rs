//! Where bodies are in a domain in space.

use alewife_mesh::spatial::{BodySurface, Domain, check_placement};
use alewife_mesh::{Point, Surface};

use super::arrangement::{Arrangement, Misplaced, ROUNDING};
use crate::Model;

/// Bodies in a domain, found by the balls around them.
pub struct Solids {
    domain: Domain,
    bodies: Vec<Solid>,
    /// Whether they are where a given mesh leaves them out.
    are_holes: bool,
}

/// A body, and its surface where its lengths make one.
struct Solid {
    body: alewife_mesh::spatial::Body,
    surface: Option<BodySurface>,
}

impl Solids {
    /// Those of a model, in a domain.
    pub fn new(domain: Domain, model: &Model) -> Self {
        let solids = model.bodies.iter().filter_map(|body| body.solid(model.case.mesh.scale));
        let bodies =
            solids.map(|body| Solid { surface: BodySurface::new(&body).ok(), body }).collect();
        Self { domain, bodies, are_holes: model.case.bodies_are_holes() }
    }

    /// Whether the balls around two bodies, or images of them, may meet.
    fn are_near(&self, one: usize, other: usize) -> bool {
        let (Some(one), Some(other)) = (&self.bodies[one].surface, &self.bodies[other].surface)
        else {
            return false;
        };
        let [min, max] = self.domain.corners();
        let mut apart = one.center() - other.center();
        for axis in 0..3 {
            let sides = 0..self.domain.sides().len();
            if sides.skip(2 * axis).take(1).any(|side| self.domain.is_periodic(side)) {
                let period = max[axis] - min[axis];
                apart[axis] -= period * (apart[axis] / period).round();
            }
        }
        apart.norm() <= (one.reach() + other.reach()) * (1.0 + ROUNDING)
    }
}

impl Arrangement for Solids {
    fn misplaced(&self) -> Vec<Misplaced> {
        let mut misplaced = Vec::new();
        let mut inside: Vec<usize> = Vec::new();
        if self.are_holes {
            return misplaced;
        }
        for (index, Solid { body, .. }) in self.bodies.iter().enumerate() {
            let mut refuse = |error| misplaced.push(Misplaced { body: index, error });
            if let Err(error) = check_placement(&self.domain, std::slice::from_ref(body)) {
                refuse(error);
                continue;
            }
            for &other in inside.iter().filter(|other| self.are_near(index, **other)) {
                let pair = [self.bodies[other].body.clone(), body.clone()];
                if let Err(error) = check_placement(&self.domain, &pair) {
                    refuse(error);
                }
            }
            inside.push(index);
        }
        misplaced
    }

    fn is_outside(&self, point: &[f64]) -> bool {
        let point = in_space(point);
        let [min, max] = self.domain.corners();
        let sides = 0..self.domain.sides().len();
        let gaps = sides.map(|side| self.domain.side_gap(side, point));
        gaps.fold(f64::INFINITY, f64::min) < -ROUNDING * (max - min).norm()
    }

    fn around(&self, point: &[f64]) -> Vec<&str> {
        let point = in_space(point);
        let [min, max] = self.domain.corners();
        // Some bodies are without ends
        let is_inside = |surface: &BodySurface| {
            let reach = surface.reach().min((max - min).norm());
            let images = self.domain.images().into_iter();
            let gaps = images.map(|shift| surface.nearest_point(point - shift).gap);
            gaps.fold(f64::INFINITY, f64::min) < -ROUNDING * reach
        };
        let around =
            self.bodies.iter().filter(|solid| solid.surface.as_ref().is_some_and(is_inside));
        around.map(|solid| solid.body.name.as_str()).collect()
    }
}

/// The point with these coordinates (m).
fn in_space(point: &[f64]) -> Point<3> {
    Point::<3>::from_fn(|axis, _| point.get(axis).copied().unwrap_or(f64::NAN))
}
