//! `Motion`: a structure in time, by the second backward difference.

use nalgebra::{DMatrix, DVector};

use super::error::DryError;
use super::level::Level;
use super::newton::{ROUNDING, Search, newton};
use super::system::{DrySystem, hold};

/// A structure in time with steps of one size. Coordinates obey the same backward difference as velocities, so that
/// what moves with a structure has its velocity to rounding:
///
/// ```text
/// M (a0 v + a1 v_n + a2 v_(n-1)) + f = Q,    a0 d + a1 d_n + a2 d_(n-1) = v.
/// ```
///
/// The first step is one of the backward Euler method.
#[derive(Debug)]
pub struct Motion<'a> {
    system: &'a DrySystem<'a>,
    mass: DMatrix<f64>,
    /// Size of a step (s).
    step: f64,
    now: Level,
    before: Option<Level>,
    /// Two steps ago.
    earlier: Option<Level>,
    /// M dv/dt + f - Q at the end of the last step, which is zero where nothing is held.
    residual: DVector<f64>,
}

impl<'a> Motion<'a> {
    /// From an instant on, with steps of a size (s).
    #[must_use]
    pub fn new(system: &'a DrySystem<'a>, start: Level, step: f64) -> Self {
        let residual = DVector::zeros(start.coordinates.len());
        let mass = system.structure().mass();
        Self { system, mass, step, now: start, before: None, earlier: None, residual }
    }

    /// The structure as it is.
    #[must_use]
    pub fn now(&self) -> &Level {
        &self.now
    }

    /// The structure one step ago.
    #[must_use]
    pub fn before(&self) -> Option<&Level> {
        self.before.as_ref()
    }

    /// Loads of the supports (n), by the equations of motion of what they hold.
    #[must_use]
    pub fn support_loads(&self) -> &DVector<f64> {
        &self.residual
    }

    /// Kinetic energy (J).
    #[must_use]
    pub fn kinetic_energy(&self) -> f64 {
        0.5 * self.now.velocities.dot(&(&self.mass * &self.now.velocities))
    }

    /// Energy (J) that the last step has lost by its backward difference alone: a quarter of the squares of the second
    /// differences of velocities, by the mass, and of coordinates, by the stiffness. It is exact in linear problems,
    /// for the energy of [`Self::energy_of_scheme`]; zero before the third step.
    #[must_use]
    pub fn loss_of_scheme(&self) -> f64 {
        let (Some(before), Some(earlier)) = (&self.before, &self.earlier) else { return 0.0 };
        let second =
            |of: fn(&Level) -> &DVector<f64>| of(&self.now) - of(before) * 2.0 + of(earlier);
        let stiffness = self.system.tangents(&self.now).stiffness;
        0.25 * self.squares(&second(velocities), &second(coordinates), &stiffness)
    }

    /// Half of the energies (J) of the present level and of the one that is extrapolated from it, about coordinates at
    /// rest, in the norms of mass and stiffness: what the backward difference keeps in linear problems.
    #[must_use]
    pub fn energy_of_scheme(&self, rest: &DVector<f64>) -> f64 {
        let before = self.before.as_ref().unwrap_or(&self.now);
        let stiffness = self.system.tangents(&self.now).stiffness;
        let ahead = |of: fn(&Level) -> &DVector<f64>| of(&self.now) * 2.0 - of(before);
        let now = self.squares(&self.now.velocities, &(&self.now.coordinates - rest), &stiffness);
        let next = self.squares(&ahead(velocities), &(ahead(coordinates) - rest), &stiffness);
        0.25 * (now + next)
    }

    fn squares(&self, v: &DVector<f64>, q: &DVector<f64>, stiffness: &DMatrix<f64>) -> f64 {
        v.dot(&(&self.mass * v)) + q.dot(&(stiffness * q))
    }

    /// Makes a step.
    ///
    /// # Errors
    /// [`DryError`] where Newton's method does not converge.
    pub fn advance(&mut self) -> Result<(), DryError> {
        let time = self.now.time + self.step;
        let held = self.system.held(time);
        let difference = Difference::new(self.step, &self.now, self.before.as_ref());
        let guess = match &self.before {
            Some(before) => &self.now.velocities * 2.0 - &before.velocities,
            None => self.now.velocities.clone(),
        };
        let level = |velocities: &DVector<f64>| {
            let mut coordinates = &difference.coordinates + velocities / difference.leading;
            for given in &held {
                coordinates[given.coordinate] = given.value;
            }
            Level { coordinates, velocities: velocities.clone(), time }
        };
        let system = self.system;
        let unbalanced = |level: &Level| {
            let rate = &level.velocities * difference.leading + &difference.velocities;
            &self.mass * rate + system.unbalanced(level)
        };
        let rounding = ROUNDING * difference.leading * self.now.coordinates.amax();
        let velocities = newton(Search { guess, rounding, time }, |velocities| {
            let level = level(velocities);
            let tangents = system.tangents(&level);
            let mut matrix = &self.mass * difference.leading
                + tangents.stiffness / difference.leading
                + tangents.damping;
            let mut residual = unbalanced(&level);
            for given in &held {
                let excess = velocities[given.coordinate] - given.rate;
                hold(&mut matrix, &mut residual, given.coordinate, excess);
            }
            (matrix, residual)
        })?;
        let next = level(&velocities);
        self.residual = unbalanced(&next);
        let now = std::mem::replace(&mut self.now, next);
        self.earlier = self.before.replace(now);
        Ok(())
    }
}

fn coordinates(level: &Level) -> &DVector<f64> {
    &level.coordinates
}

fn velocities(level: &Level) -> &DVector<f64> {
    &level.velocities
}

/// A backward difference, but for the new level.
struct Difference {
    /// Factor of the new level (1/s).
    leading: f64,
    /// What the coordinates would be without a velocity.
    coordinates: DVector<f64>,
    /// What older velocities contribute to the acceleration.
    velocities: DVector<f64>,
}

impl Difference {
    fn new(step: f64, now: &Level, before: Option<&Level>) -> Self {
        let (leading, older) = match before {
            Some(_) => (1.5 / step, [-2.0 / step, 0.5 / step]),
            None => (1.0 / step, [-1.0 / step, 0.0]),
        };
        let sum = |of: fn(&Level) -> &DVector<f64>| {
            let recent = of(now) * older[0];
            before.map_or_else(|| recent.clone(), |before| &recent + of(before) * older[1])
        };
        Self { leading, coordinates: sum(coordinates) / -leading, velocities: sum(velocities) }
    }
}
