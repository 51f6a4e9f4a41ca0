//! Places on bodies and walls, close to each other where surfaces are.

use super::clearance::Clearance;
use crate::{Domain, Point};

/// Distance of neighbouring places over the gap there.
const SPACING: f64 = 0.5;

/// Stretches of a quarter, and of a wall, to begin with.
const STRETCHES: usize = 16;

/// Most halvings of a stretch.
const MOST_HALVINGS: u32 = 24;

/// Part of the spacing by which places are moved along, so that no four lie on a circle but by
/// chance: the triangulation of equal points must not depend on rounding.
const JITTER: f64 = 0.1;

/// Places on all surfaces.
#[derive(Debug, Clone)]
pub struct Samples {
    /// Places (m).
    pub points: Vec<Point<2>>,
    /// Body of each, or the number of bodies plus 0 for the lower wall, 1 for the upper.
    pub owners: Vec<usize>,
    pub n_bodies: usize,
    pub periods: [Option<f64>; 2],
}

/// Samples of the surfaces in a domain; `None` for one that is no box.
pub fn samples(domain: &Domain, clearance: &Clearance<'_>, attempt: u64) -> Option<Samples> {
    let Domain::Box { min, max, .. } = domain else { return None };
    let mut made = Samples {
        points: Vec::new(),
        owners: Vec::new(),
        n_bodies: clearance.outlines.len(),
        periods: clearance.periods,
    };
    let mut random = Random(0x9e37_79b9_7f4a_7c15 ^ (attempt + 1).wrapping_mul(0x0012_34ab_cdef));
    let walled = (0..2).find(|&axis| clearance.periods[axis].is_none());
    let to_walls = |point: Point<2>| {
        walled.map_or(f64::INFINITY, |axis| (point[axis] - min[axis]).min(max[axis] - point[axis]))
    };
    for (body, outline) in clearance.outlines.iter().enumerate() {
        for quarter in 0..4 {
            let at = |t: f64| outline.evaluate(quarter, t)[0];
            let gap = |x: Point<2>| clearance.but(x, Some(body)).min(to_walls(x));
            made.line(&at, &gap, body, &mut random);
        }
    }
    if let Some(axis) = walled {
        for (wall, height) in [min[axis], max[axis]].into_iter().enumerate() {
            let at = |t: f64| {
                let mut point = min + (max - min) * t;
                point[axis] = height;
                point
            };
            let gap = |x: Point<2>| clearance.at(x).min(max[axis] - min[axis]);
            let owner = clearance.outlines.len() + wall;
            made.line(&at, &gap, owner, &mut random);
        }
    }
    Some(made)
}

impl Samples {
    /// Places along a line with a parameter in [0, 1], its end left out.
    fn line(
        &mut self,
        at: &dyn Fn(f64) -> Point<2>,
        gap: &dyn Fn(Point<2>) -> f64,
        owner: usize,
        random: &mut Random,
    ) {
        let mut ends: Vec<(f64, u32)> =
            (0..STRETCHES).rev().map(|i| ((i + 1) as f64 / STRETCHES as f64, 0)).collect();
        let (mut from, mut here) = (0.0, at(0.0));
        let mut gap_here = gap(here);
        while let Some((to, depth)) = ends.pop() {
            let there = at(to);
            let gap_there = gap(there);
            let is_close = (there - here).norm() <= SPACING * gap_here.min(gap_there);
            if is_close || depth >= MOST_HALVINGS {
                self.points.push(at(from + JITTER * random.next() * (to - from)));
                self.owners.push(owner);
                (from, here, gap_here) = (to, there, gap_there);
            } else {
                ends.push((to, depth + 1));
                ends.push((0.5 * (from + to), depth + 1));
            }
        }
    }
}

/// Numbers between 0 and 1, the same in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}
