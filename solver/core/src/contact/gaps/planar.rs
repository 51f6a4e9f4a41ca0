//! `PlanarGaps`: outlines of all bodies and walls, in the plane or on the axis.

use std::sync::Arc;

use alewife_mesh::{
    Closest, Domain, Outline, PlacedShape, Point, Wall, closest, closest_features, closest_to_wall,
    on_meridian, thickness, wall_features,
};
use nalgebra::Rotation2;

use super::surface::{ContactSurface, FacingPoints};
use super::surface_gaps::{BodySolid, SurfaceGaps, WallSide};
use super::{Curvatures, Gaps, Sections};
use crate::body::{Modes, Pose, in_space, on_mesh};
use crate::contact::ContactError;

/// Outlines and walls that may come into contact; the exact curves.
pub type PlanarGaps = SurfaceGaps<2, PlanarSurface>;

/// The outline of a body.
#[derive(Debug, Clone)]
pub struct PlanarSurface {
    outline: Outline,
    /// Whether it is a meridian: only points on the axis face each other there.
    is_meridian: bool,
}

impl PlanarGaps {
    /// Outlines of bodies and the sides of a domain that are walls; the poses of the shapes do not
    /// count.
    ///
    /// # Errors
    /// [`ContactError::Surface`] for a shape without outline, [`ContactError::NoWall`] for a side
    /// that is the axis or periodic.
    pub fn new(
        domain: &Domain,
        walls: &[usize],
        bodies: &[PlacedShape],
    ) -> Result<Self, ContactError> {
        let walls = walls.iter().map(|&side| {
            let name = domain.sides().get(side).copied();
            let wall = name.and_then(|_| domain.wall(side));
            name.zip(wall)
                .map(|(name, wall)| WallSide { side, name: name.to_owned(), wall })
                .ok_or(ContactError::NoWall { side })
        });
        let is_meridian = domain.is_axisymmetric();
        let bodies = bodies.iter().map(|body| {
            let surface = PlanarSurface { outline: Outline::new(body)?, is_meridian };
            let centroid = body.shape.moments().map_or(Point::<2>::zeros(), |m| m.centroid);
            Ok(BodySolid::new(body.name.clone(), surface, centroid))
        });
        let longest = |axis: usize| {
            let lengths = domain.images().into_iter().map(|image| image[axis]);
            Some(lengths.fold(0.0, f64::max)).filter(|length| *length > 0.0)
        };
        let modes = if is_meridian { Modes::AXISYMMETRIC } else { Modes::PLANAR };
        let bodies = bodies.collect::<Result<_, ContactError>>()?;
        Ok(Self::of(bodies, walls.collect::<Result<_, _>>()?, [longest(0), longest(1)], modes))
    }

    /// Gives a body another outline, its origin the centre of mass.
    pub fn deform_outline(&mut self, body: usize, outline: Outline) {
        let is_meridian = self.modes() == Modes::AXISYMMETRIC;
        self.deform(body, PlanarSurface { outline, is_meridian });
    }

    /// The same of a body with coordinates, whose points move with sections.
    pub fn bend_outline(&mut self, body: usize, outline: Outline, sections: Arc<dyn Sections>) {
        let is_meridian = self.modes() == Modes::AXISYMMETRIC;
        self.bend(body, PlanarSurface { outline, is_meridian }, sections);
    }
}

impl PlanarSurface {
    fn points(&self, features: Vec<Closest>) -> Vec<FacingPoints> {
        let features = if self.is_meridian { on_meridian(features) } else { features };
        let facing = |at: Closest| FacingPoints {
            first: in_space(&at.first),
            second: in_space(&at.second),
            normal: in_space(&at.normal),
            gap: at.gap,
            curvatures: Curvatures::Curves(at.curvatures),
        };
        features.into_iter().map(facing).collect()
    }
}

impl ContactSurface<2> for PlanarSurface {
    type Wall = Wall;

    fn center(&self) -> Point<2> {
        self.outline.center()
    }

    fn reach(&self) -> f64 {
        self.outline.reach()
    }

    fn is_round(&self) -> bool {
        self.outline.circle_radius().is_some()
    }

    fn thickness(&self) -> f64 {
        thickness(&self.outline)
    }

    fn placed(&self, pose: &Pose, centroid: &Point<2>, away: &Point<2>) -> Self {
        let angle = pose.angle();
        let offset = Rotation2::new(angle) * centroid;
        let center: Point<2> = on_mesh(&pose.center);
        Self { outline: self.outline.placed_at(center - offset + away, angle), ..*self }
    }

    fn facing(&self, other: &Self, range: f64) -> Vec<FacingPoints> {
        self.points(closest_features(&self.outline, &other.outline, range))
    }

    fn gap(&self, other: &Self) -> f64 {
        closest(&self.outline, &other.outline).gap
    }

    fn facing_wall(&self, wall: &Wall, range: f64) -> Vec<FacingPoints> {
        self.points(wall_features(&self.outline, wall, range))
    }

    fn gap_to_wall(&self, wall: &Wall) -> f64 {
        closest_to_wall(&self.outline, wall).gap
    }

    fn least_gap_to_wall(&self, wall: &Wall) -> f64 {
        wall.gap(self.outline.center()) - self.outline.reach()
    }

    fn least_gap(&self, other: &Self) -> f64 {
        self.outline.least_gap(other.outline.center()) - other.outline.reach()
    }
}
