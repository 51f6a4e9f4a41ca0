//! The cheapest lines along which a periodic domain can be cut open.

use super::medial::Medial;
use super::steps::{Steps, displacement, sum};
use super::straighten::Network;
use crate::{Domain, Point};

/// Periods a way around may stray along each direction.
const STRAY: i32 = 3;

/// A corridor followed from one of its ends.
type Leg = (usize, usize);

/// A loop once around along y and a way across, which end on each other: together they bound a cell
/// that holds all bodies. `None` where there is none.
pub fn theta(medial: &Medial) -> Option<Network> {
    let around = shortest_loop(medial)?;
    let on_loop = |junction: usize| around.iter().position(|visit| visit.junction == junction);
    // Which junctions have their third arm on the right of the loop
    let n = around.len();
    let mut third = vec![(0, false); n];
    for (i, visit) in around.iter().enumerate() {
        let (corridor, end) = around[(i + n - 1) % n].leg;
        let entered = medial.corridors[corridor].ends[1 - end].1;
        let (corridor, end) = visit.leg;
        let left = medial.corridors[corridor].ends[end].1;
        // The sides of a triangle are in counter-clockwise order: from one to the next, the third
        // is on the left
        third[i] = (3 - entered - left, left == (entered + 2) % 3);
    }
    // From the right of the loop to its left
    let mut search = Search::new(medial.junctions.len());
    for (i, visit) in around.iter().enumerate() {
        if third[i].1 {
            let leg = medial.junctions[visit.junction].arms[third[i].0];
            search.offer(medial, (visit.junction, [0, 0], 0.0, None), leg);
        }
    }
    let (last, legs) = loop {
        let found = search.next()?;
        let known = search.reached[found].clone();
        match on_loop(known.junction) {
            Some(i) if !third[i].1 && known.arm == third[i].0 => break (i, search.legs(found)),
            Some(_) => {}
            None => {
                if search.settle(known.junction) {
                    for leg in medial.junctions[known.junction].arms {
                        let from = (known.junction, known.steps, known.cost, Some(found));
                        search.offer(medial, from, leg);
                    }
                }
            }
        }
    };
    let first = {
        let (corridor, end) = *legs.first()?;
        on_loop(medial.corridors[corridor].ends[end].0)?
    };
    // Along the loop from where the way across starts
    let mut steps = [0, 0];
    let mut lines = [Vec::new(), Vec::new()];
    let mut steps_at_last = None;
    for k in 0..n {
        let visit = &around[(first + k) % n];
        if (first + k) % n == last {
            steps_at_last = Some(steps);
        }
        let line = &mut lines[usize::from(steps_at_last.is_some())];
        line.push(medial.place(visit.junction, steps));
        line.extend(medial.way(visit.leg.0, visit.leg.1, steps));
        steps = sum(steps, medial.follow(visit.leg.0, visit.leg.1).2);
    }
    let steps_at_last = steps_at_last?;
    let [mut before, mut after] = lines;
    before.push(*after.first()?);
    after.push(medial.place(around[first].junction, steps));
    let along = steps;
    let mut across = Vec::new();
    steps = [0, 0];
    for &(corridor, end) in &legs {
        let from = medial.corridors[corridor].ends[end].0;
        across.push(medial.place(from, steps));
        across.extend(medial.way(corridor, end, steps));
        steps = sum(steps, medial.follow(corridor, end).2);
    }
    across.push(medial.place(around[last].junction, steps));
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
        for leg in medial.junctions[known.junction].arms {
            let from = (known.junction, known.steps, known.cost, Some(found));
            search.offer(medial, from, leg);
        }
    };
    let legs = search.legs(last);
    let start = match legs.first() {
        Some(&(corridor, end)) => medial.corridors[corridor].ends[end].0,
        None => search.reached[last].junction,
    };
    let on_wall = |point: Point<2>, wall: usize| {
        let mut point = point;
        point[wall_axis] = [min, max][wall][wall_axis];
        point
    };
    let mut line = vec![on_wall(medial.junctions[start].walls[0]?, 0)];
    let mut steps = [0, 0];
    for &(corridor, end) in &legs {
        line.push(medial.place(medial.corridors[corridor].ends[end].0, steps));
        line.extend(medial.way(corridor, end, steps));
        steps = sum(steps, medial.follow(corridor, end).2);
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
    leg: Leg,
}

