//! Copies of a swimmer: in a lattice, or at random and apart from each other.

use std::f64::consts::TAU;

use alewife_mesh::Point;
use nalgebra::{Isometry3, UnitQuaternion};

use super::balls::{Ball, BallGrid};
use super::part_pose::PartPose;
use super::parts::{Part, poses};
use super::random::SplitMix64;
use crate::spec::body::Body;
use crate::spec::body::joint::PlanarPose;
use crate::spec::body::orientation::Orientation;
use crate::spec::body::swimmer::{Copies, SwimmerSpec};
use crate::text::diagnostic::CaseError;
use crate::{Case, Geometry};

/// Random centres tried for each copy.
const TRIALS: usize = 20_000;

/// One copy of a swimmer: its name, and the pose of the body all others are attached to.
pub struct Individual {
    pub name: String,
    pub pose: PartPose,
}

/// All copies of a swimmer; `present` are the bodies there are already.
///
/// # Errors
/// When there is no space for a copy.
pub fn individuals(
    case: &Case,
    key: &str,
    swimmer: &SwimmerSpec,
    parts: &[Part],
    present: &[Body],
) -> Result<Vec<Individual>, CaseError> {
    let start = coordinates(&swimmer.center);
    let at = |center: Point<3>| placed(case.geometry, swimmer, center);
    match &swimmer.copies {
        None => Ok(vec![Individual { name: swimmer.name.clone(), pose: at(start) }]),
        Some(Copies::Lattice { counts, spacing }) => {
            let spacing = coordinates(spacing);
            let copy = |nth: usize| {
                let mut rest = nth;
                let mut center = start;
                for (axis, count) in counts.iter().enumerate().take(3) {
                    center[axis] += (rest % count) as f64 * spacing[axis];
                    rest /= count;
                }
                Individual { name: copy_name(swimmer, nth), pose: at(center) }
            };
            Ok((0..product(counts).unwrap_or(0)).map(copy).collect())
        }
        Some(Copies::Random { .. }) => {
            let random = RandomCopies { key, swimmer, parts, present };
            match case.domain_in_space().filter(|_| case.geometry == Geometry::Spatial) {
                Some(domain) => random.place(Room {
                    corners: domain.corners(),
                    images: domain.images(),
                    clearance: Box::new(move |center| {
                        let walls = (0..domain.sides().len()).filter(|s| !domain.is_periodic(*s));
                        least(walls.map(|side| domain.side_gap(side, *center)))
                    }),
                    geometry: case.geometry,
                }),
                None => {
                    let domain = case.mesh_domain();
                    random.place(Room {
                        corners: case.extent().in_plane().map(Point::from),
                        images: domain.images(),
                        clearance: Box::new(move |center| {
                            let sides = 0..domain.sides().len();
                            let walls = sides.filter(|side| !domain.is_periodic(*side));
                            least(walls.map(|side| domain.side_gap(side, *center)))
                        }),
                        geometry: case.geometry,
                    })
                }
            }
        }
    }
}

/// How many copies a lattice has; `None` of more than can be counted.
pub fn product(counts: &[usize]) -> Option<usize> {
    counts.iter().try_fold(1usize, |product, count| product.checked_mul(*count))
}

/// A swimmer with its first body in a place (m), turned as it is written.
fn placed(geometry: Geometry, swimmer: &SwimmerSpec, center: Point<3>) -> PartPose {
    if geometry == Geometry::Spatial {
        let rotation = swimmer.orientation.as_ref().map(Orientation::rotation);
        let rotation = rotation.unwrap_or_else(UnitQuaternion::identity);
        return PartPose::Spatial(Isometry3::from_parts(center.into(), rotation));
    }
    PartPose::Planar(PlanarPose { center: [center.x, center.y].into(), angle: swimmer.angle })
}

/// Three coordinates, zero where none is written.
fn coordinates(values: &[f64]) -> Point<3> {
    Point::<3>::from_fn(|axis, _| values.get(axis).copied().unwrap_or(0.0))
}

fn least(gaps: impl Iterator<Item = f64>) -> f64 {
    gaps.fold(f64::INFINITY, f64::min)
}

fn copy_name(swimmer: &SwimmerSpec, nth: usize) -> String {
    format!("{}-{}", swimmer.name, nth + 1)
}

/// A domain that copies go into.
struct Room<const D: usize> {
    corners: [Point<D>; 2],
    /// Vectors by which it repeats (m), zero first.
    images: Vec<Point<D>>,
    /// Distance of a point from the nearest wall (m).
    clearance: Box<dyn Fn(&Point<D>) -> f64>,
    geometry: Geometry,
}

