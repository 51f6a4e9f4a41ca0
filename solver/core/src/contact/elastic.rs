//! `ElasticBodies`: what contact asks of bodies with coordinates, whose surfaces bend as their equations have it.

use std::fmt::Debug;
use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::Gaps;
use crate::body::Pose;

/// The bodies with coordinates of a step. Coordinates and lengths are those of all bodies, one body after the other.
pub trait ElasticBodies: Debug {
    /// The coordinates of each body; none of a rigid one.
    fn ranges(&self) -> &[Range<usize>];

    /// Lengths (m) by which coordinates count as displacements.
    fn lengths(&self) -> &[f64];

    /// The bodies that others are attached to.
    fn bases(&self) -> &[usize];

    /// Puts the ends of bodies that are attached to others where these have them, and bodies where their coordinates have
    /// them, and gives the gaps there; `None` where a body has no shape.
    fn place(&self, poses: &mut [Pose], coordinates: &mut [f64]) -> Option<Box<dyn Gaps>>;

    /// How far a point of each body moves at most between two sets of coordinates (m), zero of rigid ones.
    fn displacement_bounds(&self, from: &[f64], to: &[f64]) -> Vec<f64>;
}

/// Forces within bodies with coordinates beyond those that the mobility knows, which is linear.
pub trait InnerForces {
    /// At these rates of all coordinates, against the rates.
    fn beyond_linear(&self, rates: &[f64]) -> DVector<f64>;

    /// Their derivatives by the rates, n x n.
    fn tangent(&self, rates: &[f64]) -> DMatrix<f64>;
}

/// What a step with contact knows of bodies with coordinates.
#[derive(Clone, Copy)]
pub struct ElasticStep<'a> {
    /// The bodies.
    pub bodies: &'a dyn ElasticBodies,
    /// What the mobility does not know of them.
    pub forces: &'a dyn InnerForces,
    /// Coordinates without velocity: rates add the coefficient of the step times themselves.
    pub unmoved: &'a [f64],
    /// Coordinates before the step.
    pub start: &'a [f64],
    /// Rates without contact.
    pub free_rates: &'a [f64],
}

impl ElasticStep<'_> {
    /// How many coordinates there are.
    #[must_use]
    pub fn n_coordinates(&self) -> usize {
        self.unmoved.len()
    }
}
