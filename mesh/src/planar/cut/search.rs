//! The cheapest lines along which a periodic domain can be cut open.

use super::medial::{CorridorEnd, Medial};
use super::shortest_way::Search;
use super::steps::{Steps, displacement, sum};
use super::straighten::Network;
use crate::{Domain, Point};

/// Periods a way around may stray along each direction.
const STRAY: i32 = 3;

/// A loop once around along y and a way across, which end on each other: together they bound a cell
/// that holds all bodies. `None` where there is none.
pub fn theta(medial: &Medial) -> Option<Network> {
    let around = Loop::shortest(medial)?;
    let crossing = around.crossing()?;
    let first = around.position_of(medial.start(*crossing.legs.first()?).junction)?;
    let last = crossing.last;
    // Along the loop from where the way across starts
    let mut steps = [0, 0];
    let mut lines = [Vec::new(), Vec::new()];
    let mut steps_at_last = None;
    let n = around.visits.len();
    for k in 0..n {
        let visit = &around.visits[(first + k) % n];
        if (first + k) % n == last {
            steps_at_last = Some(steps);
        }
        let line = &mut lines[usize::from(steps_at_last.is_some())];
        line.push(medial.place(visit.junction, steps));
        line.extend(medial.way(visit.leg, steps));
        steps = sum(steps, medial.follow(visit.leg).steps);
    }
    let steps_at_last = steps_at_last?;
    let [mut before, mut after] = lines;
    before.push(*after.first()?);
    after.push(medial.place(around.visits[first].junction, steps));
    let along = steps;
    let mut across = Vec::new();
    steps = [0, 0];
    for &leg in &crossing.legs {
        across.push(medial.place(medial.start(leg).junction, steps));
        across.extend(medial.way(leg, steps));
        steps = sum(steps, medial.follow(leg).steps);
    }
    across.push(medial.place(around.visits[last].junction, steps));
    let over = [steps[0] - steps_at_last[0], steps[1] - steps_at_last[1]];
    // The cell must be as large as the domain, not a multiple of it
    (along[1] * over[0] - along[0] * over[1] == 1).then(|| Network::Theta {
        lines: [before, after, across],
        along: displacement(along, medial.periods),
        over: displacement(over, medial.periods),
    })
}

/// A way from the lower wall to the upper one.
pub fn crossing(medial: &Medial, domain: &Domain) -> Option<Network> {
    let Domain::Box { min, max, .. } = domain else { return None };
    let wall_axis = medial.periods.iter().position(Option::is_none)?;
    let mut search = Search::new(medial.junctions.len());
    for (index, junction) in medial.junctions.iter().enumerate() {
        if junction.walls[0].is_some() {
            search.start(index);
        }
    }
    let last = loop {
        let found = search.next()?;
        let known = search.reached[found].clone();
        if !search.settle(known.junction) {
            continue;
        }
        if medial.junctions[known.junction].walls[1].is_some() {
            break found;
        }
        search.follow_all(medial, found);
    };
    let legs = search.legs(last);
    let start = match legs.first() {
        Some(&leg) => medial.start(leg).junction,
        None => search.reached[last].junction,
    };
    let on_wall = |point: Point<2>, wall: usize| {
        let mut point = point;
        point[wall_axis] = [min, max][wall][wall_axis];
        point
    };
    let mut line = vec![on_wall(medial.junctions[start].walls[0]?, 0)];
    let mut steps = [0, 0];
    for &leg in &legs {
        line.push(medial.place(medial.start(leg).junction, steps));
        line.extend(medial.way(leg, steps));
        steps = sum(steps, medial.follow(leg).steps);
    }
    let junction = search.reached[last].junction;
    line.push(medial.place(junction, steps));
    let shift = displacement(steps, medial.periods);
    line.push(on_wall(medial.junctions[junction].walls[1]? + shift, 1));
    Some(Network::Crossing { line, wall_axis })
}

/// A junction of a loop, and how it is left.
#[derive(Debug, Clone)]
struct Visit {
    junction: usize,
    leg: CorridorEnd,
}

/// A loop once around along y that meets no junction twice.
struct Loop<'a> {
    medial: &'a Medial,
    visits: Vec<Visit>,
}

