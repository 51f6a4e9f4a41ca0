//! `Medial`: the ways between bodies of a periodic domain: junctions where three of them meet.
//!
//! From the Delaunay triangles of places on the surfaces: triangles between three surfaces are
//! junctions, strips of triangles between two are corridors. Triangles that differ by whole periods
//! are the same.

use std::collections::HashMap;

use spade::{DelaunayTriangulation, Point2, Triangulation as _};

use super::clearance::Clearance;
use super::samples::Samples;
use super::steps::{Steps, displacement, sum};
use crate::Point;
use crate::number::index_u32;

/// Copies of the places on each side of the domain in which the triangles are made.
const COPIES: i32 = 2;

/// Where three corridors meet.
#[derive(Debug, Clone)]
pub struct Junction {
    /// Its place (m).
    pub at: Point<2>,
    /// The corridors that leave it, counter-clockwise, each with the end it has here.
    pub arms: [CorridorEnd; 3],
    /// Where it reaches each of the walls, if it does (m).
    pub walls: [Option<Point<2>>; 2],
}

/// A corridor followed from one of its ends, 0 or 1.
#[derive(Debug, Clone, Copy)]
pub struct CorridorEnd {
    pub corridor: usize,
    pub end: usize,
}

/// One of the three arms of a junction.
#[derive(Debug, Clone, Copy)]
pub struct JunctionArm {
    pub junction: usize,
    pub arm: usize,
}

/// Where a corridor leads.
#[derive(Debug, Clone, Copy)]
pub struct Arrival {
    pub at: JunctionArm,
    /// Periods gone.
    pub steps: Steps,
}

/// A way between two surfaces from one junction to the next.
#[derive(Debug, Clone)]
pub struct Corridor {
    /// Junction and arm at both ends.
    pub ends: [JunctionArm; 2],
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

/// A sample with the periods by which it is moved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
struct Corner {
    sample: u32,
    steps: Steps,
}

/// A triangle, up to whole periods.
#[derive(Debug, Clone)]
struct PeriodicTriangle {
    /// Counter-clockwise.
    corners: [Corner; 3],
    /// What is behind side i, from corner i to the next; none where both corners are on the same
    /// surface.
    behind: [Option<Behind>; 3],
}

/// The triangle behind a side.
#[derive(Debug, Clone, Copy)]
struct Behind {
    triangle: usize,
    /// Its own side.
    side: usize,
    /// Periods by which it is moved.
    steps: Steps,
}

/// Corners of a triangle moved by periods so that the sample of lowest index is not moved, sorted.
#[derive(Debug, Clone, Copy)]
struct Canonical {
    key: [Corner; 3],
    /// Periods that move them back.
    steps: Steps,
}

/// What stands for an arm that has not been followed yet.
const NO_CORRIDOR: CorridorEnd = CorridorEnd { corridor: usize::MAX, end: 0 };

impl Medial {
    /// The ways between surfaces; `None` where the triangles do not repeat, by a tie.
    pub fn new(samples: &Samples, clearance: &Clearance<'_>) -> Option<Self> {
        let triangles = triangles(samples)?;
        let tracing = Tracing::new(&triangles, samples);
        let mut junctions = tracing.junctions();
        let mut corridors: Vec<Corridor> = Vec::new();
        for start in 0..triangles.len() {
            let first = tracing.number[start];
            if first == usize::MAX {
                continue;
            }
            for arm in 0..3 {
                if junctions[first].arms[arm].corridor != usize::MAX {
                    continue;
                }
                let (from, corridor) = (JunctionArm { junction: first, arm }, corridors.len());
                let traced = tracing.corridor(start, from, &junctions, clearance)?;
                for (end, JunctionArm { junction, arm }) in traced.ends.into_iter().enumerate() {
                    junctions[junction].arms[arm] = CorridorEnd { corridor, end };
                }
                corridors.push(traced);
            }
        }
        Some(Self { junctions, corridors, periods: samples.periods })
    }

    /// The place of a junction moved by periods (m).
    pub fn place(&self, junction: usize, steps: Steps) -> Point<2> {
        self.junctions[junction].at + displacement(steps, self.periods)
    }

    /// Along a corridor from one of its ends to the other.
    pub fn follow(&self, leg: CorridorEnd) -> Arrival {
        let Corridor { ends, steps, .. } = &self.corridors[leg.corridor];
        let steps = if leg.end == 0 { *steps } else { [-steps[0], -steps[1]] };
        Arrival { at: ends[1 - leg.end], steps }
    }

    /// The junction a corridor leaves, and its arm there.
    pub fn start(&self, leg: CorridorEnd) -> JunctionArm {
        self.corridors[leg.corridor].ends[leg.end]
    }

    /// Points inside a corridor from one of its ends, whose junction is moved by periods (m).
    pub fn way(&self, leg: CorridorEnd, steps: Steps) -> Vec<Point<2>> {
        let Corridor { way, steps: gone, .. } = &self.corridors[leg.corridor];
        if leg.end == 0 {
            let shift = displacement(steps, self.periods);
            way.iter().map(|x| x + shift).collect()
        } else {
            let shift = displacement([steps[0] - gone[0], steps[1] - gone[1]], self.periods);
            way.iter().rev().map(|x| x + shift).collect()
        }
    }
}

/// Follows strips of triangles from junction to junction.
struct Tracing<'a> {
    triangles: &'a [PeriodicTriangle],
    samples: &'a Samples,
    /// The junction that each triangle is, `usize::MAX` where it is none.
    number: Vec<usize>,
}