/// Copies at random, each a gap apart from what is there already. The numbers are those of the seed
/// of the swimmer alone, so that other swimmers of the case do not change them.
struct RandomCopies<'a> {
    key: &'a str,
    swimmer: &'a SwimmerSpec,
    parts: &'a [Part],
    present: &'a [Body],
}

impl RandomCopies<'_> {
    fn place<const D: usize>(&self, domain: Room<D>) -> Result<Vec<Individual>, CaseError> {
        let Self { key, swimmer, parts, present } = self;
        let Some(Copies::Random { count, seed, gap, within, turned }) = &swimmer.copies else {
            return Ok(Vec::new());
        };
        let geometry = domain.geometry;
        let mut random = SplitMix64(*seed);
        let reach = reach(parts, geometry);
        let within = within.as_ref().map(|corners| {
            corners.each_ref().map(|corner| coordinates(corner).fixed_rows::<D>(0).into_owned())
        });
        let [min, max] = within.unwrap_or(domain.corners);
        let mut taken = Taken::new(domain, [min, max], present.len() + count);
        for body in present.iter().filter(|body| body.center.len() == D) {
            let center = Point::<D>::from_fn(|axis, _| body.center[axis]);
            taken.add(Ball { center, radius: body.shape.reach() });
        }
        let mut copies = Vec::with_capacity(*count);
        for nth in 0..*count {
            let found = (0..TRIALS).find_map(|_| {
                let mut center = Point::<D>::zeros();
                for axis in 0..D {
                    let along = random.uniform();
                    // Bodies of an axisymmetric case are on the axis
                    if axis == 0 || geometry != Geometry::Axisymmetric {
                        center[axis] = min[axis] + along * (max[axis] - min[axis]);
                    }
                }
                taken.has_space(&Ball { center, radius: reach }, *gap).then_some(center)
            });
            let Some(center) = found else {
                let what = if D == 3 { "sphere" } else { "circle" };
                return Err(CaseError::at(
                    &format!("{key}.copies.random.count"),
                    format!(
                        "no space was found for copy {} of \"{}\", which takes a {what} of radius \
                         {reach:.4} and a gap of {gap}",
                        nth + 1,
                        swimmer.name
                    ),
                    "ask for fewer copies, a smaller gap, or a larger domain",
                ));
            };
            taken.add(Ball { center, radius: reach });
            let mut pose = placed(geometry, swimmer, coordinates(center.as_slice()));
            if *turned {
                match &mut pose {
                    PartPose::Planar(pose) => pose.angle = TAU * random.uniform(),
                    PartPose::Spatial(pose) => pose.rotation = random.rotation(),
                }
            }
            copies.push(Individual { name: copy_name(swimmer, nth), pose });
        }
        Ok(copies)
    }
}

/// Radius of the ball about the centre of a swimmer which holds all its parts at time zero (m).
fn reach(parts: &[Part], geometry: Geometry) -> f64 {
    let root = match geometry {
        Geometry::Spatial => PartPose::Spatial(Isometry3::identity()),
        Geometry::Planar | Geometry::Axisymmetric => PartPose::Planar(PlanarPose::default()),
    };
    poses(parts, root).iter().zip(parts).fold(0.0f64, |most, (pose, part)| {
        most.max(coordinates(&pose.center()).norm() + part.shape.reach())
    })
}

/// Balls that are taken in a domain and its periodic images.
struct Taken<const D: usize> {
    domain: Room<D>,
    balls: Vec<Ball<D>>,
    grid: BallGrid<D>,
}

impl<const D: usize> Taken<D> {
    fn new(domain: Room<D>, [min, max]: [Point<D>; 2], expected: usize) -> Self {
        Self { domain, balls: Vec::new(), grid: BallGrid::new(min, max, expected) }
    }

    fn add(&mut self, ball: Ball<D>) {
        self.grid.insert(self.balls.len(), &ball);
        self.balls.push(ball);
    }

    /// Whether a ball has a gap (m) to all others and to the walls.
    fn has_space(&self, ball: &Ball<D>, gap: f64) -> bool {
        let Ball { center, radius: reach } = *ball;
        let images = &self.domain.images;
        let is_apart = |other: usize| {
            let Ball { center: taken, radius } = self.balls[other];
            let least = reach + radius + gap;
            images.iter().all(|shift| (center - taken - shift).norm() >= least)
        };
        let image = |shift| Ball { center: center - shift, radius: reach + gap };
        (self.domain.clearance)(&center) >= reach + gap
            && images.iter().all(|shift| self.grid.near(&image(shift)).all(is_apart))
    }
}
