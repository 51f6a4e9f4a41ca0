//! `FlexibleEquation`: the equations of motion of a body with coordinates at one time.
//!
//! M dv/dt + f(q, v, t) = Q with dv/dt = rate v + history and q = unmoved + coefficient v: the rows of the system at
//! the rates v of the coordinates, on which the constraints gather the load Q of the fluid.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::turning_base::TurningBase;
use crate::structure::{Flexible, Tangents};

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
    /// Time (s) after which inner forces are taken, to first order, where the coordinates themselves do not change.
    pub relaxation: f64,
    /// Whether forces without rates are left out.
    pub is_unloaded: bool,
    /// An end that turns with the body it is clamped to.
    pub base: Option<TurningBase>,
    /// When (s).
    pub time: f64,
}

/// A body with coordinates at rates of these.
struct BodyAtRates {
    /// Coordinates that are linear in the rates, and the rates.
    linear: [DVector<f64>; 2],
    /// Those with its end as it is turned.
    turned: [DVector<f64>; 2],
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
            relaxation: 0.0,
            is_unloaded: false,
            base: None,
            time,
        }
    }

    /// The body as it is without rates.
    fn at_rest(&self) -> [DVector<f64>; 2] {
        [self.unmoved.clone(), DVector::zeros(self.unmoved.len())]
    }

    /// How inner forces change with the rates until they are taken; `None` where that is at once.
    fn relaxing(&self) -> Option<DMatrix<f64>> {
        let stiffness = || self.tangents(&self.at_rest()).stiffness;
        (self.relaxation > 0.0).then(|| stiffness() * self.relaxation)
    }

    /// The body at these rates of all coordinates.
    fn at(&self, rates: &[f64]) -> BodyAtRates {
        let own = &rates[self.first..self.first + self.unmoved.len()];
        let velocities = DVector::from_column_slice(own);
        let coordinates = &self.unmoved + &velocities * self.coefficient;
        let linear = [coordinates, velocities];
        let turned = match &self.base {
            Some(base) => [base.coordinates(&linear[0]), base.rates(&linear[0], &linear[1])],
            None => linear.clone(),
        };
        BodyAtRates { linear, turned }
    }

    fn forces(&self, [coordinates, velocities]: &[DVector<f64>; 2]) -> DVector<f64> {
        self.body.forces(coordinates, velocities, self.time)
    }

    fn tangents(&self, [coordinates, velocities]: &[DVector<f64>; 2]) -> Tangents {
        self.body.tangents(coordinates, velocities, self.time)
    }

    /// What it lacks to balance the loads of the fluid at these rates of all coordinates.
    pub(super) fn residual(&self, rates: &[f64]) -> DVector<f64> {
        let BodyAtRates { linear, turned } = self.at(rates);
        let forces = self.forces(&turned);
        let mut forces = match &self.base {
            Some(base) => base.forces(&linear[0], &forces),
            None => forces,
        };
        let [_, velocities] = linear;
        if let Some(relaxing) = self.relaxing() {
            forces += relaxing * &velocities;
        }
        if self.is_unloaded {
            forces -= self.forces(&self.at_rest());
        }
        self.body.mass() * (velocities * self.rate + &self.history) + forces
    }

    /// The rounding of what it lacks: inner forces are differences of large numbers where it is stiff.
    pub(super) fn rounding(&self, rates: &[f64]) -> DVector<f64> {
        let turned = self.at(rates).turned;
        let stiffness = self.tangents(&turned).stiffness;
        stiffness.abs() * turned[0].abs() * (ROUNDINGS * f64::EPSILON)
    }

    /// How that depends on the rates.
    pub(super) fn tangent(&self, rates: &[f64]) -> DMatrix<f64> {
        let BodyAtRates { linear, turned } = self.at(rates);
        let Tangents { stiffness, damping } = self.tangents(&turned);
        let mut inertia = self.body.mass() * self.rate;
        if let Some(relaxing) = self.relaxing() {
            inertia += relaxing;
        }
        let Some(base) = &self.base else {
            return inertia + stiffness * self.coefficient + damping;
        };
        let forces = self.forces(&turned);
        let coefficient = self.coefficient;
        inertia + base.tangent(linear.each_ref(), &forces, [&stiffness, &damping], coefficient)
    }
}
