//! `Pose`: how places move with the unknowns of rigid parts in a state, to first and to second order.

use alewife_mesh::Point;
use nalgebra::{Matrix3, Rotation2, Rotation3, Vector3};

use super::ties::Ties;
use crate::solid::pattern::Pattern;

/// How much of an unknown moves a component.
#[derive(Debug, Clone, Copy)]
struct Share {
    unknown: usize,
    weight: f64,
}

/// Rigid parts in a state.
#[derive(Debug, Clone)]
pub(in crate::solid) struct Pose<'a, const D: usize> {
    ties: &'a Ties,
    places: &'a [f64],
    middles: Vec<Point<D>>,
    /// By component; empty where it is not tied.
    shares: Vec<Vec<Share>>,
}

/// A vector of the plane or of space as one of space.
fn in_space<const D: usize>(vector: &Point<D>) -> Vector3<f64> {
    Vector3::from_fn(|i, _| if i < D { vector[i] } else { 0.0 })
}

/// Axes of turning: of the plane the third one.
fn axes(d: usize) -> std::ops::Range<usize> {
    if d == 2 { 2..3 } else { 0..3 }
}

impl<'a, const D: usize> Pose<'a, D> {
    /// That of a state.
    pub(in crate::solid) fn new(ties: &'a Ties, places: &'a [f64]) -> Self {
        let mut pose =
            Self { ties, places, middles: Vec::new(), shares: vec![Vec::new(); places.len()] };
        for (part, nodes) in ties.parts.iter().enumerate() {
            let sum = nodes.iter().map(|node| pose.at(*node)).sum::<Point<D>>();
            pose.middles.push(sum / nodes.len() as f64);
            let first = ties.unknowns(part).start;
            for node in nodes {
                let arm = in_space(&pose.arm(part, *node));
                for axis in 0..D.min(ties.n_each) {
                    let shares = &mut pose.shares[D * node + axis];
                    shares.push(Share { unknown: first + axis, weight: 1.0 });
                    if ties.n_each == 1 {
                        continue;
                    }
                    for (k, turned) in axes(D).enumerate() {
                        let weight = Vector3::ith(turned, 1.0).cross(&arm)[axis] / ties.sizes[part];
                        shares.push(Share { unknown: first + D + k, weight });
                    }
                }
            }
        }
        pose
    }

    fn at(&self, node: usize) -> Point<D> {
        Point::from_column_slice(&self.places[D * node..D * (node + 1)])
    }

    fn arm(&self, part: usize, node: usize) -> Point<D> {
        self.at(node) - self.middles[part]
    }

    /// Adds what a list of all components is along the unknowns of the parts: forces and torques of forces.
    pub(in crate::solid) fn add_free(&self, all: &[f64], free: &mut [f64]) {
        for (value, shares) in all.iter().zip(&self.shares) {
            shares.iter().for_each(|share| free[share.unknown] += share.weight * value);
        }
    }

    /// Adds how all components move with the unknowns of the parts, to first order.
    pub(in crate::solid) fn add_all(&self, free: &[f64], all: &mut [f64]) {
        for (value, shares) in all.iter_mut().zip(&self.shares) {
            *value += shares.iter().map(|share| share.weight * free[share.unknown]).sum::<f64>();
        }
    }

    /// Puts the nodes of all parts where these unknowns move them, in full.
    pub(in crate::solid) fn place(&self, free: &[f64], places: &mut [f64]) {
        for (part, nodes) in self.ties.parts.iter().enumerate() {
            let own = &free[self.ties.unknowns(part)];
            let n_ways = D.min(self.ties.n_each);
            let way: Point<D> = Point::from_fn(|i, _| if i < n_ways { own[i] } else { 0.0 });
            for node in nodes {
                let arm = self.arm(part, *node);
                let to = self.middles[part] + way + self.turned(part, own, &arm);
                places[D * node..D * (node + 1)].copy_from_slice(to.as_slice());
            }
        }
    }

