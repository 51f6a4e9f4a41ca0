//! `Medial`: the ways between bodies of a periodic domain: junctions where three of them meet.
//!
//! From the Delaunay triangles of places on the surfaces: triangles between three surfaces are
//! junctions, strips of triangles between two are corridors. Triangles that differ by whole periods
//! are the same.

use std::collections::HashMap;

use spade::{DelaunayTriangulation, Point2, Triangulation as _};

use super::clearance::Clearance;
use super::samples::Samples;
use super::steps::{Steps, displacement};
use crate::Point;

/// Copies of the places on each side of the domain in which the triangles are made.
const COPIES: i32 = 2;

/// Where three corridors meet.
#[derive(Debug, Clone)]
pub struct Junction {
    /// Its place (m).
    pub at: Point<2>,
    /// The corridors that leave it, counter-clockwise, each with the end it has here.
    pub arms: [(usize, usize); 3],
    /// Where it reaches each of the walls, if it does (m).
    pub walls: [Option<Point<2>>; 2],
}

/// A way between two surfaces from one junction to the next.
#[derive(Debug, Clone)]
pub struct Corridor {
    /// Junction and arm at both ends.
    pub ends: [(usize, usize); 2],
    /// Periods from the place of the second junction to the end of the way.
    pub steps: Steps,
    /// Places on the way, those of the junctions left out, from the first junction on (m).
    pub way: Vec<Point<2>>,
    /// Integral of ds / clearance^2 along it (1/m).
    pub cost: f64,
}

/// All ways between the surfaces.
#[derive(Debug, Clone)]
pub struct Medial {
    pub junctions: Vec<Junction>,
    pub corridors: Vec<Corridor>,
    pub periods: [Option<f64>; 2],
}

/// A place with the periods by which it is moved.
type Corner = (u32, Steps);

/// A triangle, up to whole periods.
#[derive(Debug, Clone)]
struct Cell {
    /// Counter-clockwise.
    corners: [Corner; 3],
    /// What is behind side i, from corner i to the next: cell, its side, and its periods; none
    /// where both corners are on the same surface.
    behind: [Option<(usize, usize, Steps)>; 3],
}

impl Medial {
    /// The ways between surfaces; `None` where the triangles do not repeat, by a tie.
    pub fn new(samples: &Samples, clearance: &Clearance<'_>) -> Option<Self> {
        let cells = cells(samples)?;
        let place = |(sample, steps): Corner| {
            samples.points[sample as usize] + displacement(steps, samples.periods)
        };
        let middle = |cell: usize, side: usize| {
            let corners = &cells[cell].corners;
            (place(corners[side]) + place(corners[(side + 1) % 3])) * 0.5
        };
        let is_junction = |cell: &Cell| cell.behind.iter().all(Option::is_some);
        let mut number = vec![usize::MAX; cells.len()];
        let mut junctions = Vec::new();
        for (index, cell) in cells.iter().enumerate().filter(|(_, cell)| is_junction(cell)) {
            number[index] = junctions.len();
            let [a, b, c] = cell.corners.map(place);
            let wall = |wall: usize| {
                let owner = samples.n_bodies + wall;
                let corner = cell.corners.iter().find(|c| samples.owners[c.0 as usize] == owner);
                corner.map(|corner| place(*corner))
            };
            let walls = [wall(0), wall(1)];
            junctions.push(Junction { at: incenter(a, b, c), arms: [(usize::MAX, 0); 3], walls });
        }
        let mut corridors: Vec<Corridor> = Vec::new();
        for start in 0..cells.len() {
            if number[start] == usize::MAX {
                continue;
            }
            for arm in 0..3 {
                let first = number[start];
                if junctions[first].arms[arm].0 != usize::MAX {
                    continue;
                }
                let mut way = vec![junctions[first].at];
                let (mut cell, mut side, mut steps) = (start, arm, [0, 0]);
                let end = loop {
                    way.push(middle(cell, side) + displacement(steps, samples.periods));
                    let (next, entry, moved) = cells[cell].behind[side]?;
                    steps = [steps[0] + moved[0], steps[1] + moved[1]];
                    cell = next;
                    if number[cell] != usize::MAX {
                        break (number[cell], entry);
                    }
                    side = (0..3).find(|&s| s != entry && cells[cell].behind[s].is_some())?;
                    if way.len() > cells.len() {
                        return None;
                    }
                };
                way.push(junctions[end.0].at + displacement(steps, samples.periods));
                let cost = cost(&way, clearance);
                way.pop();
                way.remove(0);
                let index = corridors.len();
                corridors.push(Corridor { ends: [(first, arm), end], steps, way, cost });
                junctions[first].arms[arm] = (index, 0);
                junctions[end.0].arms[end.1] = (index, 1);
            }
        }
        Some(Self { junctions, corridors, periods: samples.periods })
    }

    /// The place of a junction moved by periods (m).
    pub fn place(&self, junction: usize, steps: Steps) -> Point<2> {
        self.junctions[junction].at + displacement(steps, self.periods)
    }

