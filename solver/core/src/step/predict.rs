//! Where bodies get to: velocities extrapolated, contact expected, and poses integrated from velocities.

use super::context::{Guess, Iterate, StepContext};
use super::error::StepError;
use super::mesh_path::MeshPath;
use super::placement::Placement;
use super::stepper::{Step, TimeStepper};
use super::workspace::Workspace;
use crate::body::{Mode, Pose, RigidVector, Twist};
use crate::contact::ContactPrediction;
use crate::state::State;

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
        let history = &self.history;
        let coordinates = history.coordinates_with(self.state, &history.extrapolated.rates);
        Ok(Iterate {
            placement: self.placement(poses, coordinates)?,
            apart: self.state.poses.clone(),
            guess: Guess::new(history.extrapolated.clone()),
        })
    }

    /// Velocities at the new time with contact as it is expected, where there may be any.
    fn predict_contact(
        &self,
        work: &Workspace<D>,
        extrapolated: &[Twist],
        poses: &[Pose],
    ) -> Option<Vec<Twist>> {
        let Self { stepper: TimeStepper { problem, .. }, state, history, .. } = self;
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
    pub fn keep_gaps_open(&self, iterate: &mut Iterate<D>) {
        let Some(gaps) = self.gaps() else { return };
        let Iterate { placement: Placement { poses, .. }, apart, .. } = iterate;
        let between = |part: f64| -> Vec<Pose> {
            let pairs = apart.iter().zip(&*poses);
            pairs.map(|(from, to)| from.displaced(&(to.displacement_from(from) * part))).collect()
        };
        let part = gaps.part_that_keeps_open(&|part| {
            let seen = |poses: &[Pose]| self.state.in_own_frame(self.stepper.problem, poses);
            match part {
                0.0 => seen(apart),
                1.0 => seen(poses),
                part => seen(&between(part)),
            }
        });
        if part < 1.0 {
            *poses = between(part);
        }
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