    fn turned(&self, part: usize, own: &[f64], arm: &Point<D>) -> Point<D> {
        let size = self.ties.sizes[part];
        let arm = in_space(arm);
        let turned = match own.len() {
            1 => arm,
            3 => {
                let flat = Rotation2::new(own[2] / size) * arm.xy();
                Vector3::new(flat[0], flat[1], 0.0)
            }
            _ => Rotation3::new(Vector3::new(own[3], own[4], own[5]) / size) * arm,
        };
        Point::from_fn(|i, _| turned[i])
    }

    /// The unknowns of the parts whose rates are nearest to these velocities (m/s) of all components.
    pub(in crate::solid) fn rates(&self, velocities: &[f64]) -> Vec<f64> {
        let mut rates = vec![0.0; self.ties.n_unknowns()];
        for (part, nodes) in self.ties.parts.iter().enumerate() {
            let first = self.ties.unknowns(part).start;
            let velocity =
                |node: usize| Point::<D>::from_column_slice(&velocities[D * node..D * (node + 1)]);
            let mean = nodes.iter().map(|n| velocity(*n)).sum::<Point<D>>() / nodes.len() as f64;
            (0..D.min(self.ties.n_each)).for_each(|i| rates[first + i] = mean[i]);
            if self.ties.n_each == 1 {
                continue;
            }
            let (mut momentum, mut inertia) = (Vector3::zeros(), Matrix3::zeros());
            for node in nodes {
                let arm = in_space(&self.arm(part, *node));
                momentum += arm.cross(&in_space(&velocity(*node)));
                inertia += Matrix3::identity() * arm.norm_squared() - arm * arm.transpose();
            }
            let spin =
                inertia.try_inverse().map_or_else(Vector3::zeros, |inverse| inverse * momentum);
            for (k, axis) in axes(D).enumerate() {
                rates[first + D + k] = spin[axis] * self.ties.sizes[part];
            }
        }
        rates
    }

    /// Adds an entry of a symmetric matrix of all components, and its mirror, where one of them is tied.
    pub(in crate::solid) fn add_entry(
        &self,
        pattern: &Pattern,
        [one, other]: [usize; 2],
        value: f64,
        values: &mut [f64],
    ) {
        let tied = |component: usize| self.shares.get(component).filter(|all| !all.is_empty());
        if tied(one).is_none() && tied(other).is_none() {
            return;
        }
        let shares = |component: usize| -> Vec<Share> {
            let own = pattern.unknown(component);
            let free = || own.map(|unknown| Share { unknown, weight: 1.0 }).into_iter().collect();
            tied(component).cloned().unwrap_or_else(free)
        };
        let (left, right) = (shares(one), shares(other));
        for a in &left {
            for b in &right {
                let part = a.weight * b.weight * value;
                let factor = match (one == other, a.unknown == b.unknown) {
                    // Of one component each pair of unknowns comes twice
                    (true, _) if a.unknown < b.unknown => continue,
                    (false, true) => 2.0,
                    _ => 1.0,
                };
                pattern.add(pattern.entry(a.unknown, b.unknown), values, factor * part);
            }
        }
    }

    /// Adds the second derivatives of the work of forces on all components by the angles of the parts.
    pub(in crate::solid) fn add_turning(
        &self,
        pattern: &Pattern,
        forces: &[f64],
        values: &mut [f64],
    ) {
        if self.ties.n_each == 1 {
            return;
        }
        for (part, nodes) in self.ties.parts.iter().enumerate() {
            let mut moment = Matrix3::zeros();
            for node in nodes {
                let force = Point::<D>::from_column_slice(&forces[D * node..D * (node + 1)]);
                moment += in_space(&force) * in_space(&self.arm(part, *node)).transpose();
            }
            let size = self.ties.sizes[part];
            let second = ((moment + moment.transpose()) * 0.5
                - Matrix3::identity() * moment.trace())
                / (size * size);
            let first = self.ties.unknowns(part).start + D;
            for (k, i) in axes(D).enumerate() {
                for (l, j) in axes(D).enumerate().take(k + 1) {
                    let place = pattern.entry(first + k, first + l);
                    pattern.add(place, values, second[(i, j)]);
                }
            }
        }
    }
}
