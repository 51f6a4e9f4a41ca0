//! Newton's method for places and pressures together: the saddle of a potential where volumes are kept.

use crate::material::Curvature;
use crate::solid::SolidError;
use crate::solid::cholesky::Factor;
use crate::solid::potential::{Potential, Rounding, Slope, norm};
use crate::solid::rigid::unknowns::Direction;

/// Part of the decrease the slope promises that a step has to reach (Armijo's rule).
const ARMIJO: f64 = 1e-4;

/// Factors are kept while an iteration divides the distance from the saddle by more than one over this.
const KEPT: f64 = 0.1;

/// Halvings of a step at most.
const N_HALVINGS: usize = 30;

/// Times the rounding of the potential within which a decrease cannot be seen.
const ROUNDINGS: f64 = 16.0;

/// Times the rounding of forces and volumes that counts as balance.
const BALANCED: f64 = 2.0;

/// What a change of the volume costs in the search along a direction, of the shear modulus: little, so that steps
/// may leave the curved manifold of kept volumes and come back.
const PENALTY: f64 = 10.0;

/// A saddle.
#[derive(Debug, Clone)]
pub(in crate::solid) struct Saddle {
    /// Places and pressures.
    pub state: Vec<f64>,
    /// Iterations it took.
    pub iterations: usize,
    /// Factorisations it took.
    pub n_factors: usize,
    /// Norm of the forces left (N).
    pub residual: f64,
    /// Slope of the potential by all components.
    pub slope: Vec<f64>,
}

/// A state with its slope.
struct At {
    state: Vec<f64>,
    found: Slope,
}

/// What a search is measured by.
struct Measure<'a, const D: usize> {
    potential: &'a Potential<'a, D>,
    /// Volumes (m3) that belong to the pressures.
    volumes: Vec<f64>,
    /// The penalty (Pa).
    penalty: f64,
    rounding: Rounding,
}

/// A way to go from a state.
struct Newton {
    /// To be subtracted.
    way: Direction,
    /// The second derivative along it, of places only (J).
    curvature: f64,
}

/// When a search ends.
#[derive(Debug, Clone, Copy)]
pub(in crate::solid) struct Limits {
    /// The residual of the forces that balance, and of the volumes.
    pub tolerance: f64,
    /// Iterations at most.
    pub max_iterations: usize,
}

/// The saddle near a state, whose held components stay. Factors at hand serve while they bring it nearer; those of
/// the last iteration that made new ones are left.
pub(in crate::solid) fn find<const D: usize>(
    potential: &Potential<'_, D>,
    start: &[f64],
    Limits { tolerance, max_iterations }: Limits,
    factor: &mut Option<Factor>,
) -> Result<Saddle, SolidError> {
    let mut measure = Measure::new(potential, start);
    let slope = |state: &[f64]| potential.slope(state).ok_or(SolidError::TurnedOver(0));
    let mut at = At { found: slope(start)?, state: start.to_vec() };
    let (mut scale, mut n_factors) = (at.found.scale, 0);
    let volume = norm(&measure.volumes);
    let mut is_stale = false;
    for iterations in 0..max_iterations {
        let residual = measure.forces(&at.state, &at.found);
        scale = scale.max(at.found.scale);
        let has_forces = residual <= (tolerance * scale).max(BALANCED * measure.rounding.slope);
        let kept = measure.excess(&at.found);
        if has_forces && kept <= (tolerance * volume).max(BALANCED * measure.rounding.volume) {
            let slope = at.found.slope;
            return Ok(Saddle { state: at.state, iterations, n_factors, residual, slope });
        }
        let near = factor.as_ref().filter(|_| !is_stale);
        let near = near.and_then(|factor| direction(potential, &at, factor));
        // One that leads upwards is judged by factors of its own
        let mut next = near
            .filter(|direction| direction.curvature > 0.0)
            .and_then(|direction| measure.search(&at, &direction, scale));
        for curvature in [Curvature::True, Curvature::Positive] {
            if next.is_some() {
                break;
            }
            n_factors += 1;
            *factor = factorise(potential, &at, curvature);
            let direction = factor.as_ref().and_then(|new| direction(potential, &at, new));
            next = direction.and_then(|direction| measure.search(&at, &direction, scale));
        }
        let next = next.ok_or(SolidError::NotConverged { iterations, residual, scale })?;
        let before = measure.distance(&at.state, &at.found, scale);
        is_stale = measure.distance(&next.state, &next.found, scale) > KEPT * before;
        at = next;
    }
    let residual = measure.forces(&at.state, &at.found);
    Err(SolidError::NotConverged { iterations: max_iterations, residual, scale })
}

/// Factors of the second derivatives at a state; none where there are none.
fn factorise<const D: usize>(
    potential: &Potential<'_, D>,
    at: &At,
    curvature: Curvature,
) -> Option<Factor> {
    let solid = potential.solid;
    let values = potential.curvature(&at.state, curvature, &at.found.known)?;
    solid.cholesky.factorise(&solid.pattern, &values)
}

