//! Bodies with coordinates in an enclosed fluid: their net flux, and the level of the pressure on them.
//!
//! Surfaces that are interpolated carry a small net flux, and bodies that are stretched one of their own; the continuity
//! equation gets it back as a source that is spread over the fluid. Where the motion of surfaces is given, so is the source;
//! the rates of coordinates change it. The level of the pressure then does work on them. It is that of zero mean, at which a
//! source that is spread takes no work, and not that of the vertex whose pressure is fixed in the matrix, which is another one
//! on another mesh. Source and mean are two more unknowns, each of which changes the flow by one answer of the matrix.

use super::super::error::SolveError;
use super::super::pressure_mean::FluxWeight;
use super::super::problem::Problem;
use super::super::solution::Solution;
use super::rate_response::EnclosedAnswers;
use super::{Configuration, FluidSystem};
use crate::algebra::AffineConstraints;
use crate::timing::Timing;

/// Net flux (m3/s; m2/s planar) of the surfaces, and mean pressure (Pa).
#[derive(Debug, Clone, Copy, Default)]
struct FluxAndLevel {
    flux: f64,
    level: f64,
}

impl<const D: usize> FluidSystem<D> {
    /// Gives free unknowns, after a step of Newton's method from a solution, the net flux that their source is of, and bodies
    /// with coordinates a pressure of zero mean.
    ///
    /// # Errors
    /// When the matrix is singular.
    pub(super) fn balance_enclosed(
        &mut self,
        at: &Configuration<'_, D>,
        solution: &Solution<D>,
        free: &mut [f64],
        timing: &mut Timing,
    ) -> Result<(), SolveError> {
        if self.flux_weights.is_empty() {
            return Ok(());
        }
        let found = match self.rate_response.take_enclosed() {
            Some(known) => known,
            None => self.enclosed_answers(at.constraints, timing)?,
        };
        let linear = |values: &[f64]| {
            self.flux_and_level(|raw| {
                let terms = at.constraints.row(raw).iter();
                terms.map(|term| term.weight * values[term.unknown as usize]).sum()
            })
        };
        let given = self.flux_and_level(|raw| self.value_of(solution, raw));
        let by_values = self.flux_and_level(|raw| at.constraints.value(raw));
        let now = linear(free);
        let lack = FluxAndLevel {
            flux: now.flux + by_values.flux - given.flux,
            level: now.level + by_values.level - given.level,
        };
        let by_source = linear(&found.source);
        let by_level = found.level.as_deref().map(linear);
        let [source, level] = parts(lack, by_source, by_level);
        free.iter_mut().zip(&found.source).for_each(|(free, answer)| *free += source * answer);
        if let Some(answer) = &found.level {
            free.iter_mut().zip(answer).for_each(|(free, answer)| *free += level * answer);
        }
        self.rate_response.keep_enclosed(found);
        Ok(())
    }

    /// The answers of the matrix last assembled, by factors or by iterations.
    fn enclosed_answers(
        &mut self,
        constraints: &AffineConstraints,
        timing: &mut Timing,
    ) -> Result<EnclosedAnswers, SolveError> {
        let mut source = constraints.restrict(&self.unit_source());
        self.linear.solve(&mut source, None, timing)?;
        let mut level = None;
        if !self.linear.is_iterative() {
            let mut answer = constraints.restrict(&self.unit_level());
            self.linear.solve(&mut answer, None, timing)?;
            level = Some(answer);
        }
        Ok(EnclosedAnswers { source, level })
    }

    /// The same by a substitution for each with factors at hand; none in a fluid that is not enclosed.
    pub(super) fn substituted_answers(
        &mut self,
        constraints: &AffineConstraints,
        timing: &mut Timing,
    ) -> Option<EnclosedAnswers> {
        if self.flux_weights.is_empty() {
            return None;
        }
        let [mut source, mut level] =
            [self.unit_source(), self.unit_level()].map(|raw| constraints.restrict(&raw));
        let has_factors = [&mut source, &mut level].map(|rhs| self.linear.substitute(rhs, timing));
        (has_factors == [true; 2]).then_some(EnclosedAnswers { source, level: Some(level) })
    }

    /// Shifts the pressure of an enclosed flow to zero mean.
    pub fn center_pressure(&self, problem: &Problem<D>, solution: &mut Solution<D>) {
        if problem.is_enclosed() {
            self.pressure.center(&mut solution.pressure);
        }
    }

    /// Takes the mean of the pressure of a solution off the residuals of bodies with coordinates.
    pub(super) fn take_off_level(&self, solution: &Solution<D>, raw: &mut [f64]) {
        if self.flux_weights.is_empty() {
            return;
        }
        let mean = self.pressure.mean(|vertex| solution.pressure[vertex]);
        self.add_level(-mean, raw);
    }

    fn add_level(&self, pressure: f64, raw: &mut [f64]) {
        for FluxWeight { node, weight } in &self.flux_weights {
            for axis in 0..D {
                raw[self.layout.velocity(*node, axis)] += pressure * weight[axis];
            }
        }
    }

    fn value_of(&self, solution: &Solution<D>, raw: usize) -> f64 {
        let pressures = self.layout.pressures();
        match raw < pressures.start {
            true => solution.velocity[raw / D][raw % D],
            false => solution.pressure[raw - pressures.start],
        }
    }

    /// Of velocities and pressures by their raw numbers.
    fn flux_and_level(&self, value: impl Fn(usize) -> f64) -> FluxAndLevel {
        let of_node = |FluxWeight { node, weight }: &FluxWeight<D>| -> f64 {
            (0..D).map(|axis| weight[axis] * value(self.layout.velocity(*node, axis))).sum()
        };
        let first = self.layout.pressures().start;
        FluxAndLevel {
            flux: self.flux_weights.iter().map(of_node).sum(),
            level: self.pressure.mean(|vertex| value(first + vertex)),
        }
    }

    /// A source of one, spread over the fluid as a net flux is, in the rows of the raw residual.
    fn unit_source(&self) -> Vec<f64> {
        let mut raw = vec![0.0; self.layout.n_raw()];
        let pressures = self.layout.pressures();
        raw[pressures.start] = 1.0;
        self.pressure.make_compatible(&mut raw[pressures.clone()]);
        raw[pressures.clone()].iter_mut().for_each(|value| *value = -*value);
        raw[pressures.start] += 1.0;
        raw
    }

    /// What a pressure of one does to bodies with coordinates, in the rows of the raw residual.
    fn unit_level(&self) -> Vec<f64> {
        let mut raw = vec![0.0; self.layout.n_raw()];
        self.add_level(1.0, &mut raw);
        raw
    }
}

/// How much of each answer makes up for what unknowns lack, which the answers change themselves.
fn parts(lack: FluxAndLevel, source: FluxAndLevel, level: Option<FluxAndLevel>) -> [f64; 2] {
    let Some(level) = level else { return [lack.flux / (1.0 - source.flux), 0.0] };
    // (1 - F_s) s - F_l l = F, -m_s s + (1 - m_l) l = m
    let [own_source, own_level] = [1.0 - source.flux, 1.0 - level.level];
    let determinant = own_source * own_level - level.flux * source.level;
    [
        (lack.flux * own_level + level.flux * lack.level) / determinant,
        (own_source * lack.level + source.level * lack.flux) / determinant,
    ]
}
