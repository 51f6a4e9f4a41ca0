//! One time step: BDF for fluid and bodies together, convection extrapolated or by Newton.
//!
//! Where bodies will be is predicted to second order, the mesh follows them there, and fluid, bodies
//! and contact are solved for on it. The velocities that come out give where the bodies get to; where
//! that is elsewhere by more than the tolerance, the step is solved again there.
//!
//! The mesh velocity w is the backward difference of the positions of the nodes, the same as for the
//! flow: a uniform flow stays uniform, and on the surface of a body w has the body's velocity (that of
//! its centre where it is round, but for the rolling of its mesh). The mesh may also travel with a body as a
//! whole (`frame`); the unknown stays the velocity seen from the laboratory, so that no inertial force
//! appears.

use super::contact_known::KnownContact;
use super::contact_step::{PassContact, update_residual};
use super::error::{RunError, StepError};
use super::error_estimate::{local_error, pose_errors};
use super::fluid_loads::{FluidLoads, SolvedConfiguration};
use super::history::StepHistory;
use super::mesh_path::Placed;
use super::new_level::Arrival;
use super::newton::{Criterion, Flow, newton, refine};
use super::pass::{Pass, PassEquations, Placement};
use super::predict::{integrate_poses, limit_by_gaps, predict_poses};
use super::predict_contact::predict_contact;
use super::state::State;
use super::stepper::{Step, StepReport, StepResult, TimeStepper};
use super::workspace::Workspace;
use crate::body::Pose;
use crate::contact::Gaps;
use crate::coupling::Solution;
use crate::time::Bdf;

/// Most passes until the bodies are where the flow was solved for.
const MAX_PASSES: usize = 12;

/// What a step starts from.
#[derive(Clone, Copy)]
struct StepSoFar<'a, const D: usize> {
    state: &'a State<D>,
    history: &'a StepHistory<D>,
    gaps: Option<&'a dyn Gaps>,
}

