//! `Minimiser`: Newton's method for potentials, with a line search, and factors that are kept while they serve.

use super::SolidError;
use super::cholesky::Factor;
use super::mixed::saddle::{self, Limits};
use super::potential::{Potential, Slope, norm};
use super::rigid::unknowns::Direction;
use crate::material::{Curvature, Kinematics};

/// Part of the decrease the slope promises that a step has to reach (Armijo's rule).
const ARMIJO: f64 = 1e-4;

/// Factors are kept while an iteration divides the residual by more than one over this. Over 300 steps of a plate of
/// 1125 nodes they take 1445 iterations and 276 factorisations at 0.1, 1772 and 186 at 0.2, 2315 and 111 at 0.4; two
/// such motions and a gradient 7.8, 7.1 and 8.2 s, of which a tenth is scatter.
const KEPT: f64 = 0.2;

/// Pairs of steps and changes of the slope that mend factors which are kept: more than a step of these motions has
/// iterations, six.
const N_SECANTS: usize = 8;

/// Halvings of a step at most: from a state that is not turned over, one this short decreases the potential.
const N_HALVINGS: usize = 40;

/// Times the rounding of the potential within which a decrease cannot be seen.
const ROUNDINGS: f64 = 16.0;

/// Times the rounding of the inner forces that counts as balance.
const BALANCED: f64 = 2.0;

/// What is added to the diagonal, of its largest entry, where a positive part is singular.
const SHIFT: f64 = 1e-10;

/// Finds minima of potentials of one solid, step after step.
#[derive(Debug, Clone)]
pub struct Minimiser {
    /// The residual that ends a search, of the forces that balance.
    pub tolerance: f64,
    /// Iterations at most.
    pub max_iterations: usize,
    factor: Option<Factor>,
    /// Factorisations made so far.
    pub n_factors: usize,
    /// Iterations made so far.
    pub n_iterations: usize,
}

/// A minimum.
#[derive(Debug, Clone, PartialEq)]
pub struct Minimum {
    /// The state: places of all nodes (m), and pressures (Pa).
    pub places: Vec<f64>,
    /// Iterations it took.
    pub iterations: usize,
    /// Norm of the forces left (N).
    pub residual: f64,
    /// Slope of the potential by all components: where held, the force (N) the body is held with.
    pub slope: Vec<f64>,
}

impl Default for Minimiser {
    fn default() -> Self {
        Self { tolerance: 1e-10, max_iterations: 200, factor: None, n_factors: 0, n_iterations: 0 }
    }
}

impl Minimiser {
    /// One with a relative residual that ends a search.
    #[must_use]
    pub fn with_tolerance(tolerance: f64) -> Self {
        Self { tolerance, ..Self::default() }
    }

    /// The factors of the last iteration, which need not be those of its end.
    #[must_use]
    pub fn factor(&self) -> Option<&Factor> {
        self.factor.as_ref()
    }

    /// Takes factors from elsewhere, or forgets those it has.
    pub fn set_factor(&mut self, factor: Option<Factor>) {
        self.factor = factor;
    }

    /// The minimum near a state, whose held components stay.
    ///
    /// # Errors
    /// [`SolidError::TurnedOver`] where a cell is from the start, [`SolidError::NotConverged`] and
    /// [`SolidError::Singular`].
    pub fn minimise<const D: usize>(
        &mut self,
        potential: &Potential<'_, D>,
        start: &[f64],
    ) -> Result<Minimum, SolidError> {
        let solid = potential.solid;
        check_lengths(potential, start)?;
        let mut places = start.to_vec();
        let turned_over = |places: &[f64]| match solid.turned_over(places) {
            Some(cell) => Err(SolidError::TurnedOver(cell)),
            None => Ok(()),
        };
        turned_over(start)?;
        if solid.pattern.is_mixed() {
            let limits = Limits { tolerance: self.tolerance, max_iterations: self.max_iterations };
            let found = saddle::find(potential, start, limits, &mut self.factor)?;
            self.n_factors += found.n_factors;
            self.n_iterations += found.iterations;
            turned_over(&found.state)?;
            let saddle::Saddle { state: places, iterations, residual, slope, .. } = found;
            return Ok(Minimum { places, iterations, residual, slope });
        }
        let mut at = potential.slope(&places).ok_or(SolidError::TurnedOver(0))?;
        let rounding = potential.rounding(start);
        let mut scale = at.scale;
        let mut is_stale = false;
        let mut secants = Secants::default();
        for iterations in 0..self.max_iterations {
            let right = solid.free(&places, &at.slope);
            let residual = norm(&right);
            scale = scale.max(at.scale);
            if residual <= (self.tolerance * scale).max(BALANCED * rounding.slope) {
                turned_over(&places)?;
                return Ok(Minimum { places, iterations, residual, slope: at.slope });
            }
            self.n_iterations += 1;
            let is_fresh = self.factor.is_none() || is_stale;
            if is_fresh {
                self.factor = Some(self.factorise(potential, &places, &at.known)?);
                secants = Secants::default();
            }
            let Some(factor) = &self.factor else { return Err(SolidError::Singular) };
            let direction = secants
                .applied(&right, |all| solid.cholesky.solve(&solid.pattern, factor, all))
                .ok_or(SolidError::Singular)?;
            let slope = dot(&right, &direction);
            let direction = solid.direction(&places, direction);
            let promise = Promise { slope, noise: ROUNDINGS * rounding.value };
            let Some(Found { next, length }) =
                search(potential, &mut places, &at, &direction, promise)
            else {
                if is_fresh {
                    return Err(SolidError::NotConverged { iterations, residual, scale });
                }
                is_stale = true;
                continue;
            };
            let left = solid.free(&places, &next.slope);
            is_stale = norm(&left) > KEPT * residual;
            secants.add(&direction.free, length, [&right, &left]);
            at = next;
        }
        let residual = norm(&solid.free(&places, &at.slope));
        Err(SolidError::NotConverged { iterations: self.max_iterations, residual, scale })
    }

