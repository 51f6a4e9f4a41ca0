//! `StepErrorReport`: what the steps of a run leave in its velocities, ways and loads, by estimates.

use serde::{Deserialize, Serialize};

use crate::body::{Mode, on_mesh};
use crate::case::{Scheme, Unsteady};
use crate::coupling::{Drive, Problem, RigidBody};
use crate::run::Series;
use crate::run::simulation::Simulation;
use crate::state::SquaredError;
use crate::step::error_of_second_difference;

/// Rows after the start that say nothing of loads: those of velocities that jump there fall like t^-1/2.
const START_ROWS: usize = 20;

/// Component of a load over the largest one below which it is none to speak of.
const NOTABLE_LOAD: f64 = 0.05;

/// Error over what it is one of, above which there is a warning.
const NOTABLE: f64 = 0.02;

/// Way over the size of the domain that is rounding: places are sums of steps, each of which rounds them.
const ROUNDING: f64 = 1e-9;

/// Reynolds number of a width above which bodies may shed vortices: cylinders do from 47 on.
const SHEDDING: f64 = 50.0;

/// Time in which vortices leave a body, over that in which the fluid passes its width: a Strouhal number of 0.2.
const PERIOD: f64 = 5.0;

/// Fewest steps of a period in which BDF2 lets an oscillation grow that would: with three there was no shedding left.
const STEPS_OF_A_PERIOD: f64 = 20.0;

/// Bodies that are looked at for vortices.
const MOST_BODIES: usize = 20;

/// What the steps of a run leave, over what it is in; none where it is not known.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct StepErrorReport {
    /// In the velocity of the fluid, over it.
    pub velocity: Option<f64>,
    /// In the ways of the bodies, over them.
    pub ways: Option<f64>,
    /// In the forces of the fluid on bodies that are held or moved, over them.
    pub loads: Option<f64>,
}

impl StepErrorReport {
    /// Warns where fixed steps are too long, with those that would do; of a flow past bodies in which vortices need a step of
    /// `vortices` (s) at most.
    pub(in crate::run) fn log(&self, settings: &Unsteady, vortices: f64) {
        let parts = [
            ("velocity of the fluid", self.velocity),
            ("ways of the bodies", self.ways),
            ("forces on the bodies", self.loads),
        ];
        let known = parts.into_iter().filter_map(|(name, part)| Some((name, part?)));
        let largest = known.max_by(|one, other| one.1.total_cmp(&other.1));
        let step = settings.step;
        if let Some((name, part)) = largest.filter(|(_, part)| *part > NOTABLE) {
            let order = match settings.scheme {
                Scheme::Bdf1 => 1.0,
                Scheme::Bdf2 => 2.0,
                Scheme::Rk3 => 3.0,
            };
            let shorter = (step * (NOTABLE / part).powf(1.0 / order)).min(vortices);
            tracing::warn!(
                "the steps are too long: they leave about {:.0} % in the {name}, by estimates over all of the \
                 run; lower time.unsteady.step to {shorter:.1e} or less for {:.0} %, or leave it out, and \
                 steps are as long as their errors allow",
                100.0 * part,
                100.0 * NOTABLE
            );
        } else if step > vortices {
            tracing::warn!(
                "the steps are too long to tell whether vortices leave a body one after the other: an \
                 oscillation of less than {STEPS_OF_A_PERIOD} steps would be damped; lower \
                 time.unsteady.step to {vortices:.1e} or less, or leave it out, and steps are as long as \
                 their errors allow"
            );
        }
    }
}

/// What is rounding of a run so far: nothing follows from errors of that size.
pub(in crate::run) struct RoundingOfMotion {
    /// Integral of the mean square of the velocity of the fluid (m2/s).
    pub flow: f64,
    /// Way of a body (m).
    pub way: f64,
    /// Integral of the square of the force on each body (N2 s).
    pub loads: Vec<f64>,
}

impl<const D: usize> Simulation<D> {
    /// What is rounding: a way, the speed with which the time so far would lead to it, and what fluid of that speed does
    /// to bodies.
    pub(in crate::run) fn rounding_of_motion(&self) -> RoundingOfMotion {
        let Self { problem, state, .. } = self;
        let (way, time) = (ROUNDING * self.extent(), state.time);
        let speed = if time > 0.0 { way / time } else { 0.0 };
        let load = |body: &RigidBody| {
            let width = body.volume.mass.powf(1.0 / D as f64);
            let friction = problem.viscosity.at_rate(speed / width) * speed / width;
            let area = width.powf(D as f64 - 1.0);
            time * (area * (problem.density * speed * speed + friction)).powi(2)
        };
        let loads = problem.bodies.iter().map(load).collect();
        RoundingOfMotion { flow: time * speed * speed, way, loads }
    }

    /// The longest step (s) with which vortices behind bodies are followed; infinite where there are none.
    pub(in crate::run) fn longest_step_of_vortices(&self) -> f64 {
        let Self { problem, state, .. } = self;
        if !problem.has_convection || problem.metric.is_revolved() {
            return f64::INFINITY;
        }
        let of_body = |(body, rigid): (usize, &RigidBody)| {
            let own = on_mesh::<D>(&state.now.twists[body].linear);
            let relative = state.now.velocity.iter().map(|velocity| (velocity - own).norm());
            let speed = relative.fold(0.0, f64::max);
            let width = rigid.volume.mass.powf(1.0 / D as f64);
            let viscosity = problem.viscosity.at_rate(speed / width);
            let reynolds = problem.density * speed * width / viscosity;
            let period = PERIOD * width / speed;
            if reynolds > SHEDDING { period / STEPS_OF_A_PERIOD } else { f64::INFINITY }
        };
        let bodies = problem.bodies.iter().enumerate().take(MOST_BODIES);
        bodies.map(of_body).fold(f64::INFINITY, f64::min)
    }
}