    /// Along a corridor from one of its ends: the junction at the other, its arm there, and the
    /// periods gone.
    pub fn follow(&self, corridor: usize, from_end: usize) -> (usize, usize, Steps) {
        let Corridor { ends, steps, .. } = &self.corridors[corridor];
        let (junction, arm) = ends[1 - from_end];
        let steps = if from_end == 0 { *steps } else { [-steps[0], -steps[1]] };
        (junction, arm, steps)
    }

    /// Places inside a corridor from one of its ends, whose junction is moved by periods (m).
    pub fn way(&self, corridor: usize, from_end: usize, steps: Steps) -> Vec<Point<2>> {
        let Corridor { way, steps: gone, .. } = &self.corridors[corridor];
        if from_end == 0 {
            let shift = displacement(steps, self.periods);
            way.iter().map(|x| x + shift).collect()
        } else {
            let shift = displacement([steps[0] - gone[0], steps[1] - gone[1]], self.periods);
            way.iter().rev().map(|x| x + shift).collect()
        }
    }
}

/// Integral of ds / clearance^2 along a line (1/m).
pub fn cost(way: &[Point<2>], clearance: &Clearance<'_>) -> f64 {
    let price = |x: &Point<2>| clearance.at(*x).max(1e-12).powi(-2);
    let mut before = price(&way[0]);
    way.windows(2).fold(0.0, |sum, pair| {
        let next = price(&pair[1]);
        let part = 0.5 * (before + next) * (pair[1] - pair[0]).norm();
        before = next;
        sum + part
    })
}

/// The triangles between all places, each once.
fn cells(samples: &Samples) -> Option<Vec<Cell>> {
    let n = samples.points.len();
    let range = |axis: usize| samples.periods[axis].map_or(0..=0, |_| -COPIES..=COPIES);
    let copies: Vec<Steps> = range(1).flat_map(|y| range(0).map(move |x| [x, y])).collect();
    let mut all = Vec::with_capacity(n * copies.len());
    for steps in &copies {
        let shift = displacement(*steps, samples.periods);
        all.extend(samples.points.iter().map(|x| Point2::new(x.x + shift.x, x.y + shift.y)));
    }
    let made = DelaunayTriangulation::<Point2<f64>>::bulk_load_stable(all).ok()?;
    if made.num_vertices() != n * copies.len() {
        return None;
    }
    let corner = |index: usize| ((index % n) as u32, copies[index / n]);
    let mut cells = Vec::new();
    let mut number: HashMap<[Corner; 3], usize> = HashMap::new();
    let mut faces = Vec::new();
    for face in made.inner_faces() {
        let corners = face.vertices().map(|vertex| corner(vertex.index()));
        let (key, steps) = canonical(corners);
        if steps == [0, 0] {
            number.insert(key, cells.len());
            cells.push(Cell { corners, behind: [None; 3] });
            faces.push(face);
        }
    }
    let is_same = |a: Corner, b: Corner| {
        let (one, other) = (samples.owners[a.0 as usize], samples.owners[b.0 as usize]);
        one == other && (a.1 == b.1 || one >= samples.n_bodies)
    };
    for (index, face) in faces.iter().enumerate() {
        let corners = cells[index].corners;
        for edge in face.adjacent_edges() {
            let [from, to] = [edge.from(), edge.to()].map(|vertex| corner(vertex.index()));
            if is_same(from, to) {
                continue;
            }
            let side = corners.iter().position(|c| *c == from)?;
            let other = edge.rev().face().as_inner()?;
            let there = other.vertices().map(|vertex| corner(vertex.index()));
            let (key, steps) = canonical(there);
            let neighbour = *number.get(&key)?;
            let back = |c: Corner| (c.0, [c.1[0] - steps[0], c.1[1] - steps[1]]);
            let entry = cells[neighbour].corners.iter().position(|c| *c == back(to))?;
            if cells[neighbour].corners[(entry + 1) % 3] != back(from) {
                return None;
            }
            cells[index].behind[side] = Some((neighbour, entry, steps));
        }
    }
    Some(cells)
}

/// The corners of a triangle moved by periods so that the place of lowest index is not moved,
/// sorted; and the periods that move them back.
fn canonical(corners: [Corner; 3]) -> ([Corner; 3], Steps) {
    let lowest = corners[0].0.min(corners[1].0).min(corners[2].0);
    let moved = |by: Steps| {
        let mut moved = corners.map(|(i, steps)| (i, [steps[0] - by[0], steps[1] - by[1]]));
        moved.sort_unstable();
        (moved, by)
    };
    let mut best: Option<([Corner; 3], Steps)> = None;
    for (_, steps) in corners.iter().filter(|corner| corner.0 == lowest) {
        let next = moved(*steps);
        if best.is_none_or(|best| next.0 < best.0) {
            best = Some(next);
        }
    }
    best.unwrap_or_else(|| moved([0, 0]))
}

/// Centre of the circle in a triangle.
fn incenter(a: Point<2>, b: Point<2>, c: Point<2>) -> Point<2> {
    let (across_a, across_b, across_c) = ((c - b).norm(), (a - c).norm(), (b - a).norm());
    (a * across_a + b * across_b + c * across_c) / (across_a + across_b + across_c)
}
