//! The run: build, solve or march, measure, tell the observers.

use alewife_mesh::Mesh;

use super::build::{contact_law, first_mesh};
use super::follow::Follower;
use super::march::{March, MeshPath};
use super::measure::{Measure, Moving};
use super::opened::Opened;
use super::remake::remake;
use super::saved::SavedState;
use super::snapshot::{Observer, Remains, Snapshot};
use super::state::{State, poses_at};
use super::steady::{SteadyFlow, solve_steady};
use super::{RunError, Series, Stage, StepError, StepResult, Timing, build_problem};
use crate::case::{Adaptive, Convection, Initial, Model, Scheme, Steady, TimeSettings, Unsteady};
use crate::contact::{ContactError, Gaps, Law};
use crate::coupling::{
    BodyLoads, BodyShapes, FluidSystem, Levels, Problem, body_loads, mean_motion, memory_estimate,
};
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

/// The smallest step over the given one, of fixed steps that are halved where they must be.
const SMALLEST_PART: f64 = 1.0 / 1024.0;

/// Part of a step by which a discontinuity of rates may be off and still be at its end.
const SAME_TIME: f64 = 1e-7;

/// Error over the tolerance above which a step is not taken.
const REJECTED: f64 = 2.0;

/// Runs a case from beginning to end.
///
/// # Errors
/// Whatever stops the run; observers are told before it is returned.
pub fn simulate(
    model: &Model,
    observers: &mut [Box<dyn Observer<2>>],
) -> Result<Outcome, RunError> {
    simulate_from(model, None, observers)
}

