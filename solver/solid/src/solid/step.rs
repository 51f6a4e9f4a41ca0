//! Implicit steps in time: backward differences, and one that keeps the energy.

use alewife_mesh::GaussRule;

use super::SolidError;
use super::assemble::StrainLevel;
use super::build::Solid;
use super::newton::Minimiser;
use super::potential::{Inertia, Potential, Way};

/// How a solid moves in time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scheme {
    /// Implicit Euler: first order, damps what it does not resolve.
    ImplicitEuler,
    /// The backward difference of second order; its first step is one of implicit Euler.
    Bdf2,
    /// The trapezoidal rule for places with the mean of the inner forces along each step: second order, and
    /// the energy of an undamped body is kept.
    ///
    /// # Source
    /// @mclachlan1999, the average vector field.
    Conservative,
}

/// Points of the mean along a step: exact for Saint-Venant and Kirchhoff's energy, which is of degree four.
const WAY_POINTS: usize = 4;

/// Places and velocities of all nodes at two levels of time.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// Places (m).
    pub places: Vec<f64>,
    /// Velocities (m/s).
    pub velocities: Vec<f64>,
    /// The level before; none at the start.
    pub before: Option<Box<Level>>,
}

/// A level before.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// Places (m).
    pub places: Vec<f64>,
    /// Velocities (m/s).
    pub velocities: Vec<f64>,
}

/// A backward difference (a_0 y_(n+1) + a_1 y_n + a_2 y_(n-1)), its factors in 1/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    /// Factors of the new level, the last, and the one before.
    pub factors: [f64; 3],
}

impl Difference {
    /// The one of a scheme with constant step (s); without a level before it is implicit Euler's.
    #[must_use]
    pub fn new(scheme: Scheme, step: f64, has_before: bool) -> Self {
        let factors = match scheme {
            Scheme::Bdf2 if has_before => [1.5, -2.0, 0.5],
            _ => [1.0, -1.0, 0.0],
        };
        Self { factors: factors.map(|factor| factor / step) }
    }

    /// a_1 y_n + a_2 y_(n-1).
    fn history(&self, last: &[f64], before: Option<&[f64]>) -> Vec<f64> {
        let [_, a1, a2] = self.factors;
        match before {
            Some(before) => last.iter().zip(before).map(|(y, z)| a1 * y + a2 * z).collect(),
            None => last.iter().map(|y| a1 * y).collect(),
        }
    }
}

impl Motion {
    /// A body at rest.
    #[must_use]
    pub fn at_rest<const D: usize>(solid: &Solid<D>) -> Self {
        let places = solid.at_rest();
        Self { velocities: vec![0.0; places.len()], places, before: None }
    }

    /// Kinetic energy (J).
    #[must_use]
    pub fn kinetic_energy<const D: usize>(&self, solid: &Solid<D>) -> f64 {
        let momentum = solid.times_mass(&self.velocities);
        0.5 * momentum.iter().zip(&self.velocities).map(|(p, v)| p * v).sum::<f64>()
    }
}

impl<const D: usize> Solid<D> {
    /// Elastic energy (J) of a state, with that of fibres that are told these stretches.
    ///
    /// # Errors
    /// [`SolidError::TurnedOver`].
    pub fn elastic_energy(&self, places: &[f64], targets: &[f64]) -> Result<f64, SolidError> {
        let controls = super::assemble::Controls { targets, damping: None };
        if let Some(cell) = self.turned_over(places) {
            return Err(SolidError::TurnedOver(cell));
        }
        self.energy_of(places, controls).ok_or(SolidError::TurnedOver(0))
    }

    /// Whether any of its materials is damped.
    pub(super) fn is_damped(&self) -> bool {
        self.spec.materials.iter().any(|material| material.viscosity > 0.0)
    }

