//! `SpatialGaps`: surfaces of all bodies and walls in space.

use alewife_mesh::spatial::{Body, BodySurface, ClosestPoints, Domain, WallSurface};
use alewife_mesh::{Point, Surface};
use nalgebra::{Isometry3, Translation3};

use super::Curvatures;
use super::surface::{ContactSurface, FacingPoints};
use super::surface_gaps::{BodySolid, SurfaceGaps, WallSide};
use crate::body::{Modes, Pose};
use crate::contact::ContactError;

/// Bodies and walls that may come into contact; the exact surfaces.
pub type SpatialGaps = SurfaceGaps<3, SpatialSurface>;

/// The surface of a body in space.
#[derive(Debug, Clone)]
pub struct SpatialSurface(BodySurface);

impl SpatialGaps {
    /// Surfaces of bodies, whose poses do not count, and the sides of a domain that are walls, in a domain that
    /// may be periodic. `centroids` are the centres of mass in the frames of the bodies (m).
    ///
    /// # Errors
    /// [`ContactError::Surface`] for a body without surface.
    pub fn new(
        domain: &Domain,
        bodies: &[Body],
        centroids: &[Point<3>],
    ) -> Result<Self, ContactError> {
        let walls = domain.sides().into_iter().enumerate().filter_map(|(side, name)| {
            let wall = WallSurface::new(domain, side)?;
            Some(WallSide { side, name: name.to_owned(), wall })
        });
        let bodies = bodies.iter().zip(centroids).map(|(body, centroid)| {
            let surface = SpatialSurface(BodySurface::new(body)?);
            Ok(BodySolid::new(body.name.clone(), surface, *centroid))
        });
        let bodies = bodies.collect::<Result<_, ContactError>>()?;
        let periods = domain.periods();
        let periods =
            std::array::from_fn(|axis| Some(periods[axis]).filter(|length| *length > 0.0));
        Ok(Self::of(bodies, walls.collect(), periods, Modes::SPATIAL))
    }
}

impl SpatialGaps {
    /// Gives a body another surface, its origin the centre of mass.
    pub fn deform_surface(&mut self, body: usize, surface: BodySurface) {
        self.deform(body, SpatialSurface(surface));
    }
}

/// Where the frame of a body is whose centre of mass is at a place of it (m).
pub fn frame_of(pose: &Pose, centroid: &Point<3>) -> Isometry3<f64> {
    let rotation = pose.rotation();
    Isometry3::from_parts(Translation3::from(pose.center - rotation * centroid), rotation)
}

fn facing(points: Vec<ClosestPoints>) -> Vec<FacingPoints> {
    let facing = |at: ClosestPoints| FacingPoints {
        first: at.first,
        second: at.second,
        normal: at.normal,
        gap: at.gap,
        curvatures: Curvatures::Surfaces(at.curvatures),
    };
    points.into_iter().map(facing).collect()
}

/// The gap (m) of the nearest pair of points, infinite where none is found.
fn least(points: &[ClosestPoints]) -> f64 {
    points.first().map_or(f64::INFINITY, |nearest| nearest.gap)
}

impl ContactSurface<3> for SpatialSurface {
    type Wall = WallSurface;

    fn center(&self) -> Point<3> {
        self.0.center()
    }

    fn reach(&self) -> f64 {
        self.0.reach()
    }

    fn is_round(&self) -> bool {
        self.0.is_sphere()
    }

    fn thickness(&self) -> f64 {
        self.0.thickness()
    }

    fn placed(&self, pose: &Pose, centroid: &Point<3>, away: &Point<3>) -> Self {
        Self(self.0.placed_at(&frame_of(&pose.shifted(away), centroid)))
    }

    fn facing(&self, other: &Self, range: f64) -> Vec<FacingPoints> {
        facing(self.0.closest_points(&other.0, range))
    }

    fn gap(&self, other: &Self) -> f64 {
        least(&self.0.closest_points(&other.0, f64::INFINITY))
    }

    fn facing_wall(&self, wall: &WallSurface, range: f64) -> Vec<FacingPoints> {
        facing(self.0.closest_to_wall(wall, range))
    }

    fn gap_to_wall(&self, wall: &WallSurface) -> f64 {
        least(&self.0.closest_to_wall(wall, f64::INFINITY))
    }

