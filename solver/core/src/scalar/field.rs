//! `Scalar`: what is given of a scalar; `ScalarField`: what evolves of it.

use alewife_mesh::Point;
use serde::{Deserialize, Serialize};

use crate::time::Bdf;

/// A number as a function of place and time (m, s).
pub type Profile<const D: usize> = Box<dyn Fn(&Point<D>, f64) -> f64 + Send + Sync>;

/// What holds for a scalar on a boundary; without any of it nothing diffuses through.
pub enum Condition<const D: usize> {
    /// Its value.
    Value(Profile<D>),
    /// What diffuses into the fluid for each area (m/s times its unit).
    Flux(Profile<D>),
    /// Uptake k (c - c0): what diffuses out of the fluid for each area.
    Uptake {
        /// The rate k (m/s).
        rate: f64,
        /// The value c0 at which nothing is taken up.
        outside: Profile<D>,
    },
}

/// A scalar as a case gives it.
pub struct Scalar<const D: usize> {
    /// Name in the case.
    pub name: String,
    /// Diffusivity (m2/s).
    pub diffusivity: f64,
    /// What holds on each boundary of the mesh.
    pub conditions: Vec<Option<Condition<D>>>,
    /// What is made in the fluid for each volume (1/s times its unit).
    pub source: Option<Profile<D>>,
    /// Its values at the start.
    pub initial: Profile<D>,
    /// Its value on bodies less that far away, and the length (m), of Sherwood numbers.
    pub scale: Option<[f64; 2]>,
}

/// A level of a scalar after a step.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// Values at the nodes.
    pub values: Vec<f64>,
    /// What comes into the fluid through each boundary, by diffusion and with the fluid (m3/s; m2/s planar).
    pub fluxes: Vec<f64>,
    /// What is made in the fluid (m3/s; m2/s planar).
    pub source: f64,
}

/// A scalar at two levels, and what was added to it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ScalarField {
    /// Values at the nodes at present.
    pub now: Vec<f64>,
    /// Values at the same nodes one step before.
    pub previous: Vec<f64>,
    /// What comes into the fluid through each boundary (m3/s; m2/s planar).
    pub fluxes: Vec<f64>,
    /// What is made in the fluid (m3/s; m2/s planar).
    pub source: f64,
    /// The amount at the start (m3; m2 planar).
    pub initial: f64,
    /// What was added since the start, by the backward differences of the steps (m3; m2 planar).
    pub added: f64,
    /// The same one step before.
    pub added_before: f64,
}

impl ScalarField {
    /// With values at the nodes and an amount (m3; m2 planar), where there are so many boundaries.
    #[must_use]
    pub fn at_start(values: Vec<f64>, amount: f64, n_boundaries: usize) -> Self {
        Self {
            previous: values.clone(),
            now: values,
            fluxes: vec![0.0; n_boundaries],
            source: 0.0,
            initial: amount,
            added: 0.0,
            added_before: 0.0,
        }
    }

    /// Whether it has a value for each node, and a flux for each boundary.
    #[must_use]
    pub fn is_whole(&self, n_nodes: usize, n_boundaries: usize) -> bool {
        [self.now.len(), self.previous.len()] == [n_nodes; 2] && self.fluxes.len() == n_boundaries
    }

    /// Takes a level over, after a step by these differences; none of a steady solution.
    pub fn accept(&mut self, level: Level, bdf: Option<&Bdf>) {
        let Level { values, fluxes, source } = level;
        self.previous = std::mem::replace(&mut self.now, values);
        (self.fluxes, self.source) = (fluxes, source);
        if let Some(bdf) = bdf {
            let rate = self.fluxes.iter().sum::<f64>() + source;
            let added = bdf.integrate(rate, self.added, self.added_before);
            self.added_before = std::mem::replace(&mut self.added, added);
        }
    }
}
