//! `SaddlePoint` and `Weights`: what a preconditioner has to know of a system beside its matrix.

use super::super::constraints::Term;
use crate::sparse::index::to_u32;
use crate::sparse::{SparseMatrix, Unknowns};

/// What an unknown is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// A component (0, 1, 2) of the velocity at a node.
    Velocity {
        /// The node.
        node: u32,
        /// Along which axis.
        component: u8,
    },
    /// A pressure: its row and column have no entry on the diagonal.
    Pressure {
        /// The node it belongs to.
        node: u32,
    },
    /// A velocity of a body: a row and a column with many entries.
    Rigid {
        /// The body.
        body: u32,
        /// Translations 0, 1, 2 and rotations 3, 4, 5 about the axes.
        mode: u8,
    },
    /// A rate of a coordinate of a body that is not rigid. Six by six they stand for bodies behind all others.
    Rate {
        /// Which six, counted on from the bodies.
        body: u32,
        /// Its place among the six.
        mode: u8,
    },
}

/// What the unknowns of a system are; the same for all matrices of one pattern.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SaddlePoint {
    /// Part of each unknown.
    pub parts: Vec<Part>,
    /// Whether one more pressure is held at zero, because the equations leave a constant open.
    pub has_held_pressure: bool,
}

/// Velocities as sums of those on a coarser level.
#[derive(Debug, Clone, PartialEq)]
pub struct Interpolation {
    /// Start of each unknown in `terms`, and the end of the last.
    starts: Vec<u32>,
    terms: Vec<Term<u32>>,
}

/// Numbers that depend on where the nodes are, on the viscosity and on the time step.
#[derive(Debug)]
pub struct Weights {
    /// Every velocity by those of the coarser level, which stand for themselves: an unknown with one
    /// term, itself with weight one, is on both levels. Rigid velocities have to be.
    pub interpolation: Interpolation,
    /// Approximation of the Schur complement where viscosity dominates: the mass matrix of the
    /// pressures over twice the viscosity. A row for each pressure in the order of the unknowns, and
    /// then one for the pressure that is held, if there is one.
    pub pressure_mass: SparseMatrix,
    /// For each unknown its lumped mass (m^3). Not read of pressures and rigid velocities.
    pub lumped_mass: Vec<f64>,
    /// For each unknown its lumped mass over the mobility of the fluid at the distance to the nearest wall
    /// (N s/m). Not read of pressures and rigid velocities.
    pub wall_drag: Vec<f64>,
    /// What the mass is multiplied by in F: density over time step (kg/m^3/s), zero without inertia.
    pub inertia: f64,
    /// Whether F has convection.
    pub has_convection: bool,
}

impl Weights {
    /// # Panics
    /// When they do not fit the unknowns of a system.
    pub(super) fn check(&self, system: &SaddlePoint) {
        let n = system.parts.len();
        let n_pressures = system.n_pressures() + usize::from(system.has_held_pressure);
        assert_eq!(self.interpolation.n(), n, "a sum for each unknown");
        assert_eq!(self.pressure_mass.n(), n_pressures, "a row for each pressure");
        assert_eq!(self.lumped_mass.len(), n, "a mass for each unknown");
        assert_eq!(self.wall_drag.len(), n, "a drag for each unknown");
    }
}

impl SaddlePoint {
    /// What each unknown is, for a direct solver.
    #[must_use]
    pub fn unknowns(&self) -> Unknowns {
        let mut unknowns = Unknowns::default();
        for (index, part) in self.parts.iter().enumerate() {
            let node = match *part {
                Part::Velocity { node, .. } | Part::Pressure { node } => node,
                Part::Rigid { .. } | Part::Rate { .. } => {
                    unknowns.dense.push(index);
                    0
                }
            };
            unknowns.node.push(node);
            unknowns.is_pressure.push(matches!(part, Part::Pressure { .. }));
        }
        unknowns
    }

    /// Number of pressures that are unknowns.
    #[must_use]
    pub fn n_pressures(&self) -> usize {
        self.parts.iter().filter(|part| matches!(part, Part::Pressure { .. })).count()
    }
}

impl Interpolation {
    /// No unknowns yet.
    #[must_use]
    pub fn with_capacity(n_unknowns: usize) -> Self {
        let mut starts = Vec::with_capacity(n_unknowns + 1);
        starts.push(0);
        Self { starts, terms: Vec::with_capacity(2 * n_unknowns) }
    }

    /// The sum of the next unknown; unknowns may stand in it more than once.
    pub fn push(&mut self, terms: impl IntoIterator<Item = Term<u32>>) {
        self.terms.extend(terms);
        self.starts.push(to_u32(self.terms.len()));
    }

    /// Number of unknowns so far.
    #[must_use]
    pub fn n(&self) -> usize {
        self.starts.len() - 1
    }

    /// The sum of an unknown.
    #[must_use]
    pub fn terms(&self, unknown: usize) -> &[Term<u32>] {
        &self.terms[self.starts[unknown] as usize..self.starts[unknown + 1] as usize]
    }

    /// Whether an unknown is on the coarser level too.
    #[must_use]
    pub fn is_coarse(&self, unknown: usize) -> bool {
        matches!(self.terms(unknown), [term] if term.unknown as usize == unknown)
    }
}