    /// Factors of the second derivatives, or where these are not positive, of their positive part.
    fn factorise<const D: usize>(
        &mut self,
        potential: &Potential<'_, D>,
        places: &[f64],
        known: &[Kinematics],
    ) -> Result<Factor, SolidError> {
        let solid = potential.solid;
        for curvature in [Curvature::True, Curvature::Positive] {
            let mut values =
                potential.curvature(places, curvature, known).ok_or(SolidError::Singular)?;
            self.n_factors += 1;
            if let Some(factor) = solid.cholesky.factorise(&solid.pattern, &values) {
                return Ok(factor);
            }
            if curvature == Curvature::Positive {
                let diagonal = &solid.pattern.starts[..solid.pattern.n_unknowns()];
                let largest = diagonal.iter().map(|at| values[*at]).fold(0.0, f64::max);
                for at in diagonal {
                    values[*at] += SHIFT * largest;
                }
                let factor = solid.cholesky.factorise(&solid.pattern, &values);
                return factor.ok_or(SolidError::Singular);
            }
        }
        Err(SolidError::Singular)
    }
}

/// Steps of a search with what the slope changed by along them, since factors were made: the inverse of the second
/// derivatives that the factors are of, mended so that it agrees with them (limited-memory BFGS).
///
/// # Source
/// @nocedal2006, algorithm 7.4.
#[derive(Debug, Default)]
struct Secants {
    pairs: Vec<Secant>,
}

/// A step s and what the slope changed by, y, with 1/(s . y).
#[derive(Debug)]
struct Secant {
    step: Vec<f64>,
    change: Vec<f64>,
    inverse: f64,
}

impl Secants {
    /// Adds the step against a direction, with the slopes before and after; one without curvature is left out.
    fn add(&mut self, direction: &[f64], length: f64, [before, after]: [&[f64]; 2]) {
        let step: Vec<f64> = direction.iter().map(|d| -length * d).collect();
        let change: Vec<f64> = after.iter().zip(before).map(|(b, a)| b - a).collect();
        let product = dot(&step, &change);
        if product > f64::EPSILON * norm(&step) * norm(&change) {
            if self.pairs.len() == N_SECANTS {
                self.pairs.remove(0);
            }
            self.pairs.push(Secant { step, change, inverse: 1.0 / product });
        }
    }

    /// The mended inverse times a slope, by one that solves with the factors; none where that fails.
    fn applied(&self, slope: &[f64], solve: impl FnOnce(&mut [f64]) -> bool) -> Option<Vec<f64>> {
        let mut all = slope.to_vec();
        let mut shares = Vec::with_capacity(self.pairs.len());
        for Secant { step, change, inverse } in self.pairs.iter().rev() {
            let share = inverse * dot(step, &all);
            add(&mut all, -share, change);
            shares.push(share);
        }
        if !solve(&mut all) {
            return None;
        }
        for (Secant { step, change, inverse }, share) in self.pairs.iter().zip(shares.iter().rev())
        {
            let own = inverse * dot(change, &all);
            add(&mut all, share - own, step);
        }
        Some(all)
    }
}

fn dot(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(a, b)| a * b).sum()
}

/// Adds a multiple of a list.
fn add(to: &mut [f64], factor: f64, from: &[f64]) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to += factor * from);
}

/// Where a search along a direction ends, and how much of it that is.
struct Found {
    next: Slope,
    length: f64,
}

/// What a direction promises: the slope of the potential along it (J), and the decrease that drowns in rounding.
#[derive(Debug, Clone, Copy)]
struct Promise {
    slope: f64,
    noise: f64,
}

/// Goes against a direction as far as the potential decreases as its slope promises; none where it does not.
fn search<const D: usize>(
    potential: &Potential<'_, D>,
    places: &mut Vec<f64>,
    at: &Slope,
    direction: &Direction,
    Promise { slope, noise }: Promise,
) -> Option<Found> {
    let solid = potential.solid;
    let before = norm(&solid.free(places, &at.slope));
    let mut length = 1.0;
    for _ in 0..N_HALVINGS {
        let trial = solid.against(places, direction, length);
        if let Some(next) = potential.slope(&trial) {
            let after = norm(&solid.free(&trial, &next.slope));
            let is_lower =
                next.value < at.value && next.value <= at.value - ARMIJO * length * slope;
            // Near the minimum the decrease drowns in rounding, and the residual still says
            let is_nearer = next.value <= at.value + noise && after < before;
            if is_lower || is_nearer {
                *places = trial;
                return Some(Found { next, length });
            }
        }
        length *= 0.5;
    }
    None
}

/// Whether all lists have the length the solid asks for.
fn check_lengths<const D: usize>(
    potential: &Potential<'_, D>,
    start: &[f64],
) -> Result<(), SolidError> {
    let n = potential.solid.n_components();
    let n_sets = potential.solid.spec.fibres.len();
    let lists = [
        ("places of nodes", start.len(), n),
        ("loads", potential.loads.len(), n),
        ("stretches of fibres", potential.targets.len(), n_sets),
    ];
    for (what, found, expected) in lists {
        if found != expected {
            return Err(SolidError::Length { what, found, expected });
        }
    }
    Ok(())
}
