//! One time step: BDF for fluid and bodies together, convection extrapolated or by Newton.
//!
//! Where bodies will be is predicted to second order, the mesh follows them there, and fluid, bodies
//! and contact are solved for on it. The velocities that come out tell where the bodies get to; where
//! that is elsewhere by more than a trifle, the step is solved again there.
//!
//! The mesh velocity w is the backward difference of the places of the nodes, the same as for the
//! flow: a uniform flow stays uniform, and on the surface of a body w has the body's velocity (that of
//! its centre where it is round: its mesh does not turn). The mesh may also travel with a body as a
//! whole (`frame`); the unknown stays the velocity seen from the laboratory, so that no inertial force
//! appears.

use std::borrow::Cow;

use alewife_mesh::Point;

use super::explicit::INSIDE;
use super::follow::Follower;
use super::state::{Place, State, pose_at, poses_at};
use super::{RunError, Stage, StepError, Timing};
use crate::algebra::AffineConstraints;
use crate::body::{Modes, Twist};
use crate::case::Convection as ConvectionChoice;
use crate::contact::{ContactLoads, ContactStep, Gaps, Law, PlanarGaps};
use crate::coupling::{
    BodyLoads, BodyShapes, Drive, Effort, FluidSystem, Levels, Problem, ShapeError, Solution,
    SolveError, body_loads, flatten, newton_convection,
};
use crate::flow::{Convection, FlowTerms};
use crate::time::Bdf;

/// Most Newton iterations of one step.
const MAX_ITERATIONS: usize = 20;
/// Residual relative to the first of the step that counts as converged.
const TOLERANCE: f64 = 1e-10;
/// Residuals relative to the first that count as rounding once they stop falling.
const ROUNDING: f64 = 1e-7;
/// Change of the velocities over their size that is rounding.
const STILL: f64 = 1e-13;
/// Most times a step is solved until the bodies are where the flow was solved for.
const MAX_PASSES: usize = 12;
/// Part of the smallest gap that is left at least when bodies are put nearer to each other.
const KEPT_GAP: f64 = 0.5;
/// Speed over the largest so far below which the error of a step is no longer relative to it.
const NEARLY_AT_REST: f64 = 1e-3;
/// Contact is looked for where bodies may get to with this times their way.
const CONTACT_MARGIN: f64 = 2.0;

/// How the nodes of the mesh move, seen from the frame.
#[derive(Clone, Copy)]
pub enum MeshPath<'a> {
    /// Not at all.
    Still,
    /// To given places (m) of nodes at a time (s).
    Given(&'a (dyn Fn(usize, f64) -> Point<2> + Sync)),
    /// After the bodies.
    Bodies(&'a Follower),
}

/// What stays the same from step to step while the mesh lasts.
#[derive(Clone, Copy)]
pub struct March<'a> {
    /// What is solved.
    pub problem: &'a Problem,
    /// How convection is taken.
    pub choice: ConvectionChoice,
    /// How the mesh moves.
    pub path: MeshPath<'a>,
    /// The law of contact, if any.
    pub contact: Option<&'a Law>,
}

/// What a step leaves for measurements.
#[derive(Debug, Clone)]
pub struct StepResult {
    /// Loads of the fluid on the bodies, where the flow was solved for.
    pub loads: Vec<BodyLoads>,
    /// Linear systems solved.
    pub iterations: usize,
    /// Estimate of the error of the step, relative to the size of the velocities; zero for a step of
    /// first order.
    pub error: f64,
}

/// The older levels of a step, with what follows from them.
pub(super) struct Past {
    time: f64,
    /// The bodies at the new time.
    pub(super) shapes: BodyShapes,
    /// Older part of du/dt at the nodes (m/s2).
    history: Vec<Point<2>>,
    /// Velocities at the nodes extrapolated to the new time (m/s).
    ahead: Vec<Point<2>>,
    /// All unknowns extrapolated to the new time.
    raw_ahead: Vec<f64>,
    levels: Levels,
    frame_ahead: Point<2>,
}

