//! Explicit steps of the `stokes` model, where places of bodies are all that evolves.
//!
//! dq/dt = V(q, t), one Stokes flow a stage, by the third-order method of @bogacki1989 with an error
//! estimate of second order. Its last stage is the flow at the new time, and the first one of the
//! next step.

use super::Timing;
use super::error::StepError;
use super::march::{March, MeshPath, Past, StepResult};
use super::state::{Place, State, Swim, pose_at, poses_at};
use crate::body::Twist;
use crate::contact::{ContactLoads, Gaps};
use crate::coupling::{BodyLoads, BodyShapes, Effort, FluidSystem, Levels, Solution, flatten};
use crate::time::Bdf;

/// Part of a step by which rates at its ends are asked inside it: those that jump there have two.
pub(super) const INSIDE: f64 = 1e-9;

/// Weights of the stages before in the place of a stage.
const STAGES: [(f64, &[f64]); 3] =
    [(0.5, &[0.5]), (0.75, &[0.0, 0.75]), (1.0, &[2.0 / 9.0, 1.0 / 3.0, 4.0 / 9.0])];
/// Weights of the stages in the error of the new places.
const ERROR: [f64; 4] = [-5.0 / 72.0, 1.0 / 12.0, 1.0 / 9.0, -1.0 / 8.0];

/// A flow that belongs to bodies at their places.
struct Instant {
    solution: Solution,
    loads: Vec<BodyLoads>,
    efforts: Vec<Effort>,
    shapes: BodyShapes,
    nodes: Vec<alewife_mesh::Point<2>>,
    iterations: usize,
}