/// Newton's direction by factors of the second derivatives, there or near; none where it cannot be found.
fn direction<const D: usize>(
    potential: &Potential<'_, D>,
    at: &At,
    factor: &Factor,
) -> Option<Newton> {
    let solid = potential.solid;
    let right = solid.free(&at.state, &at.found.slope);
    let mut free = right.clone();
    let is_solved = solid.cholesky.solve(&solid.pattern, factor, &mut free);
    let n = solid.pattern.n_places;
    let product = |of: std::ops::Range<usize>| -> f64 {
        right[of.clone()].iter().zip(&free[of]).map(|(a, b)| a * b).sum()
    };
    // K x + B q = r and B^T x = g: x . K x = x . r - q . g
    let curvature = product(0..n) - product(n..right.len());
    is_solved.then(|| Newton { way: solid.direction(&at.state, free), curvature })
}

impl<'a, const D: usize> Measure<'a, D> {
    fn new(potential: &'a Potential<'a, D>, start: &[f64]) -> Self {
        let solid = potential.solid;
        let mut volumes = vec![0.0; solid.pressures.count()];
        let (mut stiffness, mut whole) = (0.0, 0.0);
        for cell in 0..solid.spec.mesh.n_cells() {
            for k in 0..solid.points.n_points {
                let at = solid.points.at(cell, k);
                for (pressure, share) in solid.pressures.of(cell).iter().zip(at.shares) {
                    volumes[pressure - solid.pressures.first] += at.weight * share;
                }
                stiffness += at.weight * solid.lame[solid.material_of(cell)].shear;
                whole += at.weight;
            }
        }
        let penalty = PENALTY * stiffness / whole;
        Self { potential, volumes, penalty, rounding: potential.rounding(start) }
    }

    /// Norm of the forces (N) on what is free.
    fn forces(&self, state: &[f64], found: &Slope) -> f64 {
        let solid = self.potential.solid;
        norm(&solid.free(state, &found.slope)[..solid.pattern.n_places])
    }

    /// Changes of the volumes (m3) at the pressures.
    fn excesses<'b>(&self, found: &'b Slope) -> &'b [f64] {
        &found.slope[self.potential.solid.pressures.first..]
    }

    /// Their norm.
    fn excess(&self, found: &Slope) -> f64 {
        norm(self.excesses(found))
    }

    /// Sum of squared changes of the volume over the volumes (m3).
    fn squares(&self, found: &Slope) -> f64 {
        let pairs = self.excesses(found).iter().zip(&self.volumes);
        pairs.map(|(excess, volume)| excess * excess / volume).sum()
    }

    /// How far a state is from the saddle: parts of the forces and of the volumes.
    fn distance(&self, state: &[f64], found: &Slope, scale: f64) -> f64 {
        self.forces(state, found) / scale.max(f64::MIN_POSITIVE)
            + self.excess(found) / norm(&self.volumes)
    }

    /// Goes against a direction as far as the potential with the pressures at its end, and a penalty on changes of
    /// the volume, decreases as its slope promises; none where it does not (the augmented Lagrangian of @nocedal2006).
    fn search(&mut self, at: &At, direction: &Newton, scale: f64) -> Option<At> {
        let first = self.potential.solid.pressures.first;
        let squares = self.squares(&at.found);
        if direction.curvature < 0.0 {
            // Enough of a penalty makes it lead downwards, unless the volumes are kept
            let needed = -2.0 * direction.curvature / squares;
            if needed.is_finite() && needed < 1e3 * self.penalty {
                self.penalty = self.penalty.max(needed);
            } else {
                return None;
            }
        }
        let promise = direction.curvature + self.penalty * squares;
        let merit = |found: &Slope| found.value + 0.5 * self.penalty * self.squares(found);
        let pairs = self.excesses(&at.found).iter().zip(&direction.way.all[first..]);
        let before = merit(&at.found) - pairs.map(|(excess, moved)| excess * moved).sum::<f64>();
        let distance = self.distance(&at.state, &at.found, scale);
        let noise = ROUNDINGS * self.rounding.value;
        let mut length = 1.0;
        for _ in 0..N_HALVINGS {
            let short = self.potential.solid.against(&at.state, &direction.way, length);
            let mut trial = short.clone();
            for (pressure, k) in trial[first..].iter_mut().zip(first..) {
                *pressure = at.state[k] - direction.way.all[k];
            }
            if let Some(found) = self.potential.slope(&trial) {
                let after = merit(&found);
                let is_lower = after < before && after <= before - ARMIJO * length * promise;
                let is_nearer =
                    after <= before + noise && self.distance(&trial, &found, scale) < distance;
                if is_lower || is_nearer {
                    if length == 1.0 {
                        return Some(At { state: trial, found });
                    }
                    return self.potential.slope(&short).map(|found| At { state: short, found });
                }
            }
            length *= 0.5;
        }
        None
    }
}
