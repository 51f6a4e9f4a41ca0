//! `MeanFlow`: what drives the fluid along periodic directions.

use alewife_mesh::Point;

use super::in_time::TimeValue;

/// What is given along a coordinate.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum MeanFlowAlong {
    /// Nothing: there is no mean pressure gradient, and the mean velocity is a result.
    #[default]
    Nothing,
    /// The mean pressure gradient (Pa/m).
    PressureGradient(f64),
    /// The mean velocity of fluid and bodies (m/s); the pressure gradient is a result.
    Velocity(f64),
}

/// What drives the fluid along periodic directions.
pub struct MeanFlow<const D: usize> {
    /// What is given along each coordinate when the factor is one.
    pub along: [MeanFlowAlong; D],
    /// Force per volume of fluid (N/m3) then.
    pub body_force: Point<D>,
    /// Factor in time.
    pub factor: TimeValue,
}

/// The same at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeanFlowAt<const D: usize> {
    /// The time (s), at which other loads on the fluid are taken, too.
    pub time: f64,
    /// What is given along each coordinate.
    pub along: [MeanFlowAlong; D],
    /// Force per volume of fluid (N/m3).
    pub body_force: Point<D>,
}

impl<const D: usize> MeanFlow<D> {
    /// What is given at a time (s).
    #[must_use]
    pub fn at(&self, time: f64) -> MeanFlowAt<D> {
        let factor = (self.factor)(time);
        let along = self.along.map(|along| match along {
            MeanFlowAlong::Nothing => MeanFlowAlong::Nothing,
            MeanFlowAlong::PressureGradient(value) => {
                MeanFlowAlong::PressureGradient(factor * value)
            }
            MeanFlowAlong::Velocity(value) => MeanFlowAlong::Velocity(factor * value),
        });
        MeanFlowAt { time, along, body_force: self.body_force * factor }
    }
}

impl<const D: usize> Default for MeanFlowAt<D> {
    fn default() -> Self {
        Self { time: 0.0, along: [MeanFlowAlong::Nothing; D], body_force: Point::<D>::zeros() }
    }
}

impl<const D: usize> MeanFlowAt<D> {
    /// The mean velocity along a coordinate (m/s), where it is given.
    #[must_use]
    pub fn velocity(&self, axis: usize) -> Option<f64> {
        match self.along[axis] {
            MeanFlowAlong::Velocity(value) => Some(value),
            _ => None,
        }
    }
}
