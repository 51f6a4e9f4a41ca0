//! `Search`: the cheapest way along corridors, by Dijkstra's method.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::medial::{Arrival, CorridorEnd, JunctionArm, Medial};
use super::steps::{Steps, sum};

/// What has been reached on the way, and over what.
#[derive(Debug, Clone)]
pub struct Reached {
    pub junction: usize,
    /// The arm it was entered by.
    pub arm: usize,
    pub steps: Steps,
    pub cost: f64,
    before: Option<usize>,
    leg: Option<CorridorEnd>,
}

/// What was reached and not followed yet, the cheapest first, of two as cheap the earlier.
#[derive(Debug, Clone, Copy)]
struct Open {
    cost: f64,
    at: usize,
}

impl Ord for Open {
    fn cmp(&self, other: &Self) -> Ordering {
        other.cost.total_cmp(&self.cost).then(other.at.cmp(&self.at))
    }
}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Open {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Open {}

/// Dijkstra's method.
pub struct Search {
    pub reached: Vec<Reached>,
    open: BinaryHeap<Open>,
    settled: Vec<bool>,
}

impl Search {
    pub fn new(n_states: usize) -> Self {
        Self { reached: Vec::new(), open: BinaryHeap::new(), settled: vec![false; n_states] }
    }

    pub fn start(&mut self, junction: usize) {
        let (steps, cost) = ([0, 0], 0.0);
        self.open.push(Open { cost, at: self.reached.len() });
        self.reached.push(Reached { junction, arm: 3, steps, cost, before: None, leg: None });
    }

    /// Follows a corridor from where nothing has been gone yet.
    pub fn follow_from_loop(&mut self, medial: &Medial, leg: CorridorEnd) {
        self.follow(medial, leg, [0, 0], 0.0, None);
    }

    /// Follows all corridors from a junction that was reached.
    pub fn follow_all(&mut self, medial: &Medial, found: usize) {
        let Reached { junction, steps, cost, .. } = self.reached[found];
        for leg in medial.junctions[junction].arms {
            self.follow(medial, leg, steps, cost, Some(found));
        }
    }

    fn follow(
        &mut self,
        medial: &Medial,
        leg: CorridorEnd,
        steps: Steps,
        cost: f64,
        before: Option<usize>,
    ) {
        let Arrival { at: JunctionArm { junction, arm }, steps: gone } = medial.follow(leg);
        let (steps, cost) = (sum(steps, gone), cost + medial.corridors[leg.corridor].cost);
        self.open.push(Open { cost, at: self.reached.len() });
        self.reached.push(Reached { junction, arm, steps, cost, before, leg: Some(leg) });
    }

    /// The cheapest of what is open.
    pub fn next(&mut self) -> Option<usize> {
        Some(self.open.pop()?.at)
    }

    /// Whether a state is settled for the first time.
    pub fn settle(&mut self, state: usize) -> bool {
        !std::mem::replace(&mut self.settled[state], true)
    }

    /// The corridors that led somewhere, in order.
    pub fn legs(&self, mut at: usize) -> Vec<CorridorEnd> {
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
