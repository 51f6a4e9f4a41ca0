//! `FlexibleEquation`: the equations of motion of a body with coordinates at one time.
//!
//! M dv/dt + f(q, v, t) = Q with dv/dt = rate v + history and q = unmoved + coefficient v: the rows of the system at
//! the rates v of the coordinates, on which the constraints gather the load Q of the fluid.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use crate::structure::Flexible;

/// Roundings of a number that inner forces are made of.
const ROUNDINGS: f64 = 16.0;

/// The equations of the coordinates of one body.
#[derive(Debug, Clone)]
pub struct FlexibleEquation {
    /// Its first coordinate, among those of all bodies.
    pub first: usize,
    /// What has the coordinates.
    pub body: Arc<dyn Flexible>,
    /// Factor of the new velocities in their time derivatives (1/s), 0 when steady.
    pub rate: f64,
    /// Older part of the time derivatives.
    pub history: DVector<f64>,
    /// Coordinates without velocity.
    pub unmoved: DVector<f64>,
    /// Change of the coordinates by the velocities (s).
    pub coefficient: f64,
    /// When (s).
    pub time: f64,
}

impl FlexibleEquation {
    /// A body that stays at coordinates at a time (s), without acceleration.
    #[must_use]
    pub fn steady(first: usize, body: &Arc<dyn Flexible>, coordinates: &[f64], time: f64) -> Self {
        Self {
            first,
            body: Arc::clone(body),
            rate: 0.0,
            history: DVector::zeros(coordinates.len()),
            unmoved: DVector::from_column_slice(coordinates),
            coefficient: 0.0,
            time,
        }
    }

    /// The rates of its coordinates among those of all bodies.
    fn own(&self, rates: &[f64]) -> DVector<f64> {
        DVector::from_column_slice(&rates[self.first..self.first + self.unmoved.len()])
    }

    /// What it lacks to balance the loads of the fluid at these rates of all coordinates.
    pub(super) fn residual(&self, rates: &[f64]) -> DVector<f64> {
        let velocities = self.own(rates);
        let coordinates = &self.unmoved + &velocities * self.coefficient;
        let forces = self.body.forces(&coordinates, &velocities, self.time);
        self.body.mass() * (velocities * self.rate + &self.history) + forces
    }

    /// The rounding of what it lacks: inner forces are differences of large numbers where it is stiff.
    pub(super) fn rounding(&self, rates: &[f64]) -> DVector<f64> {
        let velocities = self.own(rates);
        let coordinates = &self.unmoved + &velocities * self.coefficient;
        let stiffness = self.body.tangents(&coordinates, &velocities, self.time).stiffness;
        stiffness.abs() * coordinates.abs() * (ROUNDINGS * f64::EPSILON)
    }

    /// How that depends on the rates.
    pub(super) fn tangent(&self, rates: &[f64]) -> DMatrix<f64> {
        let velocities = self.own(rates);
        let coordinates = &self.unmoved + &velocities * self.coefficient;
        let tangents = self.body.tangents(&coordinates, &velocities, self.time);
        let stiffness = tangents.stiffness * self.coefficient;
        self.body.mass() * self.rate + stiffness + tangents.damping
    }
}