impl<'a> Tracing<'a> {
    fn new(triangles: &'a [PeriodicTriangle], samples: &'a Samples) -> Self {
        let mut n_junctions = 0;
        let number = |triangle: &PeriodicTriangle| {
            let is_junction = triangle.behind.iter().all(Option::is_some);
            let number = if is_junction { n_junctions } else { usize::MAX };
            n_junctions += usize::from(is_junction);
            number
        };
        Self { triangles, samples, number: triangles.iter().map(number).collect() }
    }

    fn point(&self, corner: Corner) -> Point<2> {
        self.samples.points[corner.sample as usize]
            + displacement(corner.steps, self.samples.periods)
    }

    fn middle(&self, triangle: usize, side: usize) -> Point<2> {
        let corners = &self.triangles[triangle].corners;
        (self.point(corners[side]) + self.point(corners[(side + 1) % 3])) * 0.5
    }

    /// All junctions, their arms not followed yet.
    fn junctions(&self) -> Vec<Junction> {
        let numbered = self.triangles.iter().zip(&self.number);
        let junction = |(triangle, _): (&PeriodicTriangle, &usize)| {
            let [a, b, c] = triangle.corners.map(|corner| self.point(corner));
            let wall = |wall: usize| {
                let owner = self.samples.n_bodies + wall;
                let owner_of = |corner: &Corner| self.samples.owners[corner.sample as usize];
                let corner = triangle.corners.iter().find(|corner| owner_of(corner) == owner);
                corner.map(|corner| self.point(*corner))
            };
            Junction { at: incenter(a, b, c), arms: [NO_CORRIDOR; 3], walls: [wall(0), wall(1)] }
        };
        numbered.filter(|(_, number)| **number != usize::MAX).map(junction).collect()
    }

    /// The corridor that leaves a junction, which is a triangle, by one of its arms.
    fn corridor(
        &self,
        start: usize,
        from: JunctionArm,
        junctions: &[Junction],
        clearance: &Clearance<'_>,
    ) -> Option<Corridor> {
        let periods = self.samples.periods;
        let mut way = vec![junctions[from.junction].at];
        let (mut triangle, mut side, mut steps) = (start, from.arm, [0, 0]);
        let end = loop {
            way.push(self.middle(triangle, side) + displacement(steps, periods));
            let next = self.triangles[triangle].behind[side]?;
            steps = sum(steps, next.steps);
            triangle = next.triangle;
            if self.number[triangle] != usize::MAX {
                break JunctionArm { junction: self.number[triangle], arm: next.side };
            }
            let behind = &self.triangles[triangle].behind;
            side = (0..3).find(|&s| s != next.side && behind[s].is_some())?;
            if way.len() > self.triangles.len() {
                return None;
            }
        };
        way.push(junctions[end.junction].at + displacement(steps, periods));
        let cost = cost(&way, clearance);
        way.pop();
        way.remove(0);
        Some(Corridor { ends: [from, end], steps, way, cost })
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

/// The triangles between all samples, each once.
fn triangles(samples: &Samples) -> Option<Vec<PeriodicTriangle>> {
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
    let corner = |index: usize| Corner { sample: index_u32(index % n), steps: copies[index / n] };
    let mut triangles = Vec::new();
    let mut number: HashMap<[Corner; 3], usize> = HashMap::new();
    let mut faces = Vec::new();
    for face in made.inner_faces() {
        let corners = face.vertices().map(|vertex| corner(vertex.index()));
        let Canonical { key, steps } = canonical(corners);
        if steps == [0, 0] {
            number.insert(key, triangles.len());
            triangles.push(PeriodicTriangle { corners, behind: [None; 3] });
            faces.push(face);
        }
    }
    for (index, face) in faces.iter().enumerate() {
        let corners = triangles[index].corners;
        for edge in face.adjacent_edges() {
            let [from, to] = [edge.from(), edge.to()].map(|vertex| corner(vertex.index()));
            if samples.is_same_surface(from, to) {
                continue;
            }
            let side = corners.iter().position(|c| *c == from)?;
            let other = edge.rev().face().as_inner()?;
            let Canonical { key, steps } =
                canonical(other.vertices().map(|vertex| corner(vertex.index())));
            let neighbour = *number.get(&key)?;
            let there = &triangles[neighbour].corners;
            let entry = there.iter().position(|c| *c == to.back(steps))?;
            if there[(entry + 1) % 3] != from.back(steps) {
                return None;
            }
            triangles[index].behind[side] =
                Some(Behind { triangle: neighbour, side: entry, steps });
        }
    }
    Some(triangles)
}

impl Samples {
    /// Whether two corners are on the same wall, or on one body in the same period.
    fn is_same_surface(&self, a: Corner, b: Corner) -> bool {
        let (one, other) = (self.owners[a.sample as usize], self.owners[b.sample as usize]);
        one == other && (a.steps == b.steps || one >= self.n_bodies)
    }
}

impl Corner {
    fn back(self, by: Steps) -> Self {
        Self { steps: [self.steps[0] - by[0], self.steps[1] - by[1]], ..self }
    }
}

fn canonical(corners: [Corner; 3]) -> Canonical {
    let lowest = corners[0].sample.min(corners[1].sample).min(corners[2].sample);
    let moved = |by: Steps| {
        let mut key = corners.map(|corner| corner.back(by));
        key.sort_unstable();
        Canonical { key, steps: by }
    };
    let mut best: Option<Canonical> = None;
    for corner in corners.iter().filter(|corner| corner.sample == lowest) {
        let next = moved(corner.steps);
        if best.is_none_or(|best| next.key < best.key) {
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