    fn least_gap_to_wall(&self, wall: &WallSurface) -> f64 {
        wall.gap(self.0.center()) - self.0.reach()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Gaps, Partner};
    use alewife_mesh::spatial::Shape;
    use nalgebra::{UnitQuaternion, Vector3};

    fn gaps(periodic: bool) -> SpatialGaps {
        let domain = Domain::Box {
            min: Point::<3>::repeat(-5.0),
            max: Point::<3>::repeat(5.0),
            periodic: [periodic; 3],
            symmetric: [false; 6],
        };
        let ellipsoid = Shape::Ellipsoid { semi_axes: [1.0, 0.6, 0.4] };
        let bodies = [
            Body::new("egg", ellipsoid, Isometry3::identity()),
            Body::new("ball", Shape::Sphere { radius: 0.5 }, Isometry3::identity()),
        ];
        // The centre of mass of the first is not its centre
        let centroids = [Point::<3>::new(0.2, 0.0, 0.1), Point::<3>::zeros()];
        SpatialGaps::new(&domain, &bodies, &centroids).unwrap()
    }

    fn poses() -> [Pose; 2] {
        let turn = UnitQuaternion::from_euler_angles(0.5, 0.9, -0.4);
        [
            Pose::spatial(Vector3::new(0.1, 0.2, -0.3), turn),
            Pose::spatial(Vector3::new(1.3, 0.7, 0.3), UnitQuaternion::identity()),
        ]
    }

    #[test]
    fn gradients_of_gaps_and_their_derivatives_are_those_of_finite_differences() {
        let (gaps, poses) = (gaps(false), poses());
        let pair = |poses: &[Pose]| gaps.pairs(poses, 9.0).into_iter().next().unwrap();
        let at = pair(&poses);
        assert_eq!((at.body, at.partner), (0, Partner::Body(1)));
        let step = 1e-4;
        let derivative = at.gradient_derivative();
        for (body, side) in [(0, 0), (1, 6)] {
            for mode in 0..6 {
                let moved = |size: f64| {
                    let mut displacement = crate::body::RigidVector::zeros();
                    displacement[mode] = size;
                    let mut moved = poses;
                    moved[body] = poses[body].displaced(&displacement);
                    pair(&moved)
                };
                let (ahead, behind) = (moved(step), moved(-step));
                let slope = (ahead.gap - behind.gap) / (2.0 * step);
                assert!((slope - at.gradient()[body][mode]).abs() < 1e-6, "{body} {mode}");
                for (row_body, row_side) in [(0, 0), (1, 6)] {
                    for row in 0..6 {
                        let [up, down] = [&ahead, &behind].map(|p| p.gradient()[row_body][row]);
                        let change = (up - down) / (2.0 * step);
                        let exact = derivative[(row_side + row, side + mode)];
                        assert!((change - exact).abs() < 2e-4, "{row} {mode}: {change} {exact}");
                    }
                }
            }
        }
    }

    #[test]
    fn walls_and_images_are_met() {
        let poses = poses();
        let walled = gaps(false);
        let walls = walled.pairs(&poses, 9.0);
        let top = walls.iter().find(|pair| (pair.body, pair.partner) == (1, Partner::Wall(3)));
        assert!((top.unwrap().gap - 3.8).abs() < 1e-12);
        assert_eq!(walled.partner_name(Partner::Wall(3)), "top");
        let periodic = gaps(true);
        // The second body and its image ten away
        let own = periodic.pairs(&poses, 9.5);
        let own: Vec<_> =
            own.iter().filter(|p| (p.body, p.partner) == (1, Partner::Body(1))).collect();
        assert_eq!(own.len(), 3);
        assert!(own.iter().all(|pair| (pair.gap - 9.0).abs() < 1e-12));
        let [one, two] = [&walled, &periodic].map(|gaps| gaps.minimum_gap(&poses).unwrap());
        assert_eq!(one, two);
        assert!((walled.reach(0) - (1.0 + 0.05_f64.sqrt())).abs() < 1e-12);
        // Half the thickness of the thinner body, 0.4, over the way of both
        let to = [poses[0], poses[1].shifted(&Vector3::new(-2.0, 0.0, 0.0))];
        assert!((walled.max_step_fraction(&poses, &to) - 0.2).abs() < 1e-12);
    }
}
