//! Contact forces of one pass: found for the gaps at the end of the step, and added to the flow, or corrected there.

use nalgebra::{DMatrix, DVector};

use super::contact_estimate::Bodies;
use super::contact_known::{KnownContact, Learnt};
use super::contact_rows::Rows;
use super::error::StepError;
use super::mesh_path::Placed;
use super::newton::{Flow, flow_residual};
use super::pass::PassEquations;
use super::predict::integrate_poses;
use super::state::State;
use super::stepper::TimeStepper;
use super::workspace::Workspace;
use super::{RunError, Stage};
use crate::body::{Pose, Twist, Wrench};
use crate::contact::{ContactLoads, ContactSolution, ContactStep, Gaps, Law, MobilityEstimate};
use crate::coupling::{BodyLoad, LoadedBody};

/// Contact is looked for where bodies may get to with this times their displacement.
const CONTACT_MARGIN: f64 = 2.0;

/// Error of a pose by the error of the mobility over the smallest gap, or the range, that is small enough.
const SMALL: f64 = 1e-6;
/// The same where the pass is to be repeated with these loads.
const SMALL_IN_BETWEEN: f64 = 1e-4;
/// Most loads from which the mobility is learnt.
const MOST_LOADS: usize = 16;
/// Least accurate solution for a load.
const LEAST_REDUCTION: f64 = 1e-2;
/// Part of the largest load to which solutions for all others are accurate: the flow is so to 1e-6 of what changes it.
const ACCURACY: f64 = 1e-7;

/// What contact needs to know of a pass.
pub(super) struct PassContact<'a, const D: usize> {
    pub stepper: &'a TimeStepper<'a, D>,
    pub state: &'a State<D>,
    pub gaps: Option<&'a dyn Gaps>,
    pub equations: &'a PassEquations<'a, D>,
}

/// Bodies that may be in contact, and the law.
struct Candidates<'a> {
    gaps: &'a dyn Gaps,
    law: &'a Law,
    /// Ascending.
    bodies: Vec<usize>,
}

