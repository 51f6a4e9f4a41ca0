//! `DrySystem`: a structure with its loads and what holds it.

use std::fmt;

use nalgebra::{DMatrix, DVector};

use super::error::DryError;
use super::level::Level;
use super::newton::{ROUNDING, Search, newton};
use crate::structure::{Held, Load, Structure, Tangents};

/// Number of times the way to an equilibrium is halved where Newton's method does not converge.
const HALVINGS: u32 = 8;

/// A structure with its loads and what holds it.
pub struct DrySystem<'a> {
    structure: &'a dyn Structure,
    loads: Vec<&'a dyn Load>,
    held: Box<dyn Fn(f64) -> Vec<Held> + 'a>,
}

impl fmt::Debug for DrySystem<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("DrySystem").field("loads", &self.loads.len()).finish_non_exhaustive()
    }
}

impl<'a> DrySystem<'a> {
    /// A structure with loads, and the coordinates that are given at a time (s).
    pub fn new(
        structure: &'a dyn Structure,
        loads: Vec<&'a dyn Load>,
        held: impl Fn(f64) -> Vec<Held> + 'a,
    ) -> Self {
        Self { structure, loads, held: Box::new(held) }
    }

    /// The coordinates that are given at a time (s).
    #[must_use]
    pub fn held(&self, time: f64) -> Vec<Held> {
        (self.held)(time)
    }

    /// The structure.
    #[must_use]
    pub fn structure(&self) -> &'a dyn Structure {
        self.structure
    }

    /// Inner forces less loads, f - Q (n).
    #[must_use]
    pub fn unbalanced(&self, level: &Level) -> DVector<f64> {
        let Level { coordinates, velocities, time } = level;
        let mut forces = self.structure.forces(coordinates, velocities, *time);
        for load in &self.loads {
            forces -= load.load(coordinates, velocities, *time);
        }
        forces
    }

    /// Derivatives of [`Self::unbalanced`].
    #[must_use]
    pub fn tangents(&self, level: &Level) -> Tangents {
        let Level { coordinates, velocities, time } = level;
        let mut tangents = self.structure.tangents(coordinates, velocities, *time);
        for load in &self.loads {
            let Tangents { stiffness, damping } = load.tangents(coordinates, velocities, *time);
            tangents.stiffness -= stiffness;
            tangents.damping -= damping;
        }
        tangents
    }

    /// Power of the loads at a level (W).
    #[must_use]
    pub fn power_of_loads(&self, level: &Level) -> f64 {
        let Level { coordinates, velocities, time } = level;
        let power = |load: &&dyn Load| load.load(coordinates, velocities, *time).dot(velocities);
        self.loads.iter().map(power).sum()
    }

    /// Coordinates (n) of an equilibrium under the loads of a time (s), followed from coordinates near that of an
    /// earlier one in a number of steps. Steps are halved where Newton's method asks for it.
    ///
    /// # Errors
    /// [`DryError`] where there is none on that way.
    pub fn equilibrium(
        &self,
        start: DVector<f64>,
        [from, to]: [f64; 2],
        steps: u32,
    ) -> Result<DVector<f64>, DryError> {
        let mut coordinates = start;
        for i in 0..steps {
            let at = |i: u32| from + (to - from) * f64::from(i) / f64::from(steps);
            coordinates = self.follow(coordinates, [at(i), at(i + 1)], HALVINGS)?;
        }
        Ok(coordinates)
    }

    fn follow(
        &self,
        start: DVector<f64>,
        [from, to]: [f64; 2],
        halvings: u32,
    ) -> Result<DVector<f64>, DryError> {
        match self.balance(start.clone(), to) {
            Err(DryError::Diverged { .. }) if halvings > 0 => {
                let middle = 0.5 * (from + to);
                let half_way = self.follow(start, [from, middle], halvings - 1)?;
                self.follow(half_way, [middle, to], halvings - 1)
            }
            result => result,
        }
    }

    /// The equilibrium at a time, by Newton's method from coordinates.
    fn balance(&self, start: DVector<f64>, time: f64) -> Result<DVector<f64>, DryError> {
        let held = self.held(time);
        let velocities = DVector::zeros(start.len());
        let level = |coordinates: &DVector<f64>| Level {
            coordinates: coordinates.clone(),
            velocities: velocities.clone(),
            time,
        };
        let rounding = ROUNDING * start.amax();
        newton(Search { guess: start, rounding, time }, |coordinates| {
            let level = level(coordinates);
            let mut matrix = self.tangents(&level).stiffness;
            let mut residual = self.unbalanced(&level);
            for given in &held {
                let missing = coordinates[given.coordinate] - given.value;
                hold(&mut matrix, &mut residual, given.coordinate, missing);
            }
            (matrix, residual)
        })
    }
}

/// Replaces an equation by one for the increment of its unknown.
pub(super) fn hold(
    matrix: &mut DMatrix<f64>,
    residual: &mut DVector<f64>,
    unknown: usize,
    excess: f64,
) {
    matrix.row_mut(unknown).fill(0.0);
    matrix[(unknown, unknown)] = 1.0;
    residual[unknown] = excess;
}

/// A load times a function of time, such as a ramp.
pub struct Scaled<L> {
    /// The load.
    pub load: L,
    /// Its factor at a time (s).
    pub factor: fn(f64) -> f64,
}

impl<L: fmt::Debug> fmt::Debug for Scaled<L> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Scaled").field("load", &self.load).finish_non_exhaustive()
    }
}

impl<L: Load> Load for Scaled<L> {
    fn load(
        &self,
        coordinates: &DVector<f64>,
        velocities: &DVector<f64>,
        time: f64,
    ) -> DVector<f64> {
        self.load.load(coordinates, velocities, time) * (self.factor)(time)
    }

    fn tangents(
        &self,
        coordinates: &DVector<f64>,
        velocities: &DVector<f64>,
        time: f64,
    ) -> Tangents {
        let Tangents { stiffness, damping } = self.load.tangents(coordinates, velocities, time);
        let factor = (self.factor)(time);
        Tangents { stiffness: stiffness * factor, damping: damping * factor }
    }
}
