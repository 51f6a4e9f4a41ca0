//! `Cloud`: the particles of one `[[tracer]]`, and what they amount to.

use alewife_mesh::Point;
use serde::{Deserialize, Serialize};

/// What became of a particle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Fate {
    /// It is in the fluid.
    InFluid,
    /// It has left through a side that fluid crosses, and stays where it did.
    Left,
}

/// A particle without size or weight.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Particle<const D: usize> {
    /// Its seed, counted from 0 in the order of the case.
    pub seed: usize,
    /// When it was released (s).
    pub released: f64,
    /// Where it was released (m).
    pub start: Point<D>,
    /// Where it is (m), in the laboratory, continuous across periodic sides.
    pub position: Point<D>,
    /// Velocity of the fluid there (m/s).
    pub velocity: Point<D>,
    /// What is added to its position for where it is in a periodic mesh (m): whole periods.
    pub shift: Point<D>,
    /// The cell it was found in last, where it is sought next.
    pub cell: usize,
    /// Time it has spent in the region (s).
    pub residence: f64,
    /// Whether it is in the region.
    pub is_inside: bool,
    /// What became of it.
    pub fate: Fate,
}

impl<const D: usize> Particle<D> {
    /// Whether the flow carries it on.
    #[must_use]
    pub fn is_in_fluid(&self) -> bool {
        self.fate == Fate::InFluid
    }
}

/// The particles of one `[[tracer]]`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Cloud<const D: usize> {
    /// All of them, those released first in front.
    pub particles: Vec<Particle<D>>,
    /// Releases so far.
    pub releases: u64,
}

/// What the particles of a cloud amount to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tally<const D: usize> {
    /// Particles in the fluid.
    pub count: usize,
    /// Particles that have left.
    pub left: usize,
    /// Particles in the region.
    pub inside: usize,
    /// Mean position of those in the fluid (m).
    pub center: Point<D>,
    /// Variance of their displacements since their release (m2).
    pub dispersion: Point<D>,
    /// Mean time in the region, of all (s).
    pub residence: f64,
}

impl<const D: usize> Cloud<D> {
    /// What they amount to; means of none are not numbers.
    #[must_use]
    pub fn tally(&self) -> Tally<D> {
        let in_fluid = || self.particles.iter().filter(|particle| particle.is_in_fluid());
        let count = in_fluid().count();
        let mean = |of: &dyn Fn(&Particle<D>) -> Point<D>| {
            in_fluid().fold(Point::<D>::zeros(), |sum, one| sum + of(one)) / count as f64
        };
        let drift = mean(&|one| one.position - one.start);
        let squared = |one: &Particle<D>| {
            let away = one.position - one.start - drift;
            away.component_mul(&away)
        };
        let spent: f64 = self.particles.iter().map(|particle| particle.residence).sum();
        Tally {
            count,
            left: self.particles.len() - count,
            inside: in_fluid().filter(|particle| particle.is_inside).count(),
            center: mean(&|one| one.position),
            dispersion: mean(&squared),
            residence: spent / self.particles.len() as f64,
        }
    }
}