impl<const D: usize> PassContact<'_, D> {
    /// Replaces loads in a flow, which has those that are known, by those that contact has there. Whether there may be
    /// any, so that its residual is another one.
    ///
    /// # Errors
    /// When contact forces are not found, or the linear system cannot be solved.
    pub fn apply(
        &self,
        work: &mut Workspace<D>,
        flow: &mut Flow<D>,
        known: &mut KnownContact,
    ) -> Result<bool, StepError> {
        let (Some(law), Some(gaps)) = (self.stepper.contact, self.gaps) else { return Ok(false) };
        let bodies = self.candidate_bodies(gaps, law, &flow.solution.twists, &known.loads);
        if bodies.is_empty() {
            return Ok(false);
        }
        let candidates = Candidates { gaps, law, bodies };
        if !work.system.is_iterative() || !self.learn_mobility(&candidates, work, flow, known)? {
            let mobility = self.mobility(&candidates, work)?;
            let next = self.solve(&candidates, flow, &known.loads, &mobility)?.loads;
            self.replace(work, flow, &mut known.loads, next, None)?;
        }
        Ok(true)
    }

    /// Replaces loads in a flow by those that contact has there, by a mobility that is learnt on the way:
    /// each solution for the loads tells more of it. Whether that led to the loads at the gaps, or near enough to
    /// them where the pass is to be repeated.
    fn learn_mobility(
        &self,
        candidates: &Candidates<'_>,
        work: &mut Workspace<D>,
        flow: &mut Flow<D>,
        known: &mut KnownContact,
    ) -> Result<bool, StepError> {
        let Candidates { gaps, law, bodies } = candidates;
        let mut estimate = self.first_estimate(candidates, work, known);
        let applied = &mut known.loads;
        let off_by = |velocities: DVector<f64>, estimate: &MobilityEstimate| {
            let off = estimate.free_part(velocities) / self.equations.history.step.bdf.next;
            gaps.largest_displacement(bodies, self.stepper.problem.modes(), &off)
        };
        let gap_of = |loads: &ContactLoads| {
            loads.minimum_gap.map_or(law.range(), |least| least.gap.min(law.range()))
        };
        let mut largest = estimate.size(&self.loads(bodies, applied));
        let mut is_found = false;
        for attempt in 0..MOST_LOADS {
            let Ok(found) = self.solve(candidates, flow, applied, estimate.matrix()) else { break };
            let change = self.loads(bodies, &found.loads) - self.loads(bodies, applied);
            let size = estimate.size(&change);
            largest = largest.max(size);
            let expected = self.rows(bodies).of_each(found.velocities.iter().map(Twist::to_vector));
            let before = self.velocities(bodies, flow);
            let gap = gap_of(&found.loads);
            let off = off_by(&expected - &before, &estimate) / gap;
            let are_those = size <= SMALL * largest && off <= SMALL;
            if are_those || off <= SMALL_IN_BETWEEN && self.is_to_be_repeated(flow, applied) {
                tracing::debug!(attempt, size, off, gap, "contact as known");
                applied.minimum_gap = found.loads.minimum_gap;
                is_found = true;
                break;
            }
            let reduction = (ACCURACY * largest / size).min(LEAST_REDUCTION);
            self.replace(work, flow, applied, found.loads, Some(reduction))?;
            let now = self.velocities(bodies, flow);
            estimate.learn(change, &now - before);
            let off = off_by(now - expected, &estimate) / gap;
            tracing::debug!(attempt, size, off, gap, bodies = bodies.len(), "contact");
            if off <= SMALL || off <= SMALL_IN_BETWEEN && self.is_to_be_repeated(flow, applied) {
                is_found = true;
                break;
            }
        }
        known.learnt = Some(Learnt { bodies: bodies.clone(), mobility: estimate.into_matrix() });
        Ok(is_found)
    }

    /// Whether bodies get so far from where the flow is solved that the pass is to be repeated there.
    fn is_to_be_repeated(&self, flow: &Flow<D>, loads: &ContactLoads) -> bool {
        let step = &self.equations.history.step;
        let reached = integrate_poses(self.stepper, self.state, step, &flow.solution.twists);
        let solved_at = &self.equations.pass.poses;
        self.stepper.path.placement(solved_at, &reached, loads) == Placed::Elsewhere
    }

    /// The mobility before any load has been tried in this pass.
    fn first_estimate(
        &self,
        candidates: &Candidates<'_>,
        work: &Workspace<D>,
        known: &mut KnownContact,
    ) -> MobilityEstimate {
        let Candidates { gaps, law, bodies } = candidates;
        let loaded = loaded_bodies(*gaps, bodies);
        let motions = work.system.free_motions(&self.equations.pass.constraints, &loaded);
        let estimated = Bodies {
            gaps: *gaps,
            law,
            bodies,
            motions,
            equations: &self.equations.pass.bodies,
            viscosity: self.stepper.problem.viscosity,
        };
        let estimate = estimated.estimate(&self.seen_poses());
        match known.learnt.take().filter(|learnt| learnt.bodies == *bodies) {
            Some(learnt) => estimate.starting_from(learnt.mobility),
            None => estimate,
        }
    }

    /// The mobility of bodies.
    fn mobility(
        &self,
        candidates: &Candidates<'_>,
        work: &mut Workspace<D>,
    ) -> Result<DMatrix<f64>, StepError> {
        let Workspace { system, timing, .. } = work;
        let step = &self.equations.history.step;
        let constraints = &self.equations.pass.constraints;
        let loaded = loaded_bodies(candidates.gaps, &candidates.bodies);
        let mobility = system.mobility(constraints, &loaded, timing);
        Ok(mobility.map_err(|error| RunError::from_solve(error, step.number, step.time))?)
    }

    /// Replaces loads of contact in a flow by others.
    fn replace(
        &self,
        work: &mut Workspace<D>,
        flow: &mut Flow<D>,
        applied: &mut ContactLoads,
        next: ContactLoads,
        reduction: Option<f64>,
    ) -> Result<(), StepError> {
        let changes = body_loads(applied, &next);
        *applied = next;
        add_loads(work, self.equations, &changes, reduction, flow)
    }

    /// The rows of some bodies.
    fn rows<'b>(&self, bodies: &'b [usize]) -> Rows<'b> {
        Rows { bodies, modes: self.stepper.problem.modes() }
    }

    fn velocities(&self, bodies: &[usize], flow: &Flow<D>) -> DVector<f64> {
        self.rows(bodies).of_twists(&flow.solution.twists)
    }

    fn loads(&self, bodies: &[usize], loads: &ContactLoads) -> DVector<f64> {
        self.rows(bodies).of(|body| loads.wrenches[body].to_vector())
    }

    /// Poses of the pass, as seen.
    fn seen_poses(&self) -> Vec<Pose> {
        self.seen(&self.equations.pass.poses)
    }

    /// Poses as seen from where the frame is in this pass: its way is no part of the unknowns.
    fn seen(&self, poses: &[Pose]) -> Vec<Pose> {
        let origin = self.state.origin_at(self.stepper.problem, &self.equations.pass.poses);
        self.state.in_frame(&origin, poses)
    }

    /// The bodies that may get within the range of something with these velocities, and those with loads.
    fn candidate_bodies(
        &self,
        gaps: &dyn Gaps,
        law: &Law,
        twists: &[Twist],
        loads: &ContactLoads,
    ) -> Vec<usize> {
        let step = &self.equations.history.step;
        let without = integrate_poses(self.stepper, self.state, step, twists);
        let [from, to] = [&self.state.poses, &without].map(|poses| self.seen(poses));
        candidate_bodies(gaps, law, [&from, &to], loads)
    }

    /// The contact forces for a flow that has some of them already.
    fn solve(
        &self,
        candidates: &Candidates<'_>,
        flow: &Flow<D>,
        applied: &ContactLoads,
        mobility: &DMatrix<f64>,
    ) -> Result<ContactSolution, StepError> {
        let Candidates { gaps, law, bodies } = candidates;
        let (state, bdf) = (self.state, &self.equations.history.step.bdf);
        let poses = &self.equations.pass.poses;
        let modes = self.stepper.problem.modes();
        let pushed = mobility * self.loads(bodies, applied);
        let free_velocities = self.rows(bodies).twists(&(self.velocities(bodies, flow) - pushed));
        let predicted_velocities: Vec<Twist> = bodies
            .iter()
            .map(|&body| {
                state.poses[body].velocity_to(bdf, &poses[body], &state.previous_poses[body])
            })
            .collect();
        let step = ContactStep {
            gaps: *gaps,
            law,
            modes,
            bodies,
            free_velocities: &free_velocities,
            mobility,
            predicted: &self.seen_poses(),
            predicted_velocities: &predicted_velocities,
            coefficient: 1.0 / bdf.next,
            start: &self.seen(&state.poses),
        };
        Ok(step.solve()?)
    }
}

