//! One time step: BDF for fluid and bodies together, convection extrapolated or by Newton.
//!
//! The mesh may travel with a body as a whole (`frame`): then w is the frame's velocity, and the
//! unknown stays the velocity seen from the laboratory, so that no inertial force appears.

use alewife_mesh::Point;
use nalgebra::Vector3;

use super::state::State;
use super::{RunError, Stage, Timing};
use crate::body::{Pose, Twist};
use crate::case::Convection as ConvectionChoice;
use crate::coupling::{
    FluidSystem, Levels, Problem, Solution, SolveError, embed, flatten, newton_convection,
};
use crate::flow::{Convection, FlowTerms};
use crate::time::Bdf;

/// Most Newton iterations of one step.
const MAX_ITERATIONS: usize = 20;
/// Residual relative to the first of the step that counts as converged.
const TOLERANCE: f64 = 1e-10;
/// Residuals relative to the first that count as rounding once they stop falling.
const ROUNDING: f64 = 1e-7;

/// What a step leaves for measurements.
#[derive(Debug, Clone)]
pub struct StepResult {
    /// Raw residual of the fluid's equations at the new solution.
    pub residual: Vec<f64>,
    /// Linear systems solved.
    pub iterations: usize,
}

fn rigid(twist: &Twist) -> [f64; 3] {
    [twist.linear.x, twist.linear.y, twist.angular.z]
}

/// Advances `state` by the step of `bdf`. On error the state is where it was.
///
/// # Errors
/// When the system is singular, the solution not finite, or Newton's method stalls.
pub fn advance(
    system: &mut FluidSystem,
    problem: &Problem,
    state: &mut State,
    bdf: &Bdf,
    choice: ConvectionChoice,
    timing: &mut Timing,
) -> Result<StepResult, RunError> {
    let time = state.time + bdf.step;
    let step = state.step + 1;
    let fail = |error: SolveError| RunError::from_solve(error, step, time);

    // Bodies first: how they will be turned, for the slip that turns with them.
    let n_bodies = problem.bodies.len();
    let poses: Vec<Pose> = (0..n_bodies)
        .map(|body| {
            let spin = bdf.extrapolate(
                state.now.twists[body].angular.z,
                state.previous.twists[body].angular.z,
            );
            let angle = bdf.integrate(spin, state.angles[body], state.previous_places[body][2]);
            let center = &state.poses[body].center;
            Pose::planar(center.x, center.y, angle)
        })
        .collect();
    let constraints = system.constraints(problem, &state.mesh, &poses, time);

    let pairs = state.now.velocity.iter().zip(&state.previous.velocity);
    let history: Vec<Point<2>> =
        pairs.clone().map(|(now, previous)| bdf.history(*now, *previous)).collect();
    let ahead: Vec<Point<2>> =
        pairs.map(|(now, previous)| bdf.extrapolate(*now, *previous)).collect();
    let body_pairs = state.now.twists.iter().zip(&state.previous.twists);
    let levels = Levels {
        rate: bdf.next,
        history: body_pairs
            .map(|(now, previous)| {
                let (now, previous) = (rigid(now), rigid(previous));
                [0, 1, 2].map(|mode| bdf.history(now[mode], previous[mode]))
            })
            .collect(),
    };
    let frame_of = |solution: &Solution| {
        problem.frame.map_or(Point::<2>::zeros(), |body| {
            let linear = &solution.twists[body].linear;
            Point::<2>::new(linear.x, linear.y)
        })
    };
    let frame_ahead = bdf.extrapolate(frame_of(&state.now), frame_of(&state.previous));

    // Nearer to the new level than the old one: less is left for an iterative solve.
    let levels_ahead = flatten(&state.now).into_iter().zip(flatten(&state.previous));
    let raw_ahead: Vec<f64> =
        levels_ahead.map(|(now, previous)| bdf.extrapolate(now, previous)).collect();
    let start = constraints.expand(&constraints.pick(&raw_ahead));
    let mut solution = embed(&system.layout, &start);
    let newton = choice == ConvectionChoice::Newton && problem.has_convection;
    let (mut first, mut last) = (0.0, f64::INFINITY);
    let mut iterations = 0;
    let residual = loop {
        let crossing: Vec<Point<2>> = match (problem.has_convection, newton) {
            (false, _) => Vec::new(),
            (true, false) => ahead.iter().map(|velocity| velocity - frame_ahead).collect(),
            (true, true) => {
                let frame = frame_of(&solution);
                solution.velocity.iter().map(|velocity| velocity - frame).collect()
            }
        };
        let terms = FlowTerms {
            viscosity: problem.viscosity,
            density: problem.density,
            rate: bdf.next,
            history: &history,
            crossing: &crossing,
            convection: match (problem.has_convection, newton) {
                (false, _) => Convection::None,
                (true, false) => Convection::Oseen,
                (true, true) => newton_convection(problem),
            },
            body_force: problem.body_force,
        };
        // A linear system is solved once; its second residual is only for the loads.
        let is_for_loads = !newton && iterations == 1;
        let stage = if is_for_loads { Stage::Loads } else { Stage::Assembly };
        let raw = timing.measure(stage, || system.fluid_residual(&state.mesh, &terms, &solution));
        if is_for_loads {
            break raw;
        }
        let reduced =
            system.reduced_residual(problem, &constraints, &levels, &solution, raw.clone());
        let size = reduced.iter().fold(0.0f64, |most, value| most.max(value.abs()));
        if iterations == 0 {
            first = size;
        }
        let relative = if first > 0.0 { size / first } else { 0.0 };
        let at_rounding = relative < ROUNDING && relative > 0.3 * last;
        if iterations > 0 && (relative <= TOLERANCE || at_rounding) {
            break raw;
        }
        if iterations == MAX_ITERATIONS {
            return Err(RunError::NewtonStalled { step, time, residual: relative, iterations });
        }
        last = relative;
        solution = system
            .newton_step(
                problem,
                &state.mesh,
                &constraints,
                &terms,
                &levels,
                &solution,
                &reduced,
                timing,
            )
            .map_err(fail)?;
        iterations += 1;
    };
    system.center_pressure(problem, &mut solution);
    accept(problem, state, bdf, solution, &levels);
    Ok(StepResult { residual, iterations })
}

