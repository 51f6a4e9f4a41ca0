//! The run: build, solve or march, measure, tell the observers.

use alewife_mesh::Mesh;

use super::march::advance;
use super::measure::Measure;
use super::snapshot::{Observer, Remains, Snapshot};
use super::state::State;
use super::steady::{SteadyFlow, solve_steady};
use super::{RunError, Series, Stage, Timing, build_mesh, build_problem};
use crate::case::{Case, Convection, Initial, Scheme, Steady, TimeSettings, Unsteady};
use crate::coupling::{FluidSystem, Problem, memory_estimate};
use crate::time::Bdf;

/// What a finished run leaves in memory.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// All quantities at all steps.
    pub series: Series,
    /// Time spent.
    pub timing: Timing,
    /// Free unknowns of the linear system.
    pub n_dofs: usize,
    /// Steps made.
    pub steps: usize,
}

/// The first step is made in pieces of 1/128, 1/128, 1/64, ... 1/2 of it: the only first-order
/// piece is so short that it does not lower the order of the whole.
const START_PIECES: u32 = 7;

/// Runs a case from beginning to end.
///
/// # Errors
/// Whatever stops the run; observers are told before it is returned.
pub fn simulate(case: &Case, observers: &mut [Box<dyn Observer<2>>]) -> Result<Outcome, RunError> {
    let mut run = Run { case, observers, timing: Timing::default(), series: Series::default() };
    let mut parts = None;
    let result = run.start(&mut parts);
    if let Err(error) = &result {
        let remains = parts.as_ref().map(|parts| Remains {
            time: parts.state.time,
            mesh: &parts.state.mesh,
            velocity: &parts.state.now.velocity,
            pressure: &parts.state.now.pressure,
        });
        for observer in run.observers.iter_mut() {
            observer.on_failure(error, remains.as_ref())?;
        }
    }
    let (n_dofs, steps) = result?;
    for observer in run.observers.iter_mut() {
        observer.on_end(&run.timing)?;
    }
    Ok(Outcome { series: run.series, timing: run.timing, n_dofs, steps })
}

struct Run<'a> {
    case: &'a Case,
    observers: &'a mut [Box<dyn Observer<2>>],
    timing: Timing,
    series: Series,
}

/// What a run is made of once it is built.
struct Parts {
    problem: Problem,
    system: FluidSystem,
    measure: Measure,
    state: State,
}

