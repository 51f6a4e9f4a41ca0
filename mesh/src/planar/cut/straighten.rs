//! `Network`: the lines of a cut, pulled straight as far as the bodies let them.

use std::sync::Arc;

use super::clearance::Clearance;
use super::path::Path;
use super::stretch::{CopyOf, Line, Stretch};
use crate::{BoundaryId, Domain, Point};

/// Distance of neighbouring points over the clearance there.
const SPACING: f64 = 0.25;

/// Most points of a line.
const MOST_POINTS: usize = 20_000;

/// A point keeps this part of the clearance it had in the middle between the bodies.
const KEPT: f64 = 0.75;

/// Sweeps along all lines; the second choice where lines pulled straight have met.
pub const SWEEPS: [usize; 2] = [120, 8];

/// Part of the way to where it is pulled by which a point moves in a sweep.
const RELAXATION: f64 = 0.7;

/// The lines of a cut.
#[derive(Debug, Clone)]
pub enum Network {
    /// Two lines that together go once around, and one across from the start of the first to a
    /// copy of the end of the first, moved by `over`.
    Theta {
        lines: [Vec<Point<2>>; 3],
        /// From the start of the first line to the end of the second (m).
        along: Point<2>,
        over: Point<2>,
    },
    /// One line from wall to wall.
    Crossing { line: Vec<Point<2>>, wall_axis: usize },
}

impl Network {
    /// The boundary of the cell, with the lines pulled straight.
    pub fn straightened(
        &self,
        clearance: &Clearance<'_>,
        domain: &Domain,
        sweeps: usize,
    ) -> Vec<Stretch> {
        match self {
            Self::Theta { lines, along, over } => theta(lines, *along, *over, clearance, sweeps),
            Self::Crossing { line, wall_axis } => {
                crossing(line, *wall_axis, clearance, domain, sweeps)
            }
        }
    }
}

fn theta(
    lines: &[Vec<Point<2>>; 3],
    along: Point<2>,
    over: Point<2>,
    clearance: &Clearance<'_>,
    sweeps: usize,
) -> Vec<Stretch> {
    let mut lines = lines.each_ref().map(|line| Tight::new(line, clearance));
    for _ in 0..sweeps {
        for line in &mut lines {
            line.sweep(clearance);
        }
        // Both junctions go where three equal pulls balance
        let [first, second, across] = &lines;
        let start = first.points[0];
        let pulls = [first.second(), second.last_but_one() - along, across.second()];
        let start = balanced(start, pulls, first.kept[0], clearance);
        let end = second.points[0];
        let pulls = [first.last_but_one(), second.second(), across.last_but_one() - over];
        let end = balanced(end, pulls, second.kept[0], clearance);
        let [first, second, across] = &mut lines;
        first.set_ends(start, end);
        second.set_ends(end, start + along);
        across.set_ends(start, end + over);
    }
    let [first, second, across] = lines.map(|line| line.points);
    let path = |points: Vec<Point<2>>| Arc::new(Path::new(points, clearance));
    let backwards = |points: &[Point<2>]| points.iter().rev().copied().collect::<Vec<_>>();
    let down = [path(backwards(&second)), path(backwards(&first))];
    let across = path(across);
    let copy = |path: &Path, shift: Point<2>| Line::Along(Arc::new(path.moved(shift).reversed()));
    let stretch = |line, side, copy_of| Stretch { line, side: BoundaryId::new(side), copy_of };
    vec![
        stretch(Line::Along(Arc::clone(&down[0])), 0, None),
        stretch(Line::Along(Arc::clone(&down[1])), 0, None),
        stretch(Line::Along(Arc::clone(&across)), 2, None),
        stretch(copy(&down[0], over), 1, copied(0, over)),
        stretch(copy(&down[1], over + along), 1, copied(1, over + along)),
        stretch(copy(&across, along), 3, copied(2, along)),
    ]
}