/// A component of the force on a body.
#[derive(Debug, Clone, Copy)]
struct Component {
    /// Its column.
    column: usize,
    /// Whether it is a result, and not what accelerates a body that is free.
    is_result: bool,
}

/// The errors of the forces on bodies that are held or moved, by their second differences.
pub(in crate::run) struct LoadErrors {
    /// Components of the forces, of each body.
    components: Vec<Vec<Component>>,
    /// Error of a second difference of one.
    share: f64,
    sums: Vec<Vec<SquaredError>>,
}

impl LoadErrors {
    /// Of a run whose quantities have these names.
    pub fn new<const D: usize>(simulation: &Simulation<D>, names: &[String]) -> Self {
        let Simulation { problem, scheme, .. } = simulation;
        let components: Vec<Vec<Component>> =
            (0..problem.bodies.len()).map(|body| components_of(problem, body, names)).collect();
        let sums = components.iter().map(|own| vec![SquaredError::default(); own.len()]).collect();
        Self { components, share: error_of_second_difference(problem, scheme.convection), sums }
    }

    /// Adds all rows of a run that resumes.
    pub fn resume(&mut self, series: &Series) {
        (1..=series.rows.len()).for_each(|count| self.add_row(series, count));
    }

    /// Adds the last row.
    pub fn add(&mut self, series: &Series) {
        self.add_row(series, series.rows.len());
    }

    fn add_row(&mut self, series: &Series, count: usize) {
        if count < START_ROWS + 3 {
            return;
        }
        let [before, now, new] = [3, 2, 1].map(|back| &series.rows[count - back]);
        let [start, middle, end] = [3, 2, 1].map(|back| series.times[count - back]);
        let (step, growth) = (end - middle, (end - middle) / (middle - start));
        for (components, sums) in self.components.iter().zip(&mut self.sums) {
            for (&Component { column, .. }, sum) in components.iter().zip(sums) {
                let last = now[column] - before[column];
                let off = self.share * (new[column] - now[column] - growth * last);
                sum.error += step * off * off;
                sum.size += step * new[column] * new[column];
            }
        }
    }

    /// The largest error of a component that is notable, over it; none of those whose square has an integral that is
    /// rounding for its body (N2 s).
    pub fn largest(&self, rounding: &[f64]) -> Option<f64> {
        let of_body = |(body, sums): (usize, &Vec<SquaredError>)| {
            let components = &self.components[body];
            let rounding = rounding.get(body).copied().unwrap_or(0.0);
            let largest = sums.iter().map(|sum| sum.size).fold(0.0, f64::max);
            let is_notable = |sum: &SquaredError| sum.size >= NOTABLE_LOAD * NOTABLE_LOAD * largest;
            let parts = components.iter().zip(sums).filter_map(|(component, sum)| {
                sum.part(rounding).filter(|_| component.is_result && is_notable(sum))
            });
            parts.max_by(f64::total_cmp)
        };
        self.sums.iter().enumerate().filter_map(of_body).max_by(f64::total_cmp)
    }
}

/// The components of the force on a body.
fn components_of<const D: usize>(
    problem: &Problem<D>,
    body: usize,
    names: &[String],
) -> Vec<Component> {
    if !problem.has_inertia {
        return Vec::new();
    }
    let rigid = &problem.bodies[body];
    let component = |axis: usize| {
        let name = format!("{}.force.{}", rigid.name, ["x", "y", "z"][axis]);
        let column = names.iter().position(|known| *known == name)?;
        let drive = rigid.drive(Mode::along(axis));
        Some(Component { column, is_result: matches!(drive, Drive::Held | Drive::Given(_)) })
    };
    (0..3).filter_map(component).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A force that oscillates about a mean in steps of a size.
    fn errors(step: f64, amplitude: f64) -> LoadErrors {
        let component = |column: usize| Component { column, is_result: true };
        let mut errors = LoadErrors {
            components: vec![[0, 1].map(component).to_vec()],
            share: 1.3,
            sums: vec![vec![SquaredError::default(); 2]],
        };
        let mut series = Series::default();
        for n in 0..2000 {
            let time = f64::from(n) * step;
            series.times.push(time);
            series.rows.push(vec![1.0, amplitude * time.sin()]);
            errors.add(&series);
        }
        errors
    }

    fn error(step: f64, amplitude: f64) -> f64 {
        errors(step, amplitude).largest(&[0.0]).unwrap()
    }

    #[test]
    fn the_error_of_an_oscillating_force_falls_with_the_square_of_the_step() {
        let (coarse, fine) = (error(0.2, 0.3), error(0.1, 0.3));
        assert!((coarse / (1.3 * 0.04) - 1.0).abs() < 0.02, "{coarse}");
        assert!((coarse / fine - 4.0).abs() < 0.1, "{coarse} {fine}");
        // Much smaller than the mean force beside it
        assert!(error(0.2, 0.01) < 1e-12);
        // A mean force of one over a time of 400 and less
        assert!(errors(0.2, 0.3).largest(&[350.0]).is_some());
        assert_eq!(errors(0.2, 0.3).largest(&[450.0]), None);
    }
}
