//! Copies of a swimmer: in a lattice, or at random and apart from each other.

use std::f64::consts::TAU;

use alewife_mesh::{Domain, Point};

use super::body::Body;
use super::diagnostic::CaseError;
use super::discs::{Disc, DiscGrid};
use super::joint::PlanarPose;
use super::parts::{Part, poses};
use super::swimmer::{Copies, SwimmerSpec};
use super::{Case, Geometry};

/// Random centres tried for each copy.
const TRIALS: usize = 20_000;

/// One copy of a swimmer: its name, and the pose of the body all others are attached to.
pub struct Individual {
    pub name: String,
    pub pose: PlanarPose,
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
    let start = Point::<2>::from(swimmer.center);
    let at = |center: Point<2>| PlanarPose { center, angle: swimmer.angle };
    match &swimmer.copies {
        None => Ok(vec![Individual { name: swimmer.name.clone(), pose: at(start) }]),
        Some(Copies::Lattice { counts: [columns, rows], spacing }) => {
            let copy = |nth: usize| {
                let (column, row) = ((nth % columns) as f64, (nth / columns) as f64);
                let shift = Point::<2>::new(column * spacing[0], row * spacing[1]);
                Individual { name: copy_name(swimmer, nth), pose: at(start + shift) }
            };
            Ok((0..rows * columns).map(copy).collect())
        }
        Some(Copies::Random { .. }) => random_copies(case, key, swimmer, parts, present),
    }
}

fn copy_name(swimmer: &SwimmerSpec, nth: usize) -> String {
    format!("{}-{}", swimmer.name, nth + 1)
}

/// Copies at random, each a gap apart from what is there already. The numbers are those of the seed
/// of the swimmer alone, so that other swimmers of the case do not change them.
fn random_copies(
    case: &Case,
    key: &str,
    swimmer: &SwimmerSpec,
    parts: &[Part],
    present: &[Body],
) -> Result<Vec<Individual>, CaseError> {
    let Some(Copies::Random { count, seed, gap, within, turned }) = &swimmer.copies else {
        return Ok(Vec::new());
    };
    let mut random = SplitMix64(*seed);
    let reach = reach(parts);
    let [min, max] = within.unwrap_or_else(|| case.extent().in_plane());
    let mut occupied = Occupied::new(case.mesh_domain(), [min, max], present.len() + count);
    for body in present.iter().filter(|body| body.center.len() == 2) {
        let center = Point::<2>::new(body.center[0], body.center[1]);
        occupied.add(Disc { center, radius: body.shape.reach() });
    }
    let mut copies = Vec::with_capacity(*count);
    for nth in 0..*count {
        let found = (0..TRIALS).find_map(|_| {
            let (along_x, along_y) = (random.next(), random.next());
            let x = min[0] + along_x * (max[0] - min[0]);
            let y = match case.geometry {
                Geometry::Planar => min[1] + along_y * (max[1] - min[1]),
                Geometry::Axisymmetric | Geometry::Spatial => 0.0,
            };
            let center = Point::<2>::new(x, y);
            occupied.has_space(&Disc { center, radius: reach }, *gap).then_some(center)
        });
        let Some(center) = found else {
            return Err(CaseError::at(
                &format!("{key}.copies.random.count"),
                format!(
                    "no space was found for copy {} of \"{}\", which takes a circle of radius \
                     {reach:.4} and a gap of {gap}",
                    nth + 1,
                    swimmer.name
                ),
                "ask for fewer copies, a smaller gap, or a larger domain",
            ));
        };
        occupied.add(Disc { center, radius: reach });
        let angle = if *turned { TAU * random.next() } else { swimmer.angle };
        copies
            .push(Individual { name: copy_name(swimmer, nth), pose: PlanarPose { center, angle } });
    }
    Ok(copies)
}

/// Radius of the circle about the centre of a swimmer which holds all its parts at time zero (m).
fn reach(parts: &[Part]) -> f64 {
    poses(parts, PlanarPose::default()).iter().zip(parts).fold(0.0f64, |most, (pose, part)| {
        most.max(pose.center.x.hypot(pose.center.y) + part.shape.reach())
    })
}

/// Discs that are taken in a domain and its periodic images.
struct Occupied {
    domain: Domain,
    images: Vec<Point<2>>,
    discs: Vec<Disc>,
    grid: DiscGrid,
}

impl Occupied {
    fn new(domain: Domain, [min, max]: [[f64; 2]; 2], expected: usize) -> Self {
        let images = domain.images();
        Self { domain, images, discs: Vec::new(), grid: DiscGrid::new(min, max, expected) }
    }

    fn add(&mut self, disc: Disc) {
        self.grid.insert(self.discs.len(), &disc);
        self.discs.push(disc);
    }

    /// Whether a disc has a gap (m) to all others and to the walls.
    fn has_space(&self, disc: &Disc, gap: f64) -> bool {
        let Disc { center, radius: reach } = *disc;
        let is_apart = |other: usize| {
            let Disc { center: taken, radius } = self.discs[other];
            let least = reach + radius + gap;
            self.images.iter().all(|shift| (center - taken - shift).norm() >= least)
        };
        let walls = (0..self.domain.sides().len()).filter(|side| !self.domain.is_periodic(*side));
        let clearance =
            walls.map(|side| self.domain.side_gap(side, center)).fold(f64::INFINITY, f64::min);
        let image = |shift| Disc { center: center - shift, radius: reach + gap };
        clearance >= reach + gap
            && self.images.iter().all(|shift| self.grid.near(&image(shift)).all(is_apart))
    }
}

/// Pseudo-random numbers that are the same on every machine and in every version (@steele2014).
struct SplitMix64(u64);

impl SplitMix64 {
    /// The next one in [0, 1).
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}