fn crossing(
    line: &[Point<2>],
    wall_axis: usize,
    clearance: &Clearance<'_>,
    domain: &Domain,
    sweeps: usize,
) -> Vec<Stretch> {
    let mut line = Tight::new(line, clearance);
    let along = 1 - wall_axis;
    for _ in 0..sweeps {
        line.sweep(clearance);
        // The ends slide on the walls, to where the line stands upright on them
        let (mut start, mut end) = (line.first(), line.last());
        start[along] = line.second()[along];
        end[along] = line.last_but_one()[along];
        line.set_ends(start, end);
    }
    let mut period = Point::<2>::zeros();
    period[along] = domain.periods()[along].unwrap_or(0.0);
    let (start, end) = (line.first(), line.last());
    let straight = |from: Point<2>, to: Point<2>, side| Stretch {
        line: Line::Straight(from, to),
        side: BoundaryId::new(side),
        copy_of: None,
    };
    let path = Path::new(line.points, clearance);
    let (there, back) = (path.clone(), path.reversed());
    let original = |path: Path, side| Stretch {
        line: Line::Along(Arc::new(path)),
        side: BoundaryId::new(side),
        copy_of: None,
    };
    let copy = |path: &Path, side, of| Stretch {
        line: Line::Along(Arc::new(path.moved(period))),
        side: BoundaryId::new(side),
        copy_of: copied(of, period),
    };
    if wall_axis == 1 {
        vec![
            original(back, 0),
            straight(start, start + period, 2),
            copy(&there, 1, 0),
            straight(end + period, end, 3),
        ]
    } else {
        vec![
            original(there, 2),
            straight(end, end + period, 1),
            copy(&back, 3, 0),
            straight(start + period, start, 0),
        ]
    }
}

fn copied(original: usize, shift: Point<2>) -> Option<CopyOf> {
    Some(CopyOf { original, shift })
}

/// A line under tension between bodies.
struct Tight {
    points: Vec<Point<2>>,
    /// Clearance each point keeps (m).
    kept: Vec<f64>,
}

impl Tight {
    fn new(line: &[Point<2>], clearance: &Clearance<'_>) -> Self {
        let mut points = vec![line[0]];
        let mut kept = vec![KEPT * clearance.at(line[0])];
        for pair in line.windows(2) {
            // A step as long as the clearance where it starts allows
            let (length, mut gone) = ((pair[1] - pair[0]).norm(), 0.0);
            loop {
                let here = pair[0] + (pair[1] - pair[0]) * (gone / length.max(f64::MIN_POSITIVE));
                gone += SPACING * clearance.at(here).max(1e-9 * length);
                if gone >= length || points.len() > MOST_POINTS {
                    break;
                }
                let at = pair[0] + (pair[1] - pair[0]) * (gone / length);
                points.push(at);
                kept.push(KEPT * clearance.at(at));
            }
            points.push(pair[1]);
            kept.push(KEPT * clearance.at(pair[1]));
        }
        let mut tight = Self { points, kept };
        tight.thin();
        tight
    }

    /// Leaves out points that are much nearer to the one before than the clearance asks for.
    fn thin(&mut self) {
        let n = self.points.len();
        let mut stays = vec![true; n];
        let mut before = 0;
        for i in 1..n - 1 {
            let apart = (self.points[i] - self.points[before]).norm();
            let to_end = (self.points[n - 1] - self.points[i]).norm();
            let enough = 0.6 * SPACING / KEPT * self.kept[i];
            stays[i] = apart >= enough && to_end >= enough;
            if stays[i] {
                before = i;
            }
        }
        let mut it = stays.iter();
        self.points.retain(|_| *it.next().unwrap_or(&true));
        let mut it = stays.iter();
        self.kept.retain(|_| *it.next().unwrap_or(&true));
    }

    fn first(&self) -> Point<2> {
        self.points[0]
    }

    fn second(&self) -> Point<2> {
        self.points[1]
    }

    fn last(&self) -> Point<2> {
        self.points[self.points.len() - 1]
    }

    fn last_but_one(&self) -> Point<2> {
        self.points[self.points.len() - 2]
    }

    fn set_ends(&mut self, start: Point<2>, end: Point<2>) {
        let last = self.points.len() - 1;
        self.points[0] = start;
        self.points[last] = end;
    }

    /// Every inner point towards the line between its neighbours, where its clearance allows.
    fn sweep(&mut self, clearance: &Clearance<'_>) {
        for i in 1..self.points.len() - 1 {
            let [before, here, after] = [i - 1, i, i + 1].map(|k| self.points[k]);
            let (one, other) = ((here - before).norm(), (after - here).norm());
            let target = (before * other + after * one) / (one + other);
            let moved = here + (target - here) * RELAXATION;
            if clearance.at(moved) >= self.kept[i] {
                self.points[i] = moved;
            }
        }
    }
}

/// Where a junction goes that is pulled towards three points with equal force.
fn balanced(
    place: Point<2>,
    pulls: [Point<2>; 3],
    kept: f64,
    clearance: &Clearance<'_>,
) -> Point<2> {
    let shortest = pulls.iter().map(|to| (to - place).norm()).fold(f64::INFINITY, f64::min);
    let force = pulls.iter().fold(Point::<2>::zeros(), |sum, to| {
        sum + (to - place).try_normalize(0.0).unwrap_or_else(Point::<2>::zeros)
    });
    let moved = place + force * (0.3 * shortest);
    if clearance.at(moved) >= kept { moved } else { place }
}