/// A way from one junction of a loop to another.
struct Crossing {
    legs: Vec<CorridorEnd>,
    /// Position on the loop at which it ends.
    last: usize,
}

/// The arm of a junction of a loop that is not part of it.
#[derive(Debug, Clone, Copy)]
struct ThirdArm {
    arm: usize,
    is_on_right: bool,
}

impl<'a> Loop<'a> {
    /// The cheapest one.
    fn shortest(medial: &'a Medial) -> Option<Self> {
        let mut least = f64::INFINITY;
        let mut best: Option<Vec<Visit>> = None;
        // What goes around takes a corridor into another period
        let leaves = |leg: &CorridorEnd| medial.follow(*leg).steps[1] != 0;
        for base in 0..medial.junctions.len() {
            if !medial.junctions[base].arms.iter().any(leaves) {
                continue;
            }
            let Some(turn) = loop_through(medial, base, least) else { continue };
            let visit = |&leg: &CorridorEnd| Visit { junction: medial.start(leg).junction, leg };
            let visits: Vec<Visit> = turn.legs.iter().map(visit).collect();
            let mut met = vec![false; medial.junctions.len()];
            let is_simple =
                visits.iter().all(|visit| !std::mem::replace(&mut met[visit.junction], true));
            if is_simple {
                (least, best) = (turn.cost, Some(visits));
            }
        }
        best.map(|visits| Self { medial, visits })
    }

    fn position_of(&self, junction: usize) -> Option<usize> {
        self.visits.iter().position(|visit| visit.junction == junction)
    }

    fn third_arms(&self) -> Vec<ThirdArm> {
        let n = self.visits.len();
        let third = |(i, visit): (usize, &Visit)| {
            let entered = self.medial.follow(self.visits[(i + n - 1) % n].leg).at.arm;
            let left = self.medial.start(visit.leg).arm;
            // The sides of a triangle are in counter-clockwise order: from one to the next, the
            // third is on the left
            ThirdArm { arm: 3 - entered - left, is_on_right: left == (entered + 2) % 3 }
        };
        self.visits.iter().enumerate().map(third).collect()
    }

    /// The cheapest way from the right of the loop to its left.
    fn crossing(&self) -> Option<Crossing> {
        let (medial, third) = (self.medial, self.third_arms());
        let mut search = Search::new(medial.junctions.len());
        for (visit, third) in self.visits.iter().zip(&third).filter(|(_, t)| t.is_on_right) {
            search.follow_from_loop(medial, medial.junctions[visit.junction].arms[third.arm]);
        }
        loop {
            let found = search.next()?;
            let known = search.reached[found].clone();
            match self.position_of(known.junction) {
                Some(last) if !third[last].is_on_right && known.arm == third[last].arm => {
                    return Some(Crossing { legs: search.legs(found), last });
                }
                Some(_) => {}
                None => {
                    if search.settle(known.junction) {
                        search.follow_all(medial, found);
                    }
                }
            }
        }
    }
}

/// A way once around from a junction.
struct Turn {
    cost: f64,
    legs: Vec<CorridorEnd>,
}

/// The cheapest way from a junction to its image one period up, if it costs less than a limit.
fn loop_through(medial: &Medial, base: usize, limit: f64) -> Option<Turn> {
    let wide = (2 * STRAY + 1) as usize;
    let mut search = Search::new(medial.junctions.len() * wide * wide);
    let state = |junction: usize, steps: Steps| {
        let index = |along: i32| usize::try_from(along + STRAY).ok().filter(|i| *i < wide);
        Some((junction * wide + index(steps[0])?) * wide + index(steps[1])?)
    };
    search.start(base);
    loop {
        let found = search.next()?;
        let known = search.reached[found].clone();
        if known.cost >= limit {
            return None;
        }
        if known.junction == base && known.steps == [0, 1] {
            return Some(Turn { cost: known.cost, legs: search.legs(found) });
        }
        let is_new = state(known.junction, known.steps).is_some_and(|state| search.settle(state));
        if is_new {
            search.follow_all(medial, found);
        }
    }
}