/// The bodies that may get within the range of something between poses, and those with loads.
pub(super) fn candidate_bodies(
    gaps: &dyn Gaps,
    law: &Law,
    [from, to]: [&[Pose]; 2],
    loads: &ContactLoads,
) -> Vec<usize> {
    let mut bodies = gaps.candidate_bodies(from, to, CONTACT_MARGIN, law.range());
    let wrenches = loads.wrenches.iter().enumerate();
    bodies.extend(wrenches.filter(|(_, load)| is_load(load)).map(|(body, _)| body));
    bodies.sort_unstable();
    bodies.dedup();
    bodies
}

/// Bodies that may be in contact, as the mobility is asked for them: contact does not turn those that are round.
pub(super) fn loaded_bodies(gaps: &dyn Gaps, bodies: &[usize]) -> Vec<LoadedBody> {
    let loaded = |&body: &usize| LoadedBody { body, turns: !gaps.is_round(body) };
    bodies.iter().map(loaded).collect()
}

/// Adds what loads of contact change in a flow found without them, and its residual.
///
/// # Errors
/// When the linear system cannot be solved.
pub(super) fn add_to_flow<const D: usize>(
    work: &mut Workspace<D>,
    equations: &PassEquations<'_, D>,
    loads: &ContactLoads,
    flow: &mut Flow<D>,
) -> Result<(), StepError> {
    let none = ContactLoads::none(loads.wrenches.len());
    add_loads(work, equations, &body_loads(&none, loads), None, flow)?;
    update_residual(work, equations, flow);
    Ok(())
}

/// What is to be added to some loads of contact to get others.
fn body_loads(from: &ContactLoads, to: &ContactLoads) -> Vec<BodyLoad> {
    let pairs = from.wrenches.iter().zip(&to.wrenches).enumerate();
    let changes =
        pairs.map(|(body, (old, new))| BodyLoad { body, load: new.to_vector() - old.to_vector() });
    changes.filter(|on_body| on_body.load.iter().any(|part| *part != 0.0)).collect()
}

fn is_load(wrench: &Wrench) -> bool {
    wrench.to_vector().iter().any(|part| *part != 0.0)
}

/// Adds what loads on some bodies change in a flow.
fn add_loads<const D: usize>(
    work: &mut Workspace<D>,
    equations: &PassEquations<'_, D>,
    loads: &[BodyLoad],
    reduction: Option<f64>,
    flow: &mut Flow<D>,
) -> Result<(), StepError> {
    if loads.is_empty() {
        return Ok(());
    }
    let Workspace { system, timing, .. } = work;
    let step = &equations.history.step;
    system
        .apply_body_loads(&equations.pass.constraints, loads, reduction, &mut flow.solution, timing)
        .map_err(|error| RunError::from_solve(error, step.number, step.time))?;
    Ok(())
}

/// Brings the residual of a flow up to date with the loads that have been added to it.
pub(super) fn update_residual<const D: usize>(
    work: &mut Workspace<D>,
    equations: &PassEquations<'_, D>,
    flow: &mut Flow<D>,
) {
    let Workspace { system, mesh, timing } = work;
    let at = equations.pass.at(equations.problem, mesh);
    flow.residual =
        timing.measure(Stage::Loads, || flow_residual(system, &at, equations, &flow.solution));
}