/// Runs a case to its end, from a saved state if there is one.
///
/// # Errors
/// Whatever stops the run; observers are told before it is returned.
pub fn simulate_from(
    model: &Model,
    saved: Option<&SavedState>,
    observers: &mut [Box<dyn Observer<2>>],
) -> Result<Outcome, RunError> {
    let mut run = Run { model, observers, timing: Timing::default(), series: Series::default() };
    let mut parts = None;
    let result = run.start(saved, &mut parts);
    if let Err(error) = &result {
        let is_march = matches!(model.case.time, TimeSettings::Unsteady(_));
        let saved = parts.as_ref().filter(|_| is_march).map(Parts::saved);
        let remains = parts.as_ref().map(|parts| Remains {
            saved: saved.as_ref(),
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
    model: &'a Model,
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
    /// Moves the mesh, where bodies move in it.
    follower: Option<Follower>,
    law: Option<Law>,
    /// Whether the frame's velocity is an unknown of the convection.
    unknown_frame: bool,
    /// Meshes made since the first.
    remeshes: usize,
    /// Whether no step has been made on this mesh.
    is_fresh: bool,
}

impl Parts {
    fn saved(&self) -> SavedState {
        SavedState::of(&self.problem, &self.state, self.follower.as_ref(), self.remeshes)
    }

    /// Takes a saved state in place of the one at time zero.
    fn go_on_from(&mut self, model: &Model, saved: &SavedState) -> Result<(), String> {
        let boundaries = &self.state.mesh.boundaries;
        let (state, follower) = saved.restore(model, &self.problem, boundaries)?;
        let poses = state.poses_in_mesh();
        self.system = FluidSystem::new(&self.problem, &state.mesh, &poses, self.unknown_frame);
        if follower.is_none() {
            self.measure.follow(&model.case, &state.mesh_in_frame());
        }
        (self.state, self.follower) = (state, follower);
        (self.remeshes, self.is_fresh) = (saved.remeshes(), false);
        Ok(())
    }

    /// Takes note of where swimmers are.
    fn take_record(&mut self, loads: &[BodyLoads]) {
        let Self { problem, state, .. } = self;
        if problem.groups.is_empty() {
            return;
        }
        if state.last_step == 0.0 {
            let efforts = state.efforts(problem, &state.places, &state.now, loads);
            state.swims.iter_mut().zip(&efforts).for_each(|(swim, effort)| swim.start(effort));
        }
        let poses = state.poses();
        for (group, swim) in problem.groups.iter().zip(&mut state.swims) {
            let Some(period) = group.period else { continue };
            let center = mean_motion(problem, group, &poses, &state.now.twists).center;
            let angle = state.places[group.bodies[0]][2];
            swim.cycles.push(swim.record(state.time, [center.x, center.y, angle]), period);
        }
    }

    /// Whether rates of gaits jump within `near` (s) of now.
    fn is_at_discontinuity(&self, near: f64) -> bool {
        let time = self.state.time;
        let times = self.problem.rate_discontinuities.as_ref();
        times.is_some_and(|times| !times(time - near, time + near).is_empty())
    }

    /// Loads of the fluid by the raw residual at the present solution.
    fn loads(&self, residual: &[f64]) -> Vec<BodyLoads> {
        body_loads(
            &self.problem,
            &self.state.mesh,
            &self.system.layout,
            &self.system.sides,
            &self.state.poses_in_mesh(),
            residual,
            &self.state.now.velocity,
        )
    }

    /// Cells the fluid crosses in a second at most (1/s).
    fn crossings(&self) -> f64 {
        let state = &self.state;
        let frame = state.origin_at(&self.problem, &state.places)
            - state.origin_at(&self.problem, &state.previous_places);
        let mut most = f64::MIN_POSITIVE;
        for nodes in state.mesh.cells() {
            let [a, b, c] = [0, 1, 2].map(|corner| state.nodes[nodes[corner]]);
            let edge = (b - a).norm().min((c - b).norm()).min((a - c).norm());
            for &node in nodes {
                let way = state.nodes[node] - state.nodes_before[node] + frame;
                let passing = state.now.velocity[node] - way / state.last_step;
                most = most.max(passing.norm() / edge);
            }
        }
        most
    }
}

/// What the pieces of a step come to.
#[derive(Default)]
struct Made {
    loads: Vec<BodyLoads>,
    iterations: usize,
}

impl Made {
    fn add(&mut self, step: StepResult) {
        self.loads = step.loads;
        self.iterations += step.iterations;
    }
}

/// Change of the step after a step with this error over the tolerance; the error goes with the
/// third power of the step.
fn growth(error: f64) -> f64 {
    if error > 0.0 { (0.85 * error.powf(-1.0 / 3.0)).clamp(0.3, 1.5) } else { 1.5 }
}

/// No smaller step helps.
fn stuck(parts: &Parts, smallest: f64, error: &StepError) -> RunError {
    let state = &parts.state;
    let (step, time) = (state.step + 1, state.time);
    let nearest =
        parts.follower.as_ref().zip(state.contact.minimum_gap).map(|(follower, least)| {
            let surfaces = follower.surfaces();
            let names = [surfaces.body_name(least.body), surfaces.partner_name(least.partner)];
            format!("; nearest are `{}` and `{}`, {:.3e} apart", names[0], names[1], least.gap)
        });
    let reason = format!("{error}{}", nearest.unwrap_or_default());
    RunError::Stuck { step, time, smallest, reason }
}

impl Run<'_> {
    /// Runs the case; what it is made of is left in `parts` once it is there.
    fn start(
        &mut self,
        saved: Option<&SavedState>,
        parts: &mut Option<Parts>,
    ) -> Result<(usize, usize), RunError> {
        let (model, case) = (self.model, &self.model.case);
        let (mesh, opened) = self.timing.measure(Stage::Mesh, || first_mesh(model))?;
        tracing::info!(cells = mesh.n_cells(), nodes = mesh.n_nodes(), "mesh made");
        check_memory(&mesh)?;
        let problem = build_problem(model, &mesh)?;
        // A frame whose velocity is itself sought enters the convection of every cell.
        let is_linear = match &case.time {
            TimeSettings::Steady(_) => false,
            TimeSettings::Unsteady(settings) => settings.convection == Convection::Extrapolated,
        };
        let unknown_frame = problem.frame.is_some() && problem.has_convection && !is_linear;
        let parts = parts.insert(self.parts(problem, mesh, opened, unknown_frame)?);
        if let Some(saved) = saved {
            parts.go_on_from(model, saved).map_err(|reason| {
                RunError::Unsupported(format!("the state cannot be gone on from: {reason}"))
            })?;
        }
        let n_steps = match &case.time {
            TimeSettings::Steady(settings) => self.steady(settings, parts)?,
            TimeSettings::Unsteady(settings) => self.unsteady(settings, saved.is_some(), parts)?,
        };
        Ok((parts.system.n_unknowns, n_steps))
    }

    fn parts(
        &mut self,
        problem: Problem,
        mesh: Mesh<2>,
        opened: Opened,
        unknown_frame: bool,
    ) -> Result<Parts, RunError> {
        let mut state = State::at_rest(&problem, mesh);
        state.wraps = opened.shifts;
        let mesh = &state.mesh;
        let poses = state.poses_in_mesh();
        let mut system = self
            .timing
            .measure(Stage::Assembly, || FluidSystem::new(&problem, mesh, &poses, unknown_frame));
        tracing::info!(unknowns = system.n_unknowns, entries = system.n_entries(), "system built");
        let measure = Measure::new(self.model, mesh).map_err(RunError::Unsupported)?;
        self.series.names = measure.names().to_vec();
        let follower = if self.model.mesh_moves() {
            let (domain, shapes) = (opened.domain, opened.shapes);
            let places = state.wrapped(&state.places);
            let made = self.timing.measure(Stage::MeshMotion, || {
                Follower::new(self.model, &problem, &state.mesh, domain, shapes, (places, 0.0))
            });
            Some(made.map_err(RunError::Mesh)?)
        } else {
            None
        };
        // Meshed with straight sides: a sheet has its shape from the beginning.
        if let Some(follower) = follower.as_ref().filter(|follower| follower.waves()) {
            let nodes = follower.nodes(&state.places, &BodyShapes::at(&problem.bodies, 0.0)?);
            state.nodes = nodes.map_err(|error| RunError::Mesh(error.to_string()))?;
            state.nodes_before.clone_from(&state.nodes);
            state.mesh.nodes.clone_from(&state.nodes);
            system.move_to(&problem, &state.mesh);
        }
        if let Some(follower) = &follower {
            state.contact.minimum_gap = follower.surfaces().minimum_gap(&poses_at(&state.places));
        }
        let law = self.model.case.contact.as_ref().map(contact_law).transpose()?;
        Ok(Parts {
            problem,
            system,
            measure,
            state,
            follower,
            law,
            unknown_frame,
            remeshes: 0,
            is_fresh: true,
        })
    }

    /// Solves for the flow at time zero without a time derivative.
    fn solve(
        &mut self,
        settings: &Steady,
        levels: &Levels,
        parts: &mut Parts,
    ) -> Result<SteadyFlow, RunError> {
        let Parts { problem, system, state, .. } = parts;
        let timing = &mut self.timing;
        solve_steady(
            system,
            problem,
            &state.mesh,
            &state.poses_in_mesh(),
            (0.0, levels),
            settings,
            timing,
        )
        .map_err(|failure| {
            state.now = failure.last;
            failure.error
        })
    }

    fn steady(&mut self, settings: &Steady, parts: &mut Parts) -> Result<usize, RunError> {
        let flow = self.solve(settings, &Levels::steady(&parts.problem, 0.0), parts)?;
        parts.state.now = flow.solution;
        let loads = parts.loads(&flow.residual);
        self.report(parts, &loads, (flow.iterations, 0.0), true)?;
        Ok(0)
    }

    fn unsteady(
        &mut self,
        settings: &Unsteady,
        goes_on: bool,
        parts: &mut Parts,
    ) -> Result<usize, RunError> {
        if !goes_on {
            self.begin(settings, parts)?;
        }
        match &settings.adaptive {
            None => self.fixed_steps(settings, parts),
            Some(adaptive) => self.adaptive_steps(settings, adaptive, parts),
        }
    }

    /// The flow a march starts from.
    fn begin(&mut self, settings: &Unsteady, parts: &mut Parts) -> Result<(), RunError> {
        let mut loads = vec![BodyLoads::default(); parts.problem.bodies.len()];
        // Without inertia the flow has no memory, and is that of the bodies' places at any time.
        if settings.initial == Initial::Stokes || !parts.problem.has_inertia {
            let convects = std::mem::replace(&mut parts.problem.has_convection, false);
            // Where bodies have inertia their loads have not moved them yet.
            let levels = if parts.problem.has_inertia {
                Levels::default()
            } else {
                Levels::steady(&parts.problem, 0.0)
            };
            let settings = Steady { tolerance: 1e-10, max_iterations: 5 };
            let flow = self.solve(&settings, &levels, parts)?;
            parts.problem.has_convection = convects;
            parts.state.now = flow.solution.clone();
            parts.state.previous = flow.solution;
            loads = parts.loads(&flow.residual);
        }
        self.report(parts, &loads, (0, 0.0), false)
    }

    fn fixed_steps(&mut self, settings: &Unsteady, parts: &mut Parts) -> Result<usize, RunError> {
        let n_steps = count_steps(settings);
        let smallest = settings.step * SMALLEST_PART;
        // A run that goes on may be anywhere within a step.
        let first = (parts.state.time / settings.step + 1e-9).floor() as usize;
        for index in first..n_steps {
            let started = parts.state.time;
            let mut made = Made::default();
            let target = ((index + 1) as f64 * settings.step).min(settings.end);
            for (piece, is_restart) in pieces(settings, parts, target) {
                if is_restart {
                    // Rates jump: what was before tells nothing of what comes.
                    parts.state.last_step = 0.0;
                }
                // The next one first.
                let mut to_do = vec![piece];
                while let Some(size) = to_do.pop() {
                    // After a short one, not more than twice as long: BDF2 would not be stable.
                    let before = parts.state.last_step;
                    let grows = before > 0.0 && size > 2.1 * before;
                    if grows && settings.scheme == Scheme::Bdf2 {
                        to_do.extend([0.5 * size; 2]);
                        continue;
                    }
                    parts.state.step = index;
                    match self.step(settings, size, f64::INFINITY, parts)? {
                        Ok(step) => made.add(step),
                        Err(error) if size <= smallest => return Err(stuck(parts, size, &error)),
                        Err(_) => to_do.extend([0.5 * size; 2]),
                    }
                    // A step in many pieces may take long.
                    self.look_for_signals(parts, false)?;
                }
            }
            // Counted, not summed, so that rounding does not pile up.
            let whole = (index + 1) as f64 * settings.step;
            parts.state.time = if index + 1 == n_steps { settings.end } else { whole };
            let step = parts.state.time - started;
            let is_last = index + 1 == n_steps;
            self.report(parts, &made.loads, (made.iterations, step), is_last)?;
            self.look_for_signals(parts, is_last)?;
        }
        Ok(n_steps)
    }

    fn adaptive_steps(
        &mut self,
        settings: &Unsteady,
        adaptive: &Adaptive,
        parts: &mut Parts,
    ) -> Result<usize, RunError> {
        let largest = adaptive.largest.unwrap_or(settings.end / 10.0);
        let smallest = adaptive.smallest.unwrap_or(settings.step * 1e-6);
        let mut start = start_pieces(settings.scheme, true, settings.step.min(settings.end));
        start.reverse();
        let (mut proposed, mut index) = (settings.step, 0);
        if parts.state.last_step > 0.0 {
            start.clear();
            (proposed, index) = (settings.step.min(parts.state.last_step), parts.state.step);
        }
        loop {
            parts.state.step = index;
            let left = settings.end - parts.state.time;
            // Pieces of the first step grow fast enough by themselves.
            let near = SAME_TIME * proposed.min(left);
            if index > 0 && parts.is_at_discontinuity(near) {
                start = start_pieces(settings.scheme, true, settings.step.min(proposed));
                start.reverse();
                parts.state.last_step = 0.0;
            }
            let is_start = !start.is_empty() && settings.scheme == Scheme::Bdf2;
            let mut size = start.pop().unwrap_or(proposed).min(largest);
            let now = parts.state.time;
            let times = parts.problem.rate_discontinuities.as_ref();
            let next = times.and_then(|times| times(now + near, settings.end).first().copied());
            let left = next.map_or(left, |next| next - now);
            if left < 2.0 * size {
                size = if left <= size * (1.0 + 1e-9) { left } else { 0.5 * left };
            }
            let gap = parts.state.contact.minimum_gap.map(|least| least.gap);
            // Pieces of the first step are smaller than any that is asked for.
            let floor = if is_start { smallest.min(SMALLEST_PART * size) } else { smallest };
            let step = loop {
                match self.step(settings, size, adaptive.tolerance, parts)? {
                    Ok(step) => break step,
                    Err(error) if size <= floor => return Err(stuck(parts, size, &error)),
                    Err(StepError::Inexact { error, .. }) => {
                        size *= growth(error / adaptive.tolerance).min(0.7);
                    }
                    Err(_) => size *= 0.5,
                }
                size = size.max(floor);
                start.clear();
                self.look_for_signals(parts, false)?;
            };
            index += 1;
            let factor = if is_start { 2.0 } else { growth(step.error / adaptive.tolerance) };
            proposed = (size * factor).min(adaptive.cfl / parts.crossings());
            if let (Some(before), Some(now)) = (gap, parts.state.contact.minimum_gap) {
                let rate = (now.gap - before).abs() / size;
                proposed = proposed.min(adaptive.gap * now.gap / rate);
            }
            proposed = proposed.clamp(smallest, largest);
            let is_last = settings.end - parts.state.time <= 1e-9 * settings.end;
            if is_last {
                parts.state.time = settings.end;
            }
            parts.state.step = index;
            self.report(parts, &step.loads, (step.iterations, size), is_last)?;
            if is_last {
                return Ok(index);
            }
            self.look_for_signals(parts, is_last)?;
        }
    }

    /// Tries a step of this size, if need be on a new mesh. The state is where it was when no step
    /// was made.
    fn step(
        &mut self,
        settings: &Unsteady,
        size: f64,
        tolerance: f64,
        parts: &mut Parts,
    ) -> Result<Result<StepResult, StepError>, RunError> {
        // Not after the step before: what was measured belongs to its mesh.
        if !parts.is_fresh {
            self.remesh_where_needed(parts)?;
        }
        loop {
            let Parts { problem, system, state, follower, law, .. } = &mut *parts;
            let bdf = match settings.scheme {
                Scheme::Bdf2 if state.last_step > 0.0 => Bdf::second_order(size, state.last_step),
                _ => Bdf::first_order(size),
            };
            let jumps =
                settings.scheme == Scheme::Rk3 && state.last_step == 0.0 && state.time > 0.0;
            let march = March {
                problem,
                choice: settings.convection,
                path: follower.as_ref().map_or(MeshPath::Still, MeshPath::Bodies),
                contact: law.as_ref(),
            };
            let saved = tolerance.is_finite().then(|| state.clone());
            let (step, time) = (state.step + 1, state.time + size);
            let timing = &mut self.timing;
            let made = if settings.scheme == Scheme::Rk3 {
                march.advance_explicit(system, state, size, jumps, timing)
            } else {
                march.advance(system, state, &bdf, timing)
            };
            match made {
                Ok(made) if made.error > REJECTED * tolerance => {
                    if let Some(saved) = saved {
                        *state = saved;
                    }
                    return Ok(Err(StepError::Inexact { error: made.error, tolerance }));
                }
                Ok(made) => {
                    parts.is_fresh = false;
                    return Ok(Ok(made));
                }
                Err(StepError::Run(error)) if !matches!(error, RunError::NewtonStalled { .. }) => {
                    return Err(error);
                }
                Err(StepError::Contact(reason @ ContactError::TooWeak { .. })) => {
                    return Err(RunError::Contact { step, time, reason: Box::new(reason) });
                }
                Err(error @ StepError::Mesh { .. }) if !parts.is_fresh => {
                    self.remesh(parts, &error.to_string())?;
                }
                Err(error) => {
                    tracing::info!(step, time, size, %error, "step not made");
                    return Ok(Err(error));
                }
            }
        }
    }

    fn remesh_where_needed(&mut self, parts: &mut Parts) -> Result<(), RunError> {
        let Parts { problem, state, follower: Some(follower), .. } = &mut *parts else {
            return Ok(());
        };
        let shapes = BodyShapes::at(&problem.bodies, state.time)?;
        let places = state.in_frame(&state.origin, &state.places);
        // Seen from the frame.
        std::mem::swap(&mut state.mesh.nodes, &mut state.nodes);
        let reason = self
            .timing
            .measure(Stage::MeshMotion, || follower.wants_remesh(&state.mesh, &places, &shapes));
        std::mem::swap(&mut state.mesh.nodes, &mut state.nodes);
        match reason {
            None => Ok(()),
            Some(reason) => self.remesh(parts, &reason.to_string()),
        }
    }

    fn remesh(&mut self, parts: &mut Parts, reason: &str) -> Result<(), RunError> {
        let Parts { problem, system, state, follower: Some(follower), unknown_frame, .. } =
            &mut *parts
        else {
            return Ok(());
        };
        let (step, time) = (state.step, state.time);
        *follower = self
            .timing
            .measure(Stage::Mesh, || remake(self.model, problem, state, follower))
            .map_err(|reason| RunError::Remesh { step, time, reason })?;
        tracing::info!(step, time, cells = state.mesh.n_cells(), reason, "mesh made anew");
        let poses = state.poses_in_mesh();
        *system = self.timing.measure(Stage::Assembly, || {
            FluidSystem::new(problem, &state.mesh, &poses, *unknown_frame)
        });
        parts.remeshes += 1;
        parts.is_fresh = true;
        Ok(())
    }

    fn look_for_signals(&self, parts: &Parts, is_last: bool) -> Result<(), RunError> {
        if !is_last && self.observers.iter().any(|observer| observer.wants_stop()) {
            return Err(RunError::Stopped { step: parts.state.step, time: parts.state.time });
        }
        Ok(())
    }

    fn report(
        &mut self,
        parts: &mut Parts,
        loads: &[BodyLoads],
        (iterations, time_step): (usize, f64),
        is_last: bool,
    ) -> Result<(), RunError> {
        parts.take_record(loads);
        if parts.follower.is_some() && !self.model.case.probe.is_empty() {
            let seen = parts.state.mesh_in_frame();
            self.timing.measure(Stage::Loads, || parts.measure.follow(&self.model.case, &seen));
        }
        let Parts { problem, system, measure, state, remeshes, follower, .. } = &mut *parts;
        let moving = follower.as_ref().map(|_| Moving { remeshes: *remeshes });
        let (bodies, values) = self
            .timing
            .measure(Stage::Loads, || measure.measure(system, problem, state, loads, moving))?;
        self.series.times.push(state.time);
        let timing = self.timing;
        let snapshot = Snapshot {
            case: &self.model.case,
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

/// Sizes of the pieces of a step to a time, cut where rates of gaits jump, each with whether the march
/// starts anew with it.
fn pieces(settings: &Unsteady, parts: &Parts, target: f64) -> Vec<(f64, bool)> {
    let state = &parts.state;
    let near = SAME_TIME * settings.step;
    let times = parts.problem.rate_discontinuities.as_ref();
    let mut at = state.time;
    let mut ends = times.map_or_else(Vec::new, |times| times(state.time + near, target - near));
    ends.push(target);
    let mut is_start = state.last_step == 0.0 || parts.is_at_discontinuity(near);
    let mut pieces = Vec::new();
    for end in ends {
        let sizes = start_pieces(settings.scheme, is_start, end - at);
        pieces
            .extend(sizes.into_iter().enumerate().map(|(nth, size)| (size, is_start && nth == 0)));
        (at, is_start) = (end, true);
    }
    pieces
}

/// Sizes of the pieces in which a step is made.
fn start_pieces(scheme: Scheme, is_start: bool, step: f64) -> Vec<f64> {
    if is_start && scheme == Scheme::Bdf2 {
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
        let pieces = start_pieces(settings.scheme, true, 0.1);
        assert!((pieces.iter().sum::<f64>() - 0.1).abs() < 1e-14);
        for pair in pieces.windows(2) {
            assert!(pair[1] / pair[0] <= 2.0 + 1e-12);
        }
    }
}