impl March<'_> {
    /// Advances `state` by `step` (s). `jumps` says that rates jump at its beginning. On error the
    /// state is where it was.
    ///
    /// # Errors
    /// When the system is singular, the solution not finite, the mesh folds, or a gait fails.
    pub fn advance_explicit(
        &self,
        system: &mut FluidSystem,
        state: &mut State,
        step: f64,
        jumps: bool,
        timing: &mut Timing,
    ) -> Result<StepResult, StepError> {
        let result = self.explicit_step(system, state, step, jumps, timing);
        if result.is_err() {
            self.put_back(state);
        }
        result
    }

    fn explicit_step(
        &self,
        system: &mut FluidSystem,
        state: &mut State,
        step: f64,
        jumps: bool,
        timing: &mut Timing,
    ) -> Result<StepResult, StepError> {
        let (start, from) = (state.time, state.places.clone());
        let mut iterations = 0;
        let (first, effort) = if jumps {
            let (time, now) = (start + INSIDE * step, state.now.clone());
            let instant = self.instant(system, state, &from, (start, time), &now, timing)?;
            iterations += instant.iterations;
            (instant.solution, instant.efforts)
        } else {
            (state.now.clone(), state.swims.iter().map(Swim::effort).collect())
        };
        let mut rates = vec![in_plane(&first)];
        let mut efforts = vec![effort];
        let mut last = None;
        let mut begin = first;
        for (part, weights) in STAGES {
            let time = start + part * step;
            let asked = if part < 1.0 { time } else { time - INSIDE * step };
            let places = self.stage_places(&from, &rates, weights, step, time);
            let instant = self.instant(system, state, &places, (time, asked), &begin, timing)?;
            iterations += instant.iterations;
            rates.push(in_plane(&instant.solution));
            efforts.push(instant.efforts.clone());
            begin = instant.solution.clone();
            last = Some((instant, places));
        }
        let Some((instant, places)) = last else {
            return Err(StepError::Unsettled { passes: 0 });
        };
        let error = self.explicit_error(&rates);
        let Instant { solution, loads, shapes, nodes, .. } = instant;
        for (group, swim) in state.swims.iter_mut().enumerate() {
            let stages = efforts.iter().zip(STAGES[2].1);
            let shares: Vec<_> = stages.map(|(stage, share)| (stage[group], *share)).collect();
            swim.go_on(step, &shares, &efforts[3][group]);
        }
        let mut contact = ContactLoads::none(places.len());
        if let Some(surfaces) = self.surfaces(&shapes) {
            contact.minimum_gap = surfaces.minimum_gap(&poses_at(&self.in_frame(state, &places)));
        }
        state.contact = contact;
        for (body, twist) in solution.twists.iter().enumerate() {
            let (new, old) = (twist.in_plane(), state.now.twists[body].in_plane());
            state.accelerations[body] = Twist::planar([0, 1, 2].map(|i| (new[i] - old[i]) / step));
        }
        self.move_on(state, start + step, step, solution, places, nodes);
        Ok(StepResult { loads, iterations, error })
    }

    /// Places of a stage; bodies that hang on others follow them exactly.
    fn stage_places(
        &self,
        from: &[Place],
        rates: &[Vec<[f64; 3]>],
        weights: &[f64],
        step: f64,
        time: f64,
    ) -> Vec<Place> {
        let mut places = from.to_vec();
        for (body, place) in places.iter_mut().enumerate() {
            for (mode, value) in place.iter_mut().enumerate() {
                if self.moves(body, mode) {
                    let pairs = rates.iter().zip(weights);
                    *value +=
                        step * pairs.map(|(rate, weight)| weight * rate[body][mode]).sum::<f64>();
                }
            }
        }
        self.problem.hang(&mut places, time);
        places
    }

    /// Solves for the flow of bodies at places at a time, with rates of gaits asked at another one.
    fn instant(
        &self,
        system: &mut FluidSystem,
        state: &mut State,
        places: &[Place],
        (time, asked): (f64, f64),
        begin: &Solution,
        timing: &mut Timing,
    ) -> Result<Instant, StepError> {
        let shapes = BodyShapes::at(&self.problem.bodies, time)?;
        let nodes = self.put(state, places, &shapes, timing)?;
        if !matches!(self.path, MeshPath::Still) {
            system.move_to(self.problem, &state.mesh);
        }
        let poses: Vec<_> = state.wrapped(places).iter().map(pose_at).collect();
        let rates = BodyShapes::at(&self.problem.bodies, asked)?;
        let constraints = system.constraints(self.problem, &state.mesh, &poses, &rates);
        let levels = Levels::default().with_loads(self.problem, asked, places, 0.0);
        let past = Past::without_memory(shapes, levels);
        let begin = system.constrained(&constraints, &flatten(begin));
        // Without density its coefficients multiply nothing.
        let bdf = Bdf::first_order(1.0);
        let mut flow = self.solve(system, state, &bdf, &past, &constraints, &[], begin, timing)?;
        let (loads, efforts) =
            self.conclude(system, state, &bdf, &past, &[], places, &mut flow, timing);
        let (solution, iterations, shapes) = (flow.solution, flow.iterations, past.shapes);
        Ok(Instant { solution, loads, efforts, shapes, nodes, iterations })
    }

    /// Error of the new places over the way of a step, at most.
    fn explicit_error(&self, rates: &[Vec<[f64; 3]>]) -> f64 {
        let reach = |body: usize| match self.path {
            MeshPath::Bodies(follower) => follower.surfaces().reach(body),
            _ => 0.0,
        };
        let (mut error, mut scale) = (0.0f64, 0.0f64);
        for body in 0..self.problem.bodies.len() {
            for mode in 0..3 {
                let length = if mode == 2 { reach(body) } else { 1.0 };
                let pairs = rates.iter().zip(ERROR);
                let off: f64 = pairs.map(|(rate, weight)| weight * rate[body][mode]).sum();
                error = error.max(length * off.abs());
                scale =
                    rates.iter().map(|rate| length * rate[body][mode].abs()).fold(scale, f64::max);
            }
        }
        if scale > 0.0 { error / scale } else { 0.0 }
    }
}

fn in_plane(solution: &Solution) -> Vec<[f64; 3]> {
    solution.twists.iter().map(Twist::in_plane).collect()
}
