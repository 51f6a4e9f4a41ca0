//! `Solution`: values of all raw unknowns: velocities, pressures, velocities of bodies.

use alewife_mesh::Point;
use serde::{Deserialize, Serialize};

use crate::body::{Modes, RigidVector, Twist};
use crate::flow::Fields;
use crate::space::DofLayout;

/// Values of all raw unknowns.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Solution<const D: usize> {
    /// Velocity at the nodes (m/s).
    pub velocity: Vec<Point<D>>,
    /// Pressure at the vertices (Pa).
    pub pressure: Vec<f64>,
    /// Rigid velocities of the bodies.
    pub twists: Vec<Twist>,
    /// Rates of the coordinates of all bodies.
    pub rates: Vec<f64>,
    /// Mean pressure gradient along periodic directions (Pa/m), which is no part of `pressure`.
    pub pressure_gradient: Point<D>,
}

impl<const D: usize> Solution<D> {
    /// Changes the velocities of bodies by what those of two flows differ by.
    pub fn shift_bodies(&mut self, from: &Self, to: &Self) {
        let twists = from.twists.iter().zip(&to.twists);
        for (own, (from, to)) in self.twists.iter_mut().zip(twists) {
            *own = Twist::from_vector(&(own.to_vector() + to.to_vector() - from.to_vector()));
        }
        let rates = from.rates.iter().zip(&to.rates);
        self.rates.iter_mut().zip(rates).for_each(|(own, (from, to))| *own += to - from);
    }

    /// Everything at rest.
    #[must_use]
    pub fn at_rest(layout: &DofLayout<D>) -> Self {
        Self {
            velocity: vec![Point::<D>::zeros(); layout.n_nodes],
            pressure: vec![0.0; layout.n_vertices],
            twists: vec![Twist::default(); layout.n_bodies],
            rates: vec![0.0; layout.n_coordinates],
            pressure_gradient: Point::<D>::zeros(),
        }
    }

    /// From a vector of raw unknowns and no mean pressure gradient, with the rigid motions `modes` of the bodies.
    #[must_use]
    pub fn from_raw(layout: &DofLayout<D>, modes: Modes, raw: &[f64]) -> Self {
        let velocities = raw[..layout.pressures().start].chunks_exact(D);
        let twist = |body: usize| {
            let mut vector = RigidVector::zeros();
            for (position, mode) in modes.iter().enumerate() {
                vector[mode] = raw[layout.rigid(body, position)];
            }
            Twist::from_vector(&vector)
        };
        Self {
            velocity: velocities.map(Point::<D>::from_column_slice).collect(),
            pressure: raw[layout.pressures()].to_vec(),
            twists: (0..layout.n_bodies).map(twist).collect(),
            rates: raw[layout.rate(0)..].to_vec(),
            pressure_gradient: Point::<D>::zeros(),
        }
    }

    /// The point at a part (1) of the way to another one.
    #[must_use]
    pub fn towards(&self, other: &Self, part: f64) -> Self {
        let between = |from: &Point<D>, to: &Point<D>| from + (to - from) * part;
        let velocities = self.velocity.iter().zip(&other.velocity);
        let number = |(from, to): (&f64, &f64)| from + (to - from) * part;
        let pressures = self.pressure.iter().zip(&other.pressure);
        let rates = self.rates.iter().zip(&other.rates);
        let twists = self.twists.iter().zip(&other.twists);
        let twist = |(from, to): (&Twist, &Twist)| {
            let from = from.to_vector();
            Twist::from_vector(&(from + (to.to_vector() - from) * part))
        };
        Self {
            velocity: velocities.map(|(from, to)| between(from, to)).collect(),
            pressure: pressures.map(number).collect(),
            twists: twists.map(twist).collect(),
            rates: rates.map(number).collect(),
            pressure_gradient: between(&self.pressure_gradient, &other.pressure_gradient),
        }
    }

    /// As a vector of raw unknowns, in the order of [`DofLayout`].
    #[must_use]
    pub fn to_raw(&self, modes: Modes) -> Vec<f64> {
        let velocities = self.velocity.iter().flat_map(|velocity| velocity.iter().copied());
        let rigid =
            self.twists.iter().flat_map(|twist| modes.iter().map(|mode| twist.component(mode)));
        let bodies = rigid.chain(self.rates.iter().copied());
        velocities.chain(self.pressure.iter().copied()).chain(bodies).collect()
    }

    /// The fields among the unknowns.
    #[must_use]
    pub fn fields(&self) -> Fields<'_, D> {
        Fields { velocity: &self.velocity, pressure: &self.pressure }
    }

    /// The largest speed of the fluid (m/s).
    #[must_use]
    pub fn top_speed(&self) -> f64 {
        self.velocity.iter().map(|velocity| velocity.norm()).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use alewife_mesh::NodeId;

    use super::*;

    fn check<const D: usize>(modes: Modes) {
        let layout = DofLayout::<D> {
            n_nodes: 5,
            n_vertices: 3,
            n_bodies: 2,
            n_modes: modes.len(),
            n_coordinates: 4,
        };
        let raw: Vec<f64> = (0..layout.n_raw()).map(|i| 0.5 + i as f64).collect();
        let solution = Solution::from_raw(&layout, modes, &raw);
        assert_eq!(solution.to_raw(modes), raw);
        assert_eq!(solution.velocity[2][D - 1], raw[layout.velocity(NodeId::new(2), D - 1)]);
        let last = modes.iter().next_back().unwrap();
        assert_eq!(solution.rates, raw[layout.rate(0)..]);
        assert_eq!(solution.twists[1].component(last), raw[layout.rigid(1, modes.len() - 1)]);
    }

    #[test]
    fn unknowns_go_to_fields_and_back() {
        check::<2>(Modes::PLANAR);
        check::<2>(Modes::AXISYMMETRIC);
        check::<3>(Modes::SPATIAL);
    }
}
