//! Where bodies get to: velocities extrapolated, contact expected, and poses integrated from velocities.

use super::context::{Apart, Guess, Iterate, StepContext};
use super::error::StepError;
use super::mesh_path::MeshPath;
use super::placement::Placement;
use super::stepper::{Step, TimeStepper};
use super::workspace::Workspace;
use crate::body::{Mode, Pose, RigidVector, Twist};
use crate::contact::{ContactLoads, ContactPrediction, largest_open_part};
use crate::state::State;

/// Difference of the turns of a magnet at convergence (rad).
const TURN_TOLERANCE: f64 = 1e-3;

/// Turn of a magnet in a step that is predicted at most (rad): from further on the iteration would lead to the field by
/// another number of whole turns.
const MAX_PREDICTED_TURN: f64 = 0.5;

impl<const D: usize> TimeStepper<'_, D> {
    /// Whether a body goes where one of its velocities takes it: it stays where the mesh is that does
    /// not follow.
    fn moves(&self, body: usize, mode: Mode) -> bool {
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

    /// Poses at the new time of bodies with these velocities there, each by itself, whatever it hangs on.
    fn integrate_apart(&self, state: &State<D>, step: &Step, twists: &[Twist]) -> Vec<Pose> {
        let levels = state.poses.iter().zip(&state.previous_poses);
        let advanced = levels.zip(twists).enumerate().map(|(body, ((now, before), twist))| {
            let last = now.displacement_from(before);
            let increment = step.bdf.increment(twist.to_vector(), last);
            now.displaced(&self.restricted(body, &increment))
        });
        advanced.collect()
    }

    /// Poses at the new time of bodies without velocity there, whatever they hang on: the velocities of bodies
    /// on joints have what the joints give of them, and lead from here to where they are.
    pub(super) fn unmoved_poses(&self, state: &State<D>, step: &Step) -> Vec<Pose> {
        self.integrate_apart(state, step, &vec![Twist::default(); state.poses.len()])
    }
}