/// A flow on the mesh of one pass.
pub(super) struct Flow {
    pub solution: Solution,
    pub residual: Vec<f64>,
    pub iterations: usize,
}

impl Past {
    /// That of a flow without inertia.
    pub(super) fn without_memory(shapes: BodyShapes, levels: Levels) -> Self {
        let (history, ahead, raw_ahead) = Default::default();
        let (time, frame_ahead) = (shapes.time(), Point::<2>::zeros());
        Self { time, shapes, history, ahead, raw_ahead, levels, frame_ahead }
    }
}

impl March<'_> {
    /// Advances `state` by the step of `bdf`. On error the state is where it was.
    ///
    /// # Errors
    /// When the system is singular, the solution not finite, Newton's method stalls, the mesh folds, a
    /// gait fails, or contact or places of bodies are not found.
    pub fn advance(
        &self,
        system: &mut FluidSystem,
        state: &mut State,
        bdf: &Bdf,
        timing: &mut Timing,
    ) -> Result<StepResult, StepError> {
        let result = self.attempt(system, state, bdf, timing);
        if result.is_err() {
            self.put_back(state);
        }
        result
    }

    /// Puts the mesh back to where the state has it.
    pub(super) fn put_back(&self, state: &mut State) {
        let State { nodes, origin, mesh, .. } = &mut *state;
        lay(&mut mesh.nodes, nodes, origin);
    }

    fn attempt(
        &self,
        system: &mut FluidSystem,
        state: &mut State,
        bdf: &Bdf,
        timing: &mut Timing,
    ) -> Result<StepResult, StepError> {
        let past = self.past(state, bdf)?;
        let time = past.time;
        let surfaces = self.surfaces(&past.shapes);
        // Rates that jump at the end of the step are those before it
        let rates = match &self.problem.rate_discontinuities {
            Some(_) => &BodyShapes::at(&self.problem.bodies, time - INSIDE * bdf.step)?,
            None => &past.shapes,
        };
        let mut from = state.places.clone();
        let mut to =
            self.reached(state, bdf, |body, mode| match &self.problem.bodies[body].drives[mode] {
                Drive::Given(value) => value(time),
                Drive::Free | Drive::Linked => bdf.extrapolate(
                    state.now.twists[body].in_plane()[mode],
                    state.previous.twists[body].in_plane()[mode],
                ),
            });
        let mut iterations = 0;
        let mut start: Option<Solution> = None;
        for _ in 0..MAX_PASSES {
            let places = self.guarded(state, surfaces.as_deref(), &from, to);
            let nodes = self.put(state, &places, &past.shapes, timing)?;
            if !matches!(self.path, MeshPath::Still) {
                system.move_to(self.problem, &state.mesh);
            }
            let poses: Vec<_> = state.wrapped(&places).iter().map(pose_at).collect();
            let constraints = system.constraints(self.problem, &state.mesh, &poses, rates);
            let mesh_velocity: Vec<Point<2>> = match (self.path, self.problem.has_inertia) {
                (MeshPath::Still, _) | (_, false) => Vec::new(),
                _ => (0..nodes.len())
                    .map(|i| bdf.rate(nodes[i], state.nodes[i], state.nodes_before[i]))
                    .collect(),
            };
            let raw = start.as_ref().map_or_else(|| past.raw_ahead.clone(), flatten);
            let begin = system.constrained(&constraints, &raw);
            let mut flow =
                self.solve(system, state, bdf, &past, &constraints, &mesh_velocity, begin, timing)?;
            iterations += flow.iterations;
            let mut contact = ContactLoads::none(places.len());
            if let (MeshPath::Bodies(follower), Some(law)) = (self.path, self.contact) {
                let surfaces = surfaces.as_deref().unwrap_or(follower.surfaces());
                let between = Contact { march: self, surfaces, law, bdf };
                if let Some(found) = between.solve(
                    system,
                    state,
                    &places,
                    &constraints,
                    &mut flow.solution,
                    timing,
                )? {
                    contact = found;
                    flow.residual = timing.measure(Stage::Loads, || {
                        self.residual(system, state, bdf, &past, &mesh_velocity, &flow.solution)
                    });
                }
            }
            let reached =
                self.reached(state, bdf, |body, mode| flow.solution.twists[body].in_plane()[mode]);
            let is_settled = match self.path {
                MeshPath::Bodies(follower) => !follower.is_misplaced(&places, &reached),
                _ => true,
            };
            if is_settled {
                let (fluid_loads, efforts) = self.conclude(
                    system,
                    state,
                    bdf,
                    &past,
                    &mesh_velocity,
                    &places,
                    &mut flow,
                    timing,
                );
                let error = self.error(state, bdf, &flow.solution);
                if let Some(surfaces) = &surfaces {
                    let reached = poses_at(&self.in_frame(state, &reached));
                    contact.minimum_gap = surfaces.minimum_gap(&reached);
                }
                self.accept(state, bdf, &past, (flow.solution, reached, contact), timing)?;
                for (swim, end) in state.swims.iter_mut().zip(&efforts) {
                    // A first-order step comes after a jump: what was before it does not count.
                    let before = swim.effort();
                    let halves = [(before, 0.5), (*end, 0.5)];
                    let all = [(*end, 1.0)];
                    let shares: &[_] = if bdf.is_second_order() { &halves } else { &all };
                    swim.go_on(bdf.step, shares, end);
                }
                return Ok(StepResult { loads: fluid_loads, iterations, error });
            }
            start = Some(flow.solution);
            (from, to) = (places, reached);
        }
        Err(StepError::Unsettled { passes: MAX_PASSES })
    }

    /// Gives the pressure of a flow that is settled its level; what the flow does to bodies at
    /// `places`, and the groups to it.
    #[expect(clippy::too_many_arguments, reason = "the end of a pass of a step")]
    pub(super) fn conclude(
        &self,
        system: &FluidSystem,
        state: &State,
        bdf: &Bdf,
        past: &Past,
        mesh_velocity: &[Point<2>],
        places: &[Place],
        flow: &mut Flow,
        timing: &mut Timing,
    ) -> (Vec<BodyLoads>, Vec<Effort>) {
        system.center_pressure(self.problem, &mut flow.solution);
        if self.problem.works_on_level() {
            flow.residual = timing.measure(Stage::Loads, || {
                self.residual(system, state, bdf, past, mesh_velocity, &flow.solution)
            });
        }
        let poses: Vec<_> = state.wrapped(places).iter().map(pose_at).collect();
        let loads = body_loads(
            self.problem,
            &state.mesh,
            &system.layout,
            &system.sides,
            &poses,
            &flow.residual,
            &flow.solution.velocity,
        );
        let efforts = state.efforts(self.problem, places, &flow.solution, &loads);
        (loads, efforts)
    }

    fn past(&self, state: &State, bdf: &Bdf) -> Result<Past, ShapeError> {
        let problem = self.problem;
        let time = state.time + bdf.step;
        let pairs = state.now.velocity.iter().zip(&state.previous.velocity);
        let body_pairs = state.now.twists.iter().zip(&state.previous.twists);
        let frame_of = |solution: &Solution| frame_velocity(problem, solution);
        // Nearer to the new level than the old one: less is left for an iterative solve.
        let raw_pairs = flatten(&state.now).into_iter().zip(flatten(&state.previous));
        let shapes = BodyShapes::at(&problem.bodies, time)?;
        let (mut inertia, mut inertia_now, mut inertia_before) = Default::default();
        if problem.bodies.iter().any(|body| body.shape.is_some() && body.inertia > 0.0) {
            let at = |time: f64| -> Result<Vec<f64>, ShapeError> {
                problem.bodies.iter().map(|body| body.inertia_at(time)).collect()
            };
            inertia = shapes.inertia(&problem.bodies);
            (inertia_now, inertia_before) = (at(state.time)?, at(state.time_before())?);
        }
        let history = body_pairs.enumerate().map(|(body, (now, previous))| {
            let (mut now, mut previous) = (now.in_plane(), previous.in_plane());
            if let (Some(next), rigid) = (inertia.get(body), &problem.bodies[body])
                && rigid.shape.is_some()
                && *next > 0.0
            {
                // d(I omega)/dt in place of I d(omega)/dt
                now[2] *= inertia_now[body] / next;
                previous[2] *= inertia_before[body] / next;
            }
            [0, 1, 2].map(|mode| bdf.history(now[mode], previous[mode]))
        });
        let history: Vec<[f64; 3]> = history.collect();
        // The new place of a body is that without velocity plus its velocity over `next`.
        let unmoved = self.reached(state, bdf, |_, _| 0.0);
        let levels = Levels { rate: bdf.next, history, inertia, ..Levels::default() }.with_loads(
            problem,
            time,
            &unmoved,
            1.0 / bdf.next,
        );
        Ok(Past {
            time,
            shapes,
            history: pairs.clone().map(|(now, before)| bdf.history(*now, *before)).collect(),
            ahead: pairs.map(|(now, before)| bdf.extrapolate(*now, *before)).collect(),
            raw_ahead: raw_pairs.map(|(now, before)| bdf.extrapolate(now, before)).collect(),
            levels,
            frame_ahead: bdf.extrapolate(frame_of(&state.now), frame_of(&state.previous)),
        })
    }

    /// Where bodies get to with velocities at the new time.
    fn reached(
        &self,
        state: &State,
        bdf: &Bdf,
        velocity: impl Fn(usize, usize) -> f64,
    ) -> Vec<Place> {
        let place = |body: usize| {
            [0, 1, 2].map(|mode| {
                let (now, before) = (state.places[body][mode], state.previous_places[body][mode]);
                if self.moves(body, mode) {
                    bdf.integrate(velocity(body, mode), now, before)
                } else {
                    now
                }
            })
        };
        let mut places: Vec<Place> = (0..self.problem.bodies.len()).map(place).collect();
        self.problem.hang(&mut places, state.time + bdf.step);
        places
    }

    /// Whether a body goes where one of its velocities takes it: it stays where a mesh is that does
    /// not follow.
    pub(super) fn moves(&self, body: usize, mode: usize) -> bool {
        mode == 2 || matches!(self.path, MeshPath::Bodies(_)) || self.problem.frame == Some(body)
    }

    /// Outlines of bodies of these shapes, and walls, where the mesh follows bodies.
    pub(super) fn surfaces(&self, shapes: &BodyShapes) -> Option<Cow<'_, PlanarGaps>> {
        match self.path {
            MeshPath::Bodies(follower) => Some(follower.surfaces_at(shapes)),
            _ => None,
        }
    }

    /// Places in the mesh, seen from the frame that goes with them.
    pub(super) fn in_frame(&self, state: &State, places: &[Place]) -> Vec<Place> {
        state.in_frame(&state.origin_at(self.problem, places), places)
    }

    /// As far on the way between places as leaves some of the smallest gap: predictions know
    /// nothing of what is in the way.
    fn guarded(
        &self,
        state: &State,
        surfaces: Option<&PlanarGaps>,
        from: &[Place],
        to: Vec<Place>,
    ) -> Vec<Place> {
        let Some(surfaces) = surfaces else { return to };
        let gap = |places: &[Place]| {
            let least = surfaces.minimum_gap(&poses_at(&self.in_frame(state, places)));
            least.map_or(f64::INFINITY, |least| least.gap)
        };
        let kept = KEPT_GAP * gap(from);
        let mut part = 1.0;
        let mut trial = to.clone();
        while gap(&trial) < kept && part > 1e-6 {
            part *= 0.5;
            let pairs = from.iter().zip(&to);
            trial = pairs
                .map(|(from, to)| [0, 1, 2].map(|mode| from[mode] + part * (to[mode] - from[mode])))
                .collect();
        }
        trial
    }

    /// Puts the mesh where bodies of these shapes at `places` want it; returns the places of its nodes
    /// seen from the frame.
    pub(super) fn put(
        &self,
        state: &mut State,
        places: &[Place],
        shapes: &BodyShapes,
        timing: &mut Timing,
    ) -> Result<Vec<Point<2>>, StepError> {
        let origin = state.origin_at(self.problem, places);
        timing.measure(Stage::MeshMotion, || {
            let nodes = match self.path {
                MeshPath::Still => state.nodes.clone(),
                MeshPath::Given(place) => {
                    (0..state.nodes.len()).map(|node| place(node, shapes.time())).collect()
                }
                MeshPath::Bodies(follower) => {
                    let places = self.in_frame(state, places);
                    follower
                        .nodes(&places, shapes)
                        .map_err(|error| RunError::Mesh(error.to_string()))?
                }
            };
            lay(&mut state.mesh.nodes, &nodes, &origin);
            if let MeshPath::Bodies(follower) = self.path
                && let Some((place, quality)) = follower.spoilt(&state.mesh)
            {
                return Err(StepError::Mesh { place, quality });
            }
            Ok(nodes)
        })
    }

    /// What convects the flow, and how it enters the matrix.
    fn crossing(
        &self,
        past: &Past,
        mesh_velocity: &[Point<2>],
        solution: &Solution,
    ) -> (Vec<Point<2>>, Convection) {
        let problem = self.problem;
        let newton = self.choice == ConvectionChoice::Newton;
        let mut crossing = match (problem.has_convection, newton) {
            (false, _) if mesh_velocity.is_empty() => return (Vec::new(), Convection::None),
            (false, _) => vec![Point::<2>::zeros(); mesh_velocity.len()],
            (true, false) => past.ahead.iter().map(|u| u - past.frame_ahead).collect(),
            (true, true) => {
                let frame = frame_velocity(problem, solution);
                solution.velocity.iter().map(|u| u - frame).collect()
            }
        };
        crossing.iter_mut().zip(mesh_velocity).for_each(|(u, w)| *u -= w);
        let convection = if newton && problem.has_convection {
            newton_convection(problem)
        } else {
            Convection::Oseen
        };
        (crossing, convection)
    }

    pub(super) fn residual(
        &self,
        system: &FluidSystem,
        state: &State,
        bdf: &Bdf,
        past: &Past,
        mesh_velocity: &[Point<2>],
        solution: &Solution,
    ) -> Vec<f64> {
        let (crossing, convection) = self.crossing(past, mesh_velocity, solution);
        let terms = self.terms(bdf, past, &crossing, convection);
        system.fluid_residual(&state.mesh, &terms, solution)
    }

    fn terms<'a>(
        &'a self,
        bdf: &Bdf,
        past: &'a Past,
        crossing: &'a [Point<2>],
        convection: Convection,
    ) -> FlowTerms<'a, 2> {
        FlowTerms {
            viscosity: self.problem.viscosity,
            density: self.problem.density,
            rate: bdf.next,
            history: &past.history,
            crossing,
            convection,
            body_force: self.problem.body_force,
        }
    }

    /// The flow on the mesh as it lies, without contact.
    #[expect(clippy::too_many_arguments, reason = "one pass of the step above")]
    pub(super) fn solve(
        &self,
        system: &mut FluidSystem,
        state: &State,
        bdf: &Bdf,
        past: &Past,
        constraints: &AffineConstraints,
        mesh_velocity: &[Point<2>],
        begin: Solution,
        timing: &mut Timing,
    ) -> Result<Flow, RunError> {
        let (problem, time, step) = (self.problem, past.time, state.step + 1);
        let fail = |error: SolveError| RunError::from_solve(error, step, time);
        let newton = self.choice == ConvectionChoice::Newton && problem.has_convection;
        let mut solution = begin;
        let (mut first, mut last, mut is_still) = (0.0, f64::INFINITY, false);
        let mut iterations = 0;
        loop {
            let (crossing, convection) = self.crossing(past, mesh_velocity, &solution);
            let terms = self.terms(bdf, past, &crossing, convection);
            // A linear system is solved once; its second residual is only for the loads.
            let is_for_loads = !newton && iterations == 1;
            let stage = if is_for_loads { Stage::Loads } else { Stage::Assembly };
            let raw =
                timing.measure(stage, || system.fluid_residual(&state.mesh, &terms, &solution));
            if is_for_loads {
                return Ok(Flow { solution, residual: raw, iterations });
            }
            let levels = &past.levels;
            let reduced =
                system.reduced_residual(problem, constraints, levels, &solution, raw.clone());
            let size = reduced.iter().fold(0.0f64, |most, value| most.max(value.abs()));
            if iterations == 0 {
                first = size;
            }
            let relative = if first > 0.0 { size / first } else { 0.0 };
            let at_rounding = relative < ROUNDING && relative > 0.3 * last || is_still;
            if iterations > 0 && (relative <= TOLERANCE || at_rounding) {
                return Ok(Flow { solution, residual: raw, iterations });
            }
            if iterations == MAX_ITERATIONS {
                return Err(RunError::NewtonStalled { step, time, residual: relative, iterations });
            }
            last = relative;
            let next = system
                .newton_step(
                    problem,
                    &state.mesh,
                    constraints,
                    &terms,
                    levels,
                    &solution,
                    &reduced,
                    timing,
                )
                .map_err(fail)?;
            // Where the first residual is rounding already, no other is small beside it.
            is_still = change(&solution, &next) <= STILL;
            solution = next;
            iterations += 1;
        }
    }

    /// Estimate of the error of a step, relative to the size of the velocities.
    fn error(&self, state: &State, bdf: &Bdf, new: &Solution) -> f64 {
        if !bdf.is_second_order() {
            return 0.0;
        }
        // What has come to rest is not to be followed down to rounding.
        let scale = fastest(new).max(NEARLY_AT_REST * state.top_speed);
        if scale == 0.0 {
            return 0.0;
        }
        let mut squares = 0.0;
        if self.problem.has_inertia {
            for (node, new) in new.velocity.iter().enumerate() {
                let (now, before) = (state.now.velocity[node], state.previous.velocity[node]);
                squares += (new - bdf.predict(now, before, state.rates[node])).norm_squared();
            }
            squares /= new.velocity.len() as f64;
        }
        let mut largest = squares.sqrt();
        for (body, new) in new.twists.iter().enumerate() {
            let (now, before) =
                (state.now.twists[body].in_plane(), state.previous.twists[body].in_plane());
            let rate = state.accelerations[body].in_plane();
            let reach = match self.path {
                MeshPath::Bodies(follower) => follower.surfaces().reach(body),
                _ => 0.0,
            };
            for (mode, new) in new.in_plane().into_iter().enumerate() {
                let length = if mode == 2 { reach } else { 1.0 };
                let predicted = bdf.predict(now[mode], before[mode], rate[mode]);
                largest = largest.max(length * (new - predicted).abs());
            }
        }
        bdf.error_share() * largest / scale
    }

    /// The one place where a state moves on in time.
    fn accept(
        &self,
        state: &mut State,
        bdf: &Bdf,
        past: &Past,
        (solution, places, contact): (Solution, Vec<Place>, ContactLoads),
        timing: &mut Timing,
    ) -> Result<(), StepError> {
        let nodes = self.put(state, &places, &past.shapes, timing)?;
        state.contact = contact;
        for (body, twist) in solution.twists.iter().enumerate() {
            let velocity = twist.in_plane();
            let rate =
                [0, 1, 2].map(|mode| bdf.next * velocity[mode] + past.levels.history[body][mode]);
            state.accelerations[body] = Twist::planar(rate);
        }
        let rates = solution.velocity.iter().zip(&past.history);
        state.rates = rates.map(|(new, history)| new * bdf.next + history).collect();
        self.move_on(state, past.time, bdf.step, solution, places, nodes);
        Ok(())
    }

    /// Takes the new level of a step for the present one.
    pub(super) fn move_on(
        &self,
        state: &mut State,
        time: f64,
        step: f64,
        solution: Solution,
        places: Vec<Place>,
        nodes: Vec<Point<2>>,
    ) {
        state.top_speed = state.top_speed.max(fastest(&solution));
        state.origin = state.origin_at(self.problem, &places);
        state.nodes_before = std::mem::replace(&mut state.nodes, nodes);
        state.previous_places = std::mem::replace(&mut state.places, places);
        state.previous = std::mem::replace(&mut state.now, solution);
        state.step += 1;
        (state.time, state.last_step) = (time, step);
    }
}

