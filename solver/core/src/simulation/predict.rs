//! Where bodies get to: predicted, limited by the gaps between them, and integrated from velocities.

use super::mesh_path::MeshPath;
use super::state::State;
use super::stepper::{Step, TimeStepper};
use crate::body::{Mode, Pose, RigidVector, Twist};
use crate::contact::Gaps;
use crate::coupling::Problem;

/// Part of the smallest gap that is left at least when bodies are put nearer to each other.
const KEPT_GAP: f64 = 0.5;

/// Smallest part of a predicted displacement that is tried.
const SMALLEST_PART: f64 = 1e-6;

impl<const D: usize> TimeStepper<'_, D> {
    /// Whether a body goes where one of its velocities takes it: it stays where the mesh is that does
    /// not follow.
    pub(super) fn moves(&self, body: usize, mode: Mode) -> bool {
        mode.is_rotation()
            || matches!(self.path, MeshPath::FollowsBodies(_))
            || self.problem.frame == Some(body)
    }

    /// The components of a displacement along which a body moves.
    pub(super) fn restricted(&self, body: usize, displacement: &RigidVector) -> RigidVector {
        let mut kept = RigidVector::zeros();
        for mode in self.problem.modes().iter().filter(|mode| self.moves(body, *mode)) {
            kept[mode] = displacement[mode];
        }
        kept
    }
}

/// Poses at the new time, with given velocities as they are then and the others extrapolated.
pub(super) fn predict_poses<const D: usize>(
    stepper: &TimeStepper<'_, D>,
    state: &State<D>,
    step: &Step,
) -> Vec<Pose> {
    integrate_poses(stepper, state, step, &predicted_twists(stepper, state, step))
}

/// Velocities at the new time, given ones as they are then and the others extrapolated.
pub(super) fn predicted_twists<const D: usize>(
    stepper: &TimeStepper<'_, D>,
    state: &State<D>,
    step: &Step,
) -> Vec<Twist> {
    let levels = state.now.twists.iter().zip(&state.previous.twists);
    let twists = stepper.problem.bodies.iter().zip(levels).map(|(body, (now, before))| {
        let mut velocity = step.bdf.extrapolate(now.to_vector(), before.to_vector());
        for mode in Mode::ALL {
            if let Some(given) = body.drive(mode).given(step.time) {
                velocity[mode] = given;
            }
        }
        Twist::from_vector(&velocity)
    });
    twists.collect()
}

/// Poses at the new time of bodies with these velocities there.
pub(super) fn integrate_poses<const D: usize>(
    stepper: &TimeStepper<'_, D>,
    state: &State<D>,
    step: &Step,
    twists: &[Twist],
) -> Vec<Pose> {
    let mut poses = integrated_apart(stepper, state, step, twists);
    stepper.problem.apply_joints(&mut poses, step.time);
    poses
}

/// The same of each body by itself, whatever it hangs on.
fn integrated_apart<const D: usize>(
    stepper: &TimeStepper<'_, D>,
    state: &State<D>,
    step: &Step,
    twists: &[Twist],
) -> Vec<Pose> {
    let levels = state.poses.iter().zip(&state.previous_poses);
    let advanced = levels.zip(twists).enumerate().map(|(body, ((now, before), twist))| {
        let last = now.displacement_from(before);
        let increment = step.bdf.increment(twist.to_vector(), last);
        now.displaced(&stepper.restricted(body, &increment))
    });
    advanced.collect()
}

/// Poses at the new time of bodies without velocity there, whatever they hang on: the velocities of bodies
/// on joints have what the joints give of them, and lead from here to where they are.
pub(super) fn unmoved_poses<const D: usize>(
    stepper: &TimeStepper<'_, D>,
    state: &State<D>,
    step: &Step,
) -> Vec<Pose> {
    integrated_apart(stepper, state, step, &vec![Twist::default(); state.poses.len()])
}

/// As far on the way between poses as leaves some of the smallest gap: predictions know
/// nothing of what is in the way.
pub(super) fn limit_by_gaps<const D: usize>(
    problem: &Problem<D>,
    gaps: Option<&dyn Gaps>,
    state: &State<D>,
    from: &[Pose],
    to: Vec<Pose>,
) -> Vec<Pose> {
    let Some(gaps) = gaps else { return to };
    let on_the_way = |part: f64| {
        let pairs = from.iter().zip(&to);
        pairs.map(|(from, to)| from.displaced(&(to.displacement_from(from) * part))).collect()
    };
    let at = |part: f64| if part == 1.0 { to.clone() } else { on_the_way(part) };
    let part = part_left_by_gaps(problem, gaps, state, from, at);
    if part == 1.0 { to } else { on_the_way(part) }
}

/// The part of a way from some poses that leaves some of their smallest gap: 1, or halved as often as that asks for.
pub(super) fn part_left_by_gaps<const D: usize>(
    problem: &Problem<D>,
    gaps: &dyn Gaps,
    state: &State<D>,
    from: &[Pose],
    on_the_way: impl Fn(f64) -> Vec<Pose>,
) -> f64 {
    let gap = |poses: &[Pose]| {
        let minimum = gaps.minimum_gap(&state.in_own_frame(problem, poses));
        minimum.map_or(f64::INFINITY, |minimum| minimum.gap)
    };
    let kept = KEPT_GAP * gap(from);
    let mut part = 1.0;
    while gap(&on_the_way(part)) < kept && part > SMALLEST_PART {
        part *= 0.5;
    }
    part
}