impl<const D: usize> TimeStepper<'_, D> {
    /// What a step of `bdf` leads to from a state, which stays where it is.
    ///
    /// # Errors
    /// When the system is singular, the solution not finite, Newton's method stalls, the mesh
    /// degenerates, a gait fails, or contact forces or poses of bodies are not found.
    pub fn advance(
        &self,
        work: &mut Workspace<D>,
        state: &State<D>,
        bdf: Bdf,
    ) -> Result<StepResult<D>, StepError> {
        let problem = self.problem;
        let step = Step::from(state, bdf);
        let history = StepHistory::new(self, state, step)?;
        let gaps = self.path.gaps(&history.shapes);
        let gaps = gaps.as_deref();
        let mut apart = state.poses.clone();
        let mut poses = predict_poses(self, state, &step);
        if let Some(in_contact) = predict_contact(self, work, state, &history, gaps, &poses) {
            poses = in_contact;
        }
        let mut guess = history.extrapolated.clone();
        let (mut iterations, mut scale, mut known) = (0, None, None);
        for _ in 0..MAX_PASSES {
            self.check_stop(state)?;
            poses = limit_by_gaps(problem, gaps, state, &apart, poses);
            let nodes = self.path.move_mesh(work, problem, state, &poses, &history.shapes)?;
            let mut pass = Pass::new(self, work, state, &history, Placement { nodes, poses });
            let mut contact = match known.take() {
                Some(known) => known,
                None if work.system.is_iterative() => {
                    KnownContact::at_poses(self, state, gaps, &pass.poses)
                }
                None => KnownContact::none(problem.bodies.len()),
            };
            contact.load(&mut pass.bodies);
            let equations = PassEquations::new(self, &history, &pass);
            let mut flow = self.solve(work, &equations, guess, scale)?;
            iterations += flow.iterations;
            scale = scale.or(Some(flow.scale));
            let is_other = PassContact { stepper: self, state, gaps, equations: &equations }
                .apply(work, &mut flow, &mut contact)?;
            let mut reached = integrate_poses(self, state, &step, &flow.solution.twists);
            let placed = self.path.placement(&pass.poses, &reached, &contact.loads);
            if placed != Placed::Elsewhere {
                if is_other {
                    update_residual(work, &equations, &mut flow);
                }
                if placed == Placed::Near && work.system.is_iterative() && equations.is_linear() {
                    let known = StepSoFar { state, history: &history, gaps };
                    reached = self.refine(work, &known, &mut pass, &mut flow, &mut contact)?;
                }
                let equations = PassEquations::new(self, &history, &pass);
                let KnownContact { loads: contact, .. } = contact;
                let loads = self.loads(work, state, &equations, &mut flow);
                let mut error = local_error(self, state, &step, &flow.solution);
                if step.bdf.is_second_order() {
                    let errors = pose_errors(state, &step, &reached);
                    error = error.max(self.gap_error(gaps, state, &reached, &errors));
                }
                let contact = self.with_minimum_gap(contact, gaps, state, &reached);
                let end = Arrival { poses: reached, solution: flow.solution, contact };
                let level = self.new_level(work, state, &history, &pass, end, &loads.propulsion)?;
                let report = StepReport { loads: loads.surfaces, iterations, error };
                return Ok(StepResult { level, report });
            }
            (apart, poses, guess) = (pass.poses, reached, flow.solution);
            known = work.system.is_iterative().then_some(contact);
        }
        Err(StepError::CouplingNotConverged { passes: MAX_PASSES })
    }

    /// Reduces what iterations have left of a flow whose residual is up to date, and finds its contact again. Where
    /// the bodies get to by it.
    fn refine(
        &self,
        work: &mut Workspace<D>,
        known: &StepSoFar<'_, D>,
        pass: &mut Pass<D>,
        flow: &mut Flow<D>,
        contact: &mut KnownContact,
    ) -> Result<Vec<Pose>, StepError> {
        let StepSoFar { state, history, gaps } = *known;
        pass.bodies = history.body_equations(self.problem, &pass.poses);
        contact.load(&mut pass.bodies);
        let equations = PassEquations::new(self, history, pass);
        let Workspace { system, mesh, timing } = work;
        let at = pass.at(self.problem, mesh);
        refine(system, timing, &at, flow)
            .map_err(|error| RunError::from_solve(error, history.step.number, history.step.time))?;
        PassContact { stepper: self, state, gaps, equations: &equations }
            .apply(work, flow, contact)?;
        update_residual(work, &equations, flow);
        Ok(integrate_poses(self, state, &history.step, &flow.solution.twists))
    }

    /// The flow on the mesh of a pass, with the contact that is known of it, from a first guess. `scale` is what residuals
    /// of the first pass were relative to.
    pub(super) fn solve(
        &self,
        work: &mut Workspace<D>,
        equations: &PassEquations<'_, D>,
        guess: Solution<D>,
        scale: Option<f64>,
    ) -> Result<Flow<D>, StepError> {
        let Workspace { system, mesh, timing } = work;
        let at = equations.pass.at(self.problem, mesh);
        let start = system.constrained(at.constraints, &guess);
        let criterion = Criterion::of_step(equations.is_linear(), scale);
        newton(system, timing, &at, equations, &criterion, start)
            .map_err(|failure| failure.in_step(&equations.history.step).into())
    }

    /// Loads of the flow of a pass, its pressure at its level.
    pub(super) fn loads(
        &self,
        work: &mut Workspace<D>,
        state: &State<D>,
        equations: &PassEquations<'_, D>,
        flow: &mut Flow<D>,
    ) -> FluidLoads {
        let Workspace { system, mesh, timing } = work;
        let at = equations.pass.at(self.problem, mesh);
        SolvedConfiguration { system, at, state, poses: &equations.pass.poses }
            .loads(equations, flow, timing)
    }
}
