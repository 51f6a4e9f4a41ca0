//! `Grid`: Gauss points along a midline, and integrals up to each of them and to the material points.

use alewife_mesh::{GaussRule, Profile, Station};

use super::number::Number;
use alewife_mesh::whole;

/// Gauss points of a panel.
const POINTS: usize = 6;

/// Panels along the body at least.
const PANELS: f64 = 40.0;

/// Gauss points on panels of a midline, on each of which it is smooth.
#[derive(Debug, Clone)]
pub struct Grid {
    /// Gauss points from the head on.
    pub nodes: Vec<Node>,
    /// Material points of the upper side from the head on.
    pub stations: Vec<Station>,
    /// Weights of the integral from the start of a panel to its points, and over all of it.
    within: Vec<Vec<f64>>,
    whole: Vec<f64>,
    /// Of each station.
    partial: Vec<PartialPanel>,
}

/// A Gauss point.
#[derive(Debug, Clone, Copy)]
pub struct Node {
    /// Distance from the head along the midline (m).
    pub along: f64,
    /// Half width (m).
    pub half_width: f64,
    /// Weight of an integral along the midline (m).
    pub weight: f64,
    /// Derivative of `along` by the parameter of the panel in [0, 1] (m).
    rate: f64,
}

/// Integrals along the midline from the head on.
#[derive(Debug, Clone)]
pub struct Integrals<D> {
    /// Up to each node.
    pub nodes: Vec<D>,
    /// Up to each station.
    pub stations: Vec<D>,
}

/// A range of the parameter of one piece of a profile.
#[derive(Debug, Clone, Copy)]
struct Panel {
    piece: usize,
    from: f64,
    step: f64,
}

/// The panel a station lies on, and the weights of the integral from its start to the station.
#[derive(Debug, Clone)]
struct PartialPanel {
    panel: usize,
    weights: Vec<f64>,
}

impl Grid {
    /// Grid of a profile; panels end at `discontinuities`, distances along the midline (m).
    pub fn new(profile: &Profile, discontinuities: &[f64]) -> Self {
        let rule = GaussRule::new(POINTS);
        let panels = panels(profile, discontinuities);
        let mut nodes = Vec::new();
        for Panel { piece, from, step } in &panels {
            for (x, weight) in rule.points.iter().zip(&rule.weights) {
                let at = profile.at(*piece, from + step * x);
                let rate = at.rate * step;
                let (along, half_width) = (at.along, at.half_width);
                nodes.push(Node { along, half_width, weight: weight * rate, rate });
            }
        }
        let stations = profile.stations();
        let partial = stations.iter().map(|station| {
            let is_in = |panel: &Panel| {
                let end = panel.from + panel.step * (1.0 + 1e-12);
                panel.piece == station.piece && station.parameter <= end
            };
            let panel = panels.iter().position(is_in).unwrap_or(panels.len() - 1);
            let Panel { from, step, .. } = panels[panel];
            PartialPanel { panel, weights: rule.up_to((station.parameter - from) / step) }
        });
        let partial = partial.collect();
        let within = rule.points.iter().map(|x| rule.up_to(*x)).collect();
        Self { nodes, stations, within, whole: rule.weights, partial }
    }

    /// Integrals along the midline, from its head to each node and to each station, of what is
    /// given at the nodes (per m).
    pub fn integrate<D: Number>(&self, values: &[D], start: D) -> Integrals<D> {
        let mut at_nodes = Vec::with_capacity(values.len());
        let mut starts = Vec::with_capacity(values.len() / POINTS);
        let mut at_start = start;
        for (values, nodes) in values.chunks(POINTS).zip(self.nodes.chunks(POINTS)) {
            starts.push(at_start);
            for row in &self.within {
                at_nodes.push(at_start + weighted(row, values, nodes));
            }
            at_start += weighted(&self.whole, values, nodes);
        }
        let at_stations = self.partial.iter().map(|PartialPanel { panel, weights }| {
            let range = panel * POINTS..(panel + 1) * POINTS;
            starts[*panel] + weighted(weights, &values[range.clone()], &self.nodes[range])
        });
        Integrals { stations: at_stations.collect(), nodes: at_nodes }
    }

    /// Solution of dx/ds = f(s, x) with x = `start` at the head, at all nodes, by collocation at the
    /// Gauss points; Picard's iteration converges within a panel like a power over its factorial.
    pub fn solve<D: Number>(&self, start: D, f: impl Fn(f64, D) -> D) -> Vec<D> {
        const ITERATIONS: usize = 12;
        let mut at_nodes = Vec::with_capacity(self.nodes.len());
        let mut at_start = start;
        for nodes in self.nodes.chunks(POINTS) {
            let slope = f(nodes[0].along, at_start);
            let mut values: Vec<D> = nodes.iter().map(|_| slope).collect();
            let mut iterate = vec![at_start; POINTS];
            for _ in 0..ITERATIONS {
                for (x, row) in iterate.iter_mut().zip(&self.within) {
                    *x = at_start + weighted(row, &values, nodes);
                }
                for (value, (x, node)) in values.iter_mut().zip(iterate.iter().zip(nodes)) {
                    *value = f(node.along, *x);
                }
            }
            at_nodes.extend(iterate);
            at_start += weighted(&self.whole, &values, nodes);
        }
        at_nodes
    }
}

/// Panels of nearly equal length, which end where pieces of the profile do and at discontinuities.
fn panels(profile: &Profile, discontinuities: &[f64]) -> Vec<Panel> {
    let longest = profile.length() / PANELS;
    let mut panels = Vec::new();
    for piece in 0..profile.n_pieces() {
        let (start, end) = (profile.at(piece, 0.0).along, profile.at(piece, 1.0).along);
        let mut ends = vec![0.0];
        let inside = discontinuities.iter().filter(|at| **at > start && **at < end);
        ends.extend(inside.map(|at| profile.find(*at).parameter));
        ends.push(1.0);
        for pair in ends.windows(2) {
            let along = [0, 1].map(|i| profile.at(piece, pair[i]).along);
            let count = ((along[1] - along[0]) / longest).ceil().max(4.0);
            let step = (pair[1] - pair[0]) / count;
            panels.extend((0..whole(count)).map(|i| {
                let from = pair[0] + step * i as f64;
                Panel { piece, from, step }
            }));
        }
    }
    panels
}

/// Integral over a part of a panel, by weights for the points of the rule.
fn weighted<D: Number>(row: &[f64], values: &[D], nodes: &[Node]) -> D {
    let mut sum = D::from(0.0);
    for ((weight, value), node) in row.iter().zip(values).zip(nodes) {
        sum += *value * (weight * node.rate);
    }
    sum
}