    /// What an implicit step (s) minimises, for a motion, stretches of the fibres and loads (N).
    ///
    /// # Errors
    /// [`SolidError::Damped`] where the scheme has no damping.
    pub fn potential_of_step<'a>(
        &'a self,
        motion: &Motion,
        scheme: Scheme,
        step: f64,
        targets: &'a [f64],
        loads: &'a [f64],
    ) -> Result<Potential<'a, D>, SolidError> {
        let mut potential = Potential::at_rest(self, targets, loads);
        let Motion { places, velocities, before } = motion;
        if scheme == Scheme::Conservative {
            if self.is_damped() {
                return Err(SolidError::Damped);
            }
            if self.pattern.is_mixed() {
                return Err(SolidError::KeptVolume);
            }
            if !self.ties.is_empty() {
                return Err(SolidError::Rigid("a conservative step"));
            }
            let rule = GaussRule::new(WAY_POINTS);
            let points = rule.points.iter().zip(&rule.weights).map(|(s, w)| [*s, *w]).collect();
            potential.way = Some(Way { from: places.clone(), points });
            let coasted = places.iter().zip(velocities).map(|(x, v)| x + step * v).collect();
            potential.inertia = Some(Inertia { factor: 2.0 / (step * step), coasted });
            return Ok(potential);
        }
        let difference = Difference::new(scheme, step, before.is_some());
        let [a0, a1, a2] = difference.factors;
        let x = difference.history(places, before.as_ref().map(|b| &b.places[..]));
        let v = difference.history(velocities, before.as_ref().map(|b| &b.velocities[..]));
        let coasted = x.iter().zip(&v).map(|(x, v)| -x / a0 - v / (a0 * a0)).collect();
        potential.inertia = Some(Inertia { factor: a0 * a0, coasted });
        if self.is_damped() {
            let mut levels = vec![StrainLevel { factor: -a1 / a0, places }];
            if let Some(before) = before.as_ref().filter(|_| a2 != 0.0) {
                levels.push(StrainLevel { factor: -a2 / a0, places: &before.places });
            }
            potential.damping = Some(self.strain_history(a0, &levels));
        }
        Ok(potential)
    }

    /// Velocities (m/s) at the end of a step that reaches these places; those of pressures are 0.
    #[must_use]
    pub fn velocities_after(
        &self,
        motion: &Motion,
        scheme: Scheme,
        step: f64,
        places: &[f64],
    ) -> Vec<f64> {
        if scheme == Scheme::Conservative {
            let both = motion.places.iter().zip(&motion.velocities);
            return both.zip(places).map(|((from, v), to)| 2.0 * (to - from) / step - v).collect();
        }
        let difference = Difference::new(scheme, step, motion.before.is_some());
        let before = motion.before.as_ref().map(|b| &b.places[..]);
        let history = difference.history(&motion.places, before);
        let mut velocities: Vec<f64> =
            places.iter().zip(&history).map(|(x, h)| difference.factors[0] * x + h).collect();
        velocities[self.n_places()..].fill(0.0);
        velocities
    }

    /// One step of a motion. Held components go where `held` says, a list of all components; they stay where
    /// there is none.
    ///
    /// # Errors
    /// Those of [`Minimiser::minimise`] and [`Solid::potential_of_step`].
    pub fn advance(
        &self,
        minimiser: &mut Minimiser,
        motion: &Motion,
        given: &StepInput<'_>,
    ) -> Result<Motion, SolidError> {
        let StepInput { scheme, step, targets, loads, held } = *given;
        let potential = self.potential_of_step(motion, scheme, step, targets, loads)?;
        let mut start = held.unwrap_or(&motion.places).to_vec();
        for component in &self.pattern.components {
            start[*component] = motion.places[*component];
        }
        for node in self.ties.parts.iter().flatten() {
            let own = D * node..D * (node + 1);
            start[own.clone()].copy_from_slice(&motion.places[own]);
        }
        let still = start.clone();
        for component in &self.pattern.components {
            start[*component] += step * motion.velocities[*component];
        }
        if let Some(pose) = self.pose(&still) {
            let rates = pose.rates(&motion.velocities);
            pose.place(&rates.iter().map(|rate| step * rate).collect::<Vec<_>>(), &mut start);
        }
        let minimum = match minimiser.minimise(&potential, &start) {
            // Coasting would turn a cell over
            Err(SolidError::TurnedOver(_)) => minimiser.minimise(&potential, &still)?,
            other => other?,
        };
        Ok(Motion {
            velocities: self.velocities_after(motion, scheme, step, &minimum.places),
            places: minimum.places,
            before: Some(Box::new(Level {
                places: motion.places.clone(),
                velocities: motion.velocities.clone(),
            })),
        })
    }
}

/// What a step is given.
#[derive(Debug, Clone, Copy)]
pub struct StepInput<'a> {
    /// How it moves.
    pub scheme: Scheme,
    /// Size of the step (s).
    pub step: f64,
    /// The stretch each set of fibres is told.
    pub targets: &'a [f64],
    /// Loads (N) on all components.
    pub loads: &'a [f64],
    /// Where held components go.
    pub held: Option<&'a [f64]>,
}