impl<const D: usize> StepContext<'_, D> {
    /// Bodies and flow at the new time, extrapolated, with contact as it is expected there.
    ///
    /// # Errors
    /// When a body has no shape there.
    pub fn predict(&self, work: &Workspace<D>) -> Result<Iterate<D>, StepError> {
        let twists = self.extrapolated_twists();
        let poses = self.integrated_poses(&twists);
        let in_contact = self.predict_contact(work, &twists, &poses);
        let poses = in_contact.map_or(poses, |twists| self.integrated_poses(&twists));
        let poses = self.with_small_turns_of_magnets(poses);
        let history = &self.history;
        let coordinates = history.coordinates_with(self.state, &history.extrapolated.rates);
        Ok(Iterate {
            placement: self.placement(poses, coordinates)?,
            apart: Apart {
                poses: self.state.poses.clone(),
                coordinates: self.state.shapes.now.clone(),
            },
            guess: Guess::new(history.extrapolated.clone()),
        })
    }

    /// Predicted poses with smaller turns of those bodies that fields turn and that are predicted to turn far.
    fn with_small_turns_of_magnets(&self, mut poses: Vec<Pose>) -> Vec<Pose> {
        let Self { stepper: TimeStepper { problem, .. }, state, history, .. } = self;
        let mut is_changed = false;
        for (body, pose) in poses.iter_mut().enumerate() {
            let now = &state.poses[body];
            let displacement = pose.displacement_from(now);
            let turn = displacement.fixed_rows::<3>(3).norm();
            if problem.bodies[body].magnet.is_some() && turn > MAX_PREDICTED_TURN {
                let smaller = now.displaced(&(displacement * (MAX_PREDICTED_TURN / turn)));
                pose.orientation = smaller.orientation;
                is_changed = true;
            }
        }
        if is_changed {
            problem.apply_joints(&mut poses, history.step.time);
        }
        poses
    }

    /// Velocities at the new time with contact as it is expected, where there may be any.
    fn predict_contact(
        &self,
        work: &Workspace<D>,
        extrapolated: &[Twist],
        poses: &[Pose],
    ) -> Option<Vec<Twist>> {
        let Self { stepper: TimeStepper { problem, .. }, state, history, .. } = self;
        // What a rod does in a contact is not to be told from its drag
        if self.has_elastic_contact() {
            return None;
        }
        let equations = history.body_equations(problem, &state.poses);
        let prediction = ContactPrediction {
            contact: self.contact_at(poses, &equations)?,
            extrapolated,
            velocities: &state.now.twists,
            accelerations: &state.accelerations,
            older: equations.bodies.iter().map(|body| body.history).collect(),
            loads: &state.contact,
        };
        let bodies = state.in_mesh(&state.poses);
        let time = history.boundary_shapes().time();
        prediction.velocities(|loaded| work.system.free_motions_at(problem, &bodies, time, loaded))
    }

    /// Shortens the displacements of all bodies by one factor where some would get too near to each other: predictions know
    /// nothing of what is in the way.
    ///
    /// # Errors
    /// When bodies have no shape between.
    pub fn keep_gaps_open(&self, iterate: &mut Iterate<D>) -> Result<(), StepError> {
        if self.has_elastic_contact() {
            return self.keep_gaps_open_by_shapes(iterate);
        }
        let Some(gaps) = self.gaps() else { return Ok(()) };
        let Iterate {
            placement: Placement { poses, .. }, apart: Apart { poses: apart, .. }, ..
        } = iterate;
        let between = |part: f64| -> Vec<Pose> {
            let pairs = apart.iter().zip(&*poses);
            pairs.map(|(from, to)| from.displaced(&(to.displacement_from(from) * part))).collect()
        };
        let part = gaps.part_that_keeps_open(&|part| {
            let seen =
                |poses: &[Pose]| self.state.in_own_frame(self.stepper.problem, poses).into_vec();
            match part {
                0.0 => seen(apart),
                1.0 => seen(poses),
                part => seen(&between(part)),
            }
        });
        if part < 1.0 {
            *poses = between(part);
        }
        Ok(())
    }

    /// The same of bodies with coordinates, which bend on the way.
    fn keep_gaps_open_by_shapes(&self, iterate: &mut Iterate<D>) -> Result<(), StepError> {
        let Self { stepper, state, .. } = self;
        let (apart, to) = (&iterate.apart, &iterate.placement);
        let between = |part: f64| {
            let pairs = apart.poses.iter().zip(&to.poses);
            let poses = pairs
                .map(|(from, to)| from.displaced(&(to.displacement_from(from) * part)))
                .collect();
            let pairs = apart.coordinates.iter().zip(&to.coordinates);
            let coordinates = pairs.map(|(from, to)| from + (to - from) * part).collect();
            self.placement(poses, coordinates)
        };
        let gap_of = |placement: &Placement| {
            let gaps = stepper.path.gaps(&placement.shapes)?;
            gaps.minimum_gap(&state.in_own_frame(stepper.problem, &placement.poses))
        };
        let gap_at = |part: f64| match part {
            1.0 => gap_of(to).map_or(f64::INFINITY, |minimum| minimum.gap),
            part => match between(part) {
                Ok(placement) => gap_of(&placement).map_or(f64::INFINITY, |minimum| minimum.gap),
                // No shape is none that keeps gaps open
                Err(_) => f64::NEG_INFINITY,
            },
        };
        let part = largest_open_part(gap_at);
        if part < 1.0 {
            iterate.placement = between(part)?;
        }
        Ok(())
    }

    /// Whether bodies get to where the flow was solved for, with these loads of contact: the fixed-point iteration
    /// ends there.
    pub fn has_converged(
        &self,
        solved_at: &Placement,
        reached: &Placement,
        contact: &ContactLoads,
    ) -> bool {
        self.stepper.path.has_converged(solved_at, reached, contact)
            && self.magnets_have_turned(&solved_at.poses, &reached.poses)
    }

    /// Whether bodies with a magnetic moment are turned as they were for the flow that was solved: where they are
    /// round, no mesh tells.
    fn magnets_have_turned(&self, solved_at: &[Pose], reached: &[Pose]) -> bool {
        let bodies = self.stepper.problem.bodies.iter().zip(solved_at.iter().zip(reached));
        bodies.filter(|(body, _)| body.magnet.is_some()).all(|(_, (solved, reached))| {
            reached.displacement_from(solved).fixed_rows::<3>(3).norm() <= TURN_TOLERANCE
        })
    }

    /// Velocities at the new time, given ones as they are then and the others extrapolated.
    pub fn extrapolated_twists(&self) -> Vec<Twist> {
        let step = &self.history.step;
        let levels = self.state.now.twists.iter().zip(&self.state.previous.twists);
        let bodies = self.stepper.problem.bodies.iter();
        let twists = bodies.zip(levels).map(|(body, (now, before))| {
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
    pub fn integrated_poses(&self, twists: &[Twist]) -> Vec<Pose> {
        let step = &self.history.step;
        let mut poses = self.stepper.integrate_apart(self.state, step, twists);
        self.stepper.problem.apply_joints(&mut poses, step.time);
        poses
    }
}