/// The cheapest loop once around along y that meets no junction twice.
fn shortest_loop(medial: &Medial) -> Option<Vec<Visit>> {
    let mut best: Option<(f64, Vec<Visit>)> = None;
    for base in 0..medial.junctions.len() {
        let limit = best.as_ref().map_or(f64::INFINITY, |best| best.0);
        let Some((cost, legs)) = loop_through(medial, base, limit) else { continue };
        let visits: Vec<Visit> = legs
            .iter()
            .map(|&leg| Visit { junction: medial.corridors[leg.0].ends[leg.1].0, leg })
            .collect();
        let mut met = vec![false; medial.junctions.len()];
        let is_simple =
            visits.iter().all(|visit| !std::mem::replace(&mut met[visit.junction], true));
        if is_simple {
            best = Some((cost, visits));
        }
    }
    best.map(|best| best.1)
}

/// The cheapest way from a junction to its image one period up, if it costs less than a limit.
fn loop_through(medial: &Medial, base: usize, limit: f64) -> Option<(f64, Vec<Leg>)> {
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
            return Some((known.cost, search.legs(found)));
        }
        let is_new = state(known.junction, known.steps).is_some_and(|state| search.settle(state));
        if is_new {
            for leg in medial.junctions[known.junction].arms {
                let from = (known.junction, known.steps, known.cost, Some(found));
                search.offer(medial, from, leg);
            }
        }
    }
}

/// What has been reached on the way, and over what.
#[derive(Debug, Clone)]
struct Reached {
    junction: usize,
    /// The arm it was entered by.
    arm: usize,
    steps: Steps,
    cost: f64,
    before: Option<usize>,
    leg: Option<Leg>,
}

/// Dijkstra's method; few enough junctions for a plain list.
struct Search {
    reached: Vec<Reached>,
    open: Vec<usize>,
    settled: Vec<bool>,
}

impl Search {
    fn new(n_states: usize) -> Self {
        Self { reached: Vec::new(), open: Vec::new(), settled: vec![false; n_states] }
    }

    fn start(&mut self, junction: usize) {
        self.open.push(self.reached.len());
        let (steps, cost) = ([0, 0], 0.0);
        self.reached.push(Reached { junction, arm: 3, steps, cost, before: None, leg: None });
    }

    /// Follows a corridor from a junction that was reached.
    fn offer(
        &mut self,
        medial: &Medial,
        (_, steps, cost, before): (usize, Steps, f64, Option<usize>),
        leg: Leg,
    ) {
        let (junction, arm, gone) = medial.follow(leg.0, leg.1);
        let (steps, cost) = (sum(steps, gone), cost + medial.corridors[leg.0].cost);
        self.open.push(self.reached.len());
        self.reached.push(Reached { junction, arm, steps, cost, before, leg: Some(leg) });
    }

    /// The cheapest of what is open.
    fn next(&mut self) -> Option<usize> {
        let cost = |at: &usize| self.reached[*at].cost;
        let order = |a: &(usize, &usize), b: &(usize, &usize)| cost(a.1).total_cmp(&cost(b.1));
        let (place, _) = self.open.iter().enumerate().min_by(order)?;
        Some(self.open.swap_remove(place))
    }

    /// Whether a state is settled for the first time.
    fn settle(&mut self, state: usize) -> bool {
        !std::mem::replace(&mut self.settled[state], true)
    }

    /// The corridors that led somewhere, in order.
    fn legs(&self, mut at: usize) -> Vec<Leg> {
        let mut legs = Vec::new();
        loop {
            legs.extend(self.reached[at].leg);
            match self.reached[at].before {
                Some(before) => at = before,
                None => break,
            }
        }
        legs.reverse();
        legs
    }
}