/// The one place where a state moves on in time.
fn accept(problem: &Problem, state: &mut State, bdf: &Bdf, solution: Solution, levels: &Levels) {
    for body in 0..problem.bodies.len() {
        let now = state.place(body);
        let before = state.previous_places[body];
        let velocity = rigid(&solution.twists[body]);
        let next = [0, 1, 2].map(|mode| bdf.integrate(velocity[mode], now[mode], before[mode]));
        let rate = [0, 1, 2].map(|mode| levels.rate * velocity[mode] + levels.history[body][mode]);
        state.accelerations[body] = Twist {
            linear: Vector3::new(rate[0], rate[1], 0.0),
            angular: Vector3::new(0.0, 0.0, rate[2]),
        };
        if problem.frame == Some(body) {
            // The mesh travels with this body as a whole.
            let shift = Point::<2>::new(next[0] - now[0], next[1] - now[1]);
            for node in &mut state.mesh.nodes {
                *node += shift;
            }
        }
        // Without a frame of its own the body stays where its mesh is, and only turns.
        let [x, y] =
            if problem.frame == Some(body) { [next[0], next[1]] } else { [now[0], now[1]] };
        state.poses[body] = Pose::planar(x, y, next[2]);
        state.angles[body] = next[2];
        state.previous_places[body] = now;
    }
    state.previous = std::mem::replace(&mut state.now, solution);
    state.step += 1;
    state.time += bdf.step;
}
