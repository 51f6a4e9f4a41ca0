//! `Cut`: where a periodic domain is cut open between bodies that leave no straight strip free.
//!
//! The cut follows the middle of the gaps: round the torus once, across it once, pulled straight.
//! What it bounds holds every body whole, and repeats by the periods of the domain.

mod clearance;
mod medial;
mod path;
mod samples;
mod search;
mod shortest_way;
mod steps;
mod straighten;
mod stretch;

use std::sync::Arc;

use crate::planar::lattice::lattice;
use crate::planar::placement::place_wrapped;
use crate::planar::vector::cross;
use crate::{Domain, MeshError, PlacedShape, Point};

pub(crate) use path::{Path, PathPoint};
pub(crate) use stretch::{CopyOf, Line, Stretch};

use clearance::Clearance;
use medial::Medial;

/// Whole periods by which a body may have to be moved into the cell.
const MOST_PERIODS: usize = 4;

/// A fundamental cell of a periodic box with curved sides that keep off the bodies.
///
/// In a box periodic along both directions the cell has six stretches in three pairs: two for `left`
/// and `right`, one for `bottom` and `top`. Where lines of equal tension meet they do so at angles
/// of 120 degrees.
#[derive(Debug, Clone, PartialEq)]
pub struct Cut {
    /// Counter-clockwise around the cell.
    stretches: Vec<Stretch>,
    shifts: Vec<Point<2>>,
    images: Vec<Point<2>>,
}

impl Cut {
    /// A cut of a periodic box between bodies, which may lie across its sides or outside.
    ///
    /// # Errors
    /// What [`crate::check_wrapped_placement`] refuses, and [`MeshError::NoCut`] when the domain is
    /// no periodic box, holds no body, or no cut is found.
    pub fn between(domain: &Domain, bodies: &[PlacedShape]) -> Result<Self, MeshError> {
        let outlines = place_wrapped(domain, bodies)?;
        let Domain::Box { min, max, .. } = domain else {
            return Err(MeshError::NoCut { reason: "the domain is no box" });
        };
        let periods = domain.periods();
        let clearance = Clearance::new(&outlines, periods, (min + max) * 0.5);
        let found = (0..4).find_map(|attempt| {
            let samples = samples::samples(domain, &clearance, attempt)?;
            let medial = Medial::new(&samples, &clearance)?;
            let network = match periods {
                [Some(_), Some(_)] => search::theta(&medial)?,
                [Some(_), None] | [None, Some(_)] => search::crossing(&medial, domain)?,
                [None, None] => return None,
            };
            Some(network)
        });
        let found = found.ok_or(MeshError::NoCut { reason: "no way between the bodies" })?;
        let mut refused = None;
        for sweeps in straighten::SWEEPS {
            let stretches = found.straightened(&clearance, domain, sweeps);
            let mut cut = Self { stretches, shifts: Vec::new(), images: Vec::new() };
            cut.center(*min, *max, periods);
            let places = outlines.iter().map(|outline| outline.evaluate(0, 0.0)[0]);
            match places.map(|place| cut.inward(place, periods)).collect() {
                Ok(shifts) => {
                    cut.shifts = shifts;
                    cut.images = cut.neighbours(periods);
                    return Ok(cut);
                }
                Err(error) => refused = Some(error),
            }
        }
        Err(refused.unwrap_or(MeshError::NoCut { reason: "no way between the bodies" }))
    }

    /// Whole periods that take each body into the cell (m).
    #[must_use]
    pub fn shifts(&self) -> &[Point<2>] {
        &self.shifts
    }

    pub(crate) fn stretches(&self) -> &[Stretch] {
        &self.stretches
    }

    /// The vectors by which the cell repeats near itself, zero first (m).
    pub(crate) fn images(&self) -> &[Point<2>] {
        &self.images
    }

    /// Corners of the polygon around the cell (m).
    fn polygon(&self) -> Vec<Point<2>> {
        let mut corners = Vec::new();
        for stretch in &self.stretches {
            match &stretch.line {
                Line::Straight(from, _) => corners.push(*from),
                Line::Along(path) => corners.extend(&path.points[..path.points.len() - 1]),
            }
        }
        corners
    }

    /// Moves the cell by whole periods to where its box lies on that of the domain.
    fn center(&mut self, min: Point<2>, max: Point<2>, periods: [Option<f64>; 2]) {
        let [low, high] = bounds(&self.polygon());
        let off = (low + high - min - max) * 0.5;
        let mut shift = Point::<2>::zeros();
        for (axis, period) in periods.into_iter().enumerate() {
            shift[axis] = period.map_or(0.0, |length| -(off[axis] / length).round() * length);
        }
        for stretch in &mut self.stretches {
            match &mut stretch.line {
                Line::Straight(from, to) => {
                    *from += shift;
                    *to += shift;
                }
                Line::Along(path) => {
                    *path = Arc::new(path.moved(shift));
                }
            }
        }
    }

    /// Whole periods that take a point into the cell (m).
    fn inward(&self, point: Point<2>, periods: [Option<f64>; 2]) -> Result<Point<2>, MeshError> {
        let polygon = self.polygon();
        let mut inside = lattice(periods, MOST_PERIODS)
            .into_iter()
            .filter(|shift| winding(&polygon, point + shift) == 1);
        match (inside.next(), inside.next()) {
            (Some(shift), None) => Ok(shift),
            _ => Err(MeshError::NoCut { reason: "the sides of the cell cross each other" }),
        }
    }

    fn neighbours(&self, periods: [Option<f64>; 2]) -> Vec<Point<2>> {
        let [low, high] = bounds(&self.polygon());
        let extent = high - low;
        let near = |shift: &Point<2>| shift.x.abs() <= extent.x && shift.y.abs() <= extent.y;
        lattice(periods, MOST_PERIODS).into_iter().filter(near).collect()
    }
}

/// Lower left and upper right corner of the box around points.
fn bounds(points: &[Point<2>]) -> [Point<2>; 2] {
    let start = [Point::<2>::repeat(f64::INFINITY), Point::<2>::repeat(f64::NEG_INFINITY)];
    points.iter().fold(start, |[low, high], point| [low.inf(point), high.sup(point)])
}

/// How often a closed polygon goes counter-clockwise around a point.
fn winding(polygon: &[Point<2>], point: Point<2>) -> i32 {
    let mut turns = 0;
    for (i, a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let side = cross(b - a, point - a);
        if a.y <= point.y && b.y > point.y && side > 0.0 {
            turns += 1;
        } else if a.y > point.y && b.y <= point.y && side < 0.0 {
            turns -= 1;
        }
    }
    turns
}