impl Run<'_> {
    /// Runs the case; what it is made of is left in `parts` once it is there.
    fn start(&mut self, parts: &mut Option<Parts>) -> Result<(usize, usize), RunError> {
        let case = self.case;
        let mesh = self.timing.measure(Stage::Mesh, || build_mesh(case))?;
        tracing::info!(cells = mesh.n_cells(), nodes = mesh.n_nodes(), "mesh made");
        check_memory(&mesh)?;
        let problem = build_problem(case, &mesh)?;
        // A frame whose velocity is itself sought enters the convection of every cell.
        let is_linear = match &case.time {
            TimeSettings::Steady(_) => false,
            TimeSettings::Unsteady(settings) => settings.convection == Convection::Extrapolated,
        };
        let unknown_frame = problem.frame.is_some() && problem.has_convection && !is_linear;
        let parts = parts.insert(self.parts(problem, mesh, unknown_frame)?);
        let n_steps = match &case.time {
            TimeSettings::Steady(settings) => self.steady(settings, parts)?,
            TimeSettings::Unsteady(settings) => self.unsteady(settings, parts)?,
        };
        Ok((parts.system.n_unknowns, n_steps))
    }

    fn parts(
        &mut self,
        problem: Problem,
        mesh: Mesh<2>,
        unknown_frame: bool,
    ) -> Result<Parts, RunError> {
        let poses: Vec<_> = problem.bodies.iter().map(|body| body.pose).collect();
        let system = self
            .timing
            .measure(Stage::Assembly, || FluidSystem::new(&problem, &mesh, &poses, unknown_frame));
        tracing::info!(unknowns = system.n_unknowns, entries = system.n_entries(), "system built");
        let measure = Measure::new(self.case, &mesh).map_err(RunError::Unsupported)?;
        self.series.names = measure.names().to_vec();
        let state = State::at_rest(&problem, mesh);
        Ok(Parts { problem, system, measure, state })
    }

    /// Solves for the flow at time zero without a time derivative.
    fn solve(&mut self, settings: &Steady, parts: &mut Parts) -> Result<SteadyFlow, RunError> {
        let Parts { problem, system, state, .. } = parts;
        let timing = &mut self.timing;
        solve_steady(system, problem, &state.mesh, &state.poses, 0.0, settings, timing).map_err(
            |failure| {
                state.now = failure.last;
                failure.error
            },
        )
    }

    fn steady(&mut self, settings: &Steady, parts: &mut Parts) -> Result<usize, RunError> {
        let flow = self.solve(settings, parts)?;
        parts.state.now = flow.solution;
        self.report(parts, &flow.residual, (flow.iterations, 0.0), true)?;
        Ok(0)
    }

    fn unsteady(&mut self, settings: &Unsteady, parts: &mut Parts) -> Result<usize, RunError> {
        let mut residual = vec![0.0; parts.system.layout.n_raw()];
        if settings.initial == Initial::Stokes {
            let convects = std::mem::replace(&mut parts.problem.has_convection, false);
            let flow = self.solve(&Steady { tolerance: 1e-10, max_iterations: 5 }, parts)?;
            parts.problem.has_convection = convects;
            parts.state.now = flow.solution.clone();
            parts.state.previous = flow.solution;
            residual = flow.residual;
        }
        self.report(parts, &residual, (0, 0.0), false)?;
        let n_steps = count_steps(settings);
        let mut before = None;
        for index in 0..n_steps {
            let started = parts.state.time;
            let mut iterations = 0;
            for step in step_pieces(settings, index) {
                let bdf = match (settings.scheme, before.replace(step)) {
                    (Scheme::Bdf2, Some(before)) => Bdf::second_order(step, before),
                    _ => Bdf::first_order(step),
                };
                parts.state.step = index;
                let result = advance(
                    &mut parts.system,
                    &parts.problem,
                    &mut parts.state,
                    &bdf,
                    settings.convection,
                    &mut self.timing,
                )?;
                residual = result.residual;
                iterations += result.iterations;
            }
            // Counted, not summed, so that rounding does not pile up.
            let whole = (index + 1) as f64 * settings.step;
            parts.state.time = if index + 1 == n_steps { settings.end } else { whole };
            let step = parts.state.time - started;
            self.report(parts, &residual, (iterations, step), index + 1 == n_steps)?;
            if index + 1 < n_steps && self.observers.iter().any(|observer| observer.wants_stop()) {
                return Err(RunError::Stopped { step: index + 1, time: parts.state.time });
            }
        }
        Ok(n_steps)
    }

    fn report(
        &mut self,
        parts: &Parts,
        residual: &[f64],
        (iterations, time_step): (usize, f64),
        is_last: bool,
    ) -> Result<(), RunError> {
        let Parts { problem, system, measure, state } = parts;
        let (bodies, values) =
            self.timing.measure(Stage::Loads, || measure.measure(system, problem, state, residual));
        self.series.times.push(state.time);
        let timing = self.timing;
        let snapshot = Snapshot {
            case: self.case,
            step: state.step,
            time: state.time,
            time_step,
            mesh: &state.mesh,
            velocity: &state.now.velocity,
            pressure: &state.now.pressure,
            bodies: &bodies,
            names: measure.names(),
            values: &values,
            n_dofs: system.n_unknowns,
            iterations,
            timing: &timing,
            is_last,
        };
        let observers = &mut self.observers;
        self.timing.measure(Stage::Output, || {
            observers.iter_mut().try_for_each(|observer| observer.on_step(&snapshot))
        })?;
        self.series.rows.push(values);
        Ok(())
    }
}

/// Refuses a mesh whose system would not fit into the memory that is free, where the system tells.
fn check_memory(mesh: &Mesh<2>) -> Result<(), RunError> {
    const GIGABYTE: f64 = 1e9;
    let n_dofs = 2 * mesh.n_nodes() + mesh.n_vertices;
    let needed = memory_estimate(n_dofs) / GIGABYTE;
    let told = std::fs::read_to_string("/proc/meminfo").unwrap_or_default();
    let line = told.lines().find_map(|line| line.strip_prefix("MemAvailable:"));
    let kilobytes = line.and_then(|line| line.trim().trim_end_matches(" kB").parse::<f64>().ok());
    match kilobytes.map(|kilobytes| kilobytes * 1024.0 / GIGABYTE) {
        Some(available) if needed > available => {
            Err(RunError::TooLarge { n_dofs, needed, available })
        }
        _ => Ok(()),
    }
}

/// Number of steps to the end; rounding of their ratio makes no step more.
fn count_steps(settings: &Unsteady) -> usize {
    (settings.end / settings.step - 1e-9).ceil().max(1.0) as usize
}

/// Sizes of the pieces in which a step is made.
fn step_pieces(settings: &Unsteady, index: usize) -> Vec<f64> {
    // The last step ends at the end.
    let rest = settings.end - settings.step * index as f64;
    let step = if index + 1 == count_steps(settings) { rest } else { settings.step };
    if index == 0 && settings.scheme == Scheme::Bdf2 {
        let part = |piece: u32| step / f64::from(1u32 << piece);
        std::iter::once(START_PIECES).chain((1..=START_PIECES).rev()).map(part).collect()
    } else {
        vec![step]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_end_at_the_end_and_never_more_than_double() {
        let settings = Unsteady {
            step: 0.1,
            end: 0.95,
            scheme: Scheme::Bdf2,
            convection: Convection::Extrapolated,
            initial: Initial::Rest,
            adaptive: None,
        };
        assert_eq!(count_steps(&settings), 10);
        let pieces: Vec<f64> = (0..10).flat_map(|index| step_pieces(&settings, index)).collect();
        assert!((pieces.iter().sum::<f64>() - 0.95).abs() < 1e-14);
        for pair in pieces.windows(2) {
            assert!(pair[1] / pair[0] <= 2.0 + 1e-12);
        }
    }
}