/// Contact forces of one pass.
struct Contact<'a, 'b> {
    march: &'a March<'b>,
    surfaces: &'a PlanarGaps,
    law: &'a Law,
    bdf: &'a Bdf,
}

impl Contact<'_, '_> {
    /// Adds contact to a solution found without it for bodies at `places`; nothing where no body can
    /// get within the range.
    fn solve(
        &self,
        system: &mut FluidSystem,
        state: &State,
        places: &[Place],
        constraints: &AffineConstraints,
        solution: &mut Solution,
        timing: &mut Timing,
    ) -> Result<Option<ContactLoads>, StepError> {
        let surfaces = self.surfaces;
        let range = self.law.range();
        let free = |body: usize| solution.twists[body].in_plane();
        let without = self.march.reached(state, self.bdf, |body, mode| free(body)[mode]);
        // Seen from where the frame is in this pass: its way is no part of the unknowns.
        let origin = state.origin_at(self.march.problem, places);
        let seen = |places: &[Place]| poses_at(&state.in_frame(&origin, places));
        let (apart, predicted) = (seen(&state.places), seen(places));
        let bodies = surfaces.candidate_bodies(&apart, &seen(&without), CONTACT_MARGIN, range);
        if bodies.is_empty() {
            return Ok(None);
        }
        let fail = |error| RunError::from_solve(error, state.step + 1, state.time + self.bdf.step);
        let mobility = system.mobility(constraints, &bodies, timing).map_err(fail)?;
        let free_velocities: Vec<Twist> =
            bodies.iter().map(|&body| Twist::planar(free(body))).collect();
        let predicted_velocities: Vec<Twist> = bodies
            .iter()
            .map(|&body| {
                Twist::planar([0, 1, 2].map(|mode| {
                    let (now, before) = (state.places[body], state.previous_places[body]);
                    self.bdf.rate(places[body][mode], now[mode], before[mode])
                }))
            })
            .collect();
        let step = ContactStep {
            gaps: surfaces,
            law: self.law,
            modes: Modes::PLANAR,
            bodies: &bodies,
            free_velocities: &free_velocities,
            mobility: &mobility,
            predicted: &predicted,
            predicted_velocities: &predicted_velocities,
            coefficient: 1.0 / self.bdf.next,
            start: &apart,
        };
        let found = step.solve()?;
        let loads: Vec<(usize, [f64; 3])> =
            bodies.iter().map(|&body| (body, found.loads.wrenches[body].in_plane())).collect();
        if loads.iter().any(|(_, load)| load.iter().any(|part| *part != 0.0)) {
            system.respond(constraints, &loads, solution, timing).map_err(fail)?;
        }
        Ok(Some(found.loads))
    }
}

/// Puts the nodes of a mesh at places seen from a frame.
fn lay(nodes: &mut [Point<2>], seen: &[Point<2>], origin: &Point<2>) {
    for (node, seen) in nodes.iter_mut().zip(seen) {
        *node = seen + origin;
    }
}

fn fastest(solution: &Solution) -> f64 {
    solution.velocity.iter().map(|velocity| velocity.norm()).fold(0.0, f64::max)
}

/// Largest change of a velocity over the largest velocity.
fn change(from: &Solution, to: &Solution) -> f64 {
    let most = |sizes: &mut dyn Iterator<Item = f64>| sizes.fold(0.0, f64::max);
    let pairs = from.velocity.iter().zip(&to.velocity);
    let change = most(&mut pairs.map(|(from, to)| (to - from).amax()));
    let size = most(&mut to.velocity.iter().map(|velocity| velocity.amax()));
    if change > 0.0 { change / size } else { 0.0 }
}

fn frame_velocity(problem: &Problem, solution: &Solution) -> Point<2> {
    problem.frame.map_or(Point::<2>::zeros(), |body| {
        let linear = &solution.twists[body].linear;
        Point::<2>::new(linear.x, linear.y)
    })
}
